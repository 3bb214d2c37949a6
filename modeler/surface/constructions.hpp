#pragma once

#include <span>
#include <vector>

#include "input/base/error.hpp"
#include "modeler/base/frame.hpp"
#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

// Surfaces from curves. Exact unless said otherwise; rational curves stay exact.

/// The curve turned about the line through `axis.origin` along axis.z by `angle` (rad, more than 0
/// and at most 2 pi): u turns, v is the curve's parameter. Rational and quadratic in u, in up to
/// four arcs. Error: kOutOfRange for another angle. [PT97 ch. 8.5]
Expected<BsplineSurface> revolve(const BsplineCurve<3>& curve, const Frame& axis, double angle);

/// The curve moved along `direction`: u is the curve's parameter, 0 <= v <= 1.
/// Error: kOutOfRange for a direction that is not finite or zero.
Expected<BsplineSurface> extrude(const BsplineCurve<3>& curve, const Eigen::Vector3d& direction);

/// Straight lines from `bottom` (v = 0) to `top` (v = 1) at equal u. Errors as make_compatible().
Expected<BsplineSurface> make_ruled(const BsplineCurve<3>& bottom, const BsplineCurve<3>& top);

/// The bilinearly blended surface of four edges that meet in their corners: S(u, 0) = bottom,
/// S(u, 1) = top, S(0, v) = left, S(1, v) = right, in the curves' own parameters.
/// Errors: as make_compatible(); kNumeric where corners are further apart than kGeometric, or their
/// weights differ. Source: S. A. Coons, MIT Project MAC TR-41 (1967); [PT97 ch. 10.6].
Expected<BsplineSurface> make_coons(const BsplineCurve<3>& bottom, const BsplineCurve<3>& top,
                                    const BsplineCurve<3>& left, const BsplineCurve<3>& right);

enum class Skinning {
  kInterpolate,  ///< through each section; a changed section changes the surface everywhere, a
                 ///< little
  kLocal,        ///< near each section; a changed section changes its neighbourhood alone
};

/// A surface over sections: u is theirs, v goes from section to section, cubic where there are four
/// or more, its parameters from 0 to 1 by the sections' average distance. `deviation` is that of
/// control points of the sections (made compatible) from those of the surface at their v.
///
/// kLocal is a quasi-interpolant: each control point is the polar form, at its knots, of the cubic
/// through the four nearest sections, so cubics are reproduced, and the end sections are.
struct Skin {
  BsplineSurface surface;
  double deviation = 0;
  std::vector<double> parameters;  ///< v of each section
};
/// `parameters` gives the v of each section instead, where it is not empty.
/// Errors: as make_compatible(); kPointCount for fewer than two sections, or another number of
/// parameters; kOutOfRange for parameters that do not ascend; kNumeric where two neighbours are the
/// same. [PT97 ch. 10.3]
Expected<Skin> make_skin(std::span<const BsplineCurve<3>> sections,
                         Skinning skinning = Skinning::kInterpolate,
                         std::span<const double> parameters = {});

/// Points in rows, u fastest: columns by rows of them.
struct PointGrid {
  int columns = 0;
  int rows = 0;
  std::vector<Eigen::Vector3d> points;
};

struct GridSurface {
  BsplineSurface surface;
  double deviation = 0;  ///< largest distance of a point from the surface at its parameters, mm
};

/// Through all points, of the degree where there are enough of them (degree + 1) a direction, with
/// parameters from 0 to 1 by average chord length.
/// Errors: kPointCount for fewer than two a direction, or another number of points than said;
/// kOutOfRange for a degree below 1 or above KnotVector::kMaxDegree, or a point that is not finite;
/// kNumeric where all points of neighbouring rows or columns coincide. [PT97 ch. 9.2]
Expected<GridSurface> interpolate_grid(const PointGrid& grid, int degree = 3);

/// By least squares within `tolerance` (mm) of all points, corners kept. Control points are added,
/// a quarter at a time in the direction that needs them more, until it is met or there are as many
/// as points: `deviation` tells. Errors as interpolate_grid(), and kOutOfRange for a tolerance that
/// is not above 0. [PT97 ch. 9.4]
Expected<GridSurface> approximate_grid(const PointGrid& grid, double tolerance, int degree = 3);

}  // namespace limn
