#include "modeler/view/raster/scene_on_raster.hpp"

#include <algorithm>
#include <limits>

#include "input/base/expect.hpp"

namespace limn {
namespace {

/// Lines on surfaces are drawn as if they were nearer by this many times a pixel's length: half
/// their width on slopes, and the triangles' deviation. Points lie before lines.
constexpr double kLinesLifted = 3;
constexpr double kPointsLifted = 5;
/// Nearer than anything: surfaces are at most 1 near.
constexpr double kInFront = 1;

}  // namespace

SceneOnRaster::SceneOnRaster(const Scene& scene, const Camera& camera, int width, int height,
                             int samples_per_pixel)
    : matrix_(camera.to_raster(width, height)), is_perspective_(camera.is_perspective) {
  // Parallel: n = (far - d) / (far - near). In perspective n = near / d, and d, less a length that
  // is a fixed part of d, is a factor.
  sample_lift_ = is_perspective_ ? camera.sample_size(1, height)
                                 : camera.sample_size(1, height) / (camera.far - camera.near);
  std::uint32_t id = 0;
  for (const SceneSurface& shown : scene.surfaces) {
    Surface surface;
    surface.mesh = &shown.mesh;
    surface.first_id = id;
    id += static_cast<std::uint32_t>(shown.mesh.triangles.size());
    surface.vertices.reserve(shown.mesh.vertices.size());
    for (const MeshVertex& vertex : shown.mesh.vertices) {
      surface.vertices.push_back(snap(to_raster(matrix_, shown.mesh.points[vertex.point])));
    }
    surfaces_.push_back(std::move(surface));
  }
  const double samples = samples_per_pixel;
  first_lines_ = id;
  for (const SceneLines& lines : scene.lines) {
    const Pen pen{0.5 * samples * lines.width, samples * kLinesLifted, lines.in_front, id++};
    for (const auto& line : lines.lines) {
      if (line.size() == 1) {
        const glm::dvec4 dot = to_raster(matrix_, line[0]);
        add_segment(dot, dot, pen);
      }
      for (std::size_t i = 1; i < line.size(); ++i) {
        add_segment(to_raster(matrix_, line[i - 1]), to_raster(matrix_, line[i]), pen);
      }
    }
  }
  first_points_ = id;
  for (const ScenePoints& points : scene.points) {
    const Pen pen{0.5 * samples * points.width, samples * kPointsLifted, points.in_front, id++};
    for (const Eigen::Vector3d& point : points.points) {
      const glm::dvec4 place = to_raster(matrix_, point);
      add_segment(place, place, pen);
    }
  }
  LIMN_EXPECT(id < RasterBand::kNothing);
}

void SceneOnRaster::add_segment(const glm::dvec4& from, const glm::dvec4& to, const Pen& pen) {
  const auto ends = clip_segment({from, to});
  if (!ends) return;
  LineOnRaster line;
  line.ends = *ends;
  line.radius = pen.radius;
  const double lift = pen.lift_samples * sample_lift_;
  if (is_perspective_) {
    line.lift_factor = 1 + lift;
  } else {
    line.lift = lift;
  }
  if (pen.in_front) line.lift += kInFront;
  segments_.push_back({line, pen.id});
}

void SceneOnRaster::index_rows() {
  for (Surface& surface : surfaces_) {
    const auto& triangles = surface.mesh->triangles;
    surface.blocks.clear();
    for (std::size_t first = 0; first < triangles.size(); first += kBlock) {
      std::int32_t low = std::numeric_limits<std::int32_t>::max();
      std::int32_t high = std::numeric_limits<std::int32_t>::min();
      std::uint32_t outside = 0;
      const std::size_t end = std::min(first + kBlock, triangles.size());
      for (std::size_t t = first; t < end; ++t) {
        for (const std::uint32_t v : triangles[t]) {
          const RasterVertex& vertex = surface.vertices[v];
          low = std::min(low, vertex.y);
          high = std::max(high, vertex.y);
          outside |= vertex.outside;
        }
      }
      // What is clipped may be anywhere.
      surface.blocks.push_back(outside != 0 ? Rows{0, std::numeric_limits<std::int32_t>::max()}
                                            : Rows{low >> kSubsampleBits, high >> kSubsampleBits});
    }
  }
}

std::array<glm::dvec4, 3> SceneOnRaster::corners_of(const Mesh& mesh,
                                                    std::uint32_t triangle) const noexcept {
  std::array<glm::dvec4, 3> out;
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k] = to_raster(matrix_, mesh.points[mesh.vertices[mesh.triangles[triangle][k]].point]);
  }
  return out;
}

