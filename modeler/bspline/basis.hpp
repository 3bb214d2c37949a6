#pragma once

namespace limn::bspline_detail {

// B-spline basis functions on bare knots: `knot` points at u_s, the first knot of a non-empty span
// [u_s, u_{s+1}), and `degree` knots on either side of the span are read. What KnotVector checks is
// taken for granted. No allocation.

/// out[k] = N_{s-p+k,p}(u) for k <= p. Outside the span this continues its polynomials. [PT97 A2.2]
void basis(const double* knot, int degree, double u, double* out) noexcept;

/// out[r (p + 1) + k] = d^r N_{s-p+k,p} / du^r for r <= order; zero for r > p. [PT97 A2.3]
void basis_derivatives(const double* knot, int degree, double u, int order, double* out) noexcept;

}  // namespace limn::bspline_detail
