#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

/// The same periodic shape with its domain beginning at `u` (a knot from then on) instead of
/// knots.domain_begin(), parameters kept: the domain becomes [u, u + period].
/// Precondition: the direction is periodic, domain_begin() <= u < domain_end(). Errors as
/// insert_knots().
template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> move_seam(
    const TensorSpline<kDirections, kDimension>& spline, int direction, double u) {
  using Spline = TensorSpline<kDirections, kDimension>;
  LIMN_EXPECT(spline.knots(direction).is_periodic());
  LIMN_EXPECT(u >= spline.knots(direction).domain_begin() &&
              u < spline.knots(direction).domain_end());
  const double asked[] = {u};
  const bool is_knot = spline.knots(direction).multiplicity(u) > 0;
  auto with_knot =
      insert_knots(spline, direction, is_knot ? std::span<const double>() : std::span(asked));
  if (!with_knot) return with_knot;
  const KnotVector& old = with_knot->knots(direction);
  const int shift = old.find_span(u) - old.degree();
  auto rotated = old.rotated(shift);
  if (!rotated) return tl::unexpected(std::move(rotated.error()));

  typename Spline::Knots knots;
  std::size_t stride = 1;
  for (int d = 0; d < kDirections; ++d) {
    knots[static_cast<std::size_t>(d)] = d == direction ? *rotated : with_knot->knots(d);
    if (d < direction) stride *= static_cast<std::size_t>(with_knot->knots(d).basis_count());
  }
  const auto count = static_cast<std::size_t>(old.basis_count());
  const auto round = count - static_cast<std::size_t>(old.degree());
  std::vector<typename Spline::Point> points = with_knot->control_points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t layer = i / stride % count;
    const std::size_t from = (layer + static_cast<std::size_t>(shift)) % round;
    points[i] = with_knot->control_points()[i - layer * stride + from * stride];
  }
  return Spline::make(std::move(knots), std::move(points));
}

}  // namespace limn
