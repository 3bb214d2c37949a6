#include "modeler/surface/crossing_branch.hpp"

namespace limn {

CrossingSegment::CrossingSegment(const CrossingPoint& from, const CrossingPoint& to,
                                 const CrossingPlace& low, const CrossingPlace& high)
    : length_((to.point() - from.point()).norm()),
      control_points_{from.at, from.at + length_ / 3 * from.rate, to.at - length_ / 3 * to.rate,
                      to.at} {
  for (Vector& p : control_points_) p.tail<4>() = p.tail<4>().cwiseMax(low).cwiseMin(high);
}

CrossingSegment::Vector CrossingSegment::at(double x) const {
  const double y = 1 - x;
  return y * y * y * control_points_[0] + 3 * x * y * y * control_points_[1] +
         3 * x * x * y * control_points_[2] + x * x * x * control_points_[3];
}

CrossingSegment CrossingSegment::reversed() const {
  CrossingSegment out = *this;
  std::reverse(out.control_points_.begin(), out.control_points_.end());
  return out;
}

}  // namespace limn
