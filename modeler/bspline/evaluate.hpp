#pragma once

namespace limn {

class SplineData;

/// Mixed partial derivatives of a spline at `u` (one parameter a direction, brought into the domain
/// by KnotVector::clamp) up to orders[k] in direction k, lower orders included. For a rational
/// spline those of the quotient, by Leibniz's rule. [PT97 A3.2, A3.6, A4.4]
///
///     out[m (r_1 + (orders[0] + 1) (r_2 + (orders[1] + 1) r_3)) + c]
///         = coordinate c of d^(r_1 + r_2 + r_3) C / du_1^r_1 du_2^r_2 du_3^r_3,   m = dimension().
///
/// Right-hand limits at interior knots, left-hand ones at the domains' ends.
/// Precondition: orders >= 0 and out has room for m times the product of the (orders[k] + 1).
/// Allocates only for rational splines and that product above 64.
void evaluate(const SplineData& spline, const double* u, const int* orders, double* out) noexcept;

/// The same of one polynomial piece: `spans` has a span of KnotVector::find_span() a direction,
/// whose polynomials go on outside it. So limits from either side of a knot may be had.
void evaluate_in_spans(const SplineData& spline, const int* spans, const double* u,
                       const int* orders, double* out) noexcept;

}  // namespace limn
