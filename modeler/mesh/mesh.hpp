#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace limn {

/// A corner of triangles of one face. Faces that meet share points, not vertices, since each has
/// normals and parameters of its own there; so has a face on both sides of its seam.
struct MeshVertex {
  std::uint32_t point = 0;    ///< of Mesh::points
  Eigen::Vector3d normal;     ///< unit, to the outside of the body; zero where there is none
  Eigen::Vector2d parameter;  ///< (u, v) of the face's surface
};

/// The triangles of one face: [first, first + count) of Mesh::triangles.
struct MeshFace {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// Triangles in space, mm, counter-clockwise seen from outside.
///
///     point    a place, once for all faces that meet there: the mesh is watertight where each
///              edge between two points has one triangle on either side
///     vertex   a point with the normal and the parameters of one face
struct Mesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<MeshVertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of vertices
  std::vector<MeshFace> faces;                          ///< in order, all triangles are of one
};

}  // namespace limn
