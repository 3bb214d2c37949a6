#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "firmware_sim/devices/minimum_jerk.hpp"
#include "firmware_sim/devices/pen_pose.hpp"

namespace limn::firmware {

/// One contact of the pen.
struct PenStroke {
  /// The path: smooth pieces through their points (mm, in the frame of PenPose), joined at sharp
  /// corners, where the hand rests for a moment: each piece begins where the one before it ends.
  /// A single piece of a single point is a dot.
  std::vector<std::vector<PlanePoint>> pieces;
  PenEnd end = PenEnd::kTip;
  double tempo = 1;       ///< see power_law_durations
  double pressure = 0.5;  ///< about which the pressure varies, 0 to 1
};

struct DrawingInfo {
  std::string_view name;
  std::string_view description;  ///< one line
};

struct Drawing {
  DrawingInfo info;
  std::vector<PenStroke> strokes;  ///< never empty
};

/// All drawings there are, in the order in which they should be listed.
std::span<const DrawingInfo> drawings() noexcept;

/// The drawing with exactly that name; nothing where there is none.
std::optional<Drawing> find_drawing(std::string_view name);

}  // namespace limn::firmware
