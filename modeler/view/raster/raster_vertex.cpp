#include "modeler/view/raster/raster_vertex.hpp"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// Sides of what can be drawn: near, left, right, top, bottom. What is far is drawn, all of it
/// being nearer than Camera::far.
constexpr std::size_t kSides = 5;

/// From a side in homogeneous coordinates: not below 0 on the side that is drawn.
double inside(std::size_t side, const glm::dvec4& p) noexcept {
  switch (side) {
    case 0:
      return p.w - p.z;  // at most as near as 1; then w is above 0, too
    case 1:
      return p.x + kRasterReach * p.w;
    case 2:
      return kRasterReach * p.w - p.x;
    case 3:
      return p.y + kRasterReach * p.w;
    default:
      return kRasterReach * p.w - p.y;
  }
}

std::uint32_t sides_outside(const glm::dvec4& p) noexcept {
  std::uint32_t bits = 0;
  for (std::size_t side = 0; side < kSides; ++side) {
    bits |= static_cast<std::uint32_t>(inside(side, p) < 0) << side;
  }
  return bits;
}

/// Where the line from a place inside to one outside meets the side. From inside, so that both
/// triangles at an edge get the same bits.
glm::dvec4 cut(std::size_t side, const glm::dvec4& in, const glm::dvec4& out) noexcept {
  const double from = inside(side, in);
  const double t = from / (from - inside(side, out));
  return in + t * (out - in);
}

/// What is inside by all sides, but for the rounding of cut().
RasterVertex snap_inside(const glm::dvec4& p) noexcept {
  const double part = 1 / p.w;
  const auto fixed = [&](double x) {
    return static_cast<std::int32_t>(std::lrint(std::clamp(x * part, -kRasterReach, kRasterReach) *
                                                static_cast<double>(kSubsamples)));
  };
  return {fixed(p.x), fixed(p.y), static_cast<float>(std::clamp(p.z * part, 0.0, 1.0)), 0};
}

}  // namespace

glm::dvec4 to_raster(const glm::dmat4& matrix, const Eigen::Vector3d& place) noexcept {
  return matrix * glm::dvec4(place.x(), place.y(), place.z(), 1);
}

RasterVertex snap(const glm::dvec4& place) noexcept {
  const std::uint32_t outside = sides_outside(place);
  if (outside != 0) return {0, 0, 0, outside};
  return snap_inside(place);
}

ClippedTriangle clip_triangle(const std::array<glm::dvec4, 3>& corners) noexcept {
  std::array<glm::dvec4, ClippedTriangle::kMostCorners> polygon;
  std::copy(corners.begin(), corners.end(), polygon.begin());
  std::size_t count = corners.size();
  for (std::size_t side = 0; side < kSides && count > 0; ++side) {
    std::array<glm::dvec4, ClippedTriangle::kMostCorners> kept;
    std::size_t n = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec4& a = polygon[i];
      const glm::dvec4& b = polygon[i + 1 < count ? i + 1 : 0];
      const bool a_in = inside(side, a) >= 0;
      const bool b_in = inside(side, b) >= 0;
      if (a_in) kept[n++] = a;
      if (a_in != b_in) kept[n++] = a_in ? cut(side, a, b) : cut(side, b, a);
    }
    polygon = kept;
    count = n;
  }
  ClippedTriangle out;
  if (count < 3) return out;
  for (std::size_t i = 0; i < count; ++i) out.corners[i] = snap_inside(polygon[i]);
  out.count = count;
  return out;
}

std::optional<std::array<glm::dvec4, 2>> clip_segment(
    const std::array<glm::dvec4, 2>& ends) noexcept {
  auto [a, b] = ends;
  for (std::size_t side = 0; side < kSides; ++side) {
    const bool a_in = inside(side, a) >= 0;
    const bool b_in = inside(side, b) >= 0;
    if (!a_in && !b_in) return std::nullopt;
    if (!a_in) a = cut(side, b, a);
    if (!b_in) b = cut(side, a, b);
  }
  return std::array<glm::dvec4, 2>{a, b};
}

}  // namespace limn
