#include "modeler/bspline/curve_evaluator.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "modeler/bspline/basis_kernels.hpp"
#include "modeler/bspline/evaluate.hpp"

namespace limn::bspline_detail {
namespace {

constexpr int kOrder = 3;
constexpr std::size_t kResults = kOrder + 1;
constexpr std::size_t kMostPoints = BasisTable::kMostDegree + 1;
/// Coordinates and weight of a point, in whole vectors.
constexpr std::size_t kMostChunks = (SplineData::kMostDimension + 1 + 3) / 4;
using Row = std::array<double, 4 * kMostChunks>;
using Rows = std::array<Row, kResults>;

/// The derivatives of A / w from those of (A, w): C^(r) = (A^(r) - sum_{s = 1..r} binom(r, s) w^(s)
/// C^(r - s)) / w. [PT97 4.8]
LIMN_KERNEL void divide(Rows& rows, std::size_t dimension) noexcept {
  constexpr double kBinomial[kResults][kResults] = {
      {1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};
  const double per_w = 1 / rows[0][dimension];
  for (std::size_t r = 0; r < kResults; ++r) {
    for (std::size_t s = 1; s <= r; ++s) {
      const double factor = kBinomial[r][s] * rows[s][dimension];
      for (std::size_t c = 0; c < dimension; ++c) rows[r][c] -= factor * rows[r - s][c];
    }
    for (std::size_t c = 0; c < dimension; ++c) rows[r][c] *= per_w;
  }
}

template <std::size_t kChunks>
LIMN_KERNEL void evaluate_jets(const SplineData& curve, const BasisTable& table,
                               std::span<const double> us, double* out) noexcept {
  const auto width = static_cast<std::size_t>(curve.width());
  const auto dimension = static_cast<std::size_t>(curve.dimension());
  const auto count = static_cast<std::size_t>(table.knots().degree()) + 1;
  std::array<double, kMostPoints*(SplineData::kMostDimension + 1) + PagedArray::kPadding> scratch;
  Functions<kOrder> f;
  Rows rows;
  for (const double u : us) {
    evaluate_functions(table, u, f);
    const double* points = curve.coordinates().run(static_cast<std::size_t>(f.first) * width,
                                                   count * width, scratch.data());
    for (std::size_t chunk = 0; chunk < kChunks; ++chunk) {
      const Lanes zero = {0, 0, 0, 0};
      Lanes s0 = zero;
      Lanes s1 = zero;
      Lanes s2 = zero;
      Lanes s3 = zero;
      for (std::size_t k = 0; k < count; ++k) {
        Lanes x;
        load(points + k * width + 4 * chunk, x);
        s0 += x * f.value[0][k];
        s1 += x * f.value[1][k];
        s2 += x * f.value[2][k];
        s3 += x * f.value[3][k];
      }
      store(s0, &rows[0][4 * chunk]);
      store(s1, &rows[1][4 * chunk]);
      store(s2, &rows[2][4 * chunk]);
      store(s3, &rows[3][4 * chunk]);
    }
    if (curve.is_rational()) divide(rows, dimension);
    for (const Row& row : rows) out = std::copy_n(row.data(), dimension, out);
  }
}

LIMN_KERNEL void evaluate_any(const SplineData& curve, const BasisTable& table,
                              std::span<const double> us, double* out) noexcept {
  switch ((curve.width() + 3) / 4) {
    case 1:
      return evaluate_jets<1>(curve, table, us, out);
    case 2:
      return evaluate_jets<2>(curve, table, us, out);
    default:
      return evaluate_jets<3>(curve, table, us, out);
  }
}

LIMN_ON_EACH_PROCESSOR(jets_of,
                       (const SplineData& curve, const BasisTable& table,
                        std::span<const double> us, double* out),
                       (curve, table, us, out), evaluate_any(curve, table, us, out))

}  // namespace

PreparedCurve::PreparedCurve(SplineData curve)
    : curve_(std::move(curve)), table_(curve_.knots(0)) {}

void PreparedCurve::jets(std::span<const double> us, double* out) const noexcept {
  if (table_.usable()) return jets_of(curve_, table_, us, out);
  for (const double u : us) {
    evaluate(curve_, &u, &kOrder, out);
    out += kResults * static_cast<std::size_t>(curve_.dimension());
  }
}

}  // namespace limn::bspline_detail
