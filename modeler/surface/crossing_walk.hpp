#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "modeler/surface/crossing_branch.hpp"
#include "modeler/surface/crossing_jets.hpp"
#include "modeler/surface/surface_index.hpp"

namespace limn {

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

  /// Why no curve can be followed from a place where the surfaces meet: kEdge at a pole, kTangency
  /// where they are tangent, kCutOff where no reason is known.
  WalkEnd end_near(const CrossingPlace& place) const;

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

  /// Where segments lie, mm: within the tolerance of both surfaces, and so within this of the curve
  /// that they follow, unless the surfaces meet at a small angle.
  double curve_room() const noexcept { return 10 * tolerance_; }

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
  /// Which point of a curve is meant: that in a plane, or that where a parameter has its value.
  struct Slice {
    int fixed = -1;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };

  /// A step along a curve.
  struct Step {
    CrossingPoint to;
    CrossingSegment segment;
    double deviation;  ///< of the segment
  };

  Pieces pieces_at(const CrossingPlace& place) const;
  CrossingPlace walls(bool upper, const Pieces& pieces) const;
  int span(std::size_t direction, std::size_t piece, double x) const;
  double span_length(std::size_t direction, std::size_t piece, double x) const;
  CrossingJets jets(const CrossingPlace& place, const Pieces& pieces) const;
  std::optional<CrossingPoint> point_at(const CrossingPlace& place, const Pieces& pieces) const;
  bool settle(CrossingPlace& place, const Pieces& pieces, const Slice& slice) const;
  Eigen::Vector4d speeds(const CrossingPlace& place, const Pieces& pieces) const;
  CrossingPlace margins(const CrossingPlace& place, const Pieces& pieces) const;
  double longest_step(const CrossingPoint& from, const Pieces& pieces) const;
  std::optional<int> wall_beyond(const CrossingPlace& place, const CrossingPlace& margins,
                                 const Pieces& pieces) const;
  std::optional<CrossingPoint> next_point(const CrossingPoint& from, const Pieces& pieces,
                                          double length) const;
  CrossingSegment segment_between(const CrossingPoint& from, const CrossingPoint& to,
                                  const Pieces& pieces) const;
  double deviation_of(const CrossingSegment& segment, const Pieces& pieces) const;
  std::optional<Step> step_of(const CrossingPoint& from, const Pieces& pieces, double length) const;
  std::optional<Step> advance(const CrossingPoint& from, const Pieces& pieces,
                              double& length) const;
  std::optional<WalkEnd> pass_walls(CrossingPoint& here, Pieces& pieces) const;
  WalkEnd end_near(const CrossingPlace& last, const Pieces& pieces) const;
  WalkEnd walk(const CrossingPoint& start, std::vector<CrossingSegment>& segments,
               double& deviation) const;

  const SurfaceIndex* surfaces_[2];
  double tolerance_;
  std::array<Direction, 4> directions_;
};

}  // namespace limn
