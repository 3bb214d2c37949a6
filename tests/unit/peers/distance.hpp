#pragma once

#include <algorithm>
#include <cmath>

#include "tests/peers/peer_surface.hpp"

namespace limn::peers {

inline double dot(const PeerPoint& a, const PeerPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline double norm(const PeerPoint& a) { return std::sqrt(dot(a, a)); }

inline double distance(const PeerPoint& a, const PeerPoint& b) {
  return norm({a[0] - b[0], a[1] - b[1], a[2] - b[2]});
}

inline PeerPoint cross(const PeerPoint& a, const PeerPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline PeerPoint unit(const PeerPoint& a) {
  const double length = norm(a);
  return {a[0] / length, a[1] / length, a[2] / length};
}

inline PeerPoint along(const PeerRay& ray, double t) {
  return {ray.origin[0] + t * ray.direction[0], ray.origin[1] + t * ray.direction[1],
          ray.origin[2] + t * ray.direction[2]};
}

/// Three numbers from `first` on.
inline PeerPoint triple(const std::vector<double>& values, std::size_t first) {
  return {values[first], values[first + 1], values[first + 2]};
}

/// Of the control points.
inline double box_diagonal(const PeerSurface& surface) {
  PeerPoint low = triple(surface.points, 0);
  PeerPoint high = low;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], surface.points[i]);
    high[i % 3] = std::max(high[i % 3], surface.points[i]);
  }
  return distance(low, high);
}

}  // namespace limn::peers
