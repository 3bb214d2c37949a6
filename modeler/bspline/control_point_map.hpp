#pragma once

#include <span>
#include <vector>

#include "input/base/error.hpp"
#include "input/base/expect.hpp"
#include "modeler/bspline/knot_vector.hpp"

namespace limn {

/// A linear map on the control points of one direction, with a band of non-zeros:
///
///     Q_r = sum_k a_{r,k} P_{first(r) + k},    r < rows(), 0 <= k < width()
///
/// Refinement, degree elevation and extraction are such maps. They act along one direction of a
/// tensor product, on each line of control points alike, and on anything control points may be
/// (positions, velocities, weights). Rows of a map that leaves constants alone sum to 1.
/// A regular value type. Immutable after construction.
class ControlPointMap {
 public:
  /// `first` gives a row's first column; `coefficients` holds the rows, `width` each.
  /// Precondition: coefficients.size() == first.size() * width, 0 <= first[r] <= columns - width.
  ControlPointMap(int columns, int width, std::vector<int> first, std::vector<double> coefficients);

  int rows() const noexcept { return static_cast<int>(first_.size()); }
  int columns() const noexcept { return columns_; }
  int width() const noexcept { return width_; }
  int first(int row) const noexcept { return first_[static_cast<std::size_t>(row)]; }
  std::span<const double> row(int row) const noexcept {
    return {coefficients_.data() + static_cast<std::ptrdiff_t>(row) * width_,
            static_cast<std::size_t>(width_)};
  }

  /// Maps the line in[0], in[stride], .. (columns() of them) to out[0], out[stride], .. (rows()).
  /// The ranges must not overlap. Point needs Point * double and Point + Point.
  template <class Point>
  void apply(const Point* in, Point* out, std::ptrdiff_t stride = 1) const {
    for (int r = 0; r < rows(); ++r) {
      const auto coefficients = row(r);
      const Point* p = in + stride * first(r);
      Point sum = *p * coefficients[0];
      for (std::size_t k = 1; k < coefficients.size(); ++k) {
        p += stride;
        sum = sum + *p * coefficients[k];
      }
      out[stride * r] = sum;
    }
  }

 private:
  int columns_;
  int width_;
  std::vector<int> first_;
  std::vector<double> coefficients_;
};

/// The map that applies `inner` first, then `outer`.
/// Precondition: outer.columns() == inner.rows().
ControlPointMap compose(const ControlPointMap& outer, const ControlPointMap& inner);

/// New knots, and the map from control points on the old ones to control points on the new ones
/// that leaves the shape as it is.
struct KnotRefinement {
  KnotVector knots;
  ControlPointMap map;
};

/// Adds the knots `added` (any order, repeated for multiplicity) to `knots`. In a periodic
/// direction their images one period on follow by themselves; a knot at the seam may be given by
/// either end. O((n + m) p^2) for m knots. [PT97 ch. 5.3]
/// Errors: kOutOfRange for a knot outside the domain or one whose multiplicity would grow too high.
Expected<KnotRefinement> insert_knots(const KnotVector& knots, std::span<const double> added);

/// Raises the degree by `by` (0 or more); every distinct knot of the domain gains `by` in
/// multiplicity, so that continuity stays. [PT97 ch. 5.5]
/// Error: kOutOfRange where the degree would pass KnotVector::kMaxDegree.
Expected<KnotRefinement> elevate_degree(const KnotVector& knots, int by);

}  // namespace limn
