#include "firmware_sim/link/usbip_protocol.hpp"

#include <algorithm>

namespace limn::firmware::usbip {
namespace {

constexpr std::size_t kPathBytes = 256;
constexpr std::string_view kPath = "/sys/devices/limn/usb1/1-1";
constexpr std::uint8_t kHidClass = 3;

std::uint32_t number(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[at + i];
  return value;
}

std::uint16_t high_first(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

std::uint16_t low_first(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at + 1] << 8 | bytes[at]);
}

void append_text(std::vector<std::uint8_t>& out, std::string_view text, std::size_t size) {
  const std::size_t end = out.size() + size;
  out.insert(out.end(), text.begin(), text.end());
  out.resize(end);
}

}  // namespace

OperationHeader read_operation(std::span<const std::uint8_t, kOperationBytes> bytes) noexcept {
  return {high_first(bytes, 0), high_first(bytes, 2), number(bytes, 4)};
}

UrbHeader read_urb(std::span<const std::uint8_t, kUrbBytes> bytes) noexcept {
  UrbHeader urb;
  urb.command = number(bytes, 0);
  urb.sequence = number(bytes, 4);
  urb.direction = number(bytes, 12);
  urb.endpoint = number(bytes, 16);
  urb.unlinked = number(bytes, 20);  // of a submit: flags
  urb.length = number(bytes, 24);
  urb.packets = number(bytes, 32);
  urb.setup = {bytes[40], bytes[41], low_first(bytes, 42), low_first(bytes, 44),
               low_first(bytes, 46)};
  return urb;
}

void append_number(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    out.push_back(static_cast<std::uint8_t>(value >> shift & 0xFF));
  }
}

void append_number(std::vector<std::uint8_t>& out, std::uint16_t value) {
  out.push_back(static_cast<std::uint8_t>(value >> 8));
  out.push_back(static_cast<std::uint8_t>(value & 0xFF));
}

void append_operation(std::vector<std::uint8_t>& out, Operation code, OperationStatus status) {
  append_number(out, kVersion);
  append_number(out, static_cast<std::uint16_t>(code));
  append_number(out, static_cast<std::uint32_t>(status));
}

void append_device(std::vector<std::uint8_t>& out, const DeviceSpec& spec) {
  append_text(out, kPath, kPathBytes);
  append_text(out, kBusId, kBusIdBytes);
  for (const std::uint32_t value : {kBusNumber, kDeviceNumber, kFullSpeed}) {
    append_number(out, value);
  }
  for (const std::uint16_t value : {spec.vendor, spec.product, spec.version}) {
    append_number(out, value);
  }
  const auto interfaces = static_cast<std::uint8_t>(spec.interfaces.size());
  // Class, subclass and protocol are the interfaces'; configuration 1, of 1.
  for (const int value : {0, 0, 0, 1, 1}) out.push_back(static_cast<std::uint8_t>(value));
  out.push_back(interfaces);
}

void append_interfaces(std::vector<std::uint8_t>& out, const DeviceSpec& spec) {
  for (const InterfaceSpec& interface : spec.interfaces) {
    for (const std::uint8_t value : {kHidClass, interface.subclass, interface.protocol}) {
      out.push_back(value);
    }
    out.push_back(0);  // padding
  }
}

void append_returned_submit(std::vector<std::uint8_t>& out, std::uint32_t sequence,
                            std::int32_t status, std::uint32_t actual,
                            std::span<const std::uint8_t> data) {
  const std::size_t end = out.size() + kUrbBytes;
  append_number(out, static_cast<std::uint32_t>(Command::kReturnSubmit));
  append_number(out, sequence);
  out.resize(out.size() + 12);  // device, direction, endpoint: a client goes by the sequence number
  append_number(out, static_cast<std::uint32_t>(status));
  append_number(out, actual);
  out.resize(end);  // start frame, packets, errors, padding
  out.insert(out.end(), data.begin(), data.end());
}

void append_returned_unlink(std::vector<std::uint8_t>& out, std::uint32_t sequence,
                            std::int32_t status) {
  const std::size_t end = out.size() + kUrbBytes;
  append_number(out, static_cast<std::uint32_t>(Command::kReturnUnlink));
  append_number(out, sequence);
  out.resize(out.size() + 12);
  append_number(out, static_cast<std::uint32_t>(status));
  out.resize(end);
}

}  // namespace limn::firmware::usbip
