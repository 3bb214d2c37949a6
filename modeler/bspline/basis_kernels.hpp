#pragma once

#include <cstddef>

#include "modeler/bspline/basis_table.hpp"
#include "modeler/bspline/lanes.hpp"

namespace limn::bspline_detail {

/// The functions of one direction that do not vanish at a parameter, with derivatives up to kOrder.
template <int kOrder>
struct Functions {
  static constexpr std::size_t kMostPadded = (BasisTable::kMostDegree + 4) / 4 * 4;
  alignas(32) double value[std::size_t{kOrder} + 1][kMostPadded];
  int first = 0;  ///< control point of function 0
};

/// Horner's scheme on kChunks times four functions: value, f', f''/2 and f'''/6 in t, then in u.
template <int kOrder, int kChunks>
LIMN_KERNEL void horner(const double* row, int degree, double t, double per_half,
                        Functions<kOrder>& out) noexcept {
  static_assert(kOrder >= 0 && kOrder <= 3);
  const Lanes zero = {0, 0, 0, 0};
  for (int chunk = 0; chunk < kChunks; ++chunk) {
    const double* c = row + 4 * chunk;
    Lanes value;
    load(c, value);
    Lanes first = zero;
    Lanes second = zero;
    Lanes third = zero;
    for (int j = 0; j < degree; ++j) {
      c += 4 * kChunks;
      Lanes next;
      load(c, next);
      if constexpr (kOrder > 2) third = third * t + second;
      if constexpr (kOrder > 1) second = second * t + first;
      if constexpr (kOrder > 0) first = first * t + value;
      value = value * t + next;
    }
    store(value, &out.value[0][4 * chunk]);
    if constexpr (kOrder > 0) store(first * per_half, &out.value[1][4 * chunk]);
    if constexpr (kOrder > 1) {
      store(second * (2 * per_half * per_half), &out.value[2][4 * chunk]);
    }
    if constexpr (kOrder > 2) {
      store(third * (6 * per_half * per_half * per_half), &out.value[3][4 * chunk]);
    }
  }
}

/// On the piece of a span of KnotVector::find_span(). kDegree is the table's, or -1 where it is not
/// known to the compiler.
template <int kDegree, int kOrder>
LIMN_KERNEL void evaluate_functions_in(const BasisTable& table, int span_number, double x,
                                       Functions<kOrder>& out) noexcept {
  const int degree = kDegree < 0 ? table.knots().degree() : kDegree;
  const int i = span_number - degree;
  const BasisTable::Span& span = table.span(i);
  const double t = (x - span.middle) * span.per_half;
  out.first = span.first;
  const int padded = kDegree < 0 ? table.padded_count() : (kDegree + 4) / 4 * 4;
  const double* row = table.coefficients() + static_cast<std::ptrdiff_t>(i) * (degree + 1) * padded;
  switch (padded) {
    case 4:
      return horner<kOrder, 1>(row, degree, t, span.per_half, out);
    case 8:
      return horner<kOrder, 2>(row, degree, t, span.per_half, out);
    default:
      return horner<kOrder, 3>(row, degree, t, span.per_half, out);
  }
}

template <int kOrder>
LIMN_KERNEL void evaluate_functions(const BasisTable& table, double u,
                                    Functions<kOrder>& out) noexcept {
  const double x = table.knots().clamp(u);
  evaluate_functions_in<-1>(table, table.knots().find_span(x), x, out);
}

}  // namespace limn::bspline_detail
