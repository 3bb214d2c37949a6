#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "modeler/fit/polyline.hpp"

namespace limn::fit_detail {

/// Finds corners: places where the path turns by at least `angle` (radians) within the least length
/// that can be told apart, w, and not noticeably more or less within w/2, 2w and 4w, since a smooth
/// bend turns in proportion to length. "Noticeably" allows for the noise's effect on each. Pens
/// slow down in corners: where this one did not, twice the angle is asked for.
///
/// w is 16 standard deviations of the noise or 3 samples, whichever is more, and at least half the
/// `tolerance`: a bend tighter than that is a corner as far as anyone can see.
///
/// The turning at a sample is the angle between the chords to where the path first leaves the ball
/// of radius w around it, on either side. O(samples) time but for paths that do not leave.
template <int kDimension>
class CornerDetector {
 public:
  using Point = Eigen::Matrix<double, kDimension, 1>;

  CornerDetector(const Polyline<kDimension>& line, double tolerance, double angle)
      : line_(line), path_(line.smoothed), angle_(angle) {
    constexpr double kNoiseScale = 16;
    constexpr double kToleranceScale = 0.5;
    constexpr double kMostToleranceScale = 8;  // beyond, it is the noise that is being fitted
    scale_ = std::max(kToleranceScale * tolerance,
                      std::min(kNoiseScale * line.noise, kMostToleranceScale * tolerance));
  }

  /// Indices of corners, ascending, without the end points.
  std::vector<std::size_t> find() const {
    const std::size_t count = path_.size();
    std::vector<std::size_t> corners;
    if (count < 3) return corners;
    std::vector<double> scale(count, scale_);
    std::vector<double> turning(count, 0.0);
    for (std::size_t i = 1; i + 1 < count; ++i) {
      scale[i] = scale_at(i);
      if (const auto turn = turn_at(i, scale[i])) turning[i] = turn->angle;
    }
    for (std::size_t begin = 1, end = 1; begin + 1 < count; begin = end) {
      end = run_end(turning, begin);
      const std::size_t i = begin + (end - begin - 1) / 2;
      if (turning[i] >= angle_ && is_peak(turning, begin, end, scale[i]) &&
          is_corner(i, scale[i], turning[i])) {
        corners.push_back(i);
      }
    }
    return corners;
  }

 private:
  static constexpr std::size_t kMostSteps = 256;  // of a walk: bounds the time in a scribbled dwell

  struct Exit {
    Point point;
    std::size_t steps;
  };
  struct Turn {
    double angle;
    double time;  // from the left exit to the right one
  };

  /// Where the path from sample i, forwards or backwards, first leaves the ball of radius w.
  std::optional<Exit> exit(std::size_t i, bool forwards, double w) const {
    const Point& centre = path_[i];
    const std::size_t available = std::min(forwards ? path_.size() - 1 - i : i, kMostSteps);
    double before = 0;
    for (std::size_t step = 1; step <= available; ++step) {
      const std::size_t at = forwards ? i + step : i - step;
      const double distance = (path_[at] - centre).norm();
      if (distance >= w) {
        const Point& previous = path_[forwards ? at - 1 : at + 1];
        const double share = (w - before) / (distance - before);
        return Exit{previous + share * (path_[at] - previous), step};
      }
      before = distance;
    }
    return std::nullopt;
  }

  std::optional<Turn> turn_at(std::size_t i, double w) const {
    const auto left = exit(i, false, w);
    if (!left) return std::nullopt;
    const auto right = exit(i, true, w);
    if (!right) return std::nullopt;
    const Point in = path_[i] - left->point;
    const Point out = right->point - path_[i];
    const double lengths = in.norm() * out.norm();
    if (!(lengths > 0)) return std::nullopt;
    return Turn{std::acos(std::clamp(in.dot(out) / lengths, -1.0, 1.0)),
                line_.clock[i + right->steps] - line_.clock[i - left->steps]};
  }

  double scale_at(std::size_t i) const {
    constexpr std::size_t kSamples = 3;
    const std::size_t reach = std::min({kSamples, i, path_.size() - 1 - i});
    double left = 0;
    double right = 0;
    for (std::size_t j = 1; j <= reach; ++j) {
      left = std::max(left, (line_.points[i - j] - line_.points[i]).squaredNorm());
      right = std::max(right, (line_.points[i + j] - line_.points[i]).squaredNorm());
    }
    return std::max(scale_, std::sqrt(std::min(left, right)));
  }

  /// End of the run of samples that turn as `begin` does: where a path returns on itself, all
  /// within w of its tip turn by pi, and the tip is in their middle.
  static std::size_t run_end(const std::vector<double>& turning, std::size_t begin) {
    constexpr double kAlike = 1e-6;  // radians: rounding of an arc cosine near pi
    std::size_t end = begin + 1;
    while (end + 1 < turning.size() && std::abs(turning[end] - turning[begin]) <= kAlike) ++end;
    return end;
  }

  /// Whether nothing within 2w along the path turns more than the samples begin .. end - 1 do.
  bool is_peak(const std::vector<double>& turning, std::size_t begin, std::size_t end,
               double w) const {
    const std::size_t i = begin + (end - begin - 1) / 2;
    const double reach2 = 4 * w * w;
    const auto near = [&](std::size_t j) { return (path_[j] - path_[i]).squaredNorm() < reach2; };
    std::size_t steps = 0;
    for (std::size_t j = begin; j-- > 1 && near(j) && steps < kMostSteps; ++steps) {
      if (turning[j] >= turning[i]) return false;
    }
    steps = 0;
    for (std::size_t j = end; j + 1 < path_.size() && near(j) && steps < kMostSteps; ++j, ++steps) {
      if (turning[j] > turning[i]) return false;
    }
    return true;
  }

  bool is_corner(std::size_t i, double w, double angle) const {
    // The turning over length w of three points with noise has standard deviation sqrt(6) noise /
    // w.
    const double noise = std::sqrt(6.0) * line_.noise / w;
    constexpr double kCurving = 0.1;     // radians that a corner's sides may turn themselves
    constexpr double kDwell = 1.7;       // time share of the inner w by which a pen slowed down
    constexpr double kWithoutDwell = 2;  // times the angle
    // The widest look the stroke's ends allow, up to 4w.
    constexpr double kWidest = 4;
    constexpr double kNarrowest = 1.5;
    constexpr double kNarrowing = 1.4;
    double width = kWidest;
    std::optional<Turn> wide = turn_at(i, width * w);
    while (!wide && width > kNarrowest) {
      width /= kNarrowing;
      wide = turn_at(i, width * w);
    }
    const auto inner = turn_at(i, w);
    if (!wide || !inner) return false;
    const double dwell = wide->time > 0 ? inner->time * width / wide->time : 1;
    if (dwell < kDwell && angle < kWithoutDwell * angle_) return false;
    if (wide->angle > angle + kCurving + 2 * noise) return false;
    if (wide->angle < angle - 2 * kCurving - 3 * noise) return false;
    const auto twice = turn_at(i, 2 * w);
    if (twice && twice->angle > angle + kCurving + 1.5 * noise) return false;
    const auto half = turn_at(i, 0.5 * w);
    return !half || half->angle > angle - 2 * kCurving - 2 * noise;
  }

  const Polyline<kDimension>& line_;
  const std::vector<Point>& path_;
  double angle_;
  double scale_ = 0;
};

}  // namespace limn::fit_detail
