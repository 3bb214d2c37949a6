#include "modeler/surface/surface_crossings.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "input/base/expect.hpp"
#include "modeler/base/tolerance.hpp"
#include "modeler/surface/crossing_cell.hpp"
#include "modeler/surface/crossing_touches.hpp"
#include "modeler/surface/crossing_walk.hpp"
#include "modeler/surface/known_crossing.hpp"

namespace limn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr int kMostPairs = 300'000;
/// Curves that could not be followed to an end; more show that numbers are too large for it.
constexpr int kMostCutOffs = 1000;
/// Pairs of halves looked at to show that parts are apart which seemed to run together: in all, and
/// of one pair. Parts that are kFlat and some kGeometric apart take a few hundred.
constexpr int kMostLooks = 100'000;
constexpr int kMostLooksAtPair = 500;
constexpr std::size_t kMostTogether = 40'000;   ///< pairs of parts that run together
constexpr std::size_t kMostSegments = 300'000;  ///< of all curves
/// Parts that are flat to this (mm), and neither apart nor transversal, run together.
constexpr double kFlat = 1e-7;
/// The sine of the angle from which on a curve can be followed for certain.
constexpr double kTransversal = 1e-4;
/// Knots nearer than this part of a curve's length are one.
constexpr double kSameKnot = 1e-12;

/// The direction in which to halve a part: to flatten it, unless it is much longer the other way,
/// which spoils the bounds of rational parts.
int direction_to_halve(const PatchBound& bound) {
  const Vector2d half = bound.box.half();
  const double u = bound.jet.du.norm() * half.x();
  const double v = bound.jet.dv.norm() * half.y();
  constexpr double kMuchLonger = 4;
  if (u > kMuchLonger * v) return 0;
  if (v > kMuchLonger * u) return 1;
  return wider_direction(bound);
}

/// The leaves of a surface and their halves, made when they are asked for.
class Parts {
 public:
  explicit Parts(const SurfaceIndex& index)
      : index_(&index), leaf_halves_(index.leaves().size(), kNone) {}

  const SurfaceIndex& index() const { return *index_; }
  /// Part i: a leaf, or what halves() said.
  const PatchBound& bound(int i) const {
    const int leaves = static_cast<int>(leaf_halves_.size());
    return i < leaves ? index_->leaves()[static_cast<std::size_t>(i)] : half(i).bound;
  }
  /// Its halves; none where no parameter is left between its ends.
  std::optional<std::array<int, 2>> halves(int i) {
    const int leaves = static_cast<int>(leaf_halves_.size());
    const bool is_leaf = i < leaves;
    std::array<int, 2>& known =
        is_leaf ? leaf_halves_[static_cast<std::size_t>(i)] : half(i).halves;
    if (known != kNone) return known;
    const int direction = direction_to_halve(bound(i));
    Patch before = is_leaf ? index_->patch(bound(i)) : half(i).patch;
    if (!before.can_halve(direction)) return std::nullopt;
    Patch after = before.halve(direction);
    const int next = leaves + static_cast<int>(halves_.size());
    known = {next, next + 1};  // before the deque grows: references into it stay
    for (Patch* patch : {&before, &after}) {
      const PatchBound bound = index_->bound(*patch);
      halves_.push_back({bound, std::move(*patch), kNone});
    }
    return std::array<int, 2>{next, next + 1};
  }

 private:
  struct Half {
    PatchBound bound;
    Patch patch;
    std::array<int, 2> halves;
  };
  static constexpr std::array<int, 2> kNone = {-1, -1};

  Half& half(int i) { return halves_[static_cast<std::size_t>(i) - leaf_halves_.size()]; }
  const Half& half(int i) const {
    return halves_[static_cast<std::size_t>(i) - leaf_halves_.size()];
  }

  const SurfaceIndex* index_;
  std::vector<std::array<int, 2>> leaf_halves_;
  std::deque<Half> halves_;
};

