#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "firmware_sim/devices/knob_pose.hpp"

namespace limn::firmware {

using Deflection = std::array<double, kKnobAxes>;  ///< as KnobPose's

/// A movement of the knob from rest to rest through points, or a rest at one.
struct MotionPiece {
  std::vector<Deflection> points;  ///< one: a rest; else the first is where the piece before ends
  double seconds = 0;              ///< for each way from point to point, or of the rest
  std::uint16_t buttons = 0;       ///< pressed all the time
};

struct MotionInfo {
  std::string_view name;
  std::string_view description;  ///< one line
};

struct Motion {
  MotionInfo info;
  std::vector<MotionPiece> pieces;  ///< never empty; begin and end at zero deflection
};

/// All motions there are, in the order in which they should be listed.
std::span<const MotionInfo> motions() noexcept;

/// The motion with exactly that name; nothing where there is none.
std::optional<Motion> find_motion(std::string_view name);

}  // namespace limn::firmware
