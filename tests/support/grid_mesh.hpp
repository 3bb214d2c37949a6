#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "modeler/base/tolerance.hpp"
#include "modeler/bspline/jet.hpp"
#include "modeler/bspline/surface_evaluator.hpp"
#include "modeler/mesh/mesh.hpp"

namespace limn::test {

/// `count` values from one end of the domain to the other.
inline std::vector<double> steps(const KnotVector& knots, int count) {
  std::vector<double> out;
  out.reserve(static_cast<std::size_t>(count));
  const double begin = knots.domain_begin();
  const double length = knots.domain_end() - begin;
  for (int i = 0; i < count; ++i) out.push_back(begin + length * i / (count - 1));
  return out;
}

/// A face of columns x rows vertices at equal steps of the parameters. Vertices that lie in one
/// place share their point: those of a seam or a pole, so that closed surfaces have closed meshes.
inline Mesh grid_mesh(const BsplineSurface& surface, int columns, int rows) {
  const auto us = steps(surface.knots(0), columns);
  const auto vs = steps(surface.knots(1), rows);
  std::vector<SurfaceFrame> frames(us.size() * vs.size());
  SurfaceEvaluator(surface).grid(us, vs, frames);
  const auto at = [&](int i, int j) { return static_cast<std::size_t>(i + columns * j); };
  const auto coincide = [&](std::size_t a, std::size_t b) {
    return (frames[a].point - frames[b].point).norm() <= 1e3 * kGeometric;  // rounding, of 100 mm
  };
  Mesh mesh;
  std::vector<std::uint32_t> points(frames.size());
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      std::size_t same = at(i, j);
      if (i > 0 && coincide(at(i - 1, j), same)) same = at(i - 1, j);
      if (i == columns - 1 && coincide(at(0, j), same)) same = at(0, j);
      if (j == rows - 1 && coincide(at(i, 0), same)) same = at(i, 0);
      if (same == at(i, j)) {
        points[same] = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(frames[same].point);
      }
      points[at(i, j)] = points[same];
      mesh.vertices.push_back({points[same],
                               frames[at(i, j)].normal,
                               {us[static_cast<std::size_t>(i)], vs[static_cast<std::size_t>(j)]}});
    }
  }
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    if (points[a] == points[b] || points[b] == points[c] || points[c] == points[a]) return;
    mesh.triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                              static_cast<std::uint32_t>(c)});
  };
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  mesh.faces.push_back({0, static_cast<std::uint32_t>(mesh.triangles.size())});
  return mesh;
}

/// A curvature (such as &SurfaceCurvature::mean) at each vertex of a grid_mesh() of the surface; 0
/// where it has none.
inline std::vector<double> field_of(const BsplineSurface& surface, const Mesh& mesh,
                                    double SurfaceCurvature::*which) {
  const SurfaceEvaluator evaluator(surface);
  std::vector<double> out;
  for (const MeshVertex& vertex : mesh.vertices) {
    const auto found = curvature(evaluator.jet(vertex.parameter.x(), vertex.parameter.y()));
    out.push_back(found ? (*found).*which : 0);
  }
  return out;
}

}  // namespace limn::test
