#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "modeler/fit/polyline.hpp"

namespace limn::fit_detail {

/// Whether a stroke ends where it began, so that its curve is to be periodic: the gap between its
/// ends is at most the tolerance or 1.5 mean legs (what one sample more would bridge), the stroke
/// leaves its beginning by at least 8 such gaps, and it has at least 12 points. What the directions
/// do at the gap does not matter: where they turn, corner detection finds a corner there.
template <int kDimension>
bool is_closed(const Polyline<kDimension>& line, double tolerance) {
  constexpr std::size_t kLeastPoints = 12;
  constexpr double kLegs = 1.5;
  constexpr double kLeastExtent = 8;
  if (line.size() < kLeastPoints) return false;
  double length = 0;
  double extent = 0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    length += (line.points[i] - line.points[i - 1]).norm();
    extent = std::max(extent, (line.points[i] - line.points[0]).norm());
  }
  const double mean_leg = length / static_cast<double>(line.size() - 1);
  const double gap = std::max(tolerance, kLegs * mean_leg);
  return (line.points.back() - line.points.front()).norm() <= gap && extent >= kLeastExtent * gap;
}

/// The line with as many of its last points in front and of its first ones behind as corner
/// detection at the seam looks at. `lead` receives the number in front.
template <int kDimension>
Polyline<kDimension> unrolled(const Polyline<kDimension>& line, std::size_t& lead) {
  constexpr std::size_t kMostLead = 128;
  const std::size_t count = line.size();
  // Where the last point is the first one, it stands for it.
  const std::size_t round = line.points.back() == line.points.front() ? count - 1 : count;
  lead = std::min(kMostLead, round / 2);
  const double step = (line.clock.back() - line.clock.front()) / static_cast<double>(count - 1);
  const double period = line.clock.back() - line.clock.front() + (round == count ? step : 0.0);
  Polyline<kDimension> out;
  out.noise = line.noise;
  for (std::size_t i = 0; i < round + 2 * lead; ++i) {
    const std::size_t turned = i + round - lead;
    const std::size_t rounds = turned / round;  // 1 from the stroke's beginning to its end
    out.points.push_back(line.points[turned % round]);
    out.clock.push_back(line.clock[turned % round] + (static_cast<double>(rounds) - 1) * period);
  }
  out.smoothed = smooth(out.points, kSmoothingReach * out.noise);
  return out;
}

}  // namespace limn::fit_detail
