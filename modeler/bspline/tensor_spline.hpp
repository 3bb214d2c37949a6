#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "input/base/error.hpp"
#include "input/base/expect.hpp"
#include "modeler/bspline/evaluate.hpp"
#include "modeler/bspline/knot_vector.hpp"
#include "modeler/bspline/spline_data.hpp"

namespace limn {

/// The control points of a spline in R^m, first direction fastest, without their weights. A view:
/// it reads a spline that must outlive it.
template <int kDimension>
class ControlPoints {
 public:
  using Point = Eigen::Matrix<double, kDimension, 1>;

  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = Point;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = Point;

    Iterator(const SplineData* spline, std::size_t at) : spline_(spline), at_(at) {}
    Point operator*() const { return ControlPoints(*spline_)[at_]; }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    Iterator operator++(int) {
      const Iterator old = *this;
      ++at_;
      return old;
    }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.at_ == b.at_; }

   private:
    const SplineData* spline_;  // not the view, which may go
    std::size_t at_;
  };

  explicit ControlPoints(const SplineData& spline) : spline_(&spline) {}

  std::size_t size() const noexcept { return spline_->count(); }
  Point operator[](std::size_t i) const noexcept {
    std::array<double, std::size_t{kDimension} + 1 + PagedArray::kPadding> scratch;
    const auto width = static_cast<std::size_t>(spline_->width());
    const double* x = spline_->coordinates().run(i * width, width, scratch.data());
    Point point = Eigen::Map<const Point>(x);
    if (spline_->is_rational()) point /= x[kDimension];
    return point;
  }
  Point front() const noexcept { return (*this)[0]; }
  Point back() const noexcept { return (*this)[size() - 1]; }
  Iterator begin() const noexcept { return {spline_, 0}; }
  Iterator end() const noexcept { return {spline_, size()}; }

 private:
  const SplineData* spline_;
};

/// Tensor-product B-spline from R^d (d = 1 curve, 2 surface, 3 volume) to R^m, polynomial or
/// rational,
///
///     C(u) = sum_i N_i(u) w_i P_i / sum_i N_i(u) w_i,    N_i(u) = N_{i1,p1}(u_1) ..
///     N_{id,pd}(u_d),
///
/// u in the product of the domains; all w_i are 1 where it is polynomial.
///
///     name                symbol  note
///     knots(k)                    degree, knots and basis of direction k (0-based)
///     control_points()    P_i     first direction fastest, in mm where they are places
///     weight(i)           w_i     not all need be positive, but the denominator is
///
/// A periodic direction repeats its first `degree` layers of control points as its last ones. One
/// point of degree 0 is legal: a dot.
///
/// A regular value type. Copies share their control points until one is changed (SplineData), so
/// any number of threads may read copies while one edits its own.
/// Source: [PT97] ch. 3 and 4 (key in modeler/REFERENCES.md).
template <int kDirections, int kDimension>
class TensorSpline {
  static_assert(kDirections >= 1 && kDirections <= SplineData::kMostDirections,
                "curves, surfaces and volumes");
  static_assert(kDimension >= 1 && kDimension <= SplineData::kMostDimension,
                "points of dimension 1 to 10");

 public:
  using Point = Eigen::Matrix<double, kDimension, 1>;
  using Knots = std::array<KnotVector, static_cast<std::size_t>(kDirections)>;
  using Parameter = std::array<double, static_cast<std::size_t>(kDirections)>;
  using Orders = std::array<int, static_cast<std::size_t>(kDirections)>;

  /// One point at the origin, of degree 0 on [0, 1].
  TensorSpline() : data_(*make_data(Knots(), {Point(Point::Zero())}, {})) {}

  /// Polynomial. Errors: kPointCount unless there is one point a basis function; kOutOfRange for a
  /// coordinate that is not finite or a periodic direction whose last points do not equal its
  /// first.
  static Expected<TensorSpline> make(const Knots& knots, const std::vector<Point>& points) {
    return from(make_data(knots, points, {}));
  }

  /// The same for a curve.
  static Expected<TensorSpline> make(KnotVector knots,
                                     const std::vector<Point>& points) requires(kDirections == 1) {
    return make(Knots{std::move(knots)}, points);
  }

