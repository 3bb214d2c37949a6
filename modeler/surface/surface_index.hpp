#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "modeler/bspline/surface_evaluator.hpp"
#include "modeler/surface/box_tree.hpp"
#include "modeler/surface/patch.hpp"

namespace limn {

/// The point of a surface that is closest to another.
struct ClosestPoint {
  Eigen::Vector2d parameter;  ///< (u, v)
  Eigen::Vector3d point;
  double distance = 0;  ///< mm, 0 or more
  /// No point of the surface is nearer than distance - slack. Below kGeometric but for places that
  /// a curve or an area of the surface has nearly the same distance to, where the search is cut
  /// off.
  double slack = 0;
};

/// A half-line: origin + t direction, 0 <= t <= most. The direction need not be of length 1.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  double most = 1e300;
};

/// Where a ray meets a surface.
struct RayHit {
  double t = 0;
  Eigen::Vector2d parameter;
  Eigen::Vector3d point;
  /// The ray touches the surface here, or runs along it: from `point` on it stays within kGeometric
  /// for about this length in mm. 0 where it passes through.
  double run = 0;
  /// False where the search was cut off: a part of the surface near `point` may be hit or missed.
  bool certain = true;
};

struct RayHits {
  std::vector<RayHit> hits;  ///< ascending t, those within some kGeometric of each other once
  /// Whether these are all. False where the search was cut off after a bounded number of halves.
  bool complete = true;
};

/// A surface with a hierarchy of certified bounds of its parts, for questions about the whole of
/// it.
///
/// Leaves are patches small enough for Newton's iteration to be safe in nearly all of them; a query
/// proves for each that it cannot hold the answer, or that there is one at most and finds it, or
/// cuts it in halves. Answers are therefore those of the whole surface, not of a sampling.
///
/// Linear in the control points to make, some 0.8 kB and 7 us a span where the surface bends little
/// in it, up to 256 times that where it bends much; about logarithmic to ask. Coordinates up to 1e6
/// mm keep kGeometric apart; of those above 1e150 nothing is found. Immutable after construction,
/// so any number of threads may ask. Deterministic.
class SurfaceIndex {
 public:
  explicit SurfaceIndex(BsplineSurface surface);

  const BsplineSurface& surface() const noexcept { return evaluator_.surface(); }
  const SurfaceEvaluator& evaluator() const noexcept { return evaluator_; }

  /// One of them where several are equally close, always the same. Precondition: p is finite.
  ClosestPoint closest_point(const Eigen::Vector3d& p) const;

  /// None where the ray misses; see RayHit::certain. Precondition: finite, a direction that is not
  /// zero.
  std::optional<RayHit> first_hit(const Ray& ray) const;
  RayHits all_hits(const Ray& ray) const;

  /// A leaf's box along its tangent plane: what most visits of a leaf end with.
  const std::vector<OrientedBox>& boxes() const noexcept { return boxes_; }
  /// Parts of one span of each direction, neighbours mostly near each other.
  const std::vector<PatchBound>& leaves() const noexcept { return leaves_; }
  /// The hierarchy of the leaves' boxes. The root is first; empty where there is one leaf only.
  const std::vector<BoxNode>& nodes() const noexcept { return nodes_; }
  /// Asks the processor for what is below a node: a node, or leaf ~child if below 0. Of large
  /// surfaces it is not near, and what is asked for together comes together.
  void prefetch(std::int32_t child) const noexcept;
  /// The Bézier form of a leaf.
  Patch patch(const PatchBound& leaf) const;
  /// The jet of the polynomial piece that a leaf, or a part of it, is of: at a knot line the limit
  /// from the leaf's side.
  SurfaceJet jet(const PatchBound& leaf, const Eigen::Vector2d& at) const noexcept {
    return evaluator_.jet_in_spans(leaf.spans, at.x(), at.y());
  }
  /// The bound of a part of a leaf.
  PatchBound bound(const Patch& part) const {
    const Eigen::Vector2d center = part.box.center();
    return bound_of(part, evaluator_.jet_in_spans(part.spans, center.x(), center.y()));
  }

 private:
  void add_leaves(Patch patch, int halvings);

  SurfaceEvaluator evaluator_;
  PatchGrid grid_;
  std::vector<PatchBound> leaves_;
  std::vector<OrientedBox> boxes_;  ///< of each leaf
  std::vector<BoxNode> nodes_;
};

/// The direction in which halving a patch flattens it more.
int wider_direction(const PatchBound& bound) noexcept;

}  // namespace limn
