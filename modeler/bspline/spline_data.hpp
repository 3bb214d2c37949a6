#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "input/base/error.hpp"
#include "modeler/base/paged_array.hpp"
#include "modeler/bspline/knot_vector.hpp"

namespace limn {

/// What the coordinates of a control point are: x_1 .. x_m, or w x_1 .. w x_m, w.
enum class Form : bool { kPolynomial, kRational };

/// A tensor-product B-spline whose numbers of directions and coordinates are known at run time
/// only: what TensorSpline<directions, dimension> holds and what algorithms that fit all of them
/// work on.
///
///     name            symbol  note
///     directions()    d       1 curve, 2 surface, 3 volume
///     dimension()     m       of the points, 1 to 10
///     width()                 doubles a control point: m, and one for the weight of a rational one
///     coordinates()           width() doubles a control point, first direction fastest
///
/// A rational spline is kept in homogeneous coordinates, so that refinement, which is linear in
/// them, need not know. Its denominator is positive everywhere, which is proved when it is made.
/// A periodic direction repeats its first `degree` layers of control points as its last ones.
///
/// A regular value type. Copies share the coordinates' pages until one of them is changed, so a
/// copy costs the same whatever the size.
class SplineData {
 public:
  static constexpr int kMostDirections = 3;
  static constexpr int kMostDimension = 10;

  /// Errors: kPointCount unless there are width() coordinates a basis function; kOutOfRange for a
  /// coordinate that is not finite, a weight nearly 0 (below 1e-100), or a periodic direction whose
  /// last points do not equal its first; kNumeric where the denominator is not positive, or could
  /// not be proved to be. Precondition: 1 to 3 knot vectors, a dimension from 1 to 10.
  static Expected<SplineData> make(std::span<const KnotVector> knots, int dimension, Form form,
                                   std::span<const double> coordinates);
  /// The same of coordinates that are in pages already.
  static Expected<SplineData> make(std::span<const KnotVector> knots, int dimension, Form form,
                                   PagedArray coordinates);

  int directions() const noexcept { return directions_; }
  int dimension() const noexcept { return dimension_; }
  Form form() const noexcept { return form_; }
  bool is_rational() const noexcept { return form_ == Form::kRational; }
  int width() const noexcept { return dimension_ + (is_rational() ? 1 : 0); }
  const KnotVector& knots(int direction) const noexcept {
    return knots_[static_cast<std::size_t>(direction)];
  }
  std::span<const KnotVector> knots() const noexcept {
    return {knots_.data(), static_cast<std::size_t>(directions_)};
  }
  const PagedArray& coordinates() const noexcept { return coordinates_; }

  /// How many control points there are, those that a periodic direction repeats included.
  std::size_t count() const noexcept {
    return coordinates_.size() / static_cast<std::size_t>(width());
  }
  /// How many control points lie from one to its next in `direction`.
  std::size_t stride(int direction) const noexcept;

  /// Puts a control point and its repetitions of periodic directions elsewhere. O(1) but for pages
  /// that are shared; where a weight is not positive, the denominator is proved anew.
  /// Errors, with the spline as it was: as make(). Precondition: index < count(), width() values.
  Expected<void> set_control_point(std::size_t index, std::span<const double> coordinates);

  friend bool operator==(const SplineData&, const SplineData&) = default;

 private:
  SplineData() = default;

  int directions_ = 0;
  int dimension_ = 0;
  Form form_ = Form::kPolynomial;
  bool positive_weights_ = true;  ///< all of them, which proves the denominator
  std::array<KnotVector, kMostDirections> knots_;
  PagedArray coordinates_;
};

}  // namespace limn
