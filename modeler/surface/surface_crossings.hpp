#pragma once

#include <vector>

#include "modeler/bspline/tensor_spline.hpp"
#include "modeler/surface/surface_index.hpp"

namespace limn {

/// A curve in which two surfaces cross: in space and in the parameters of both, all three cubic, on
/// the same knots, with about the arc length as their parameter t.
///
///     |S_1(on_first(t)) - curve(t)| and |S_2(on_second(t)) - curve(t)| are at most about
///     `deviation`,
///
/// which is the largest of them in three places of each span. All control points of on_first and
/// on_second lie in the surfaces' domains.
struct SurfaceCrossing {
  BsplineCurve<3> curve;
  BsplineCurve<2> on_first;   ///< (u, v)
  BsplineCurve<2> on_second;  ///< (u, v)
  double deviation = 0;       ///< mm
  /// It ends where it begins, in both surfaces' parameters. A curve over the seam of a closed
  /// surface ends there and begins anew.
  bool is_closed = false;
};

/// Where two surfaces meet and do not cross, tangentially for the most part: a place, or a
/// connected set of them.
struct SurfaceTouch {
  Eigen::Vector3d point;  ///< one of the set
  Eigen::Vector2d on_first;
  Eigen::Vector2d on_second;
  double extent = 0;  ///< mm, about how long or wide the set is; 0 for one isolated place
};

struct SurfaceCrossings {
  std::vector<SurfaceCrossing> curves;
  std::vector<SurfaceTouch> touches;
  /// Whether these are all. False where the search was cut off after a bounded number of parts, as
  /// where surfaces run together over an area, or nearly do; where a curve could not be followed to
  /// an edge, a break, a pole, a tangency or its own beginning; and where parts that seem to run
  /// together were neither found to meet nor shown to be apart. It does not tell of two curves that
  /// are so near each other, at a small angle, that `tolerance` makes them one.
  bool complete = true;
};

/// All curves in which two surfaces cross, within `tolerance` (mm, more than 0; 1e-8 at least) of
/// both: off the true curve by more where they meet at a small angle.
///
/// Parts of both are halved until their bounds show that they are apart, or that they cross in one
/// curve at most at each value of one of the four parameters; that curve is looked for and followed
/// through all of both surfaces. What is left when parts are flat to some 1e-7 mm runs together
/// there. Curves end at edges, at poles and where the surfaces become tangent; they have a corner
/// where a surface has.
///
/// Deterministic. Source: that parts of which no normals are parallel cross without loops, [SKW85].
SurfaceCrossings cross_surfaces(const SurfaceIndex& first, const SurfaceIndex& second,
                                double tolerance);

}  // namespace limn
