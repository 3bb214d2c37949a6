#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

/// Where faces end: a curve in space that one face has (a border), two faces, or one face twice (a
/// seam).
struct Edge {
  /// A pole's edge is a dot: degree 0, one control point.
  BsplineCurve<3> curve;
  std::array<std::size_t, 2> vertices = {0, 0};  ///< at the curve's ends; equal where it is closed
  /// How far the trims' curves on their surfaces are from `curve`, at most, mm.
  double deviation = 0;
};

/// A use of an edge by a face.
///
/// `curve` runs in (u, v) as the edge's does in space: at each parameter t that is the same part of
/// both domains, |surface(curve(t)) - edge.curve(t)| <= edge.deviation. At a pole, whose edge is a
/// dot, it is any curve of degree 1 or more.
struct Trim {
  std::size_t edge = 0;   ///< of Body::edges
  bool reversed = false;  ///< the loop runs against the edge and against `curve`
  BsplineCurve<2> curve;
};

/// Trims one after another, the last meeting the first, with the face to their left in (u, v): the
/// outer loop turns counter-clockwise, holes clockwise.
using Loop = std::vector<Trim>;

/// A part of a surface.
struct Face {
  BsplineSurface surface;
  std::vector<Loop> loops;  ///< the outer one first
  bool reversed = false;    ///< the outside is against S_u x S_v
};

/// Faces that meet in edges. It is closed (has an inside) where each edge but poles is used twice.
struct Body {
  std::string name;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Edge> edges;
  std::vector<Face> faces;
};

}  // namespace limn
