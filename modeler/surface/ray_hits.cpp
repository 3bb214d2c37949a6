#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "modeler/base/tolerance.hpp"
#include "modeler/surface/surface_index.hpp"

namespace limn {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMostSteps = 30;      ///< of one Newton iteration
constexpr int kMostHalvings = 100;  ///< of a leaf
constexpr int kMostCells = 4096;    ///< halves looked at in one query
/// Neighbours share their edges: a root this far outside a patch, in its half sides, counts.
constexpr double kEdge = 1e-9;
/// Components of a direction below this are none: dividing by them overflows.
constexpr double kNoDirection = 1e-300;

/// The part of the ray inside a box, first > last where there is none.
struct Interval {
  double first;
  double last;
};

class RaySearch {
 public:
  RaySearch(const SurfaceIndex& index, const Ray& ray, bool first_only)
      : index_(index), ray_(ray), first_only_(first_only), most_(ray.most) {
    const double length = ray.direction.stableNorm();
    const Vector3d along = ray.direction / length;
    across_[0] = along.unitOrthogonal();
    across_[1] = along.cross(across_[0]);
    per_length_ = 1 / length;
    along_ = along;
  }

  RayHits run() {
    if (index_.nodes().empty()) {
      for (std::int32_t i = 0; i < std::ssize(index_.leaves()); ++i) visit_leaf(i);
    } else {
      visit_nodes();
    }
    finish();
    return std::move(found_);
  }

 private:
  struct Waiting {
    double first;
    std::int32_t node;
  };

  void visit_nodes() {
    // Deeper than any tree of int32 leaves, which has up to 8 children a node.
    constexpr std::size_t kMostDepth = 11;
    constexpr std::size_t kWidth = BoxNode::kWidth;
    std::array<Waiting, kWidth * kMostDepth> stack;
    std::size_t size = 0;
    stack[size++] = {0, 0};
    while (size > 0) {
      const Waiting next = stack[--size];
      if (next.first > most_) continue;
      if (next.node < 0) {
        visit_leaf(~next.node);
        continue;
      }
      const BoxNode& node = index_.nodes()[static_cast<std::size_t>(next.node)];
      std::array<double, kWidth> first;
      const std::size_t bottom = size;
      for (unsigned met = node.passages(ray_.origin, ray_.direction, most_, first.data()); met != 0;
           met &= met - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(met));
        index_.prefetch(node.child[i]);
        std::size_t to = size++;  // the nearest on top
        for (; to > bottom && stack[to - 1].first < first[i]; --to) stack[to] = stack[to - 1];
        stack[to] = {first[i], node.child[i]};
      }
    }
  }

  /// The ray in a patch's own frame, and the part of it inside its box there.
  struct Passage {
    Vector3d origin;
    Vector3d direction;
    Interval t;
    bool misses() const { return t.first > t.last + 1e-14 * std::abs(t.last); }
  };
  Passage pass(const OrientedBox& box) const noexcept {
    Passage out{box.axes * (ray_.origin - box.middle), box.axes * ray_.direction, {0, most_}};
    for (Eigen::Index d = 0; d < 3; ++d) {
      const double rounding = 1e-14 * (std::abs(out.origin[d]) + box.high[d] - box.low[d]);
      clip(out.origin[d], out.direction[d], box.low[d] - rounding, box.high[d] + rounding, out.t);
    }
    return out;
  }
  Passage pass(const PatchBound& b) const noexcept {
    return pass({b.jet.point, b.frame.transpose(), b.frame_low, b.frame_high});
  }

  /// Keeps of `t` where low <= origin + t direction <= high.
  static void clip(double origin, double direction, double low, double high, Interval& t) noexcept {
    if (std::abs(direction) < kNoDirection) {
      if (origin < low || origin > high) t = {1, 0};
      return;
    }
    const double a = (low - origin) / direction;
    const double b = (high - origin) / direction;
    t.first = std::max(t.first, std::min(a, b));
    t.last = std::min(t.last, std::max(a, b));
  }

  void visit_leaf(std::int32_t number) {
    const Passage ray = pass(index_.boxes()[static_cast<std::size_t>(number)]);
    if (ray.misses()) return;
    const PatchBound& leaf = index_.leaves()[static_cast<std::size_t>(number)];
    if (settle(leaf)) return;
    halve(index_.patch(leaf), leaf, ray, 0);
  }

  /// S seen along the ray, F(u, v) = (across_0, across_1) . (S - origin), which is 0 at hits.
  Vector2d seen(const Vector3d& x) const noexcept {
    const Vector3d r = x - ray_.origin;
    return {r.dot(across_[0]), r.dot(across_[1])};
  }
  Matrix2d jacobian(const SurfaceJet& jet) const noexcept {
    Matrix2d out;
    out << jet.du.dot(across_[0]), jet.dv.dot(across_[0]), jet.du.dot(across_[1]),
        jet.dv.dot(across_[1]);
    return out;
  }

