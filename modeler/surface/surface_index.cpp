#include "modeler/surface/surface_index.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace limn {
namespace {

/// Leaves bend less, unless they were halved as often as is worth it: near a pole nothing helps.
constexpr double kMostBending = 0.35;
constexpr double kMostChange = 0.6;
constexpr int kMostHalvings = 8;

/// Item i becomes what item order[i] was.
void put_in_order(std::vector<std::int32_t>& order, std::vector<PatchBound>& items) {
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (order[i] < 0) continue;
    PatchBound first = std::move(items[i]);
    std::size_t to = i;
    for (;;) {  // round the cycle that i is in
      const auto from = static_cast<std::size_t>(std::exchange(order[to], -1));
      if (from == i) break;
      items[to] = std::move(items[from]);
      to = from;
    }
    items[to] = std::move(first);
  }
}

template <class T>
void prefetch_all(const T& object) noexcept {
  constexpr std::size_t kLine = 64;
  const char* first = reinterpret_cast<const char*>(&object);
  for (std::size_t i = 0; i < sizeof object; i += kLine) __builtin_prefetch(first + i);
  __builtin_prefetch(first + sizeof object - 1);
}

}  // namespace

int wider_direction(const PatchBound& bound) noexcept {
  // How much the tangents turn along each direction, each against its own length: with S_uv one
  // tangent turns where the other parameter moves.
  const Eigen::Vector2d half = bound.box.half();
  const double least = 1e-12 * bound.reach;  // where a tangent vanishes
  const double per_u = 1 / std::max(bound.jet.du.norm(), least / half.x());
  const double per_v = 1 / std::max(bound.jet.dv.norm(), least / half.y());
  const double uu = bound.jet.duu.norm() + bound.along.duu + bound.off.duu;
  const double uv = bound.jet.duv.norm() + bound.along.duv + bound.off.duv;
  const double vv = bound.jet.dvv.norm() + bound.along.dvv + bound.off.dvv;
  return half.x() * (uu * per_u + uv * per_v) >= half.y() * (vv * per_v + uv * per_u) ? 0 : 1;
}

SurfaceIndex::SurfaceIndex(BsplineSurface surface)
    : evaluator_(std::move(surface)), grid_(evaluator_.surface()) {
  for (const int v : grid_.spans(1)) {
    for (const int u : grid_.spans(0)) add_leaves(grid_.patch({u, v}), 0);
  }
  const auto box_of = [](const PatchBound& leaf) -> OrientedBox {
    return {leaf.jet.point, leaf.frame.transpose(), leaf.frame_low, leaf.frame_high};
  };
  boxes_.resize(leaves_.size());
  std::transform(leaves_.begin(), leaves_.end(), boxes_.begin(), box_of);
  std::vector<std::int32_t> order;
  nodes_ = make_box_tree(boxes_, order);
  put_in_order(order, leaves_);
  std::transform(leaves_.begin(), leaves_.end(), boxes_.begin(), box_of);
}

void SurfaceIndex::add_leaves(Patch patch, int halvings) {
  int direction = halvings % 2;
  // Positive weights come with halving, because the denominator is positive.
  if (patch.has_positive_weights()) {
    PatchBound leaf = bound(patch);
    // Points as far away as it is wide see it convex, if second derivatives stay near the middle's.
    const bool steady = 2 * leaf.reach * leaf.second_reach_off <=
                        kMostChange * leaf.least_stretch * leaf.least_stretch;
    direction = wider_direction(leaf);
    if ((leaf.bending() <= kMostBending && steady) || halvings >= kMostHalvings ||
        !patch.can_halve(direction)) {
      leaves_.push_back(std::move(leaf));
      return;
    }
  }
  Patch after = patch.halve(direction);
  add_leaves(std::move(patch), halvings + 1);
  add_leaves(std::move(after), halvings + 1);
}

void SurfaceIndex::prefetch(std::int32_t child) const noexcept {
  if (child >= 0) return prefetch_all(nodes_[static_cast<std::size_t>(child)]);
  const auto leaf = static_cast<std::size_t>(~child);
  prefetch_all(boxes_[leaf]);
  prefetch_all(leaves_[leaf]);
}

Patch SurfaceIndex::patch(const PatchBound& leaf) const {
  Patch patch = grid_.patch(leaf.spans);
  for (int d = 0; d < 2; ++d) {
    const auto cut_at = [&](double u) {
      const double t = (u - patch.box.low[d]) / (patch.box.high[d] - patch.box.low[d]);
      Patch after{patch.box, patch.spans, patch.shape, std::vector<double>(patch.net.size())};
      cut_bezier(patch.shape, d, t, patch.net, after.net);
      patch.box.high[d] = after.box.low[d] = u;
      return after;
    };
    if (leaf.box.high[d] < patch.box.high[d]) cut_at(leaf.box.high[d]);
    if (leaf.box.low[d] > patch.box.low[d]) patch = cut_at(leaf.box.low[d]);
  }
  return patch;
}

}  // namespace limn
