#include "modeler/bspline/basis_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "modeler/bspline/basis.hpp"

namespace limn {

BasisTable::BasisTable(const KnotVector& knots) : knots_(knots) {
  const int p = knots.degree();
  padded_count_ = (p + 4) / 4 * 4;
  if (p > kMostDegree) return;
  const int count = knots.basis_count() - p;  // spans, empty ones too
  spans_.resize(static_cast<std::size_t>(count));
  coefficients_.resize(static_cast<std::size_t>(count * (p + 1) * padded_count_));
  const double* knot = knots.values().data() + p;
  for (int i = 0; i < count; ++i, ++knot) {
    if (!(knot[0] < knot[1])) continue;
    Span& span = spans_[static_cast<std::size_t>(i)];
    const double half = 0.5 * (knot[1] - knot[0]);
    span.middle = knot[0] + half;
    span.per_half = 1 / half;
    span.first = i;
    // The knots around the span in t, so that derivatives are of the size of the functions.
    std::array<double, 2 * kMostDegree + 2> local;
    for (int k = 1 - p; k <= p; ++k) {
      local[static_cast<std::size_t>(k + p)] = (knot[k] - span.middle) * span.per_half;
    }
    std::array<double, (kMostDegree + 1) * (kMostDegree + 1)> derivatives;
    bspline_detail::basis_derivatives(local.data() + p, p, 0.0, p, derivatives.data());
    double* row = coefficients_.data() + static_cast<std::ptrdiff_t>(i) * (p + 1) * padded_count_;
    double factorial = 1;
    for (int j = 0; j <= p; ++j) {
      if (j > 0) factorial *= j;
      for (int k = 0; k <= p; ++k) {
        row[(p - j) * padded_count_ + k] =
            derivatives[static_cast<std::size_t>(j * (p + 1) + k)] / factorial;
      }
    }
  }
  usable_ = std::all_of(coefficients_.begin(), coefficients_.end(),
                        [](double c) { return std::isfinite(c); });
}

}  // namespace limn
