#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "modeler/bspline/tensor_spline.hpp"
#include "tests/support/rng.hpp"

namespace limn::test {

/// Any legal knot vector of the degree: clamped, unclamped or periodic, spans of ratios up to about
/// 1000, multiplicities up to the degree (where `breaks`, one more).
inline KnotVector any_knots(Rng& rng, int degree, bool breaks = false) {
  const int spans = static_cast<int>(rng.integer(1, 7));
  std::vector<double> at = {rng.uniform(-10, 10)};
  for (int i = 0; i < spans; ++i) at.push_back(at.back() + std::pow(10, rng.uniform(-2, 1)));
  const double end = at.back();
  const bool periodic = degree > 0 && rng.chance(0.3);
  std::vector<double> inner;
  for (int i = periodic ? 0 : 1; i < spans; ++i) {
    const int most = breaks && !periodic ? degree + 1 : std::max(degree, 1);
    const auto times = rng.chance(0.7) ? 1 : rng.integer(1, most);
    inner.insert(inner.end(), static_cast<std::size_t>(times), at[static_cast<std::size_t>(i)]);
  }
  if (periodic) return *KnotVector::make_periodic(degree, inner, end);
  if (rng.chance(0.6)) return *KnotVector::make_clamped(degree, at[0], end, inner);
  std::vector<double> values;
  double before = at[0];
  for (int i = 0; i < degree; ++i) values.insert(values.begin(), before -= rng.uniform(0.1, 2));
  values.push_back(at[0]);
  values.insert(values.end(), inner.begin(), inner.end());
  double after = end;
  values.push_back(end);
  for (int i = 0; i < degree; ++i) values.push_back(after += rng.uniform(0.1, 2));
  return *KnotVector::make(degree, values);
}

/// Makes values repeat as periodic directions of the knots must.
template <class Value>
void repeat_layers(std::span<const KnotVector> knots, std::vector<Value>& values) {
  std::size_t stride = 1;
  for (const KnotVector& k : knots) {
    const auto count = static_cast<std::size_t>(k.basis_count());
    const auto round = count - static_cast<std::size_t>(k.is_periodic() ? k.degree() : 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t layer = i / stride % count;
      if (layer >= round) values[i] = values[i - (layer - layer % round) * stride];
    }
    stride *= count;
  }
}

/// A spline on the knots with coordinates in [-100, 100]; where rational, weights of 0.3 to 3.
template <int kDirections, int kDimension>
TensorSpline<kDirections, kDimension> any_spline(
    Rng& rng, typename TensorSpline<kDirections, kDimension>::Knots knots, bool rational = false) {
  using Spline = TensorSpline<kDirections, kDimension>;
  std::size_t size = 1;
  for (const KnotVector& k : knots) size *= static_cast<std::size_t>(k.basis_count());
  std::vector<typename Spline::Point> points(size);
  for (auto& p : points) {
    for (int d = 0; d < kDimension; ++d) p[d] = rng.uniform(-100, 100);
  }
  repeat_layers(knots, points);
  if (!rational) return *Spline::make(std::move(knots), points);
  std::vector<double> weights(size);
  for (double& w : weights) w = std::pow(10, rng.uniform(-0.5, 0.5));
  repeat_layers(knots, weights);
  return *Spline::make_rational(std::move(knots), points, weights);
}

/// Any curve of a degree up to `most_degree`.
template <int kDimension>
BsplineCurve<kDimension> any_curve(Rng& rng, int most_degree, bool breaks = false) {
  const auto degree = static_cast<int>(rng.integer(0, most_degree));
  return any_spline<1, kDimension>(rng, {any_knots(rng, degree, breaks)});
}

inline double any_parameter(Rng& rng, const KnotVector& knots) {
  return rng.uniform(knots.domain_begin(), knots.domain_end());
}

}  // namespace limn::test
