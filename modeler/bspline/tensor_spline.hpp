#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "input/base/error.hpp"
#include "input/base/expect.hpp"
#include "modeler/bspline/control_point_map.hpp"
#include "modeler/bspline/knot_vector.hpp"

namespace limn {

/// Polynomial tensor-product B-spline from R^d (d = 1 curve, 2 surface, 3 volume) to R^m,
///
///     C(u) = sum_i N_{i1,p1}(u_1) .. N_{id,pd}(u_d) P_i,    u in the product of the domains.
///
///     name                symbol  note
///     knots(k)                    degree, knots and basis of direction k (0-based)
///     control_points()    P_i     contiguous, first direction fastest, in mm where they are places
///
/// A periodic direction repeats its first `degree` layers of control points as its last ones. One
/// point of degree 0 is legal: a dot.
///
/// A regular value type. Immutable, so any number of threads may read one.
/// Source: [PT97] ch. 3 (key in modeler/REFERENCES.md).
template <int kDirections, int kDimension>
class TensorSpline {
  static_assert(kDirections >= 1 && kDirections <= 3, "curves, surfaces and volumes");
  static_assert(kDimension >= 1 && kDimension <= 10, "points of dimension 1 to 10");

 public:
  using Point = Eigen::Matrix<double, kDimension, 1>;
  using Knots = std::array<KnotVector, static_cast<std::size_t>(kDirections)>;
  using Parameter = std::array<double, static_cast<std::size_t>(kDirections)>;
  using Orders = std::array<int, static_cast<std::size_t>(kDirections)>;

  /// One point at the origin, of degree 0 on [0, 1].
  TensorSpline() : points_(1, Point::Zero()) {}

  /// Errors: kPointCount unless there is one point a basis function; kOutOfRange for a coordinate
  /// that is not finite or a periodic direction whose last points do not equal its first.
  static Expected<TensorSpline> make(Knots knots, std::vector<Point> points);

  /// The same for a curve.
  static Expected<TensorSpline> make(KnotVector knots,
                                     std::vector<Point> points) requires(kDirections == 1) {
    return make(Knots{std::move(knots)}, std::move(points));
  }

  const KnotVector& knots(int direction = 0) const noexcept {
    return knots_[static_cast<std::size_t>(direction)];
  }
  const std::vector<Point>& control_points() const noexcept { return points_; }

  /// C(u); u is brought into the domain (KnotVector::clamp). No allocation. [PT97 A3.1, A3.5]
  Point point(const Parameter& u) const noexcept {
    Point out;
    derivatives(u, Orders{}, {&out, 1});
    return out;
  }
  Point point(double u) const noexcept requires(kDirections == 1) { return point(Parameter{u}); }

  /// Mixed partial derivatives up to orders[k] in direction k, lower orders included:
  /// out[r1 + (orders[0]+1) (r2 + (orders[1]+1) r3)] = d^(r1+r2+r3) C / du_1^r1 du_2^r2 du_3^r3,
  /// zero where r_k > degree. Right-hand limits at interior knots, left-hand at the domains' ends.
  /// Precondition: orders >= 0 and out.size() is the product of the (orders[k] + 1).
  /// No allocation. [PT97 A3.2, A3.6]
  void derivatives(const Parameter& u, const Orders& orders, std::span<Point> out) const noexcept;

  /// out[r] = d^r C / du^r for r < out.size(). Precondition: out is not empty.
  void derivatives(double u, std::span<Point> out) const noexcept requires(kDirections == 1) {
    derivatives(Parameter{u}, Orders{static_cast<int>(out.size()) - 1}, out);
  }

  friend bool operator==(const TensorSpline&, const TensorSpline&) = default;

 private:
  TensorSpline(Knots knots, std::vector<Point> points)
      : knots_(std::move(knots)), points_(std::move(points)) {}

  Knots knots_;
  std::vector<Point> points_;
};

template <int kDimension>
using BsplineCurve = TensorSpline<1, kDimension>;

/// The same shape on refined knots in one direction: every line of control points goes through
/// `refinement.map`. Precondition: refinement was made from spline.knots(direction).
/// Error: kOutOfRange where a new coordinate overflows.
template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> refine(
    const TensorSpline<kDirections, kDimension>& spline, int direction,
    const KnotRefinement& refinement);

/// The same shape with knots added in one direction. Errors as for knot vectors.
template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> insert_knots(
    const TensorSpline<kDirections, kDimension>& spline, int direction,
    std::span<const double> added) {
  auto refinement = insert_knots(spline.knots(direction), added);
  if (!refinement) return tl::unexpected(std::move(refinement.error()));
  return refine(spline, direction, *refinement);
}

/// The same shape of a higher degree in one direction. Errors as for knot vectors.
template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> elevate_degree(
    const TensorSpline<kDirections, kDimension>& spline, int direction, int by) {
  auto refinement = elevate_degree(spline.knots(direction), by);
  if (!refinement) return tl::unexpected(std::move(refinement.error()));
  return refine(spline, direction, *refinement);
}

// Implementation ------------------------------------------------------------------------------

namespace bspline_detail {

/// Whether the layers of control points repeat as a periodic direction must.
/// `stride` apart lie neighbours of that direction, `count` of them a line.
template <class Point>
bool repeats_along(const std::vector<Point>& points, std::size_t stride, std::size_t count,
                   std::size_t degree) {
  const std::size_t shift = (count - degree) * stride;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i / stride % count < degree && points[i] != points[i + shift]) return false;
  }
  return true;
}

}  // namespace bspline_detail

