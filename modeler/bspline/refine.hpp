#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "modeler/bspline/control_point_map.hpp"
#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

// The same shape on other knots. Each exists for SplineData, where it is written, and for the typed
// splines.

/// On refined knots in one direction: every line of control points goes through `refinement.map`.
/// Precondition: refinement was made from spline.knots(direction).
/// Error: kOutOfRange where a new coordinate overflows.
Expected<SplineData> refine(const SplineData& spline, int direction,
                            const KnotRefinement& refinement);

/// With knots added in one direction. Errors as for knot vectors.
Expected<SplineData> insert_knots(const SplineData& spline, int direction,
                                  std::span<const double> added);

/// With knots added in each direction at once, added[d] in direction d: what that gives in between
/// is neither checked nor put into pages. Errors as for one direction. Precondition: a list, which
/// may be empty, a direction.
Expected<SplineData> insert_knots(const SplineData& spline,
                                  std::span<const std::span<const double>> added);

/// Of a higher degree in one direction. Errors as for knot vectors.
Expected<SplineData> elevate_degree(const SplineData& spline, int direction, int by);

/// The same periodic shape with its domain beginning at `u` (a knot from then on) instead of
/// knots.domain_begin(), parameters kept: the domain becomes [u, u + period].
/// Precondition: the direction is periodic, domain_begin() <= u < domain_end(). Errors as
/// insert_knots().
Expected<SplineData> move_seam(const SplineData& spline, int direction, double u);

/// The part on [low, high] of one direction, clamped there; of a periodic direction it is open.
/// Errors as segment_knots().
Expected<SplineData> segment(const SplineData& spline, int direction, double low, double high);

/// Run through backwards in one direction: u becomes domain_begin() + domain_end() - u.
Expected<SplineData> reverse(const SplineData& spline, int direction);

/// In Bézier form in one direction (bezier_knots()): clamped and open, each span by itself.
Expected<SplineData> to_bezier(const SplineData& spline, int direction);

template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> refine(
    const TensorSpline<kDirections, kDimension>& spline, int direction,
    const KnotRefinement& refinement) {
  return TensorSpline<kDirections, kDimension>::from(refine(spline.data(), direction, refinement));
}
template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> insert_knots(
    const TensorSpline<kDirections, kDimension>& spline, int direction,
    std::span<const double> added) {
  return TensorSpline<kDirections, kDimension>::from(insert_knots(spline.data(), direction, added));
}
template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> insert_knots(
    const TensorSpline<kDirections, kDimension>& spline,
    const std::array<std::span<const double>, std::size_t{kDirections}>& added) {
  return TensorSpline<kDirections, kDimension>::from(insert_knots(spline.data(), added));
}
template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> elevate_degree(
    const TensorSpline<kDirections, kDimension>& spline, int direction, int by) {
  return TensorSpline<kDirections, kDimension>::from(elevate_degree(spline.data(), direction, by));
}
template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> move_seam(
    const TensorSpline<kDirections, kDimension>& spline, int direction, double u) {
  return TensorSpline<kDirections, kDimension>::from(move_seam(spline.data(), direction, u));
}

template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> segment(
    const TensorSpline<kDirections, kDimension>& spline, int direction, double low, double high) {
  return TensorSpline<kDirections, kDimension>::from(segment(spline.data(), direction, low, high));
}
template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> reverse(
    const TensorSpline<kDirections, kDimension>& spline, int direction) {
  return TensorSpline<kDirections, kDimension>::from(reverse(spline.data(), direction));
}
template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> to_bezier(
    const TensorSpline<kDirections, kDimension>& spline, int direction) {
  return TensorSpline<kDirections, kDimension>::from(to_bezier(spline.data(), direction));
}

}  // namespace limn
