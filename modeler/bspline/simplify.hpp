#pragma once

#include <span>

#include "modeler/bspline/refine.hpp"

namespace limn {

// Fewer knots, a lower degree, two splines made one: what changes the shape, and says by how much.

/// A spline near another: no point moves further than `deviation` at equal parameters (mm where the
/// spline is in mm). A bound, from the hull of the difference, not a measurement: it may be several
/// times what is really moved.
template <class Spline>
struct Simplified {
  Spline spline;
  double deviation = 0;
};

/// No point of `a` is further from that of `b` at equal parameters (mm where they are in mm): a
/// bound, infinite where a weight is not positive. Precondition: the same knots, dimension and
/// form.
double largest_difference(const SplineData& a, const SplineData& b);

/// Without one of the knots `u` of one direction. Control points that the knot does not touch stay;
/// the others are the least-squares solution of inserting it again, a linear map.
/// Errors: kMissing where u is no knot inside the domain (move_seam() first to remove a periodic
/// seam's); kOutOfRange where too few are left. [PT97 ch. 5.4]
Expected<KnotRefinement> remove_knot(const KnotVector& knots, double u);

/// The same for a spline.
Expected<Simplified<SplineData>> remove_knot(const SplineData& spline, int direction, double u);

/// Removes knots of one direction, those first that cost least, while the sum of the deviations
/// stays within `tolerance`. The spline itself, with deviation 0, where none can go.
/// Every round tries each knot with dense matrices: O(knots^4), for some dozens of knots.
Simplified<SplineData> remove_knots(const SplineData& spline, int direction, double tolerance);

/// Of one degree less in one direction, with a knot of multiplicity m kept m - 1 times, once at
/// least: the least-squares solution of raising the degree again, exact where the spline was raised
/// before. An open direction keeps its end points.
/// Error: kOutOfRange for degree 0, or periodic degree 1. [PT97 ch. 5.6]
Expected<Simplified<SplineData>> reduce_degree(const SplineData& spline, int direction);

/// `first` followed by `second` in one direction, whose parameters are shifted to go on from the
/// first's end. The joint is a knot of multiplicity `degree`; `deviation` is half of the gap that
/// was closed there, by meeting in the middle. Degrees and the other directions' knots are made
/// equal first, as are the weights at the joint where they are proportional. Errors: kOutOfRange
/// for a periodic direction; kNumeric for weights at the joint that are not proportional, or other
/// directions' domains that are not the same.
Expected<Simplified<SplineData>> join(const SplineData& first, const SplineData& second,
                                      int direction);

/// Both on the same degrees and knots in one direction: the higher degree, all knots of both.
/// Errors: kNumeric where their domains differ, kOutOfRange where one is periodic and one not.
Expected<std::pair<SplineData, SplineData>> make_compatible(const SplineData& a,
                                                            const SplineData& b, int direction);

template <int kDirections, int kDimension>
using SimplifiedSpline = Simplified<TensorSpline<kDirections, kDimension>>;

namespace bspline_detail {
template <int kDirections, int kDimension>
Expected<SimplifiedSpline<kDirections, kDimension>> typed(Expected<Simplified<SplineData>> from) {
  if (!from) return tl::unexpected(std::move(from.error()));
  return SimplifiedSpline<kDirections, kDimension>{
      TensorSpline<kDirections, kDimension>::of(std::move(from->spline)), from->deviation};
}
}  // namespace bspline_detail

template <int kDirections, int kDimension>
Expected<SimplifiedSpline<kDirections, kDimension>> remove_knot(
    const TensorSpline<kDirections, kDimension>& spline, int direction, double u) {
  return bspline_detail::typed<kDirections, kDimension>(remove_knot(spline.data(), direction, u));
}
template <int kDirections, int kDimension>
SimplifiedSpline<kDirections, kDimension> remove_knots(
    const TensorSpline<kDirections, kDimension>& spline, int direction, double tolerance) {
  auto [data, deviation] = remove_knots(spline.data(), direction, tolerance);
  return {TensorSpline<kDirections, kDimension>::of(std::move(data)), deviation};
}
template <int kDirections, int kDimension>
Expected<SimplifiedSpline<kDirections, kDimension>> reduce_degree(
    const TensorSpline<kDirections, kDimension>& spline, int direction) {
  return bspline_detail::typed<kDirections, kDimension>(reduce_degree(spline.data(), direction));
}
template <int kDirections, int kDimension>
Expected<SimplifiedSpline<kDirections, kDimension>> join(
    const TensorSpline<kDirections, kDimension>& first,
    const TensorSpline<kDirections, kDimension>& second, int direction = 0) {
  return bspline_detail::typed<kDirections, kDimension>(
      join(first.data(), second.data(), direction));
}

}  // namespace limn
