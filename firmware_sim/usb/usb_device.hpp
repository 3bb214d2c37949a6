#pragma once

#include <array>
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
///     SET_ADDRESS, SET_CONFIGURATION   as 9.4.6, 9.4.7 say; wrong numbers stall. A device without
///                                      an address may be configured: USB/IP gives it none
///     GET_CONFIGURATION, GET_STATUS,   interface 0..n-1, alternate setting 0 only
///     GET_INTERFACE, SET_INTERFACE
///     SET_FEATURE, CLEAR_FEATURE       endpoint halt, remote wakeup
///     GET_REPORT, SET_REPORT           by the function; input reports not given yet: the last one
///     GET_IDLE, SET_IDLE               kept for each report ID; a report that does not change is
///                                      repeated at that rate, at 0 never
///     GET_PROTOCOL, SET_PROTOCOL       boot interfaces only; kept, but reports are the same in
///     both vendor and any other requests    by the function
///
/// Only descriptors, device requests and the function's own are answered before SET_CONFIGURATION.
/// An answer is cut to wLength. Sources: USB 2.0, chapter 9; HID 1.11, section 7.
/// Memory: the object alone. No heap, exceptions or RTTI. One thread at a time.
class UsbDevice final : public BusDevice {
 public:
  static constexpr std::size_t kMostInterfaces = 4;
  static constexpr std::size_t kMostEndpoints = 8;
  static constexpr std::size_t kMostReportBytes = 512;
  /// Input reports, by interface and ID, that are remembered. Of one more, GET_REPORT and SET_IDLE
  /// stall, and it is not repeated.
  static constexpr std::size_t kMostReports = 12;

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
  std::chrono::microseconds silent_until(std::chrono::microseconds now) noexcept override;

  std::uint8_t address() const noexcept { return address_; }
  std::uint8_t configuration() const noexcept { return configuration_; }

 private:
  /// The last input report of one ID, and how often it is to be repeated.
  struct Kept {
    bool used = false;
    std::uint8_t interface = 0;
    std::uint8_t id = 0;
    std::uint8_t idle = 0;  // in units of 4 ms; 0: never
    std::chrono::microseconds sent{};
    std::size_t bytes = 0;  // 0: none was sent yet
    std::array<std::uint8_t, kMostReportBytes> report{};
  };

  struct Endpoint {
    std::uint8_t address = 0;
    std::uint8_t interface = 0;
    bool halted = false;
  };

  void forget() noexcept;
  bool configured() const noexcept { return configuration_ != 0; }
  bool has_interface(std::uint16_t index) const noexcept;
  Endpoint* find_endpoint(std::uint16_t address) noexcept;
  Kept* find_kept(std::uint8_t interface, std::uint8_t id) noexcept;
  Kept* keep(std::uint8_t interface, std::uint8_t id) noexcept;

  int answer(const SetupPacket& setup, std::span<const std::uint8_t> out,
             std::span<std::uint8_t> in) noexcept;
  int descriptor(const SetupPacket& setup, std::span<std::uint8_t> in) noexcept;
  int string(std::uint8_t index, std::uint16_t language, std::span<std::uint8_t> in) noexcept;
  int set_address(const SetupPacket& setup) noexcept;
  int set_configuration(const SetupPacket& setup) noexcept;
  int status(const SetupPacket& setup, std::span<std::uint8_t> in) noexcept;
  int feature(const SetupPacket& setup, bool on) noexcept;
  int class_request(const SetupPacket& setup, std::span<const std::uint8_t> out,
                    std::span<std::uint8_t> in) noexcept;
  int get_report(const SetupPacket& setup, std::span<std::uint8_t> in) noexcept;
  int set_idle(const SetupPacket& setup) noexcept;

  UsbFunction& function_;
  std::uint8_t address_ = 0;
  std::uint8_t configuration_ = 0;
  bool remote_wakeup_ = false;
  std::array<bool, kMostInterfaces> numbered_{};  // its reports have IDs
  std::array<bool, kMostInterfaces> boot_protocol_{};
  std::array<std::uint8_t, kMostInterfaces> idle_{};  // of IDs that have none of their own
  std::array<Endpoint, kMostEndpoints> endpoints_{};
  std::size_t endpoint_count_ = 0;
  std::array<Kept, kMostReports> kept_{};
};

}  // namespace limn::firmware
