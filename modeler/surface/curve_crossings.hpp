#pragma once

#include <vector>

#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

/// Parameters from `first` to `last`.
struct ParameterRange {
  double first = 0;
  double last = 0;
};

/// Where a curve meets a plane.
struct PlaneCrossings {
  std::vector<double> at;              ///< ascending; a touching place once
  std::vector<ParameterRange> within;  ///< spans that lie in the plane to kGeometric
  bool complete = true;  ///< false where the curve's numbers are too large to work with
};

/// All places where (C(t) - point) . normal is zero: none is missed (modeler/bspline/roots.hpp).
/// Precondition: finite, a normal that is not zero, of any length.
PlaneCrossings cross_plane(const BsplineCurve<3>& curve, const Eigen::Vector3d& point,
                           const Eigen::Vector3d& normal);

/// Where two curves come within kGeometric of each other.
struct CurveCrossing {
  double s = 0;  ///< parameter of the first
  double t = 0;  ///< of the second
  /// They stay that near for about this length (mm, or the curves' unit): 0 where they only cross.
  double run = 0;
};

struct CurveCrossings {
  std::vector<CurveCrossing> crossings;  ///< ascending s
  /// Whether these are all. False where the search was cut off after a bounded number of halves.
  bool complete = true;
};

/// In the plane, so also in the parameter plane of a surface. Pieces are halved until their hulls
/// are apart, or their directions differ everywhere, so that they cross once at most, and Newton's
/// iteration finds it, or both are straight to kGeometric.
CurveCrossings cross_curves(const BsplineCurve<2>& first, const BsplineCurve<2>& second);
CurveCrossings cross_curves(const BsplineCurve<3>& first, const BsplineCurve<3>& second);

/// The point of a curve closest to p, global, as SurfaceIndex::closest_point() has it for surfaces.
template <int kDimension>
struct ClosestOnCurve {
  double t = 0;
  Eigen::Matrix<double, kDimension, 1> point = Eigen::Matrix<double, kDimension, 1>::Zero();
  double distance = 0;
};
ClosestOnCurve<2> closest_on_curve(const BsplineCurve<2>& curve, const Eigen::Vector2d& p);
ClosestOnCurve<3> closest_on_curve(const BsplineCurve<3>& curve, const Eigen::Vector3d& p);

}  // namespace limn
