#pragma once

#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

/// The curve on a surface that a curve in its parameter plane gives, t -> S(C(t)), exactly: a
/// spline of degree deg C (deg_u S + deg_v S), with a knot wherever C has one or passes a knot line
/// of S. Rational if one of the two is. The curve's knots keep their multiplicity's continuity in
/// shape, but all have full multiplicity: remove_knots() takes what is not needed.
/// Errors: kOutOfRange where C leaves the domain of S (a periodic direction's included); kLimit
/// where the degree would pass KnotVector::kMaxDegree: approximate such a curve by samples. Source:
/// T. DeRose, R. Goldman, H. Hagen, S. Mann: Functional composition algorithms via blossoming
/// [DGHM93].
Expected<BsplineCurve<3>> compose(const BsplineSurface& surface, const BsplineCurve<2>& curve);

}  // namespace limn
