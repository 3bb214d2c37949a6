#pragma once

#include <chrono>
#include <cstdint>

namespace limn::firmware {

/// Where the pen is, as far as the tablet can tell.
enum class Proximity : std::uint8_t {
  kAway,      ///< too high for the tablet to notice
  kHovering,  ///< noticed, not touching
  kTouching,
};

/// Which end points at the tablet.
enum class PenEnd : std::uint8_t { kTip, kEraser };

/// A physical pen at one instant, before any sensor: x to the right and y towards the user, in mm
/// from the upper left corner of the active area.
struct PenPose {
  std::chrono::microseconds time{};  ///< since the session began
  Proximity proximity = Proximity::kAway;
  PenEnd end = PenEnd::kTip;
  bool barrel_switch = false;
  bool secondary_barrel_switch = false;
  double x_mm = 0;
  double y_mm = 0;
  double pressure = 0;    ///< 0 to 1; above 0 exactly while touching
  double tilt_x_deg = 0;  ///< -90 to 90, positive when the pen's upper end leans to the right
  double tilt_y_deg = 0;  ///< -90 to 90, positive when it leans towards the user
};

}  // namespace limn::firmware
