#pragma once

#include "firmware_sim/devices/knob_function.hpp"

namespace limn::firmware {

/// A SpaceNavigator (046d:c626, firmware 4.35): every 8 ms a report of 7 bytes, by turns number 1,
/// the translations, and 2, the rotations, each three axes as le16. Its descriptor calls them
/// "relative", which is wrong: they are displacements. Its other feature reports (5, 6, 8 to 11 and
/// 19, of which nothing is published) hold zeros, and what they are told. Source: a USB capture.
/// Firmware: static storage, no heap, no exceptions, no RTTI. One thread.
class SpaceNavigator final : public KnobFunction {
 public:
  static constexpr std::chrono::microseconds kReportPeriod{8000};

  explicit SpaceNavigator(KnobSensor& sensor) noexcept : KnobFunction(sensor, kReportPeriod) {}

  const DeviceSpec& spec() const noexcept override;
  int get_report(std::uint8_t interface, ReportKind kind, std::uint8_t id,
                 std::span<std::uint8_t> out) noexcept override;

 private:
  static constexpr std::size_t kFeatures = 8;
  static constexpr std::size_t kMostFeatureBytes = 8;

  std::size_t axis_report(const Counts& counts, ReportBuffer report) noexcept override;
  bool set_feature(std::uint8_t id, std::span<const std::uint8_t> bytes) noexcept override;
  void restart() noexcept override;

  bool turned_ = false;  // the next report is of the rotations
  std::array<std::array<std::uint8_t, kMostFeatureBytes>, kFeatures> features_{};
};

}  // namespace limn::firmware
