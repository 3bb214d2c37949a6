#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "firmware_sim/devices/drawings.hpp"
#include "firmware_sim/devices/hand.hpp"
#include "firmware_sim/devices/hid_pen.hpp"
#include "firmware_sim/devices/sensor_noise.hpp"

namespace limn::firmware {

/// One input report as it leaves the device, report ID first.
struct TimedReport {
  std::chrono::microseconds time{};  ///< since the session began
  std::array<std::uint8_t, HidPen::kReportBytes> bytes{};
};

/// A drawing made with the simulated pen: hand, sensor noise, pen. The same drawing and seed give
/// the same reports, to the bit, on every machine. Times are multiples of HidPen::kReportPeriod;
/// a period is left out only while the pen is out of range. The last report tells its leaving.
class PenSession {
 public:
  /// Standard deviation of the position's noise on each axis, independent from report to report.
  static constexpr double kJitterMm = 0.02;

  PenSession(const Drawing& drawing, std::uint64_t seed) : hand_(drawing), noise_(seed) {}

  /// The next report; false, with `report` unmodified, for ever after the last one.
  bool next(TimedReport& report) noexcept;

 private:
  Hand hand_;
  SensorNoise noise_;
  HidPen pen_;
  std::chrono::microseconds time_{};
};

}  // namespace limn::firmware
