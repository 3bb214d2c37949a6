#pragma once

#include <vector>

#include "input/base/time.hpp"
#include "input/sample/pen_sample.hpp"

namespace limn {

/// What is kept of a sample in a stroke. Positions in mm in the frame of PenSample; pressure 0..1,
/// tilt in radians, both meaningful only where the stroke's `axes` has them.
struct StrokePoint {
  Timestamp time{};
  double x_mm = 0;
  double y_mm = 0;
  double pressure = 0;
  double tilt_x_rad = 0;
  double tilt_y_rad = 0;
};

/// One contact of a pen, from touch to lift: every sample in contact, in order, duplicates included
/// (a dwell has pressure and time even where it has no length; a fit merges what it must).
/// Never empty.
struct Stroke {
  DeviceIndex device = 0;
  Tool tool = Tool::kPen;
  PenAxes axes;  ///< axes that every point has
  /// False: the stream ended, or a limit cut it, before the pen lifted.
  bool closed_by_lift = true;
  std::vector<StrokePoint> points;
};

}  // namespace limn
