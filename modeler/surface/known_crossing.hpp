#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <vector>

#include "modeler/surface/crossing_branch.hpp"

namespace limn {

/// A branch that was followed, with boxes of its segments for quick answers.
class KnownCrossing {
 public:
  using Vector = CrossingSegment::Vector;

  explicit KnownCrossing(CrossingBranch found);

  const CrossingBranch& branch() const { return branch_; }
  double length() const { return length_; }

  /// Calls visit(from, to) for where the branch, as a polygon of some corners a segment, is inside
  /// a box of parameters.
  template <class Visit>
  void clip(const Eigen::Vector4d& low, const Eigen::Vector4d& high, Visit visit) const {
    constexpr int kCorners = 8;
    for (std::size_t i = 0; i < branch_.segments.size(); ++i) {
      if ((low_[i].tail<4>().array() > high.array()).any() ||
          (high_[i].tail<4>().array() < low.array()).any()) {
        continue;
      }
      Eigen::Vector4d from = branch_.segments[i].at(0).tail<4>();
      for (int k = 1; k <= kCorners; ++k) {
        const Eigen::Vector4d to = branch_.segments[i].at(double(k) / kCorners).tail<4>();
        if (const auto inside = clip({from, to}, low, high)) visit(inside->from, inside->to);
        from = to;
      }
    }
  }

  /// Calls visit(segment, x) for segments whose cubics come this near to a point in space, x being
  /// where the chord is nearest; until it returns true, which is the result then.
  template <class Visit>
  bool any_near(const Eigen::Vector3d& point, double room, Visit visit) const {
    for (std::size_t i = 0; i < branch_.segments.size(); ++i) {
      if (((low_[i].head<3>() - point).array() > room).any() ||
          ((point - high_[i].head<3>()).array() > room).any()) {
        continue;
      }
      const Eigen::Vector3d from = branch_.segments[i].at(0).head<3>();
      const Eigen::Vector3d chord = branch_.segments[i].at(1).head<3>() - from;
      const double square = chord.squaredNorm();
      const double x = square > 0 ? std::clamp((point - from).dot(chord) / square, 0.0, 1.0) : 0.0;
      if (visit(branch_.segments[i], x)) return true;
    }
    return false;
  }

 private:
  struct Side {
    CrossingPlace from;
    CrossingPlace to;
  };
  static std::optional<Side> clip(const Side& side, const CrossingPlace& low,
                                  const CrossingPlace& high);

  CrossingBranch branch_;
  double length_ = 0;
  std::vector<Vector> low_;  ///< of each segment's control points
  std::vector<Vector> high_;
};

}  // namespace limn
