#include "modeler/view/raster/mesh_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "input/base/expect.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<std::uint32_t, 3>;

std::span<const Triangle> triangles_of(const Mesh& mesh, const MeshFace& face) {
  return std::span(mesh.triangles).subspan(face.first, face.count);
}

/// Where a parameter (0: u, 1: v) is `level` in the triangle. A corner at the level counts as above
/// it, so that a line along edges is drawn once.
void add_crossing(const Mesh& mesh, const Triangle& triangle, int parameter, double level,
                  Polylines& out) {
  std::vector<Vector3d> ends;
  for (std::size_t k = 0; k < 3; ++k) {
    const MeshVertex& a = mesh.vertices[triangle[k]];
    const MeshVertex& b = mesh.vertices[triangle[(k + 1) % 3]];
    const double at_a = a.parameter[parameter];
    const double at_b = b.parameter[parameter];
    if ((at_a >= level) == (at_b >= level)) continue;
    const double t = (level - at_a) / (at_b - at_a);
    ends.push_back(mesh.points[a.point] + t * (mesh.points[b.point] - mesh.points[a.point]));
  }
  if (ends.size() == 2) out.push_back(std::move(ends));
}

void add_isolines(const Mesh& mesh, const MeshFace& face, int parameter, int count,
                  Polylines& out) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Triangle& triangle : triangles_of(mesh, face)) {
    for (const std::uint32_t v : triangle) {
      low = std::min(low, mesh.vertices[v].parameter[parameter]);
      high = std::max(high, mesh.vertices[v].parameter[parameter]);
    }
  }
  const double step = (high - low) / (count + 1);
  if (!(step > 0)) return;
  for (const Triangle& triangle : triangles_of(mesh, face)) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const std::uint32_t v : triangle) {
      least = std::min(least, mesh.vertices[v].parameter[parameter]);
      most = std::max(most, mesh.vertices[v].parameter[parameter]);
    }
    const int first = std::max(static_cast<int>(std::floor((least - low) / step)), 1);
    for (int i = first; i <= count && low + i * step <= most; ++i) {
      add_crossing(mesh, triangle, parameter, low + i * step, out);
    }
  }
}

}  // namespace

Polylines isolines(const Mesh& mesh, int count) {
  LIMN_EXPECT(count >= 0);
  Polylines out;
  for (const int parameter : {0, 1}) {
    for (const MeshFace& face : mesh.faces) add_isolines(mesh, face, parameter, count, out);
  }
  return out;
}

Polylines face_borders(const Mesh& mesh) {
  using Edge = std::array<std::uint32_t, 2>;  // points, the lower first
  std::vector<Edge> borders;
  std::vector<Edge> edges;
  for (const MeshFace& face : mesh.faces) {
    edges.clear();
    for (const Triangle& triangle : triangles_of(mesh, face)) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = mesh.vertices[triangle[k]].point;
        const std::uint32_t b = mesh.vertices[triangle[(k + 1) % 3]].point;
        if (a != b) edges.push_back({std::min(a, b), std::max(a, b)});
      }
    }
    std::sort(edges.begin(), edges.end());
    for (auto edge = edges.begin(); edge != edges.end();) {
      const auto next = std::upper_bound(edge, edges.end(), *edge);
      if (next - edge == 1) borders.push_back(*edge);
      edge = next;
    }
  }
  std::sort(borders.begin(), borders.end());
  borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
  Polylines out;
  for (const auto& [a, b] : borders) out.push_back({mesh.points[a], mesh.points[b]});
  return out;
}

Polylines control_net(const BsplineSurface& surface) {
  const auto points = surface.control_points();
  const auto columns = static_cast<std::size_t>(surface.knots(0).basis_count());
  const std::size_t rows = points.size() / columns;
  Polylines out;
  for (std::size_t j = 0; j < rows; ++j) {
    auto& line = out.emplace_back();
    for (std::size_t i = 0; i < columns; ++i) line.push_back(points[i + j * columns]);
  }
  for (std::size_t i = 0; i < columns; ++i) {
    auto& line = out.emplace_back();
    for (std::size_t j = 0; j < rows; ++j) line.push_back(points[i + j * columns]);
  }
  return out;
}

std::vector<Vector3d> control_points(const BsplineSurface& surface) {
  const auto points = surface.control_points();
  return {points.begin(), points.end()};
}

}  // namespace limn
