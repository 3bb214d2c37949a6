#include "modeler/bspline/basis.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "modeler/bspline/knot_vector.hpp"

namespace limn::bspline_detail {

void basis(const double* knot, int degree, double u, double* out) noexcept {
  std::array<double, KnotVector::kMaxDegree + 1> left;
  std::array<double, KnotVector::kMaxDegree + 1> right;
  out[0] = 1;
  for (int j = 1; j <= degree; ++j) {
    const auto sj = static_cast<std::size_t>(j);
    left[sj] = u - knot[1 - j];
    right[sj] = knot[j] - u;
    double saved = 0;
    for (std::size_t r = 0; r < sj; ++r) {
      const double share = out[r] / (right[r + 1] + left[sj - r]);
      out[r] = saved + right[r + 1] * share;
      saved = left[sj - r] * share;
    }
    out[sj] = saved;
  }
}

void basis_derivatives(const double* knot, int degree, double u, int order, double* out) noexcept {
  const int p = degree;
  const int width = p + 1;
  basis(knot, p, u, out);
  // The r-th derivative of N_{.,p} comes from N_{.,p-r} by r steps of
  // N'_{i,q} = q (N_{i,q-1} / (u_{i+q} - u_i) - N_{i+1,q-1} / (u_{i+q+1} - u_{i+1})).
  std::array<double, KnotVector::kMaxDegree + 2> lower;
  for (int r = 1; r <= order; ++r) {
    double* row = out + r * width;
    if (r > p) {
      std::fill_n(row, width, 0.0);
      continue;
    }
    const int q0 = p - r;
    lower.fill(0);  // lower[k] = N_{s-q+k,q} while q grows from q0 to p
    basis(knot, q0, u, lower.data());
    for (int q = q0 + 1; q <= p; ++q) {
      for (int k = q; k >= 0; --k) {  // downwards, so that lower[k - 1] is still of degree q - 1
        const auto sk = static_cast<std::size_t>(k);
        const double from_left = k > 0 ? lower[sk - 1] / (knot[k] - knot[k - q]) : 0.0;
        const double from_right = k < q ? lower[sk] / (knot[k + 1] - knot[k + 1 - q]) : 0.0;
        lower[sk] = q * (from_left - from_right);
      }
    }
    std::copy_n(lower.begin(), width, row);
  }
}

}  // namespace limn::bspline_detail
