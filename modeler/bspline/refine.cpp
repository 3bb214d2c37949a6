#include "modeler/bspline/refine.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "input/base/expect.hpp"

namespace limn {
namespace {

/// Coordinates as `blocks` of `count` layers of `layer` doubles: one direction between those before
/// and those after it.
struct Layers {
  std::size_t layer;
  std::size_t count;
  std::size_t blocks;
};

Layers layers_of(const SplineData& spline, int direction) {
  Layers out{};
  out.layer = spline.stride(direction) * static_cast<std::size_t>(spline.width());
  out.count = static_cast<std::size_t>(spline.knots(direction).basis_count());
  out.blocks = spline.coordinates().size() / (out.layer * out.count);
  return out;
}

Expected<SplineData> with_direction(const SplineData& spline, int direction, KnotVector knots,
                                    PagedArray coordinates) {
  std::vector<KnotVector> all(spline.knots().begin(), spline.knots().end());
  all[static_cast<std::size_t>(direction)] = std::move(knots);
  return SplineData::make(all, spline.dimension(), spline.form(), std::move(coordinates));
}

/// Which row of the map makes a layer: a periodic direction's last ones repeat its first, which the
/// map gives up to rounding only.
struct Rows {
  explicit Rows(const KnotRefinement& refinement)
      : count(static_cast<std::size_t>(refinement.map.rows())),
        round(count - static_cast<std::size_t>(
                          refinement.knots.is_periodic() ? refinement.knots.degree() : 0)) {}
  std::size_t of(std::size_t layer) const noexcept { return layer < round ? layer : layer % round; }

  std::size_t count;
  std::size_t round;
};

/// Layers of few doubles: a block of them at a time.
PagedArray refine_blocks(const PagedArray& from, const Layers& in,
                         const KnotRefinement& refinement) {
  const Rows rows(refinement);
  std::vector<double> old(in.count * in.layer);
  std::vector<double> block(rows.count * in.layer);
  std::size_t next = 0;  // block to make
  return PagedArray::generate(in.blocks * block.size(), [&](std::size_t at, std::span<double> out) {
    while (!out.empty()) {
      if (at == next * block.size()) {
        from.read(next++ * old.size(), old);
        map_layers(refinement.map, in.layer, old.data(), block.data());
        for (std::size_t i = rows.round * in.layer; i < block.size(); ++i) {
          block[i] = block[i - rows.round * in.layer];
        }
      }
      const std::size_t begin = at % block.size();
      const std::size_t count = std::min(block.size() - begin, out.size());
      std::copy_n(block.data() + begin, count, out.data());
      out = out.subspan(count);
      at += count;
    }
  });
}

/// Layers of many doubles: as much of one as a page has room for at a time.
PagedArray refine_layers(const PagedArray& from, const Layers& in,
                         const KnotRefinement& refinement) {
  const Rows rows(refinement);
  constexpr std::size_t kRoom = PagedArray::kPageSize + PagedArray::kPadding;
  const auto most = static_cast<std::size_t>(refinement.map.width());
  const auto scratch = std::make_unique_for_overwrite<double[]>(most * kRoom);
  std::vector<const double*> terms(most);
  return PagedArray::generate(in.blocks * rows.count * in.layer, [&](std::size_t at,
                                                                     std::span<double> out) {
    while (!out.empty()) {
      const std::size_t layer = at / in.layer;
      const std::size_t begin = at % in.layer;
      const std::size_t count = std::min(in.layer - begin, out.size());
      const auto sum = refinement.map.sum(static_cast<int>(rows.of(layer % rows.count)));
      const auto size = static_cast<std::size_t>(sum.size);
      const std::size_t first = layer / rows.count * in.count + static_cast<std::size_t>(sum.first);
      for (std::size_t k = 0; k < size; ++k) {
        terms[k] = from.run((first + k) * in.layer + begin, count, scratch.get() + k * kRoom);
      }
      add_layers({sum.coefficients, size}, terms.data(), count, out.data());
      out = out.subspan(count);
      at += count;
    }
  });
}

}  // namespace

Expected<SplineData> refine(const SplineData& spline, int direction,
                            const KnotRefinement& refinement) {
  LIMN_EXPECT(refinement.map.columns() == spline.knots(direction).basis_count());
  const Layers in = layers_of(spline, direction);
  constexpr std::size_t kFew = 16;
  return with_direction(spline, direction, refinement.knots,
                        in.layer < kFew ? refine_blocks(spline.coordinates(), in, refinement)
                                        : refine_layers(spline.coordinates(), in, refinement));
}

Expected<SplineData> insert_knots(const SplineData& spline, int direction,
                                  std::span<const double> added) {
  auto refinement = insert_knots(spline.knots(direction), added);
  if (!refinement) return tl::unexpected(std::move(refinement.error()));
  return refine(spline, direction, *refinement);
}

Expected<SplineData> elevate_degree(const SplineData& spline, int direction, int by) {
  auto refinement = elevate_degree(spline.knots(direction), by);
  if (!refinement) return tl::unexpected(std::move(refinement.error()));
  return refine(spline, direction, *refinement);
}

Expected<SplineData> segment(const SplineData& spline, int direction, double low, double high) {
  auto part = segment_knots(spline.knots(direction), low, high);
  if (!part) return tl::unexpected(std::move(part.error()));
  return refine(spline, direction, *part);
}

Expected<SplineData> reverse(const SplineData& spline, int direction) {
  auto turned = reverse_knots(spline.knots(direction));
  if (!turned) return tl::unexpected(std::move(turned.error()));
  return refine(spline, direction, *turned);
}

Expected<SplineData> to_bezier(const SplineData& spline, int direction) {
  return refine(spline, direction, bezier_knots(spline.knots(direction)));
}

Expected<SplineData> move_seam(const SplineData& spline, int direction, double u) {
  const KnotVector& knots = spline.knots(direction);
  LIMN_EXPECT(knots.is_periodic() && u >= knots.domain_begin() && u < knots.domain_end());
  const double asked[] = {u};
  const bool is_knot = knots.multiplicity(u) > 0;
  auto with_knot =
      insert_knots(spline, direction, is_knot ? std::span<const double>() : std::span(asked));
  if (!with_knot) return with_knot;
  const KnotVector& old = with_knot->knots(direction);
  const int shift = old.find_span(u) - old.degree();
  auto rotated = old.rotated(shift);
  if (!rotated) return tl::unexpected(std::move(rotated.error()));

  const Layers in = layers_of(*with_knot, direction);
  const std::size_t round = in.count - static_cast<std::size_t>(old.degree());
  const std::vector<double> from = with_knot->coordinates().to_vector();
  std::vector<double> to(from.size());
  for (std::size_t b = 0; b < in.blocks; ++b) {
    for (std::size_t layer = 0; layer < in.count; ++layer) {
      const std::size_t source = (layer + static_cast<std::size_t>(shift)) % round;
      std::copy_n(from.data() + (b * in.count + source) * in.layer, in.layer,
                  to.data() + (b * in.count + layer) * in.layer);
    }
  }
  return with_direction(*with_knot, direction, *std::move(rotated), PagedArray(to));
}

}  // namespace limn
