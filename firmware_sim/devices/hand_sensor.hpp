#pragma once

#include <chrono>
#include <cstdint>

#include "firmware_sim/devices/hand.hpp"
#include "firmware_sim/devices/pen_sensor.hpp"

namespace limn::firmware {

/// The hand's pen as a tablet of a certain size measures it: the drawing is made smaller where it
/// would not fit, and the position has Gaussian noise, independent from one measurement to the
/// next, which grows towards the edge of the tablet as its coils' field ends:
///
///     deviation = jitter (1 + 4 (1 - d / 10 mm)^2)   at d < 10 mm from the nearest edge.
///
/// The same arguments and times give the same poses on every machine, however often it is asked.
/// Not firmware (the hand uses the heap).
class HandSensor final : public PenSensor {
 public:
  /// Standard deviation of the noise in the middle of a tablet, in mm.
  static constexpr double kJitterMm = 0.02;
  static constexpr double kEdgeMm = 10;
  static constexpr double kEdgeGrowth = 4;

  /// `size_mm`: of the tablet, to the right and towards the user.
  HandSensor(const Drawing& drawing, PlanePoint size_mm, std::uint64_t seed,
             double jitter_mm = kJitterMm);

  /// When the pen has gone for good.
  std::chrono::microseconds duration() const noexcept { return hand_.duration(); }

  /// Where the pen is on this tablet, without noise.
  PenPose pose(std::chrono::microseconds time) const noexcept;

  PenPose measure(std::chrono::microseconds time) noexcept override;

 private:
  Hand hand_;
  PlanePoint size_mm_;
  double scale_;
  std::uint64_t seed_;
  double jitter_mm_;
};

}  // namespace limn::firmware
