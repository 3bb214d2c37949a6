#pragma once

#include <initializer_list>
#include <vector>

#include "firmware_sim/devices/minimum_jerk.hpp"

namespace limn::firmware {

/// Where and how large a drawing's own coordinates (any unit, y up) lie on the tablet (mm, y
/// towards the user).
struct Placement {
  PlanePoint origin;    ///< of the drawing's (0, 0), in mm
  double scale_mm = 1;  ///< of one unit
  double slant = 0;     ///< units to the right for each unit up

  PlanePoint operator()(PlanePoint unit) const noexcept {
    return {origin.x + scale_mm * (unit.x + slant * unit.y), origin.y - scale_mm * unit.y};
  }
};

/// A smooth piece of a stroke, collected as points for the hand to move through.
using Path = std::vector<PlanePoint>;

/// The points as they are.
Path through(const Placement& place, std::initializer_list<PlanePoint> points);

/// A straight line with points on the way, so that the hand keeps to it and to a steady speed.
Path line(const Placement& place, PlanePoint from, PlanePoint to);

/// Appends the cubic Bezier curve from the path's end through two control points to `to`, as
/// `steps` points. Precondition: the path is not empty.
void append_bezier(Path& path, const Placement& place, PlanePoint control_1, PlanePoint control_2,
                   PlanePoint to, int steps);

}  // namespace limn::firmware