  /// Finds the only hit that a patch can have, or that it has none; false where several are
  /// possible.
  ///
  /// In coordinates x of the box, from -1 to 1, let J be the Jacobian of F in the middle. If the
  /// tangents turn so little that |J^-1 J(x) - 1| <= k < 1 on the box, x -> J^-1 F(x) is one to one
  /// there, and a root x* lies near the middle's Newton step x_0: |x_0 - x*| <= k |x*|.
  bool settle(const PatchBound& b) {
    const Vector2d half = b.box.half();
    const Matrix2d j = jacobian(b.jet) * half.asDiagonal();
    const double det = j.determinant();
    const double mean = 0.5 * j.squaredNorm();
    const double largest = std::sqrt(mean + std::sqrt(std::max(0.0, mean * mean - det * det)));
    const double smallest = largest > 0 ? std::abs(det) / largest : 0.0;
    constexpr double kMostTurn = 0.9;
    if (!(b.turn < kMostTurn * smallest)) return false;
    const double k = b.turn / smallest;
    const Vector2d f = seen(b.jet.point);
    const Vector2d step =
        Vector2d(j(0, 1) * f.y() - j(1, 1) * f.x(), j(1, 0) * f.x() - j(0, 0) * f.y()) / det;
    constexpr double kDiagonal = 1.4142135623730951;
    if (step.cwiseAbs().maxCoeff() > 1 + k * kDiagonal + kEdge) return true;
    return pursue(b, step, k);
  }

  /// Newton's step for F in half sides of a box.
  Vector2d newton_step(const SurfaceJet& jet, const Vector2d& half) const noexcept {
    const Vector2d f = seen(jet.point);
    const Matrix2d j = jacobian(jet);
    const double per_det = 1 / (j(0, 0) * j(1, 1) - j(0, 1) * j(1, 0));
    return {(j(0, 1) * f.y() - j(1, 1) * f.x()) * per_det / half.x(),
            (j(1, 0) * f.x() - j(0, 0) * f.y()) * per_det / half.y()};
  }

  /// Newton from the middle's step; the chord with the middle's Jacobian, which contracts, where
  /// Newton leaves.
  bool pursue(const PatchBound& b, Vector2d x, double turn) {
    const Vector2d center = b.box.center();
    const Vector2d half = b.box.half();
    // Roots outside do not count: stay near.
    const auto stay = [&x] { x = x.cwiseMax(-1.5).cwiseMin(1.5); };
    stay();
    // On the second-order expansion, which costs little; its end is only where to begin.
    const Vector2d on_expansion = x + newton_step(expand(b.jet, x.cwiseProduct(half)), half);
    if (on_expansion.allFinite()) x = on_expansion;
    double before = std::numeric_limits<double>::infinity();
    for (int step = 0; step < kMostSteps; ++step) {
      stay();
      const SurfaceJet jet = index_.jet(b, center + x.cwiseProduct(half));
      Vector2d move = newton_step(jet, half);
      const double size = move.cwiseAbs().maxCoeff();
      const bool by_newton = size < 2 * before;
      if (!by_newton) {
        move = -(jacobian(b.jet) * half.asDiagonal()).inverse() * seen(jet.point);
        if (!(move.cwiseAbs().maxCoeff() < 4)) return false;
      }
      before = size;
      // Of Newton's: squared it is below rounding, and third derivatives do not count.
      constexpr double kLastStep = 1e-7;
      if (by_newton && size < kLastStep) {
        const Vector2d end = x + move;
        if (end.cwiseAbs().maxCoeff() > 1 + kEdge) return none_inside(b, turn, end);
        const Vector2d inside = end.cwiseMax(-1.0).cwiseMin(1.0);
        add(center + inside.cwiseProduct(half), expand(jet, (inside - x).cwiseProduct(half)).point,
            0, true);
        return true;
      }
      x += move;
    }
    return false;
  }

  /// Whether a root outside the box, at x, shows that there is none inside. From the nearest place
  /// c of the box, y = J^-1 F(c) leads to a root x* of the box up to k |c - x*|; with n pointing
  /// out of the box at c, (c - x*) . n >= 0, while y . n < 0. Both are possible only if y runs
  /// along the edge: |y . n| <= |y x n| k / sqrt(1 - k^2).
  bool none_inside(const PatchBound& b, double k, const Vector2d& x) const {
    const Matrix2d chord = (jacobian(b.jet) * b.box.half().asDiagonal()).inverse();
    const Vector2d c = x.cwiseMax(-1.0).cwiseMin(1.0);
    const Vector2d y =
        chord * seen(index_.jet(b, b.box.center() + c.cwiseProduct(b.box.half())).point);
    const std::array<double, 2> outwards = {x.x() == c.x() ? 0.0 : std::copysign(1.0, c.x()),
                                            x.y() == c.y() ? 0.0 : std::copysign(1.0, c.y())};
    if (outwards[0] != 0 && outwards[1] != 0) {
      return y.x() * outwards[0] < 0 && y.y() * outwards[1] < 0;
    }
    const double across = outwards[0] != 0 ? y.x() * outwards[0] : y.y() * outwards[1];
    const double along = outwards[0] != 0 ? y.y() : y.x();
    return across < -std::abs(along) * k / std::sqrt(1 - k * k);
  }

