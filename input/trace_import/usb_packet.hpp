#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "input/base/error.hpp"
#include "input/base/time.hpp"

namespace limn {

/// How a packet of a USB capture is laid out: the link types of pcap and pcapng files that limn
/// knows (tcpdump.org/linktypes.html).
///
///     kUsbmon48   189  Linux usbmon, a header of 48 bytes, numbers in the host's byte order
///     kUsbmon64   220  the same with 64 bytes
///     kUsbPcap    249  USBPcap of Windows, 27 bytes and more, low byte first
enum class UsbLink { kUsbmon48 = 189, kUsbmon64 = 220, kUsbPcap = 249 };

enum class UsbTransfer : std::uint8_t { kIsochronous, kInterrupt, kControl, kBulk, kOther };

/// One packet of a USB capture, whatever captured it: a transfer as it was submitted, or as it
/// ended. The spans are borrowed from the bytes it was made of.
struct UsbPacket {
  std::uint64_t number = 0;   ///< in the file, from 1
  Timestamp time{};           ///< since the file's first packet, 0 before it
  std::uint64_t request = 0;  ///< ties an end to its submission; used again afterwards
  std::uint16_t bus = 0;
  std::uint16_t device = 0;   ///< its address
  std::uint8_t endpoint = 0;  ///< bit 7: towards the host
  UsbTransfer transfer = UsbTransfer::kOther;
  bool completed = false;               ///< the end of a transfer
  bool failed = false;                  ///< which went wrong: a stall, an unplugged device
  std::span<const std::uint8_t> setup;  ///< of a submitted control transfer: 8 bytes, else none
  std::span<const std::uint8_t> data;   ///< what was sent or came back, where it is in the capture
  std::size_t missing = 0;  ///< bytes of `data` that were not captured (the snapshot length)
};

/// Reads a captured packet; leaves `number` and `time` zero. For usbmon, numbers are in this
/// machine's byte order, as libpcap gives them.
/// Error: kSyntax where it is shorter than its header.
Expected<UsbPacket> parse_usb_packet(UsbLink link, std::span<const std::uint8_t> bytes);

}  // namespace limn
