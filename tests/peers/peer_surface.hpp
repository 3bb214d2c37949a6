#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace limn::peers {

// What goes into and comes out of the libraries that limn is compared with: plain data, which knows
// neither their types nor limn's.

using PeerPoint = std::array<double, 3>;

/// Clamped tensor-product B-spline surface, polynomial or rational.
///
///     member          size                     note
///     degree[d]                                1 to 25; d = 0 is u, d = 1 is v
///     knots[d]        count[d] + degree[d] + 1 full multiplicity, the ends degree[d] + 1 times
///     count[d]                                 control points in that direction
///     points          3 count[0] count[1]      Cartesian x, y, z; u fastest
///     weights         count[0] count[1], or 0  positive, u fastest; none: polynomial
struct PeerSurface {
  std::array<int, 2> degree = {};
  std::array<std::vector<double>, 2> knots;
  std::array<int, 2> count = {};
  std::vector<double> points;
  std::vector<double> weights;

  double low(std::size_t direction) const { return knots[direction].front(); }
  double high(std::size_t direction) const { return knots[direction].back(); }
};

/// The same with one parameter. `dimension` is 2 or 3; points has dimension times count numbers.
struct PeerCurve {
  int dimension = 3;
  int degree = 0;
  std::vector<double> knots;
  int count = 0;
  std::vector<double> points;
  std::vector<double> weights;
};

/// S and its partial derivatives, in the order in which SISL writes them.
struct PeerJet {
  PeerPoint point, du, dv, duu, duv, dvv;
};

/// C, C' and C''; z is 0 in the plane.
struct PeerCurveJet {
  PeerPoint point, first, second;
};

struct PeerParameters {
  double u = 0.0, v = 0.0;
};

struct PeerRay {
  PeerPoint origin, direction;  ///< the direction need not have unit length
};

/// origin + t direction = S(u, v).
struct PeerHit {
  double t = 0.0, u = 0.0, v = 0.0;
};

/// Points, derivatives and normals on a grid, u fastest. A second use of the same object allocates
/// nothing.
struct PeerGrid {
  std::vector<double> jets;  ///< nine a grid point: S, S_u, S_v
  std::vector<double>
      normals;  ///< three a grid point: S_u x S_v, of the length that its maker says
};

/// A parameter of each of two curves.
struct PeerCurvePair {
  double first = 0.0, second = 0.0;
};

/// A place on each of two surfaces.
struct PeerSurfacePair {
  PeerParameters first, second;
};

struct PeerBranch {
  std::vector<PeerSurfacePair> places;  ///< in order along the branch
  bool is_closed = false;  ///< said by the library, not deduced; the first place may be repeated
};

struct PeerIntersection {
  std::vector<PeerBranch> branches;
  std::vector<PeerSurfacePair> points;  ///< isolated
};

/// Triangles. parameters is empty where the maker knows none.
struct PeerMesh {
  std::vector<double> positions;   ///< three a vertex
  std::vector<double> parameters;  ///< two a vertex: u, v
  std::vector<int> triangles;      ///< three vertices a triangle

  std::size_t triangle_count() const { return triangles.size() / 3; }
};

}  // namespace limn::peers
