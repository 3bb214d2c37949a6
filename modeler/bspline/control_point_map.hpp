#pragma once

#include <cstddef>
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

  /// A row without the zeros that it begins and ends with: the sum over k < size of coefficients[k]
  /// P_{first + k}.
  struct Sum {
    int first = 0;
    int size = 0;
    const double* coefficients = nullptr;
  };
  Sum sum(int row) const noexcept {
    const Part& part = parts_[static_cast<std::size_t>(row)];
    return {part.first, part.size, coefficients_.data() + part.begin};
  }

 private:
  struct Part {
    int first;  ///< column
    int size;
    std::ptrdiff_t begin;  ///< in coefficients_
  };

  int columns_;
  int width_;
  std::vector<int> first_;
  std::vector<double> coefficients_;
  std::vector<Part> parts_;  ///< of each row, that Sum is of
};

/// Maps layers of `layer` doubles, one after another: out layer r = sum_k a_{r,k} in layer
/// first(r) + k. Each block of `in` holds map.columns() layers, out gets map.rows() a block, one
/// after another; they must not overlap. Gives the same bits on every processor.
/// Several blocks at a time cost least, best a multiple of kBlocksTogether.
inline constexpr std::size_t kBlocksTogether = 4;
void map_layers(const ControlPointMap& map, std::size_t layer, std::span<const double* const> in,
                double* out) noexcept;

/// out[i] = sum_k coefficients[k] in[k][i] for i < count, the terms added in this order; the same
/// bits on every processor. Precondition: at least one.
void add_layers(std::span<const double> coefficients, const double* const* in, std::size_t count,
                double* out) noexcept;

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

/// The part of a direction on [low, high], clamped there. The map's rows are convex combinations.
/// Works on periodic directions, too, whose part is open. [PT97 ch. 5.3]
/// Errors: kOutOfRange unless domain_begin() <= low < high <= domain_end().
Expected<KnotRefinement> segment_knots(const KnotVector& knots, double low, double high);

/// Clamped, with all knots inside the domain of multiplicity max(degree, 1): each span's control
/// points are its Bézier points then, the first shared with the span before. Breaks stay breaks.
KnotRefinement bezier_knots(const KnotVector& knots);

/// The direction run through backwards, u becoming domain_begin() + domain_end() - u.
/// Error: kOutOfRange where rounding makes knots meet.
Expected<KnotRefinement> reverse_knots(const KnotVector& knots);

/// The Bézier control points of one span from the control points that shape it:
///
///     Q_r = sum_k out[r (p + 1) + k] P_{span-p+k},    0 <= r, k <= p.
///
/// Rows are convex combinations, so hulls only shrink. Precondition: span from find_span(). O(p^3).
/// [PT97 ch. 5.3]
std::vector<double> bezier_extraction(const KnotVector& knots, int span);

}  // namespace limn
