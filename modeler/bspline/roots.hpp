#pragma once

#include <span>
#include <vector>

namespace limn {

/// Where a polynomial in Bernstein form on [0, 1] is zero.
struct Roots {
  std::vector<double> at;  ///< ascending, each once, whatever its multiplicity
  /// Whether the polynomial is zero, to `noise`, on the whole interval; `at` is empty then.
  bool everywhere = false;
};

/// All roots in [0, 1] of sum_k B_{k,p} coefficients[k]. Halves the interval until the coefficients
/// change their sign once at most, then brackets; so no root is missed, and what is left of a root
/// of even multiplicity is found to about the square root of `noise`. Values up to `noise` count as
/// zero: what rounding has made of the coefficients. Precondition: 1 to 1024 coefficients, noise >=
/// 0.
Roots bernstein_roots(std::span<const double> coefficients, double noise);

/// The value at t, by de Casteljau's algorithm.
double bernstein_value(std::span<const double> coefficients, double t);

/// Coefficients of the product, of the sum of the degrees.
std::vector<double> bernstein_product(std::span<const double> a, std::span<const double> b);

}  // namespace limn
