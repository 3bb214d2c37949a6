#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <optional>
#include <vector>

#include "modeler/view/raster/camera.hpp"

namespace limn {

/// A place of the raster is a whole number of these parts of a sample, so that what a triangle
/// covers is decided without rounding.
inline constexpr int kSubsampleBits = 8;
inline constexpr std::int32_t kSubsamples = 1 << kSubsampleBits;
/// Nothing on the raster is further than this from its top left corner, samples: cross products of
/// differences then fit 64 bits.
inline constexpr double kRasterReach = 1 << 20;

/// A corner on the raster.
struct RasterVertex {
  std::int32_t x = 0;         ///< 1 / kSubsamples of a sample, to the right
  std::int32_t y = 0;         ///< downwards
  float nearness = 0;         ///< 0 far to 1 near (Camera::to_raster)
  std::uint32_t outside = 0;  ///< of the sides of what can be drawn, a bit each; then the rest is 0
};

/// (x, y, n, w) of Camera::to_raster for a place of the model.
glm::dvec4 to_raster(const glm::dmat4& matrix, const Eigen::Vector3d& place) noexcept;

/// Precondition: finite.
RasterVertex snap(const glm::dvec4& place) noexcept;

/// The part of a triangle that can be drawn: a convex polygon, its corners in the triangle's order.
/// Neighbours that share an edge share the corners that are cut from it.
struct ClippedTriangle {
  static constexpr std::size_t kMostCorners = 3 + 5;  ///< each side adds one
  std::array<RasterVertex, kMostCorners> corners;
  std::size_t count = 0;  ///< 0 or 3 at least
};
ClippedTriangle clip_triangle(const std::array<glm::dvec4, 3>& corners) noexcept;

/// The part of a segment that can be drawn; none where there is none.
std::optional<std::array<glm::dvec4, 2>> clip_segment(
    const std::array<glm::dvec4, 2>& ends) noexcept;

}  // namespace limn