/// Whether the box of `a` along its tangent plane is apart from that of `b`, seen along its axes.
bool apart_along(const PatchBound& a, const PatchBound& b) {
  const Vector3d middle =
      b.jet.point + b.frame * (0.5 * (b.frame_low + b.frame_high)) - a.jet.point;
  const Matrix3d turn = a.frame.transpose() * b.frame;
  const Vector3d reach = turn.cwiseAbs() * (0.5 * (b.frame_high - b.frame_low));
  const Vector3d local = a.frame.transpose() * middle;
  return ((local - reach - a.frame_high).array() > kGeometric).any() ||
         ((a.frame_low - local - reach).array() > kGeometric).any();
}

bool boxes_apart(const Vector3d& low_a, const Vector3d& high_a, const Vector3d& low_b,
                 const Vector3d& high_b) {
  return ((low_a - high_b).array() > kGeometric).any() ||
         ((low_b - high_a).array() > kGeometric).any();
}

bool apart(const PatchBound& a, const PatchBound& b) {
  return boxes_apart(a.low, a.high, b.low, b.high) || apart_along(a, b) || apart_along(b, a);
}

/// Off the tangent plane, mm.
double height_of(const PatchBound& bound) { return bound.frame_high.z() - bound.frame_low.z(); }

/// A stretch of a cell's axis.
struct Stretch {
  double low;
  double high;
  double length() const { return high - low; }
  double middle() const { return low + 0.5 * (high - low); }
};

/// Whether the hierarchy's floats hold its boxes, and doubles the fourth powers of lengths that
/// Newton's iterations take.
bool is_within_numbers(const SurfaceIndex& index) {
  constexpr double kFarthest = 1e30;  // mm
  return std::all_of(index.leaves().begin(), index.leaves().end(), [](const PatchBound& leaf) {
    const auto is_near = [](const Vector3d& x) { return x.cwiseAbs().maxCoeff() <= kFarthest; };
    return leaf.low.allFinite() && leaf.high.allFinite() && is_near(leaf.low) && is_near(leaf.high);
  });
}

class CrossingSearch {
 public:
  CrossingSearch(const SurfaceIndex& first, const SurfaceIndex& second, double tolerance)
      : first_(first), second_(second), tolerance_(tolerance), walk_(first, second, tolerance) {}

  SurfaceCrossings run();

 private:
  /// A part of the hierarchy: an inner node, or a leaf as ~number.
  struct Branching {
    std::int32_t node;
    Eigen::AlignedBox<double, 3> box;
  };
  static Branching root_of(const SurfaceIndex& index);
  static std::vector<Branching> below(const SurfaceIndex& index, const Branching& at);
  void visit_nodes(const Branching& a, const Branching& b);
  void visit(int a, int b);
  bool cover(const CrossingCell& cell);
  std::vector<Stretch> uncovered(const CrossingCell& cell, const Stretch& stretch) const;
  bool is_known(const CrossingPlace& place, const Vector3d& point) const;
  bool is_on_curve(const Vector3d& point) const;
  bool follow(const CrossingPlace& place, double reach);
  bool is_seam(const KnownCrossing& one, const KnownCrossing& other) const;
  bool are_apart(int a, int b, int& looks);
  bool is_beside_curve(const PatchBound& a, const PatchBound& b) const;
  bool find_meeting(const PatchBound& a, const PatchBound& b);
  void add_meeting(const CrossingPlace& place, double reach);

  Parts first_;
  Parts second_;
  double tolerance_;
  CrossingWalk walk_;
  std::vector<KnownCrossing> known_;
  std::vector<std::array<int, 2>> running_together_;  ///< parts that do, or seem to
  std::vector<MeetingPlace> meetings_;
  int pairs_ = 0;
  int cut_offs_ = 0;
  int looks_ = kMostLooks;  ///< that are left
  std::size_t segments_ = 0;
  bool complete_ = true;
};

CrossingSearch::Branching CrossingSearch::root_of(const SurfaceIndex& index) {
  if (index.nodes().empty()) return {~0, {index.leaves()[0].low, index.leaves()[0].high}};
  Branching root{0, {}};
  for (const Branching& part : below(index, root)) root.box.extend(part.box);
  return root;
}

