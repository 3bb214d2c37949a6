#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/cli/run_limn.hpp"
#include "tests/support/temp_folder.hpp"

namespace limn::test {

/// A USB device with one HID interface that umockdev simulates below the C library: sysfs, and
/// usbfs, which answers libusb's transfers in the order of the script that the members write. A
/// transfer that the script does not expect waits for ever.
class SimulatedUsb {
 public:
  using Bytes = std::vector<std::uint8_t>;

  std::uint16_t vendor = 0x1209;
  std::uint16_t product = 1;
  std::uint8_t interface_number = 0;
  std::uint16_t packet_bytes = 64;
  Bytes report_descriptor;
  std::uint16_t announced_descriptor = 0;  ///< its length as the interface says; 0: what it is
  std::string driver = "hid-generic";      ///< Linux's, which has read that descriptor
  bool on_hidraw = false;                  ///< and made /dev/hidraw0 of it

  /// The device is asked for its report descriptor: always the first of its transfers on USB.
  void give_descriptor();
  /// It is asked for a string (in US English) and answers; nothing: it stalls.
  void give_string(std::uint8_t index, const Bytes& answer);
  /// It is sent an output report over the control pipe.
  void take_output(const Bytes& bytes);
  /// It is sent a feature report.
  void take_feature(const Bytes& bytes);
  /// It is asked for a feature report, at most `length` bytes, and answers.
  void give_feature(std::uint8_t id, const Bytes& answer, std::uint16_t length);
  /// Its interrupt-out endpoint 3 is written to.
  void take_interrupt(const Bytes& bytes);
  /// It sends a report into a transfer of so many bytes.
  void send(const Bytes& report, std::uint32_t transfer_bytes);
  /// Such a transfer fails, with an errno: EPIPE stalls, ENODEV is an unplugged device.
  void fail(int error, std::uint32_t transfer_bytes);

  /// Runs limn on it. `before` are shell commands ahead, in the simulation; `options` more words
  /// for umockdev-run.
  CommandRun limn(const std::string& words, const std::string& before = {},
                  const std::string& options = {}) const;
  /// The same with another program.
  CommandRun run(const std::string& program, const std::string& words,
                 const std::string& before = {}, const std::string& options = {}) const;

  /// Writes what umockdev is told of it; the file's path.
  std::string write_description() const {
    return folder_.write("usb.umockdev", device_text()).string();
  }

  /// A path in a folder of its own.
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  /// Where its node lies while it runs, for `before`.
  static constexpr const char* kNode = "\"$UMOCKDEV_DIR\"/dev/bus/usb/001/002";

 private:
  TempFolder folder_;
  std::string packets_;
  std::uint64_t requests_ = 0;

  void take_report(std::uint8_t kind, const Bytes& bytes);
  void exchange(std::uint8_t type, std::uint8_t endpoint, const Bytes& setup, std::uint32_t length,
                const Bytes& out, int status, const Bytes& in);
  std::string device_text() const;
  Bytes descriptors() const;
};

}  // namespace limn::test
