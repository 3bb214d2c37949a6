#pragma once

#include <cstdint>

#include "firmware_sim/usb/bus_device.hpp"

/// The requests that every host makes [USB 2.0, 9.4; HID 1.11, 7.2], as setup packets.
namespace limn::firmware {

inline constexpr std::uint8_t kToHost = 0x80;  ///< of bmRequestType, and of endpoint addresses

constexpr SetupPacket set_address(std::uint8_t address) { return {0x00, 5, address, 0, 0}; }

constexpr SetupPacket set_configuration(std::uint8_t value) { return {0x00, 9, value, 0, 0}; }

constexpr SetupPacket clear_halt(std::uint8_t endpoint) { return {0x02, 1, 0, endpoint, 0}; }

/// Input reports come only where something has changed.
constexpr SetupPacket set_idle_forever(std::uint8_t interface) {
  return {0x21, 0x0A, 0, interface, 0};
}

constexpr SetupPacket get_string(std::uint8_t index, std::uint16_t language, std::uint16_t length) {
  return {kToHost, 6, static_cast<std::uint16_t>(0x0300 | index), language, length};
}

constexpr SetupPacket get_report_descriptor(std::uint8_t interface, std::uint16_t length) {
  return {0x81, 6, 0x2200, interface, length};
}

constexpr std::uint16_t report_value(ReportKind kind, std::uint8_t id) {
  return static_cast<std::uint16_t>(static_cast<unsigned>(kind) << 8 | id);
}

constexpr SetupPacket get_report(std::uint8_t interface, ReportKind kind, std::uint8_t id,
                                 std::uint16_t length) {
  return {0xA1, 0x01, report_value(kind, id), interface, length};
}

constexpr SetupPacket set_report(std::uint8_t interface, ReportKind kind, std::uint8_t id,
                                 std::uint16_t length) {
  return {0x21, 0x09, report_value(kind, id), interface, length};
}

}  // namespace limn::firmware
