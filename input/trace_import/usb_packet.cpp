#include "input/trace_import/usb_packet.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace limn {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kSetupBytes = 8;
constexpr std::uint8_t kIn = 0x80;

/// A number in this machine's byte order. Precondition: it is within `bytes`.
template <class T>
T native(Bytes bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// A number low byte first. Precondition: it is within `bytes`.
template <class T>
T little(Bytes bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = sizeof(T); i-- > 0;) value = value << 8 | bytes[at + i];
  return static_cast<T>(value);
}

UsbTransfer transfer_of(std::uint8_t type) {
  return type <= 3 ? static_cast<UsbTransfer>(type) : UsbTransfer::kOther;
}

tl::unexpected<Error> too_short(std::size_t size, std::size_t header) {
  return fail(ErrorCode::kSyntax, "",
              "the packet has " + std::to_string(size) + " bytes, fewer than the " +
                  std::to_string(header) + " of its header",
              "add --salvage to skip it");
}

/// The first `length` bytes of `rest`, as many as there are.
void take_data(UsbPacket& packet, Bytes rest, std::size_t length) {
  packet.data = rest.first(std::min(rest.size(), length));
  packet.missing = length - packet.data.size();
}

/// struct usbmon_packet of Linux, Documentation/usb/usbmon.rst.
Expected<UsbPacket> usbmon(Bytes bytes, std::size_t header) {
  constexpr std::uint8_t kSubmitted = 'S';
  constexpr std::uint8_t kNotThere = '<';  // and '>': data go the other way
  constexpr std::uint8_t kNotThereEither = '>';
  constexpr std::int32_t kShortTransfer = -121;  // EREMOTEIO, and yet there are data
  if (bytes.size() < header) return too_short(bytes.size(), header);
  UsbPacket packet;
  packet.request = native<std::uint64_t>(bytes, 0);
  packet.completed = bytes[8] != kSubmitted;
  packet.transfer = transfer_of(bytes[9]);
  packet.endpoint = bytes[10];
  packet.device = bytes[11];
  packet.bus = native<std::uint16_t>(bytes, 12);
  const auto status = native<std::int32_t>(bytes, 28);
  packet.failed = packet.completed && status != 0 && status != kShortTransfer;
  const bool has_setup = bytes[14] == 0;
  if (has_setup && !packet.completed) packet.setup = bytes.subspan(40, kSetupBytes);
  const std::uint8_t data_flag = bytes[15];
  if (data_flag == kNotThere || data_flag == kNotThereEither) return packet;
  const auto length = native<std::uint32_t>(bytes, 32);
  const auto captured = native<std::uint32_t>(bytes, 36);
  take_data(packet,
            bytes.subspan(header).first(std::min<std::size_t>(bytes.size() - header, captured)),
            length);
  return packet;
}

/// USBPCAP_BUFFER_PACKET_HEADER, desowin.org/usbpcap/captureformat.html.
Expected<UsbPacket> usbpcap(Bytes bytes) {
  constexpr std::size_t kHeader = 27;
  constexpr std::uint8_t kFromDevice = 1;
  constexpr std::uint8_t kSetupStage = 0;
  if (bytes.size() < kHeader) return too_short(bytes.size(), kHeader);
  UsbPacket packet;
  const std::size_t header = std::max<std::size_t>(little<std::uint16_t>(bytes, 0), kHeader);
  packet.request = little<std::uint64_t>(bytes, 2);
  packet.completed = (bytes[16] & kFromDevice) != 0;
  packet.failed = packet.completed && (little<std::uint32_t>(bytes, 10) >> 31) != 0;
  packet.bus = little<std::uint16_t>(bytes, 17);
  packet.device = little<std::uint16_t>(bytes, 19);
  packet.endpoint = bytes[21];
  packet.transfer = transfer_of(bytes[22]);
  const bool control = packet.transfer == UsbTransfer::kControl;
  if (bytes.size() < header || (control && header == kHeader)) {
    return too_short(bytes.size(), control ? std::max(header, kHeader + 1) : header);
  }
  take_data(packet, bytes.subspan(header), little<std::uint32_t>(bytes, 23));
  if (control && !packet.completed && bytes[kHeader] == kSetupStage) {
    if (packet.data.size() < kSetupBytes) return too_short(bytes.size(), header + kSetupBytes);
    packet.setup = packet.data.first(kSetupBytes);
    packet.data = packet.data.subspan(kSetupBytes);
  }
  return packet;
}

}  // namespace

Expected<UsbPacket> parse_usb_packet(UsbLink link, std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kHeader48 = 48;
  constexpr std::size_t kHeader64 = 64;
  auto packet = link == UsbLink::kUsbPcap
                    ? usbpcap(bytes)
                    : usbmon(bytes, link == UsbLink::kUsbmon48 ? kHeader48 : kHeader64);
  // A control transfer's endpoint has no direction; USBPcap gives it that of the data.
  if (packet && packet->transfer == UsbTransfer::kControl) packet->endpoint &= kIn - 1;
  return packet;
}

}  // namespace limn
