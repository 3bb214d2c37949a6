#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "modeler/surface/surface_index.hpp"

namespace limn {

/// Parameters on two surfaces: (u, v) on the first, then (u, v) on the second.
using CrossingPlace = Eigen::Vector4d;

/// A point of a curve in which two surfaces cross: (x, y, z) and its place, and how both change
/// along the curve.
struct CrossingPoint {
  using Vector = Eigen::Matrix<double, 7, 1>;
  Vector at;
  Vector rate;  ///< by arc length; its first three coordinates are the unit tangent

  Eigen::Vector3d point() const { return at.head<3>(); }
  CrossingPlace place() const { return at.tail<4>(); }
  Eigen::Vector3d direction() const { return rate.head<3>(); }
};

/// The cubic from one point of a curve to the next, in Bézier form: tangents are kept, the length
/// is the chord's.
class CrossingSegment {
 public:
  using Vector = CrossingPoint::Vector;
  CrossingSegment(const CrossingPoint& from, const CrossingPoint& to);

  double length() const noexcept { return length_; }
  const std::array<Vector, 4>& control_points() const noexcept { return control_points_; }
  Vector at(double x) const;  ///< 0 <= x <= 1

 private:
  double length_;
  std::array<Vector, 4> control_points_;
};

/// A curve in which two surfaces cross, from end to end. At a corner two points follow each other
/// in the same place, with the tangents of both sides.
struct CrossingBranch {
  std::vector<CrossingPoint> points;  ///< the last is the first again where it is closed
  bool is_closed = false;
  double deviation = 0;  ///< of segments from both surfaces, mm
};

/// Follows curves in which two surfaces cross, with steps so short that the cubics between points
/// are within a tolerance of both surfaces. Between knots where a surface may have a corner, its
/// pieces are smooth; a curve is led exactly to such a knot, and goes on in the next piece.
///
/// Keeps references to the surfaces' indices. Immutable, so any number of threads may use one.
class CrossingWalk {
 public:
  CrossingWalk(const SurfaceIndex& first, const SurfaceIndex& second, double tolerance);

  /// The point of a curve that is near a place where both surfaces nearly have the same point; none
  /// where they are tangent.
  std::optional<CrossingPoint> settled(const CrossingPlace& place) const;

  /// The branch through such a point.
  CrossingBranch branch_through(const CrossingPoint& start) const;

  /// A place where the surfaces meet and have one tangent plane.
  struct Tangency {
    CrossingPlace place;
    bool is_single;  ///< no others beside it
  };
  /// By Newton's iteration from a place near it; none that is `reach` (mm) away or further, and
  /// none of planes.
  std::optional<Tangency> tangency_near(const CrossingPlace& place, double reach) const;

  /// Whether the curve near `x` of a segment of a branch leads through this place.
  bool leads_through(const CrossingSegment& segment, double x, const CrossingPlace& place) const;

  /// An end of the domain of one of the four parameters.
  struct Edge {
    int parameter;
    bool upper;
  };
  /// The edge along which all of a branch runs.
  std::optional<Edge> edge_along(const CrossingBranch& branch) const;

  /// The sine of the angle between both surfaces there, 0 where one has no normal.
  double sine_at(const CrossingPlace& place) const;

 private:
  /// One parameter of one surface.
  struct Direction {
    const KnotVector* knots;
    /// The ends of the domain, and where the surface may have a corner between them.
    std::vector<double> walls;
    std::vector<std::array<int, 2>> spans;  ///< the first and the last between walls i and i + 1
  };
  /// Between which walls each parameter is: i for walls i and i + 1.
  using Pieces = std::array<std::size_t, 4>;
  struct Pair {
    SurfaceJet first;
    SurfaceJet second;
  };
  /// Which point of a curve is meant: that in a plane, or that where a parameter has its value.
  struct Slice {
    int fixed = -1;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };

  Pieces pieces_at(const CrossingPlace& place) const;
  int span(std::size_t direction, std::size_t piece, double x) const;
  double span_length(std::size_t direction, std::size_t piece, double x) const;
  Pair jets(const CrossingPlace& place, const Pieces& pieces) const;
  std::optional<CrossingPoint> point_at(const CrossingPlace& place, const Pieces& pieces) const;
  bool settle(CrossingPlace& place, const Pieces& pieces, const Slice& slice) const;
  Eigen::Vector4d speeds(const CrossingPlace& place, const Pieces& pieces) const;
  CrossingPlace margins(const CrossingPlace& place, const Pieces& pieces) const;
  double longest_step(const CrossingPoint& from, const Pieces& pieces) const;
  std::optional<int> wall_beyond(const CrossingPlace& place, const CrossingPlace& margins,
                                 const Pieces& pieces) const;
  double wall(int direction, bool upper, const Pieces& pieces) const;
  std::optional<CrossingPoint> step(const CrossingPoint& from, const Pieces& pieces,
                                    double length) const;
  std::optional<CrossingPoint> advance(const CrossingPoint& from, const Pieces& pieces,
                                       double& length, double& deviation) const;
  bool pass_walls(std::vector<CrossingPoint>& points, Pieces& pieces) const;
  double deviation_of(const CrossingSegment& segment, const Pieces& pieces) const;
  bool walk(std::vector<CrossingPoint>& points, Pieces pieces, double& deviation) const;

  const SurfaceIndex* surfaces_[2];
  double tolerance_;
  std::array<Direction, 4> directions_;
};

}  // namespace limn
