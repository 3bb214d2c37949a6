#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <vector>

#include "firmware_sim/devices/knob_pose.hpp"
#include "firmware_sim/devices/minimum_jerk.hpp"
#include "firmware_sim/devices/motions.hpp"

namespace limn::firmware {

/// The hand on a 3D mouse: goes through a motion with minimum jerk (MinimumJerk), two axes by two,
/// and trembles a little where it holds the knob; the knob at rest is still.
/// The same motion and seed give the same poses on every machine. Not firmware (it uses the heap).
class KnobHand final : public KnobSensor {
 public:
  /// Standard deviation of the tremor on each axis: 0.5 of 350 counts.
  static constexpr double kTremor = 0.5 / 350;

  KnobHand(const Motion& motion, std::uint64_t seed);

  /// When the knob rests for good.
  std::chrono::microseconds duration() const noexcept { return duration_; }

  /// How the knob is held, without any tremor.
  KnobPose pose(std::chrono::microseconds time) const noexcept;

  KnobPose measure(std::chrono::microseconds time) noexcept override;

 private:
  struct Leg {
    std::array<MinimumJerk, kKnobAxes / 2> paths;
    double begin = 0;  // seconds
    std::uint16_t buttons = 0;
  };

  std::vector<Leg> legs_;
  std::uint64_t seed_;
  std::chrono::microseconds duration_{};
};

}  // namespace limn::firmware