  void add(const Vector2d& parameter, const Vector3d& point, double run, bool certain) {
    const double t = (point - ray_.origin).dot(along_) * per_length_;
    if (!std::isfinite(t) || !parameter.allFinite()) {  // numbers overflowed
      found_.complete = false;
      return;
    }
    if (t < -kGeometric * per_length_ || t > most_ + kGeometric * per_length_) return;
    found_.hits.push_back({std::max(t, 0.0), parameter, point, run, certain});
    if (first_only_ && certain) most_ = std::min(most_, std::max(t, 0.0));
  }

  /// A patch that is flat to kGeometric and still not settled: the ray runs along it, or it is a
  /// sliver beside a pole. Met where the ray is over the parallelogram of its tangents.
  void touch(const PatchBound& b, const Passage& ray) {
    Interval t = ray.t;
    if (b.least_stretch > 0) {
      const Vector2d origin = b.flatten * ray.origin.head<2>();
      const Vector2d direction = b.flatten * ray.direction.head<2>();
      const double edge = 1 + kEdge + b.bending();
      for (Eigen::Index d = 0; d < 2; ++d) clip(origin[d], direction[d], -edge, edge, t);
      if (t.first > t.last) return;
    }
    const Vector2d x = b.flatten * (ray.origin + t.first * ray.direction).head<2>();
    const Vector2d at = b.box.center() + x.cwiseMax(-1.0).cwiseMin(1.0).cwiseProduct(b.box.half());
    const double run = (t.last - t.first) / per_length_;
    add(at, index_.jet(b, at).point, run > 10 * kGeometric ? run : 0.0, true);
  }

  void halve(Patch patch, const PatchBound& bound, const Passage& ray, int halvings) {
    // Flat, with even parameters: then the tangents in the middle tell all of it. A pole's cells
    // have none and end when they are small.
    constexpr double kEven = 1e-3;
    const bool flat =
        bound.frame_high.z() - bound.frame_low.z() <= 2 * kGeometric && bound.bending() <= kEven;
    if (flat || bound.reach <= kGeometric) {
      touch(bound, ray);
      return;
    }
    const int direction = wider_direction(bound);
    if (halvings == kMostHalvings || cells_ >= kMostCells || !patch.can_halve(direction)) {
      found_.complete = false;
      add(bound.box.center(), bound.jet.point, 0, false);
      return;
    }
    Patch after = patch.halve(direction);
    std::array<PatchBound, 2> bounds;
    std::array<Patch*, 2> patches = {&patch, &after};
    std::array<double, 2> distance{};
    for (std::size_t i = 0; i < 2; ++i) {
      bounds[i] = index_.bound(*patches[i]);
      distance[i] = (bounds[i].jet.point - ray_.origin).dot(along_);
    }
    const std::size_t near = distance[1] < distance[0] ? 1 : 0;
    for (const std::size_t i : {near, 1 - near}) {
      ++cells_;
      const Passage through = pass(bounds[i]);
      if (through.misses() || settle(bounds[i])) continue;
      halve(std::move(*patches[i]), bounds[i], through, halvings + 1);
    }
  }

  /// Ascending, one for each place: patches that share an edge both find what lies on it, and runs
  /// go on from patch to patch.
  void finish() {
    auto& hits = found_.hits;
    if (hits.size() < 2) return;
    std::sort(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) {
      if (a.t != b.t) return a.t < b.t;
      if (a.run != b.run) return a.run < b.run;
      return std::pair(a.parameter.x(), a.parameter.y()) <
             std::pair(b.parameter.x(), b.parameter.y());
    });
    std::vector<RayHit> kept;
    for (const RayHit& hit : hits) {
      constexpr double kNear = 10 * kGeometric;
      RayHit* known = nullptr;
      for (RayHit& k : kept) {
        const double beyond = (hit.t - k.t) / per_length_ - k.run;  // of the end of its run
        const bool same_place = (k.point - hit.point).norm() < kNear;
        // Ends of runs are known to a part of their length only; what crosses is no part of them.
        const double room = hit.run > 0 ? 0.5 * (k.run + hit.run) + kNear : kNear;
        if (same_place || (k.run > 0 && beyond < room)) known = &k;
      }
      if (known == nullptr) {
        kept.push_back(hit);
      } else {
        if (known->run > 0 || hit.run > 0) {
          known->run = std::max(known->run, (hit.t - known->t) / per_length_ + hit.run);
        }
        known->certain = known->certain && hit.certain;
      }
    }
    hits = std::move(kept);
  }

  const SurfaceIndex& index_;
  Ray ray_;
  bool first_only_;
  double most_;
  Vector3d along_;
  std::array<Vector3d, 2> across_;
  double per_length_ = 1;
  RayHits found_;
  int cells_ = 0;
};

}  // namespace

std::optional<RayHit> SurfaceIndex::first_hit(const Ray& ray) const {
  const RayHits found = RaySearch(*this, ray, true).run();
  if (found.hits.empty()) return std::nullopt;
  return found.hits.front();
}

RayHits SurfaceIndex::all_hits(const Ray& ray) const { return RaySearch(*this, ray, false).run(); }

}  // namespace limn
