#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "input/base/error.hpp"
#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

/// One polynomial piece of a plane curve on [u0, u1] as a cubic Bezier curve.
struct BezierPiece {
  double u0 = 0;
  double u1 = 0;
  std::array<Eigen::Vector2d, 4> points;
};

/// The same curve as cubic Bezier pieces, one a span, in order; the last point of a piece and the
/// first of the next have the same bits. A periodic curve ends where it begins. Degrees 1 and 2 are
/// raised to 3. A dot has no pieces.
/// Error: kLimit for degrees above 3, which cubic pieces cannot express.
Expected<std::vector<BezierPiece>> bezier_pieces(const BsplineCurve<2>& curve);

/// The same curve on its domain with end knots of full multiplicity, degree + 1: the form that
/// every modeler reads. A periodic curve is cut at its seam and keeps its interior knots and their
/// continuity; one that is clamped already comes back as it is. A dot comes back as it is.
BsplineCurve<2> clamped(const BsplineCurve<2>& curve);

}  // namespace limn