std::vector<CrossingSearch::Branching> CrossingSearch::below(const SurfaceIndex& index,
                                                             const Branching& at) {
  const BoxNode& node = index.nodes()[static_cast<std::size_t>(at.node)];
  std::vector<Branching> out;
  for (std::size_t i = 0; i < BoxNode::kWidth; ++i) {
    if (node.has_child(i)) out.push_back({node.child[i], node.child_box(i)});
  }
  return out;
}

void CrossingSearch::visit_nodes(const Branching& a, const Branching& b) {
  if (boxes_apart(a.box.min(), a.box.max(), b.box.min(), b.box.max())) return;
  if (a.node < 0 && b.node < 0) return visit(~a.node, ~b.node);
  const bool split_first =
      b.node < 0 || (a.node >= 0 && a.box.diagonal().norm() >= b.box.diagonal().norm());
  if (split_first) {
    for (const Branching& part : below(first_.index(), a)) visit_nodes(part, b);
  } else {
    for (const Branching& part : below(second_.index(), b)) visit_nodes(a, part);
  }
}

void CrossingSearch::visit(int a, int b) {
  if (cut_offs_ > kMostCutOffs) return;
  const PatchBound& one = first_.bound(a);
  const PatchBound& other = second_.bound(b);
  if (apart(one, other)) return;
  const CrossingCell cell(first_.index(), one, second_.index(), other);
  if (cell.is_transversal() && cover(cell)) return;
  if (++pairs_ > kMostPairs) {
    complete_ = false;
    return;
  }
  const bool flat = height_of(one) <= kFlat;
  const bool other_flat = height_of(other) <= kFlat;
  // Flat parts may cross, and only their parameters turn: then they are halved on. Tangent planes
  // of parts that run together differ by no more than the parts bend.
  constexpr double kBends = 8;          // how a parabola's slope goes with its height
  constexpr double kLeastAngle = 1e-9;  // rad
  const double sine = one.frame.col(2).cross(other.frame.col(2)).norm();
  const double bends =
      kBends * (height_of(one) + height_of(other)) / std::min(one.reach, other.reach);
  const bool together = flat && other_flat && !(sine > bends + kLeastAngle);
  const bool is_small = std::min(one.reach, other.reach) <= kFlat;
  // The one that bends more.
  const bool first = one.turn >= other.turn;
  std::optional<std::array<int, 2>> halves;
  if (!together && !is_small) {
    halves = first ? first_.halves(a) : second_.halves(b);
  }
  if (!halves) {
    if (running_together_.size() < kMostTogether) {
      running_together_.push_back({a, b});
    } else {
      complete_ = false;
    }
    return;
  }
  for (const int half : *halves) first ? visit(half, b) : visit(a, half);
}

/// Finds all crossings of a transversal cell. Whatever stretch of its axis no branch covers yet is
/// asked in its middle: there is a crossing, or there is none in all of it, or it is halved. False
/// where that takes long: parts of the cell are easier.
bool CrossingSearch::cover(const CrossingCell& cell) {
  constexpr int kMostQuestions = 100;
  constexpr double kShortest = 1e-6;
  constexpr double kBesideAnswer = 0.01;  // the curve leads through here, however far it was known
  constexpr double kEdge = 1e-9;          // neighbours share their edges
  std::vector<Stretch> open = {{-1, 1}};
  int questions = 0;
  while (!open.empty()) {
    const Stretch next = open.back();
    open.pop_back();
    for (const Stretch& stretch : uncovered(cell, next)) {
      if (stretch.length() < kShortest) continue;
      if (++questions > kMostQuestions) return false;
      const double c = stretch.middle();
      Vector4d x;
      const bool solved = cell.solve(c, x);
      double gap = 0;
      if (solved && x.cwiseAbs().maxCoeff() <= 1 + kEdge) {
        if (!follow(cell.place(x.cwiseMax(-1.0).cwiseMin(1.0)), 0)) return true;
        gap = kBesideAnswer;
      } else if (cell.excludes(c, 0.5 * stretch.length(),
                               solved ? x : Vector4d(Vector4d::Zero()))) {
        continue;
      }
      open.push_back({stretch.low, c - gap});
      open.push_back({c + gap, stretch.high});
    }
  }
  return true;
}

