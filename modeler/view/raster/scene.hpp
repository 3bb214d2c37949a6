#pragma once

#include <Eigen/Core>
#include <vector>

#include "modeler/mesh/mesh.hpp"
#include "modeler/view/canvas.hpp"

namespace limn {

/// Triangles, and what they look like.
struct SceneSurface {
  Mesh mesh;
  Color front = {126, 160, 199};
  Color back = {208, 166, 98};  ///< of the side that Mesh calls inside
  /// A number a vertex of the mesh, such as a curvature in 1/mm, for Shading::kCurvature; empty
  /// where there is none.
  std::vector<double> field;
};

/// Polylines: isoparametric lines, edges, control nets.
struct SceneLines {
  std::vector<std::vector<Eigen::Vector3d>> lines;  ///< a line of one point is a dot
  Color color = {38, 50, 66};
  double width = 1.2;     ///< pixels
  bool in_front = false;  ///< of all surfaces, as control nets are shown
};

/// Points as discs.
struct ScenePoints {
  std::vector<Eigen::Vector3d> points;
  Color color = {190, 40, 40};
  double width = 6;  ///< pixels
  bool in_front = false;
};

/// What a picture of a model shows; mm. A value like any other.
struct Scene {
  std::vector<SceneSurface> surfaces;
  std::vector<SceneLines> lines;
  std::vector<ScenePoints> points;
};

}  // namespace limn
