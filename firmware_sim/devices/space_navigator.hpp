#pragma once

#include "firmware_sim/devices/knob_function.hpp"

namespace limn::firmware {

/// A SpaceNavigator (046d:c626, firmware 4.35): every 8 ms a report of 7 bytes, by turns number 1,
/// the translations, and 2, the rotations, each three axes as le16. Its descriptor calls them
/// "relative", which is wrong: they are displacements. Source: a USB capture.
/// Firmware: static storage, no heap, no exceptions, no RTTI. One thread.
class SpaceNavigator final : public KnobFunction {
 public:
  static constexpr std::chrono::microseconds kReportPeriod{8000};

  explicit SpaceNavigator(KnobSensor& sensor) noexcept : KnobFunction(sensor, kReportPeriod) {}

  const DeviceSpec& spec() const noexcept override;

 private:
  std::size_t axis_report(const Counts& counts, ReportBuffer report) noexcept override;
  void restart() noexcept override { turned_ = false; }

  bool turned_ = false;  // the next report is of the rotations
};

}  // namespace limn::firmware