/// What of a stretch of the cell's axis no known branch passes through. Branches are polygons here:
/// what they miss is asked for.
std::vector<Stretch> CrossingSearch::uncovered(const CrossingCell& cell,
                                               const Stretch& stretch) const {
  constexpr double kRoom = 1e-7;  // along an edge
  std::vector<Stretch> covered;
  for (const KnownCrossing& known : known_) {
    known.clip(cell.place(Vector4d::Constant(-1 - kRoom)),
               cell.place(Vector4d::Constant(1 + kRoom)),
               [&](const CrossingPlace& from, const CrossingPlace& to) {
                 const double a = cell.local(from)[cell.axis()];
                 const double b = cell.local(to)[cell.axis()];
                 covered.push_back({std::min(a, b), std::max(a, b)});
               });
  }
  std::sort(covered.begin(), covered.end(),
            [](const Stretch& a, const Stretch& b) { return a.low < b.low; });
  std::vector<Stretch> out;
  double at = stretch.low;
  for (const Stretch& c : covered) {
    if (c.low > at) out.push_back({at, std::min(c.low, stretch.high)});
    at = std::max(at, c.high);
    if (at >= stretch.high) return out;
  }
  out.push_back({at, stretch.high});
  return out;
}

bool CrossingSearch::is_known(const CrossingPlace& place, const Vector3d& point) const {
  return std::any_of(known_.begin(), known_.end(), [&](const KnownCrossing& known) {
    return known.any_near(point, walk_.curve_room(), [&](const CrossingSegment& segment, double x) {
      return walk_.leads_through(segment, x, place);
    });
  });
}

/// Whether a point is on a curve that is known: there the surfaces may be tangent, or one may have
/// a pole, and it is no touch.
bool CrossingSearch::is_on_curve(const Vector3d& point) const {
  const double room = std::max(2 * tolerance_, kNearCrossing);
  return std::any_of(known_.begin(), known_.end(), [&](const KnownCrossing& known) {
    return known.any_near(point, room, [&](const CrossingSegment& segment, double x) {
      return (segment.at(x).head<3>() - point).norm() <= room;
    });
  });
}

/// The branch through a place where the surfaces meet, unless it is known; a meeting place where
/// there is none. False where following it fails from the beginning.
bool CrossingSearch::follow(const CrossingPlace& place, double reach) {
  const auto cut_off = [this] {
    complete_ = false;
    ++cut_offs_;
    return false;
  };
  const auto start = walk_.settled(place);
  if (!start) {
    if (walk_.sine_at(place) > kTransversal && walk_.end_near(place) == WalkEnd::kCutOff) {
      return cut_off();
    }
    add_meeting(place, reach);
    return true;
  }
  if (is_known(start->place(), start->point())) return true;
  if (segments_ > kMostSegments) return cut_off();
  KnownCrossing found(walk_.branch_through(*start));
  segments_ += found.branch().segments.size();
  const bool is_cut_off = found.branch().is_cut_off();
  if (found.length() > kNearCrossing) {
    known_.push_back(std::move(found));
    if (is_cut_off) cut_off();
    return true;
  }
  if (is_cut_off) return cut_off();
  add_meeting(place, 0);  // all of it is there
  return true;
}

void CrossingSearch::add_meeting(const CrossingPlace& place, double reach) {
  meetings_.push_back({place, first_.index().surface().point({place[0], place[1]}), reach});
}

/// Whether both are one curve in space, which runs along a seam and so has two places in a surface.
bool CrossingSearch::is_seam(const KnownCrossing& one, const KnownCrossing& other) const {
  const auto edge = walk_.edge_along(one.branch());
  const auto opposite = walk_.edge_along(other.branch());
  if (!edge || !opposite || edge->parameter != opposite->parameter ||
      edge->upper == opposite->upper)
    return false;
  return std::all_of(
      one.branch().segments.begin(), one.branch().segments.end(), [&](const CrossingSegment& side) {
        const Vector3d point = side.at(1).head<3>();
        return other.any_near(point, tolerance_, [&](const CrossingSegment& segment, double x) {
          return (segment.at(x).head<3>() - point).norm() <= walk_.curve_room();
        });
      });
}

