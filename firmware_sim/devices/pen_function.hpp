#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware_sim/devices/pen_sensor.hpp"
#include "firmware_sim/devices/report_clock.hpp"
#include "firmware_sim/usb/usb_function.hpp"

namespace limn::firmware {

/// What all tablets share: a sensor asked once a report period, and measurements that wait for the
/// host. A tablet adds how a pose becomes a report.
/// Firmware: static storage, no heap, no exceptions, no RTTI. One thread.
class PenFunction : public UsbFunction {
 public:
  static constexpr std::size_t kMostReportBytes = 384;

  void reset() noexcept final;
  std::size_t next_report(std::uint8_t interface, std::chrono::microseconds now,
                          std::span<std::uint8_t> report) noexcept final;
  std::chrono::microseconds silent_until(std::chrono::microseconds now) const noexcept final {
    return clock_.due(now);
  }

 protected:
  /// `sensor` must outlive this.
  PenFunction(PenSensor& sensor, std::chrono::microseconds period) noexcept
      : sensor_(sensor), clock_(period) {}
  ~PenFunction() = default;

  using ReportBuffer = std::span<std::uint8_t, kMostReportBytes>;

 private:
  /// The interface at which the pen reports now.
  virtual std::uint8_t pen_interface() const noexcept { return 0; }

  /// One measurement: fills `report`, zero before, and returns its length, or 0 where the device
  /// has nothing to say.
  virtual std::size_t scan(const PenPose& pose, ReportBuffer report) noexcept = 0;

  /// As if switched on.
  virtual void restart() noexcept = 0;

  PenSensor& sensor_;
  ReportClock clock_;
  std::array<std::uint8_t, kMostReportBytes> report_{};
};

}  // namespace limn::firmware
