#include "modeler/bspline/refine.hpp"

#include <algorithm>
#include <cstddef>
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
                                    std::span<const double> coordinates) {
  std::vector<KnotVector> all(spline.knots().begin(), spline.knots().end());
  all[static_cast<std::size_t>(direction)] = std::move(knots);
  return SplineData::make(all, spline.dimension(), spline.form(), coordinates);
}

}  // namespace

Expected<SplineData> refine(const SplineData& spline, int direction,
                            const KnotRefinement& refinement) {
  const ControlPointMap& map = refinement.map;
  LIMN_EXPECT(map.columns() == spline.knots(direction).basis_count());
  const Layers in = layers_of(spline, direction);
  const auto rows = static_cast<std::size_t>(map.rows());
  const std::vector<double> from = spline.coordinates().to_vector();
  std::vector<double> to(in.blocks * rows * in.layer);
  for (std::size_t b = 0; b < in.blocks; ++b) {
    map_layers(map, in.layer, from.data() + b * in.count * in.layer,
               to.data() + b * rows * in.layer);
    if (refinement.knots.is_periodic()) {
      // The map gives the repeated layers only up to rounding.
      double* block = to.data() + b * rows * in.layer;
      const auto repeated = static_cast<std::size_t>(refinement.knots.degree()) * in.layer;
      double* last = block + rows * in.layer - repeated;
      const double* first = block;
      for (std::size_t i = 0; i < repeated; ++i) last[i] = first[i];
    }
  }
  return with_direction(spline, direction, refinement.knots, to);
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
  return with_direction(*with_knot, direction, *std::move(rotated), to);
}

}  // namespace limn
