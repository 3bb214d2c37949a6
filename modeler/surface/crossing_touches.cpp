#include "modeler/surface/crossing_touches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>

namespace limn {
namespace {

using Eigen::Vector3d;

/// Whether two places belong to one touch. Reaches are those of parts, which share no more than an
/// edge: their middles may be off by as much again.
bool belong_together(const MeetingPlace& a, const MeetingPlace& b) {
  return (a.point - b.point).norm() <= 2 * (a.reach + b.reach) + kNearCrossing;
}

using GridCell = std::array<std::int64_t, 3>;

GridCell cell_of(const Vector3d& p, double width) {
  constexpr double kMost = 1e15;  // and one more is an int64 still
  GridCell out{};
  for (std::size_t d = 0; d < 3; ++d) {
    const double x = std::floor(p[static_cast<Eigen::Index>(d)] / width);
    out[d] = static_cast<std::int64_t>(std::clamp(x, -kMost, kMost));
  }
  return out;
}

/// One of those in the same place, with the largest reach of them: neighbours often find the same.
std::vector<MeetingPlace> without_repeats(const std::vector<MeetingPlace>& places) {
  std::vector<MeetingPlace> out;
  std::map<GridCell, std::size_t> known;
  for (const MeetingPlace& p : places) {
    const auto [at, is_new] = known.try_emplace(cell_of(p.point, kNearCrossing), out.size());
    if (is_new) {
      out.push_back(p);
    } else {
      out[at->second].reach = std::max(out[at->second].reach, p.reach);
    }
  }
  return out;
}

/// For each place, the first of those that are joined with it, directly or through others.
std::vector<std::size_t> joined(const std::vector<MeetingPlace>& places) {
  std::vector<std::size_t> parent(places.size());  // of a forest; parents come first
  const auto root = [&parent](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  // Neighbours are found by cells that are as wide as any two that belong together may be apart.
  double width = kNearCrossing;
  for (const MeetingPlace& p : places) width = std::max(width, 4 * p.reach + kNearCrossing);
  std::map<GridCell, std::vector<std::size_t>> grid;
  for (std::size_t i = 0; i < places.size(); ++i) {
    parent[i] = i;
    const GridCell at = cell_of(places[i].point, width);
    for (int k = 0; k < 27; ++k) {
      const auto found = grid.find({at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1});
      if (found == grid.end()) continue;
      for (const std::size_t j : found->second) {
        const std::size_t a = root(i);
        const std::size_t b = root(j);
        if (a == b || !belong_together(places[i], places[j])) continue;
        parent[std::max(a, b)] = std::min(a, b);
      }
    }
    grid[at].push_back(i);
  }
  for (std::size_t i = 0; i < places.size(); ++i) parent[i] = root(i);
  return parent;
}

}  // namespace

std::vector<SurfaceTouch> touches_of(const std::vector<MeetingPlace>& found) {
  const std::vector<MeetingPlace> places = without_repeats(found);
  struct Cluster {
    const MeetingPlace* one = nullptr;  ///< whose reach is least: the place that is best known
    Vector3d low;
    Vector3d high;
    double reach = 0;
  };
  std::map<std::size_t, Cluster> clusters;  // by their first places
  const std::vector<std::size_t> first = joined(places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const MeetingPlace& next = places[i];
    Cluster& c = clusters[first[i]];
    if (c.one == nullptr) c.low = c.high = next.point;
    if (c.one == nullptr || next.reach < c.one->reach) c.one = &next;
    c.low = c.low.cwiseMin(next.point);
    c.high = c.high.cwiseMax(next.point);
    c.reach = std::max(c.reach, next.reach);
  }
  std::vector<SurfaceTouch> out;
  for (const auto& [number, c] : clusters) {
    const double extent = (c.high - c.low).norm() + 2 * c.reach;
    const bool isolated = c.reach == 0 && extent <= kNearCrossing;
    out.push_back(
        {c.one->point, c.one->place.head<2>(), c.one->place.tail<2>(), isolated ? 0.0 : extent});
  }
  return out;
}

}  // namespace limn