/// Whether halves of two parts, of which so many pairs may be looked at, are all apart.
bool CrossingSearch::are_apart(int a, int b, int& looks) {
  const PatchBound& one = first_.bound(a);
  const PatchBound& other = second_.bound(b);
  if (apart(one, other)) return true;
  if (--looks < 0) return false;
  const bool first = one.reach >= other.reach;
  const auto halves = first ? first_.halves(a) : second_.halves(b);
  if (!halves) return false;
  return std::all_of(halves->begin(), halves->end(), [&](int half) {
    return first ? are_apart(half, b, looks) : are_apart(a, half, looks);
  });
}

/// Beside a curve on which curved surfaces become tangent its parts run together, too, as does a
/// pole that it leads through. (Planar parts may be large, and run together elsewhere.)
bool CrossingSearch::is_beside_curve(const PatchBound& a, const PatchBound& b) const {
  const PatchBound& smaller = a.reach < b.reach ? a : b;
  if (smaller.reach <= kFlat && is_on_curve(smaller.jet.point)) return true;
  constexpr double kPlanar = 1e-3 * kFlat;
  if (std::max(height_of(a), height_of(b)) <= kPlanar) return false;
  Vector4d center;
  Vector4d half;
  center << a.box.center(), b.box.center();
  half << a.box.half(), b.box.half();
  bool beside = false;
  for (const KnownCrossing& known : known_) {
    known.clip(center - 2 * half, center + 2 * half, [&](auto&, auto&) { beside = true; });
  }
  return beside;
}

/// A place where two flat parts that cannot be told apart meet, by least squares. Whether there is
/// one.
bool CrossingSearch::find_meeting(const PatchBound& a, const PatchBound& b) {
  CrossingPlace place;
  CrossingPlace low;
  CrossingPlace high;
  place << a.box.center(), b.box.center();
  low << a.box.low, b.box.low;
  high << a.box.high, b.box.high;
  constexpr int kMostSteps = 30;
  constexpr double kMeets = 2 * kGeometric;
  bool meets = false;
  for (int step = 0; step < kMostSteps && !meets; ++step) {
    const CrossingJets here = {first_.index().jet(a, place.head<2>()),
                               second_.index().jet(b, place.tail<2>())};
    meets = here.gap().norm() <= kMeets;
    Eigen::Matrix<double, 3, 4> m = here.jacobian();
    // In mm, and so that tangent surfaces do not divide by 0.
    constexpr double kNoSpeed = 1e-300;  // at a pole
    constexpr double kDamping = 1e-10;
    const Vector4d scale = m.colwise().norm().cwiseMax(kNoSpeed).cwiseInverse();
    m = m * scale.asDiagonal();
    Vector4d move = Vector4d::Zero();
    for (int solved = 0; solved < 4; ++solved) {  // without those that would leave the parts
      const Eigen::Matrix4d normal =
          m.transpose() * m + kDamping * Eigen::Matrix4d(Eigen::Matrix4d::Identity());
      move = normal.partialPivLu().solve(m.transpose() * here.gap()).cwiseProduct(scale);
      if (!move.allFinite()) return false;
      bool leaves = false;
      for (int k = 0; k < 4; ++k) {
        if (!(move[k] < 0 ? place[k] <= low[k] : move[k] > 0 && place[k] >= high[k])) continue;
        m.col(k).setZero();
        leaves = true;
      }
      if (!leaves) break;
    }
    place = (place + move).cwiseMax(low).cwiseMin(high);
  }
  const double reach = std::min(a.reach, b.reach);
  if (const auto found = walk_.tangency_near(place, 2 * reach)) {
    add_meeting(found->place, found->is_single ? 0 : reach);
    return true;
  }
  if (!meets) return false;
  if (walk_.sine_at(place) > kTransversal) return follow(place, reach);
  add_meeting(place, reach);
  return true;
}

