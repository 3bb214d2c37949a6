#include "modeler/surface/surface_index.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace limn {
namespace {

using Eigen::Vector3d;

/// Leaves bend less, unless they were halved as often as is worth it: near a pole nothing helps.
constexpr double kMostBending = 0.35;
constexpr double kMostChange = 0.3;
constexpr int kMostHalvings = 8;

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
  boxes_.reserve(leaves_.size());
  for (const PatchBound& leaf : leaves_) {
    boxes_.push_back({leaf.jet.point, leaf.frame.transpose(), leaf.frame_low, leaf.frame_high});
  }
  if (leaves_.size() < 2) return;
  std::vector<std::int32_t> order(leaves_.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(leaves_.size());
  add_nodes(order, 0, order.size());
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

std::int32_t SurfaceIndex::add_nodes(std::vector<std::int32_t>& order, std::size_t begin,
                                     std::size_t end) {
  if (end - begin == 1) return ~order[begin];
  const auto middle_of = [this](std::int32_t i) {
    const PatchBound& bound = leaves_[static_cast<std::size_t>(i)];
    const Vector3d middle = bound.low + bound.high;  // twice; an overflow may sort anywhere
    return middle.allFinite() ? middle : Vector3d(Vector3d::Zero());
  };
  Vector3d low = middle_of(order[begin]);
  Vector3d high = low;
  for (std::size_t i = begin; i < end; ++i) {
    low = low.cwiseMin(middle_of(order[i]));
    high = high.cwiseMax(middle_of(order[i]));
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&order](std::size_t i) {
    return order.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(at(begin), at(middle), at(end), [&](std::int32_t a, std::int32_t b) {
    const double x = middle_of(a)[axis];
    const double y = middle_of(b)[axis];
    return x < y || (x == y && a < b);  // a total order, so that every run gives the same tree
  });
  const auto number = nodes_.size();
  nodes_.emplace_back();
  const std::array<std::size_t, 3> edge = {begin, middle, end};
  for (std::size_t side = 0; side < 2; ++side) {
    const std::int32_t child = add_nodes(order, edge[side], edge[side + 1]);
    Node& node = nodes_[number];
    node.child[side] = child;
    if (child < 0) {
      const PatchBound& bound = leaves_[static_cast<std::size_t>(~child)];
      node.low[side] = bound.low;
      node.high[side] = bound.high;
    } else {
      const Node& below = nodes_[static_cast<std::size_t>(child)];
      node.low[side] = below.low[0].cwiseMin(below.low[1]);
      node.high[side] = below.high[0].cwiseMax(below.high[1]);
    }
  }
  return static_cast<std::int32_t>(number);
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
