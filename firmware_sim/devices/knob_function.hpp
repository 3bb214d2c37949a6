#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware_sim/devices/knob_pose.hpp"
#include "firmware_sim/devices/report_clock.hpp"
#include "firmware_sim/usb/usb_function.hpp"

namespace limn::firmware {

/// What 3Dconnexion's devices share: axes as displacements of up to 350 counts; at rest exactly
/// three reports of zeros, then silence; report 3, the buttons as 16 bits, whenever they change;
/// output report 4, the light; feature report 7 (07 00), which takes the knob as it is for its
/// zero. Firmware: static storage, no heap, no exceptions, no RTTI. One thread.
class KnobFunction : public UsbFunction {
 public:
  static constexpr std::int32_t kMostCounts = 350;
  static constexpr int kZeroReports = 3;
  static constexpr std::size_t kMostReportBytes = 13;

  void reset() noexcept final;
  std::size_t next_report(std::uint8_t interface, std::chrono::microseconds now,
                          std::span<std::uint8_t> report) noexcept final;
  std::chrono::microseconds silent_until(std::chrono::microseconds now) const noexcept final {
    return clock_.due(now);
  }
  bool set_report(std::uint8_t interface, ReportKind kind, std::uint8_t id,
                  std::span<const std::uint8_t> bytes) noexcept final;

  bool light() const noexcept { return light_; }

 protected:
  using Counts = std::array<std::int32_t, kKnobAxes>;
  using ReportBuffer = std::span<std::uint8_t, kMostReportBytes>;

  /// `sensor` must outlive this.
  KnobFunction(KnobSensor& sensor, std::chrono::microseconds period) noexcept
      : sensor_(sensor), clock_(period) {}
  ~KnobFunction() = default;

 private:
  /// The next report of axes; its length.
  virtual std::size_t axis_report(const Counts& counts, ReportBuffer report) noexcept = 0;
  /// Any other feature report than number 7. False: stall.
  virtual bool set_feature(std::uint8_t /*id*/, std::span<const std::uint8_t> /*bytes*/) noexcept {
    return false;
  }
  virtual void restart() noexcept {}

  std::size_t scan(const KnobPose& pose, ReportBuffer report) noexcept;

  KnobSensor& sensor_;
  ReportClock clock_;
  Counts measured_{};
  Counts zero_{};
  std::uint16_t buttons_ = 0;
  int zeros_left_ = 0;
  bool light_ = false;
};

}  // namespace limn::firmware