/// Whether the cubics through a joint, with their lengths as parameters, have one tangent there.
bool is_smooth(const CrossingSegment& before, const CrossingSegment& after) {
  constexpr double kSameRate = 1e-8;  // a little more than what the walk takes for no corner
  const auto& p = before.control_points();
  const auto& q = after.control_points();
  const CrossingSegment::Vector rate = (p[3] - p[2]) / before.length();
  const CrossingSegment::Vector next = (q[1] - q[0]) / after.length();
  return (next - rate).norm() <= kSameRate * rate.norm();
}

/// The three curves of a branch; none where its knots can't be told apart. Knots are double where
/// segments meet, so that tangents agree, and triple at corners.
std::optional<SurfaceCrossing> crossing_of(const CrossingBranch& branch) {
  std::vector<double> knots(4, 0.0);
  std::vector<CrossingSegment::Vector> points = {branch.segments.front().control_points()[0]};
  double at = 0;
  const CrossingSegment* before = nullptr;
  for (const CrossingSegment& segment : branch.segments) {
    // A step to a knot may be too short for one of its own.
    if (segment.length() <= std::max(kGeometric, kSameKnot * at)) continue;
    if (before != nullptr) {
      const bool smooth = is_smooth(*before, segment);
      knots.insert(knots.end(), smooth ? 2 : 3, at);
      if (!smooth) points.push_back(segment.control_points()[0]);
    }
    points.push_back(segment.control_points()[1]);
    points.push_back(segment.control_points()[2]);
    at += segment.length();
    before = &segment;
  }
  knots.insert(knots.end(), 4, at);
  points.push_back(branch.segments.back().control_points()[3]);
  const auto knot_vector = KnotVector::make(3, std::move(knots));
  if (!knot_vector) return std::nullopt;
  std::vector<Vector3d> in_space;
  std::vector<Vector2d> on_first;
  std::vector<Vector2d> on_second;
  for (const auto& p : points) {
    in_space.push_back(p.head<3>());
    on_first.push_back(p.segment<2>(3));
    on_second.push_back(p.tail<2>());
  }
  auto curve = BsplineCurve<3>::make(*knot_vector, in_space);
  auto first = BsplineCurve<2>::make(*knot_vector, on_first);
  auto second = BsplineCurve<2>::make(*knot_vector, on_second);
  if (!curve || !first || !second) return std::nullopt;
  return SurfaceCrossing{*std::move(curve), *std::move(first), *std::move(second), branch.deviation,
                         branch.is_closed()};
}

SurfaceCrossings CrossingSearch::run() {
  visit_nodes(root_of(first_.index()), root_of(second_.index()));
  for (const auto& [a, b] : running_together_) {
    const PatchBound& one = first_.bound(a);
    const PatchBound& other = second_.bound(b);
    if (is_beside_curve(one, other) || find_meeting(one, other) || !complete_) continue;
    int looks = std::min(looks_, kMostLooksAtPair);
    looks_ -= looks;
    complete_ = are_apart(a, b, looks);
    looks_ += std::max(looks, 0);
  }
  const auto on_curve = [this](const MeetingPlace& m) { return is_on_curve(m.point); };
  meetings_.erase(std::remove_if(meetings_.begin(), meetings_.end(), on_curve), meetings_.end());
  SurfaceCrossings out;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    const bool repeats = std::any_of(known_.begin(), known_.begin() + std::ptrdiff_t(i),
                                     [&](const KnownCrossing& k) { return is_seam(known_[i], k); });
    if (repeats) continue;
    if (auto crossing = crossing_of(known_[i].branch())) {
      out.curves.push_back(*std::move(crossing));
    } else {
      complete_ = false;  // too short, or too far away, for knots of its own
    }
  }
  out.touches = touches_of(meetings_);
  out.complete = complete_;
  return out;
}

}  // namespace

SurfaceCrossings cross_surfaces(const SurfaceIndex& first, const SurfaceIndex& second,
                                double tolerance) {
  LIMN_EXPECT(tolerance > 0);
  if (!is_within_numbers(first) || !is_within_numbers(second)) return {{}, {}, false};
  return CrossingSearch(first, second, std::max(tolerance, kNearCrossing)).run();
}

}  // namespace limn
