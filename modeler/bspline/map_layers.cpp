#include <cstddef>
#include <span>

#include "modeler/bspline/control_point_map.hpp"
#include "modeler/bspline/lanes.hpp"

namespace limn {
namespace bspline_detail {
namespace {

/// The sum of kTerms layers, with as many registers as it needs.
template <std::size_t kTerms>
LIMN_KERNEL void add_terms(const double* coefficients, const double* const* layers,
                           std::size_t count, double* out) noexcept {
  double a[kTerms];  // copies, which `out` cannot be part of
  const double* in[kTerms];
  for (std::size_t k = 0; k < kTerms; ++k) {
    a[k] = coefficients[k];
    in[k] = layers[k];
  }
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    Lanes x;
    load(in[0] + i, x);
    Lanes sum = a[0] * x;
    for (std::size_t k = 1; k < kTerms; ++k) {
      load(in[k] + i, x);
      sum += a[k] * x;
    }
    std::memcpy(out + i, &sum, sizeof sum);
  }
  for (; i < count; ++i) {
    double sum = a[0] * in[0][i];
    for (std::size_t k = 1; k < kTerms; ++k) sum += a[k] * in[k][i];
    out[i] = sum;
  }
}

LIMN_KERNEL void add_any(std::span<const double> a, const double* const* in, std::size_t count,
                         double* out) noexcept {
  switch (a.size()) {
    case 1:
      return add_terms<1>(a.data(), in, count, out);
    case 2:
      return add_terms<2>(a.data(), in, count, out);
    case 3:
      return add_terms<3>(a.data(), in, count, out);
    default:
      break;
  }
  add_terms<4>(a.data(), in, count, out);
  for (std::size_t k = 4; k < a.size(); ++k) {
    for (std::size_t i = 0; i < count; ++i) out[i] += a[k] * in[k][i];
  }
}

/// Layers of kLayer doubles, a point each, by vectors of four, of kBlocks blocks at once: what such
/// a vector reads and writes beyond its layer must be of the array, so the last ones are left to
/// the caller. Returns how many rows are done.
template <std::size_t kLayer, std::size_t kBlocks>
LIMN_KERNEL void map_points(const ControlPointMap& map, const double* const* in, double* out,
                            int& done) noexcept {
  const auto out_step = static_cast<std::size_t>(map.rows()) * kLayer;
  const double* blocks[kBlocks];
  for (std::size_t b = 0; b < kBlocks; ++b) blocks[b] = in[b];
  const int count = map.rows() - 1;
  int r = 0;
  for (; r < count; ++r, out += kLayer) {
    const ControlPointMap::Sum row = map.sum(r);
    if (row.first + row.size >= map.columns()) break;
    std::size_t from = static_cast<std::size_t>(row.first) * kLayer;
    Lanes sums[kBlocks];
    for (std::size_t b = 0; b < kBlocks; ++b) {
      Lanes x;
      load(blocks[b] + from, x);
      sums[b] = row.coefficients[0] * x;
    }
    for (int k = 1; k < row.size; ++k) {
      from += kLayer;
      const double a = row.coefficients[k];
      for (std::size_t b = 0; b < kBlocks; ++b) {
        Lanes x;
        load(blocks[b] + from, x);
        sums[b] += a * x;
      }
    }
    for (std::size_t b = 0; b < kBlocks; ++b) {
      const Lanes sum = sums[b];  // a copy: what has an address is not kept in a register
      std::memcpy(out + b * out_step, &sum, sizeof sum);
    }
  }
  done = r;
}

template <std::size_t kLayer>
LIMN_KERNEL void map_blocks(const ControlPointMap& map, std::span<const double* const> in,
                            double* out, int& done) noexcept {
  const auto step = static_cast<std::size_t>(map.rows()) * kLayer;
  std::size_t b = 0;
  for (; b + kBlocksTogether <= in.size(); b += kBlocksTogether) {
    map_points<kLayer, kBlocksTogether>(map, in.data() + b, out + b * step, done);
  }
  for (; b < in.size(); ++b) map_points<kLayer, 1>(map, in.data() + b, out + b * step, done);
}

LIMN_ON_EACH_PROCESSOR(add_layers_of,
                       (std::span<const double> a, const double* const* in, std::size_t count,
                        double* out),
                       (a, in, count, out), add_any(a, in, count, out))
LIMN_ON_EACH_PROCESSOR(map_triples,
                       (const ControlPointMap& map, std::span<const double* const> in, double* out,
                        int& done),
                       (map, in, out, done), map_blocks<3>(map, in, out, done))
LIMN_ON_EACH_PROCESSOR(map_quadruples,
                       (const ControlPointMap& map, std::span<const double* const> in, double* out,
                        int& done),
                       (map, in, out, done), map_blocks<4>(map, in, out, done))

}  // namespace
}  // namespace bspline_detail

void add_layers(std::span<const double> coefficients, const double* const* in, std::size_t count,
                double* out) noexcept {
  bspline_detail::add_layers_of(coefficients, in, count, out);
}

void map_layers(const ControlPointMap& map, std::size_t layer, std::span<const double* const> in,
                double* out) noexcept {
  int done = 0;
  if (layer == 3) bspline_detail::map_triples(map, in, out, done);
  if (layer == 4) bspline_detail::map_quadruples(map, in, out, done);
  for (const double* block : in) {
    out += static_cast<std::size_t>(done) * layer;
    for (int r = done; r < map.rows(); ++r, out += layer) {
      const ControlPointMap::Sum row = map.sum(r);
      const double* from = block + static_cast<std::size_t>(row.first) * layer;
      for (std::size_t i = 0; i < layer; ++i) out[i] = row.coefficients[0] * from[i];
      for (int k = 1; k < row.size; ++k) {
        from += layer;
        for (std::size_t i = 0; i < layer; ++i) out[i] += row.coefficients[k] * from[i];
      }
    }
  }
}

}  // namespace limn
