#pragma once

#include <Eigen/Core>
#include <vector>

#include "modeler/bspline/tensor_spline.hpp"
#include "modeler/mesh/mesh.hpp"

namespace limn {

// Lines that pictures show with a model.

using Polylines = std::vector<std::vector<Eigen::Vector3d>>;

/// `count` isoparametric lines of each face in each direction, u first, at equal steps between the
/// ends of its parameters, as segments of two points: where the parameter has that value in the
/// triangles. So they lie on the mesh and end where a trimmed face does. O(triangles count).
/// Precondition: count not below 0.
Polylines isolines(const Mesh& mesh, int count);

/// The edges that end a face: those of one of its triangles alone, by Mesh::points, as segments of
/// two points, each once where two faces meet. A seam is none.
Polylines face_borders(const Mesh& mesh);

/// Rows and columns of control points, without their weights: u lines first.
Polylines control_net(const BsplineSurface& surface);

/// The control points themselves.
std::vector<Eigen::Vector3d> control_points(const BsplineSurface& surface);

}  // namespace limn
