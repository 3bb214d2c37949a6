#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "modeler/surface/crossing_jets.hpp"

namespace limn {

/// A point of a curve in which two surfaces cross: (x, y, z) and its place, and how both change
/// along the curve.
struct CrossingPoint {
  using Vector = Eigen::Matrix<double, 7, 1>;
  Vector at;
  Vector rate;  ///< by arc length; its first three coordinates are the unit tangent

  Eigen::Vector3d point() const { return at.head<3>(); }
  CrossingPlace place() const { return at.tail<4>(); }
  Eigen::Vector3d direction() const { return rate.head<3>(); }
};

/// The cubic from one point of a curve to the next, in Bézier form: tangents are kept, the length
/// is the chord's.
class CrossingSegment {
 public:
  using Vector = CrossingPoint::Vector;
  /// Its places stay within [low, high]: so do the control points, at the cost of a tangent.
  CrossingSegment(const CrossingPoint& from, const CrossingPoint& to, const CrossingPlace& low,
                  const CrossingPlace& high);

  double length() const noexcept { return length_; }
  const std::array<Vector, 4>& control_points() const noexcept { return control_points_; }
  Vector at(double x) const;  ///< 0 <= x <= 1
  CrossingSegment reversed() const;

 private:
  double length_;
  std::array<Vector, 4> control_points_;
};

/// Why a curve that was followed ends.
enum class WalkEnd {
  kLoop,      ///< where it began
  kEdge,      ///< at an edge of a surface's domain, or at a pole
  kBreak,     ///< where a surface breaks off
  kTangency,  ///< where the surfaces are tangent
  kCutOff,    ///< following it failed, or took too many segments: it may go on
};

/// A curve in which two surfaces cross, from end to end; at a corner the tangents of two segments
/// differ.
struct CrossingBranch {
  std::vector<CrossingSegment> segments;
  std::array<WalkEnd, 2> ends = {WalkEnd::kCutOff, WalkEnd::kCutOff};
  double deviation = 0;  ///< of segments from both surfaces, mm

  bool is_closed() const noexcept { return ends[1] == WalkEnd::kLoop; }
  bool is_cut_off() const noexcept {
    return std::find(ends.begin(), ends.end(), WalkEnd::kCutOff) != ends.end();
  }
};

}  // namespace limn
