#include "modeler/surface/known_crossing.hpp"

#include <utility>

namespace limn {

KnownCrossing::KnownCrossing(CrossingBranch found) : branch_(std::move(found)) {
  for (const CrossingSegment& segment : branch_.segments) {
    const auto& points = segment.control_points();
    low_.push_back(points[0].cwiseMin(points[1]).cwiseMin(points[2]).cwiseMin(points[3]));
    high_.push_back(points[0].cwiseMax(points[1]).cwiseMax(points[2]).cwiseMax(points[3]));
    length_ += segment.length();
  }
}

std::optional<KnownCrossing::Side> KnownCrossing::clip(const Side& side, const CrossingPlace& low,
                                                       const CrossingPlace& high) {
  double first = 0;
  double last = 1;
  const CrossingPlace change = side.to - side.from;
  for (int d = 0; d < 4; ++d) {
    const double a = low[d] - side.from[d];
    const double b = high[d] - side.from[d];
    if (change[d] == 0) {
      if (a > 0 || b < 0) return std::nullopt;
      continue;
    }
    first = std::max(first, std::min(a / change[d], b / change[d]));
    last = std::min(last, std::max(a / change[d], b / change[d]));
  }
  if (first > last) return std::nullopt;
  return Side{side.from + first * change, side.from + last * change};
}

}  // namespace limn