template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> TensorSpline<kDirections, kDimension>::make(
    Knots knots, std::vector<Point> points) {
  std::size_t expected = 1;
  for (const KnotVector& k : knots) expected *= static_cast<std::size_t>(k.basis_count());
  if (points.size() != expected) {
    return fail(
        ErrorCode::kPointCount, "control points",
        std::to_string(points.size()) + " are given but the knots need " + std::to_string(expected),
        "give one control point a basis function");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      return fail(ErrorCode::kOutOfRange, "control point " + std::to_string(i),
                  "a coordinate is not finite", "give finite coordinates");
    }
  }
  std::size_t stride = 1;
  for (const KnotVector& k : knots) {
    const auto count = static_cast<std::size_t>(k.basis_count());
    const auto degree = static_cast<std::size_t>(k.degree());
    if (k.is_periodic() && !bspline_detail::repeats_along(points, stride, count, degree)) {
      return fail(ErrorCode::kOutOfRange, "control points",
                  "a periodic direction does not end with its first points",
                  "repeat the first 'degree' control points at the end");
    }
    stride *= count;
  }
  return TensorSpline(std::move(knots), std::move(points));
}

template <int kDirections, int kDimension>
void TensorSpline<kDirections, kDimension>::derivatives(const Parameter& u, const Orders& orders,
                                                        std::span<Point> out) const noexcept {
  constexpr auto kD = static_cast<std::size_t>(kDirections);
  constexpr int kMostBasis = KnotVector::kMaxDegree + 1;
  // Orders above the degree are zero; leaving them out bounds the stack.
  std::array<std::array<double, kMostBasis * kMostBasis>, kD> basis;
  std::array<int, kD> order{};  // computed: min(asked, degree)
  std::array<int, kD> first{};
  for (std::size_t d = 0; d < kD; ++d) {
    const KnotVector& k = knots_[d];
    const double x = k.clamp(u[d]);
    const int span = k.find_span(x);
    order[d] = std::min(orders[d], k.degree());
    first[d] = span - k.degree();
    k.basis_derivatives(span, x, order[d], basis[d]);
  }
  std::fill(out.begin(), out.end(), Point(Point::Zero()));

  // For each line of the window along direction 0, its sums are added to all outputs they reach.
  std::array<int, kD> at{};  // window position; at[0] is summed inside
  const int width0 = knots_[0].degree() + 1;
  std::array<Point, kMostBasis> line;
  for (;;) {
    std::size_t offset = 0;
    for (std::size_t d = kD; d-- > 0;) {
      offset = offset * static_cast<std::size_t>(knots_[d].basis_count()) +
               static_cast<std::size_t>(first[d] + at[d]);
    }
    const Point* p = points_.data() + offset;
    for (int r = 0; r <= order[0]; ++r) {
      const double* b = basis[0].data() + r * width0;
      Point sum = b[0] * p[0];
      for (int k = 1; k < width0; ++k) sum += b[k] * p[k];
      line[static_cast<std::size_t>(r)] = sum;
    }
    std::array<int, kD> r{};
    for (;;) {  // over the orders of the other directions
      double weight = 1;
      std::size_t target = 0;
      for (std::size_t d = kD; d-- > 1;) {
        weight *= basis[d][static_cast<std::size_t>(r[d] * (knots_[d].degree() + 1) + at[d])];
        target = target * static_cast<std::size_t>(orders[d] + 1) + static_cast<std::size_t>(r[d]);
      }
      target *= static_cast<std::size_t>(orders[0] + 1);
      for (int r0 = 0; r0 <= order[0]; ++r0) {
        out[target + static_cast<std::size_t>(r0)] += weight * line[static_cast<std::size_t>(r0)];
      }
      std::size_t d = 1;
      while (d < kD && ++r[d] > order[d]) r[d++] = 0;
      if (d >= kD) break;
    }
    std::size_t d = 1;
    while (d < kD && ++at[d] > knots_[d].degree()) at[d++] = 0;
    if (d >= kD) break;
  }
}

template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> refine(
    const TensorSpline<kDirections, kDimension>& spline, int direction,
    const KnotRefinement& refinement) {
  using Spline = TensorSpline<kDirections, kDimension>;
  LIMN_EXPECT(refinement.map.columns() == spline.knots(direction).basis_count());
  typename Spline::Knots knots;
  std::ptrdiff_t stride = 1;
  std::ptrdiff_t blocks = 1;  // number of lines' blocks after this direction
  for (int d = 0; d < kDirections; ++d) {
    const KnotVector& k = spline.knots(d);
    if (d < direction) stride *= k.basis_count();
    if (d > direction) blocks *= k.basis_count();
    knots[static_cast<std::size_t>(d)] = d == direction ? refinement.knots : k;
  }
  const auto& map = refinement.map;
  std::vector<typename Spline::Point> points(
      static_cast<std::size_t>(stride * blocks * map.rows()));
  for (std::ptrdiff_t b = 0; b < blocks; ++b) {
    for (std::ptrdiff_t s = 0; s < stride; ++s) {
      map.apply(spline.control_points().data() + b * stride * map.columns() + s,
                points.data() + b * stride * map.rows() + s, stride);
    }
  }
  if (refinement.knots.is_periodic()) {
    // The map gives the repeated layers only up to rounding.
    const auto layer = static_cast<std::size_t>(stride);
    const auto count = static_cast<std::size_t>(map.rows());
    const auto degree = static_cast<std::size_t>(refinement.knots.degree());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i / layer % count >= count - degree) points[i] = points[i - (count - degree) * layer];
    }
  }
  return Spline::make(std::move(knots), std::move(points));
}

}  // namespace limn