void SceneOnRaster::draw_clipped(const Surface& surface, std::uint32_t triangle,
                                 RasterBand& band) const {
  const ClippedTriangle clipped = clip_triangle(corners_of(*surface.mesh, triangle));
  for (std::size_t k = 2; k < clipped.count; ++k) {
    band.draw_triangle(clipped.corners[0], clipped.corners[k - 1], clipped.corners[k],
                       surface.first_id + triangle);
  }
}

void SceneOnRaster::draw_surfaces(RasterBand& band) const {
  for (const Surface& surface : surfaces_) {
    const auto& triangles = surface.mesh->triangles;
    const RasterVertex* const vertices = surface.vertices.data();
    for (std::size_t first = 0; first < triangles.size(); first += kBlock) {
      if (!surface.blocks.empty()) {
        const Rows& rows = surface.blocks[first / kBlock];
        if (rows.bottom < band.first_row() || rows.top >= band.end_row()) continue;
      }
      const std::size_t end = std::min(first + kBlock, triangles.size());
      for (std::size_t t = first; t < end; ++t) {
        const RasterVertex& a = vertices[triangles[t][0]];
        const RasterVertex& b = vertices[triangles[t][1]];
        const RasterVertex& c = vertices[triangles[t][2]];
        const auto number = static_cast<std::uint32_t>(t);
        if ((a.outside | b.outside | c.outside) == 0) {
          band.draw_triangle(a, b, c, surface.first_id + number);
        } else if ((a.outside & b.outside & c.outside) == 0) {
          draw_clipped(surface, number, band);
        }
      }
    }
  }
}

void SceneOnRaster::draw_lines(RasterBand& band) const {
  for (const Segment& segment : segments_) band.draw_line(segment.line, segment.id);
}

ScenePart SceneOnRaster::part_of(std::uint32_t id) const noexcept {
  if (id >= first_points_) return {ScenePart::Kind::kPoints, id - first_points_, id, id + 1};
  if (id >= first_lines_) return {ScenePart::Kind::kLines, id - first_lines_, id, id + 1};
  const auto behind = std::upper_bound(
      surfaces_.begin(), surfaces_.end(), id,
      [](std::uint32_t i, const Surface& surface) { return i < surface.first_id; });
  const auto index = static_cast<std::size_t>(behind - surfaces_.begin()) - 1;
  const std::uint32_t first = surfaces_[index].first_id;
  const std::size_t count = surfaces_[index].mesh->triangles.size();
  return {ScenePart::Kind::kSurface, index, first, first + static_cast<std::uint32_t>(count)};
}

TrianglePlace SceneOnRaster::place_in(std::size_t surface, std::uint32_t triangle, int x,
                                      int y) const noexcept {
  const Surface& shown = surfaces_[surface];
  const auto& corners = shown.mesh->triangles[triangle];
  const RasterVertex& a = shown.vertices[corners[0]];
  const RasterVertex& b = shown.vertices[corners[1]];
  const RasterVertex& c = shown.vertices[corners[2]];
  std::array<double, 3> w;
  if ((a.outside | b.outside | c.outside) == 0) {
    const std::int64_t px = std::int64_t{x} * kSubsamples + kSubsamples / 2;
    const std::int64_t py = std::int64_t{y} * kSubsamples + kSubsamples / 2;
    const auto area = [px, py](const RasterVertex& p, const RasterVertex& q) {
      return static_cast<double>((std::int64_t{q.x} - p.x) * (py - p.y) -
                                 (std::int64_t{q.y} - p.y) * (px - p.x));
    };
    w = {area(b, c), area(c, a), area(a, b)};
    if (is_perspective_) {  // nearness is 1 / w of the corner, but for a factor
      w[0] *= static_cast<double>(a.nearness);
      w[1] *= static_cast<double>(b.nearness);
      w[2] *= static_cast<double>(c.nearness);
    }
  } else {
    // Seen from the sample's centre, in homogeneous coordinates: [OG97].
    auto q = corners_of(*shown.mesh, triangle);
    for (glm::dvec4& p : q) {
      p.x -= (x + 0.5) * p.w;
      p.y -= (y + 0.5) * p.w;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec4& from = q[(k + 1) % 3];
      const glm::dvec4& to = q[(k + 2) % 3];
      w[k] = from.x * to.y - from.y * to.x;
    }
  }
  // Counter-clockwise in the model is clockwise where y points down: the area is below 0.
  const double sum = w[0] + w[1] + w[2];
  const double part = 1 / sum;
  TrianglePlace place;
  place.is_front = sum < 0;
  for (std::size_t k = 0; k < 3; ++k) {
    place.weights[k] = w[k] * part > 0 ? w[k] * part : 0;  // 0 for a NaN
  }
  return place;
}

}  // namespace limn
