#pragma once

#include <cstdint>
#include <string>

namespace limn::test {

/// Numbers and bytes, in one byte order.
class Bytes {
 public:
  explicit Bytes(bool big_endian = false) : big_endian_(big_endian) {}
  Bytes& number(std::uint64_t value, int size);
  Bytes& text(const std::string& more) {
    text_ += more;
    return *this;
  }
  const std::string& str() const { return text_; }

 private:
  bool big_endian_;
  std::string text_;
};

/// A transfer as the captures below tell it.
struct Transfer {
  int kind = 1;  ///< 1 interrupt, 2 control
  bool completed = true;
  int device = 5;
  int endpoint = 0x81;
  int request = 1;
  std::string setup = {};  ///< 8 bytes: a control transfer begins
  std::string data = {};
  bool failed = false;
};

/// A packet of usbmon (`header` 48 or 64 bytes), in either byte order, and one of USBPcap.
std::string usbmon_packet(const Transfer& transfer, int header, bool big_endian = false);
std::string usbpcap_packet(const Transfer& transfer);

/// A capture file: packets 1 ms apart from 1000.5 s on.
class CaptureFile {
 public:
  enum class Kind { kPcap, kPcapng };
  CaptureFile(Kind kind, int link, bool big_endian = false);
  /// `left_out` bytes at its end were not captured.
  CaptureFile& packet(const std::string& bytes, std::size_t left_out = 0);
  const std::string& str() const { return file_; }

 private:
  std::string block(std::uint32_t type, const std::string& content) const;

  Kind kind_;
  bool big_endian_;
  std::string file_;
  int count_ = 0;
};

}  // namespace limn::test
