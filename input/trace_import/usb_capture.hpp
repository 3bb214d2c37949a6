#pragma once

#include <memory>
#include <optional>

#include "input/base/byte_stream.hpp"
#include "input/base/error.hpp"
#include "input/trace_import/usb_packet.hpp"

namespace limn {

/// The packets of a pcap or pcapng file of USB, in file order, as libpcap reads it: of any byte
/// order, with microseconds or nanoseconds.
///
/// A stream: what is held is the packet in hand. (A damaged file may claim a packet of as much as
/// libpcap allows, 128 MB, which is then set aside for it.) Not thread-safe.
class UsbCapture {
 public:
  /// Reads the head of the file.
  /// Error: kIo; kSyntax where it is no such file; kUnknown for a link type other than UsbLink's;
  /// kMissing where limn was built without libpcap.
  static Expected<UsbCapture> open(std::unique_ptr<ByteSource> bytes);

  UsbCapture(UsbCapture&&) noexcept;
  UsbCapture& operator=(UsbCapture&&) noexcept;
  ~UsbCapture();

  /// The next packet, whose spans are good until the next call; nothing at the end.
  /// Error, with its place ("packet 12"): kIo; kSyntax, kOutOfRange for a damaged packet, behind
  /// which the next call goes on, or for a damaged file, after which ended() is true.
  Expected<std::optional<UsbPacket>> next();

  /// Whether there is nothing more to come.
  bool ended() const noexcept;

  /// How many packets were begun.
  std::uint64_t packet_count() const noexcept;

 private:
  struct Impl;
  explicit UsbCapture(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
