#include "firmware_sim/devices/path.hpp"

#include <algorithm>
#include <cmath>

namespace limn::firmware {

Path through(const Placement& place, std::initializer_list<PlanePoint> points) {
  Path path;
  path.reserve(points.size());
  for (const PlanePoint& p : points) path.push_back(place(p));
  return path;
}

Path line(const Placement& place, PlanePoint from, PlanePoint to) {
  constexpr double kStepMm = 8;
  const PlanePoint start = place(from);
  const PlanePoint end = place(to);
  const PlanePoint across = end - start;
  const int steps = std::max(1, static_cast<int>(length(across) / kStepMm));
  Path path;
  for (int i = 0; i < steps; ++i) {
    path.push_back(start + (static_cast<double>(i) / steps) * across);
  }
  path.push_back(end);  // to the bit, so that pieces join
  return path;
}

void append_bezier(Path& path, const Placement& place, PlanePoint control_1, PlanePoint control_2,
                   PlanePoint to, int steps) {
  const PlanePoint p0 = path.back();
  const PlanePoint p1 = place(control_1);
  const PlanePoint p2 = place(control_2);
  const PlanePoint p3 = place(to);
  for (int i = 1; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const double s = 1 - t;
    path.push_back((s * s * s) * p0 + (3 * s * s * t) * p1 + (3 * s * t * t) * p2 +
                   (t * t * t) * p3);
  }
}

}  // namespace limn::firmware
