#pragma once

#include <cstdint>
#include <span>

namespace limn {

/// A control request without its data: the fields of a setup packet (USB 2.0, 9.3), wLength left
/// to the transfer.
struct ControlRequest {
  std::uint8_t type = 0;  ///< bmRequestType: direction, type and recipient
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
};

/// GET_DESCRIPTOR of a string, to the device.
constexpr ControlRequest string_request(std::uint8_t index, std::uint16_t language) noexcept {
  return {0x80, 6, static_cast<std::uint16_t>(3 << 8 | index), language};
}

/// SET_REPORT and GET_REPORT of a feature report (HID 1.11, 7.2), to an interface.
constexpr ControlRequest set_feature_request(std::uint8_t id, std::uint8_t interface) noexcept {
  return {0x21, 9, static_cast<std::uint16_t>(3 << 8 | id), interface};
}
constexpr ControlRequest get_feature_request(std::uint8_t id, std::uint8_t interface) noexcept {
  return {0xA1, 1, static_cast<std::uint16_t>(3 << 8 | id), interface};
}

/// SET_REPORT of an output report.
constexpr ControlRequest set_output_request(std::uint8_t id, std::uint8_t interface) noexcept {
  return {0x21, 9, static_cast<std::uint16_t>(2 << 8 | id), interface};
}

/// The data of SET_REPORT for a report whose first byte is its ID: an ID of 0 stands for no ID, and
/// does not travel. Precondition: `report` is not empty.
constexpr std::span<const std::uint8_t> report_data(std::span<const std::uint8_t> report) noexcept {
  return report.subspan(report[0] == 0 ? 1 : 0);
}

}  // namespace limn