  /// Rational. Errors as make(), and: kPointCount unless there is one weight a point; kNumeric
  /// where the denominator is not positive, or cannot be proved to be
  /// (modeler/bspline/denominator.hpp).
  static Expected<TensorSpline> make_rational(const Knots& knots, const std::vector<Point>& points,
                                              const std::vector<double>& weights) {
    if (weights.size() != points.size()) {
      return fail(ErrorCode::kPointCount, "weights",
                  std::to_string(weights.size()) + " are given for " +
                      std::to_string(points.size()) + " control points",
                  "give one weight a control point");
    }
    return from(make_data(knots, points, weights));
  }

  /// Precondition: data has these numbers of directions and coordinates.
  static TensorSpline of(SplineData data) {
    LIMN_EXPECT(data.directions() == kDirections && data.dimension() == kDimension);
    return TensorSpline(std::move(data));
  }
  static Expected<TensorSpline> from(Expected<SplineData> data) {
    if (!data) return tl::unexpected(std::move(data.error()));
    return of(*std::move(data));
  }

  const KnotVector& knots(int direction = 0) const noexcept { return data_.knots(direction); }
  ControlPoints<kDimension> control_points() const noexcept {
    return ControlPoints<kDimension>(data_);
  }
  bool is_rational() const noexcept { return data_.is_rational(); }
  double weight(std::size_t i) const noexcept {
    const auto width = static_cast<std::size_t>(data_.width());
    return is_rational() ? data_.coordinates()[i * width + width - 1] : 1.0;
  }
  const SplineData& data() const noexcept { return data_; }

  /// Moves control point i, and what repeats it in periodic directions; its weight stays.
  /// Error: kOutOfRange for a coordinate that is not finite. Precondition: i < number of points.
  Expected<void> set_control_point(std::size_t i, const Point& point) {
    std::array<double, std::size_t{kDimension} + 1> x;
    const double w = weight(i);
    Eigen::Map<Point>(x.data()) = is_rational() ? Point(w * point) : point;
    x.back() = w;
    return data_.set_control_point(i, {x.data(), static_cast<std::size_t>(data_.width())});
  }

  /// C(u); u is brought into the domain (KnotVector::clamp). No allocation. [PT97 A3.1, A3.5]
  Point point(const Parameter& u) const noexcept {
    Point out;
    derivatives(u, Orders{}, {&out, 1});
    return out;
  }
  Point point(double u) const noexcept requires(kDirections == 1) { return point(Parameter{u}); }

  /// Mixed partial derivatives up to orders[k] in direction k, lower orders included:
  /// out[r1 + (orders[0]+1) (r2 + (orders[1]+1) r3)] = d^(r1+r2+r3) C / du_1^r1 du_2^r2 du_3^r3.
  /// Right-hand limits at interior knots, left-hand at the domains' ends.
  /// Precondition: orders >= 0 and out.size() is the product of the (orders[k] + 1).
  /// Allocates only for rational splines and more than 64 results.
  void derivatives(const Parameter& u, const Orders& orders, std::span<Point> out) const noexcept {
    static_assert(sizeof(Point) == kDimension * sizeof(double));
    evaluate(data_, u.data(), orders.data(), out.data()->data());
  }

  /// out[r] = d^r C / du^r for r < out.size(). Precondition: out is not empty.
  void derivatives(double u, std::span<Point> out) const noexcept requires(kDirections == 1) {
    derivatives(Parameter{u}, Orders{static_cast<int>(out.size()) - 1}, out);
  }

  friend bool operator==(const TensorSpline&, const TensorSpline&) = default;

 private:
  explicit TensorSpline(SplineData data) : data_(std::move(data)) {}

  static Expected<SplineData> make_data(const Knots& knots, const std::vector<Point>& points,
                                        const std::vector<double>& weights) {
    std::vector<double> coordinates;
    coordinates.reserve(points.size() * (kDimension + 1));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double w = weights.empty() ? 1.0 : weights[i];
      for (int c = 0; c < kDimension; ++c) coordinates.push_back(w * points[i][c]);
      if (!weights.empty()) coordinates.push_back(w);
    }
    return SplineData::make(knots, kDimension,
                            weights.empty() ? Form::kPolynomial : Form::kRational, coordinates);
  }

  SplineData data_;
};

template <int kDimension>
using BsplineCurve = TensorSpline<1, kDimension>;
/// In space, the case that queries are for.
using BsplineSurface = TensorSpline<2, 3>;

}  // namespace limn
