#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace limn::fit_detail {

/// The samples of a stroke with runs of equal positions merged, in a frame where coordinates are at
/// most about 1.
template <int kDimension>
struct Polyline {
  using Point = Eigen::Matrix<double, kDimension, 1>;
  std::vector<Point> points;       ///< neighbours differ
  std::vector<std::size_t> first;  ///< first sample of each point's run
  std::vector<double> clock;       ///< time of that sample, or its index
  double noise = 0;                ///< standard deviation of a coordinate, estimated
  std::vector<Point> smoothed;     ///< points averaged over noise, end points kept

  std::size_t size() const noexcept { return points.size(); }
};

/// Estimates the noise of one coordinate from fourth differences, which a smooth stroke hardly has:
/// their median norm, over that of independent normal noise of variance 1.
template <class Point>
double estimate_noise(const std::vector<Point>& points) {
  constexpr std::size_t kLeastPoints = 9;
  if (points.size() < kLeastPoints) return 0;
  std::vector<double> norms;
  norms.reserve(points.size() - 4);
  for (std::size_t i = 4; i < points.size(); ++i) {
    norms.push_back(
        (points[i] - 4 * points[i - 1] + 6 * points[i - 2] - 4 * points[i - 3] + points[i - 4])
            .norm());
  }
  const auto middle = norms.begin() + static_cast<std::ptrdiff_t>(norms.size() / 2);
  std::nth_element(norms.begin(), middle, norms.end());
  // 1 + 16 + 36 + 16 + 1 squared binomials; median of a chi distribution by Wilson and Hilferty.
  const double d = static_cast<double>(points[0].size());
  const double chi_median = std::sqrt(d * std::pow(1 - 2 / (9 * d), 3));
  return *middle / (std::sqrt(70.0) * chi_median);
}

/// Averages each point with as many neighbours (the same number either side, at most 5) as it takes
/// to span `reach`: where the pen is slow, noise would otherwise pass for length and turning.
template <class Point>
std::vector<Point> smooth(const std::vector<Point>& points, double reach) {
  constexpr std::size_t kMostNeighbours = 5;
  std::vector<Point> out = points;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const std::size_t most = std::min({i, points.size() - 1 - i, kMostNeighbours});
    std::size_t h = 0;
    while (h < most && (points[i + h] - points[i - h]).squaredNorm() < reach * reach) ++h;
    Point sum = Point::Zero();
    for (std::size_t j = i - h; j <= i + h; ++j) sum += points[j];
    out[i] = sum / static_cast<double>(2 * h + 1);
  }
  return out;
}

/// Smoothing reach in standard deviations of the noise.
inline constexpr double kSmoothingReach = 10;

}  // namespace limn::fit_detail
