#pragma once

#include <vector>

#include "modeler/bspline/knot_vector.hpp"

namespace limn {

/// The basis functions of one direction as polynomials, for many evaluations: on each span [a, b]
/// the p + 1 functions that do not vanish are
///
///     N_k(u) = sum_j c_{j,k} t^j,    t = (u - m) / h,  m = (a + b) / 2,  h = (b - a) / 2,
///
/// whose Horner scheme works on several functions at once and has no division. |t| <= 1, so what
/// rounding costs against the recursion of [PT97 A2.2] is a factor of at most about 2^p.
///
/// Immutable after construction, so any number of threads may read one.
class BasisTable {
 public:
  /// Above it the recursion is as fast and the powers lose too many digits.
  static constexpr int kMostDegree = 9;

  /// O(spans p^3).
  explicit BasisTable(const KnotVector& knots);

  /// Whether there is a table: the degree is not too high and no coefficient overflows.
  bool usable() const noexcept { return usable_; }
  const KnotVector& knots() const noexcept { return knots_; }

  /// Functions a row holds: degree + 1, and zeros up to a multiple of 4.
  int padded_count() const noexcept { return padded_count_; }

  struct Span {
    double middle = 0;
    double per_half = 0;  ///< 1 / h
    int first = 0;        ///< control point of function 0
  };
  /// Number i of find_span() - degree.
  const Span& span(int i) const noexcept { return spans_[static_cast<std::size_t>(i)]; }
  /// Of span i from i (degree + 1) padded_count() on: c_{p,0}, c_{p,1}, .., c_{0,p}, each padded.
  const double* coefficients() const noexcept { return coefficients_.data(); }

 private:
  KnotVector knots_;
  bool usable_ = false;
  int padded_count_ = 0;
  std::vector<Span> spans_;  ///< from find_span's first, degree(), on; empty ones stay zero
  std::vector<double> coefficients_;
};

}  // namespace limn
