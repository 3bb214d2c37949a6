#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware_sim/usb/bus_device.hpp"
#include "firmware_sim/usb/usb_function.hpp"

namespace limn::firmware {

/// The device side of USB for a HID device: chapter 9's requests and those of the HID class, with
/// the state they set. A link (firmware_sim/link) brings it what the host wants, whole transfers at
/// a time; the UsbFunction behind it answers what is the device's own.
///
///     request                          answered
///     GET_DESCRIPTOR                   device, configuration (with all below it), strings, HID,
///                                      report; stall for others (a full-speed device has no
///                                      qualifier)
///     SET_ADDRESS, SET_CONFIGURATION   as 9.4.6, 9.4.7 say; wrong numbers stall
///     GET_CONFIGURATION, GET_STATUS,   interface 0..n-1, alternate setting 0 only
///     GET_INTERFACE, SET_INTERFACE
///     SET_FEATURE, CLEAR_FEATURE       endpoint halt, remote wakeup
///     GET_REPORT, SET_REPORT           by the function; input reports not given yet: the last one
///     GET_IDLE, SET_IDLE               kept for each report ID; a report that does not change is
///                                      repeated at that rate, at 0 never
///     GET_PROTOCOL, SET_PROTOCOL       boot interfaces only
///
/// An answer is cut to wLength. Sources: USB 2.0, chapter 9; HID 1.11, section 7.
/// Memory: the object alone. No heap, exceptions or RTTI. One thread at a time.
class UsbDevice final : public BusDevice {
 public:
  static constexpr std::size_t kMostInterfaces = 4;
  static constexpr std::size_t kMostEndpoints = 8;
  static constexpr std::size_t kMostReportBytes = 1024;

  /// `function` must outlive this. Precondition: its spec keeps the limits above.
  explicit UsbDevice(UsbFunction& function) noexcept;

  const DeviceSpec& spec() const noexcept override { return function_.spec(); }
  bool plugged(std::chrono::microseconds) noexcept override { return true; }
  void reset() noexcept override;
  TransferResult control(const SetupPacket& setup, std::chrono::microseconds now,
                         std::span<std::uint8_t> data) noexcept override;
  TransferResult interrupt_in(std::uint8_t endpoint, std::chrono::microseconds now,
                              std::span<std::uint8_t> data) noexcept override;
  TransferResult interrupt_out(std::uint8_t endpoint, std::chrono::microseconds now,
                               std::span<const std::uint8_t> data) noexcept override;

  std::uint8_t address() const noexcept { return address_; }
  std::uint8_t configuration() const noexcept { return configuration_; }

 private:
  UsbFunction& function_;
  std::uint8_t address_ = 0;
  std::uint8_t configuration_ = 0;
};

}  // namespace limn::firmware
