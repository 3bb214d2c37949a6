#pragma once

#include <memory>
#include <span>
#include <vector>

#include "input/base/error.hpp"

namespace limn {

/// Whether a spline direction ends or runs round.
enum class Closure : bool { kOpen, kPeriodic };

/// Knots of one direction of a spline, and the B-spline basis N_{i,p} on them.
///
///     name             symbol  note
///     degree()         p       0 to kMaxDegree; limn never stores the order, p + 1
///     values()         u_j     n + p + 1 of them, non-decreasing, repeated per multiplicity
///     basis_count()    n       number of basis functions, so of control points
///     domain           [u_p, u_n]
///
/// An open direction may have any end knots (clamped or not). A knot inside the domain of
/// multiplicity m leaves the spline C^(p-m): p makes a corner, p + 1 (the most allowed anywhere) a
/// break. No basis function is dead: u_p < u_{p+1} and u_{n-1} < u_n.
///
/// A periodic direction of degree p (at least 1) is kept wrapped: with N = n - p functions round
/// the period T = u_n - u_p it holds u_{j+N} = u_j + T, and a spline repeats its first p control
/// points at the end, so that evaluation needs no special case. Multiplicity is at most p, the seam
/// included, hence value(u_p) = value(u_n).
///
/// A regular value type. Immutable, so any number of threads may read one; copies share the values.
/// Source: [PT97] ch. 2.
class KnotVector {
 public:
  static constexpr int kMaxDegree = 25;

  /// Degree 0 on [0, 1]: one constant function.
  KnotVector();

  /// Errors: kOutOfRange for the degree, a value that is not finite, decreases, is too close to its
  /// neighbour to divide by, or too high a multiplicity; kPointCount for too few values; kNumeric
  /// where a periodic direction does not repeat.
  static Expected<KnotVector> make(int degree, std::vector<double> values,
                                   Closure closure = Closure::kOpen);

  /// The clamped vector with end knots `begin` and `end` of multiplicity degree + 1 and the given
  /// interior knots, with their multiplicities. Errors as make().
  static Expected<KnotVector> make_clamped(int degree, double begin, double end,
                                           std::span<const double> interior = {});

  /// The periodic vector of period end - begin whose knots in [begin, end) are `round`: begin
  /// first (repeated for a corner at the seam), then the rest, with multiplicities. Errors as
  /// make().
  static Expected<KnotVector> make_periodic(int degree, std::span<const double> round, double end);

  /// The periodic vector whose domain begins at this one's value degree() + shift, values of the
  /// next period following. Precondition: is_periodic(), 0 <= shift < basis_count() - degree().
  /// Error: kOutOfRange where that value is not the last of equal ones.
  Expected<KnotVector> rotated(int shift) const;

  int degree() const noexcept { return degree_; }
  bool is_periodic() const noexcept { return closure_ == Closure::kPeriodic; }
  Closure closure() const noexcept { return closure_; }
  const std::vector<double>& values() const noexcept { return table_->values; }
  int basis_count() const noexcept { return static_cast<int>(values().size()) - degree_ - 1; }
  double domain_begin() const noexcept { return values()[static_cast<std::size_t>(degree_)]; }
  double domain_end() const noexcept { return values()[static_cast<std::size_t>(basis_count())]; }

  /// `u` brought into the domain: clamped, or wrapped where periodic (the end itself stays).
  double clamp(double u) const noexcept;

  /// The s with u_s <= u < u_{s+1}, degree() <= s < basis_count(); the last non-empty span for
  /// u >= domain_end(), the first for u < domain_begin(). O(1) where spans are about equal, O(log
  /// n) at worst. [PT97 A2.1]
  int find_span(double u) const noexcept;

  /// out[k] = N_{span-p+k,p}(u), the p + 1 functions that do not vanish on `span` (from
  /// find_span). Outside the span this continues the span's polynomials.
  /// Precondition: out.size() >= degree() + 1. O(p^2), no allocation. [PT97 A2.2]
  void basis(int span, double u, std::span<double> out) const noexcept;

  /// out[r (p + 1) + k] = d^r N_{span-p+k,p} / du^r for r <= order; zero for r > p.
  /// Precondition: out.size() >= (order + 1) (p + 1), order >= 0. No allocation. [PT97 A2.3]
  void basis_derivatives(int span, double u, int order, std::span<double> out) const noexcept;

  /// (u_{i+1} + .. + u_{i+p}) / p, the parameter that control point i belongs to; the middle of
  /// the span for degree 0. Precondition: 0 <= i < basis_count().
  double greville(int i) const noexcept;

  /// How often the value `u` occurs, compared exactly.
  int multiplicity(double u) const noexcept;

  /// The distinct knots of the domain, ascending, both ends included.
  std::vector<double> breakpoints() const;

  friend bool operator==(const KnotVector& a, const KnotVector& b) noexcept {
    return a.degree_ == b.degree_ && a.closure_ == b.closure_ &&
           (a.table_ == b.table_ || a.values() == b.values());
  }

 private:
  /// The domain is cut into equal cells; for a parameter in cell c, find_span() need only look from
  /// the last span that begins before c to the last that begins in it.
  struct Table {
    std::vector<double> values;
    std::vector<int> last_span;  ///< of cell c - 1 and before, at c; one more than there are cells
    double cells_per_unit = 0;
  };
  static std::shared_ptr<const Table> make_table(int degree, std::vector<double> values);

  KnotVector(int degree, std::vector<double> values, Closure closure)
      : degree_(degree), closure_(closure), table_(make_table(degree, std::move(values))) {}

  int degree_ = 0;
  Closure closure_ = Closure::kOpen;
  std::shared_ptr<const Table> table_;
};

}  // namespace limn
