#pragma once

#include "firmware_sim/devices/knob_function.hpp"

namespace limn::firmware {

/// A SpaceMouse Wireless on its cable (256f:c62e): one report of 13 bytes, number 1, with all six
/// axes as le16, every 17.5 ms. Its descriptor says what the vendor's says of these, the buttons
/// and the light. Firmware: static storage, no heap, no exceptions, no RTTI. One thread.
class SpaceMouse final : public KnobFunction {
 public:
  static constexpr std::chrono::microseconds kReportPeriod{17500};
  static constexpr std::size_t kAxisBytes = 13;

  explicit SpaceMouse(KnobSensor& sensor) noexcept : KnobFunction(sensor, kReportPeriod) {}

  const DeviceSpec& spec() const noexcept override;

 private:
  std::size_t axis_report(const Counts& counts, ReportBuffer report) noexcept override;
};

}  // namespace limn::firmware
