#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "modeler/base/tolerance.hpp"
#include "modeler/surface/surface_index.hpp"

namespace limn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMostSteps = 40;  ///< of one Newton iteration
constexpr int kMostWalkSteps = 8;
constexpr int kMostHalvings = 100;  ///< of a leaf
constexpr int kMostCells = 4096;    ///< halves looked at in one query

double square(double x) { return x * x; }

/// Square of the distance from p to a box, 0 within.
double square_distance(const Vector3d& p, const Vector3d& low, const Vector3d& high) noexcept {
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
}

/// f = |S - p|^2 / 2 at a jet: gradient and Hessian.
///
///     f_u = r . S_u,   f_uu = S_u . S_u + r . S_uu,   f_uv = S_u . S_v + r . S_uv,   r = S - p.
struct Objective {
  Vector2d gradient;
  double uu, uv, vv;
};

Objective objective(const SurfaceJet& jet, const Vector3d& r) noexcept {
  return {{r.dot(jet.du), r.dot(jet.dv)},
          jet.du.dot(jet.du) + r.dot(jet.duu),
          jet.du.dot(jet.dv) + r.dot(jet.duv),
          jet.dv.dot(jet.dv) + r.dot(jet.dvv)};
}

/// Where the quadratic g . d + d H d / 2 is least for low <= d <= high. Its direction leads down,
/// which a step of Newton's that is cut off at the box need not do.
Vector2d least_step(const Objective& f, double det, const Vector2d& low,
                    const Vector2d& high) noexcept {
  const Vector2d free = Vector2d(f.uv * f.gradient.y() - f.vv * f.gradient.x(),
                                 f.uv * f.gradient.x() - f.uu * f.gradient.y()) /
                        det;
  if ((free.array() >= low.array()).all() && (free.array() <= high.array()).all()) return free;
  const auto value = [&f](const Vector2d& d) {
    return f.gradient.dot(d) + 0.5 * (f.uu * d.x() * d.x() + f.vv * d.y() * d.y()) +
           f.uv * d.x() * d.y();
  };
  Vector2d best(0, 0);
  double least = std::numeric_limits<double>::infinity();
  for (const double u : {low.x(), high.x()}) {
    const double v = std::clamp(-(f.gradient.y() + f.uv * u) / f.vv, low.y(), high.y());
    if (value({u, v}) < least) {
      best = {u, v};
      least = value(best);
    }
  }
  for (const double v : {low.y(), high.y()}) {
    const double u = std::clamp(-(f.gradient.x() + f.uv * v) / f.uu, low.x(), high.x());
    if (value({u, v}) < least) {
      best = {u, v};
      least = value(best);
    }
  }
  return best;
}

/// Whether f is strictly convex on all of the patch. In the coordinates that flatten the patch
/// (PatchBound::flatten) the Hessian is J^T J + Q, Q_ab = r . S_ab. The first part is at least
/// (1 - t)^2, where the tangents change by t along the tangent plane (off it, they only add); Q is
/// that of the middle but for what the reaches allow.
bool is_convex(const PatchBound& b, const Vector3d& r) noexcept {
  if (!(b.turn_along < b.least_stretch)) return false;
  const Vector2d half = b.box.half();
  Eigen::Matrix2d q;
  q(0, 0) = r.dot(b.jet.duu) * half.x() * half.x();
  q(0, 1) = q(1, 0) = r.dot(b.jet.duv) * half.x() * half.y();
  q(1, 1) = r.dot(b.jet.dvv) * half.y() * half.y();
  q = b.flatten.transpose() * q * b.flatten;
  const double least_q =
      0.5 * (q(0, 0) + q(1, 1)) - std::sqrt(square(0.5 * (q(0, 0) - q(1, 1))) + square(q(0, 1)));
  const double off = std::abs(r.dot(b.frame.col(2)));
  const double along = std::sqrt(std::max(0.0, r.squaredNorm() - off * off));
  const double change = off * b.second_reach_off + along * b.second_reach_along +
                        b.along.point * (b.second_along + b.second_reach_along) +
                        b.off.point * (b.second_off + b.second_reach_off);
  return square(1 - b.turn_along / b.least_stretch) + least_q - change / square(b.least_stretch) >
         0;
}

class ClosestSearch {
 public:
  ClosestSearch(const SurfaceIndex& index, const Vector3d& p) : index_(index), p_(p) {}

  ClosestPoint run() {
    if (index_.nodes().empty()) {
      for (std::int32_t i = 0; i < std::ssize(index_.leaves()); ++i) visit_leaf(i);
    } else {
      walk();
      visit_nodes();
    }
    settle_later();
    const double distance = std::sqrt(best_);
    if (!std::isfinite(distance)) return beyond_numbers();
    return {parameter_, point_, distance, std::max(0.0, distance - abandoned_)};
  }

 private:
  /// Where squares of distances overflow: any point, and no claim.
  ClosestPoint beyond_numbers() const {
    const BsplineSurface& surface = index_.surface();
    const Vector2d at(surface.knots(0).domain_begin(), surface.knots(1).domain_begin());
    const Vector3d point = index_.evaluator().point(at.x(), at.y());
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {at, point, (point - p_).stableNorm(), kInfinity};
  }

  struct Waiting {
    double square;
    std::int32_t node;
  };
  struct Later {
    double square;
    const PatchBound* leaf;
  };

  void visit_nodes() {
    std::array<Waiting, 64> stack;  // deeper than any tree of int32 leaves that halves at each node
    std::size_t size = 0;
    stack[size++] = {0, 0};
    while (size > 0) {
      const Waiting next = stack[--size];
      if (next.square >= best_) continue;
      if (next.node < 0) {
        visit_leaf(~next.node);
        continue;
      }
      const auto& node = index_.nodes()[static_cast<std::size_t>(next.node)];
      const std::array<double, 2> d = {square_distance(p_, node.low[0], node.high[0]),
                                       square_distance(p_, node.low[1], node.high[1])};
      const std::size_t near = d[1] < d[0] ? 1 : 0;
      stack[size++] = {d[1 - near], node.child[1 - near]};
      stack[size++] = {d[near], node.child[near]};
    }
  }

  /// From the leaf that seems nearest by Newton's iteration over the whole surface, wherever it
  /// leads: proves nothing, but a good first answer spares most of the search.
  void walk() {
    std::int32_t at = 0;
    while (at >= 0) {
      const auto& node = index_.nodes()[static_cast<std::size_t>(at)];
      const auto far = [&](std::size_t i) {
        return square_distance(p_, node.low[i], node.high[i]) +
               1e-3 * (node.low[i] + node.high[i] - 2 * p_).squaredNorm();
      };
      at = node.child[far(1) < far(0) ? 1 : 0];
    }
    const PatchBound& leaf = index_.leaves()[static_cast<std::size_t>(~at)];
    const BsplineSurface& surface = index_.surface();
    const Vector2d low(surface.knots(0).domain_begin(), surface.knots(1).domain_begin());
    const Vector2d high(surface.knots(0).domain_end(), surface.knots(1).domain_end());
    Vector2d place = leaf.box.center();
    SurfaceJet jet = leaf.jet;
    for (int step = 0; step < kMostWalkSteps; ++step) {
      const Vector3d r = jet.point - p_;
      const double f = r.squaredNorm();
      if (f >= best_) return;
      best_ = f;
      parameter_ = place;
      point_ = jet.point;
      Objective here = objective(jet, r);
      double det = here.uu * here.vv - here.uv * here.uv;
      if (!(here.uu > 0 && det > 0)) {  // Gauss-Newton leads down where Newton does not
        here.uu = jet.du.squaredNorm();
        here.uv = jet.du.dot(jet.dv);
        here.vv = jet.dv.squaredNorm();
        det = here.uu * here.vv - here.uv * here.uv;
        if (!(det > 0)) return;
      }
      const Vector2d next = place + least_step(here, det, low - place, high - place);
      if ((next - place).cwiseAbs().cwiseQuotient(leaf.box.half()).maxCoeff() < 1e-6) return;
      place = next;
      jet = index_.evaluator().jet(place.x(), place.y());
    }
  }

  /// No point of the patch is nearer; squared.
  double least_square(const PatchBound& bound, const Vector3d& r) const noexcept {
    const Vector3d local = bound.frame.transpose() * -r;
    return square_distance(local, bound.frame_low, bound.frame_high);
  }

  void visit_leaf(std::int32_t number) {
    const auto& box = index_.boxes()[static_cast<std::size_t>(number)];
    const double least = square_distance(box.axes * (p_ - box.middle), box.low, box.high);
    if (least >= best_) return;
    const PatchBound& leaf = index_.leaves()[static_cast<std::size_t>(number)];
    if (settle(leaf, leaf.jet.point - p_)) return;
    // Halving is dear, and what other leaves hold may spare it.
    keep_if_better(leaf);
    later_.push_back({least, &leaf});
  }

  void settle_later() {
    std::sort(later_.begin(), later_.end(), [](const Later& a, const Later& b) {
      return a.square != b.square ? a.square < b.square : a.leaf < b.leaf;
    });
    for (const Later& next : later_) {
      if (next.square >= best_) return;
      Patch patch = index_.patch(*next.leaf);
      if (!cannot_be_nearer(patch)) halve(std::move(patch), *next.leaf, 0);
    }
  }

  /// Finds the least distance of a patch where f is known to be convex; false where it is not.
  bool settle(const PatchBound& bound, const Vector3d& r) {
    if (!is_convex(bound, r)) return false;
    // From the best place if it is near: on the edge towards it, where the least is likely.
    const ParameterBox& box = bound.box;
    const Vector2d edge = parameter_.cwiseMax(box.low).cwiseMin(box.high);
    if ((edge - parameter_).cwiseAbs().cwiseQuotient(box.half()).maxCoeff() < 4) {
      return descend(bound, edge, index_.jet(bound, edge));
    }
    return descend(bound, box.center(), bound.jet);
  }

  /// Newton's iteration on f within a box, in which f is convex; keeps what is better than the
  /// best. Whether it converged.
  bool descend(const PatchBound& bound, Vector2d at, SurfaceJet jet) {
    const ParameterBox& box = bound.box;
    double before = std::numeric_limits<double>::infinity();
    Vector2d last = at;
    for (int step = 0; step < kMostSteps; ++step) {
      const Vector3d r = jet.point - p_;
      const double f = r.squaredNorm();
      if (f < best_) {
        best_ = f;
        parameter_ = at;
        point_ = jet.point;
      }
      if (f > before) {                         // too far: half way back
        constexpr double kRoundingStep = 1e-7;  // a step that only rounding can make worse
        if ((at - last).cwiseAbs().cwiseQuotient(box.half()).maxCoeff() < kRoundingStep)
          return true;
        at = 0.5 * (at + last);
        jet = index_.jet(bound, at);
        continue;
      }
      before = f;
      last = at;
      const Objective here = objective(jet, r);
      // A convex f lies above its tangent plane: nothing in the box may be nearer.
      double least = f;
      for (Eigen::Index d = 0; d < 2; ++d) {
        least += 2 * std::min(here.gradient[d] * (box.low[d] - at[d]),
                              here.gradient[d] * (box.high[d] - at[d]));
      }
      constexpr double kRoundingOfDistance = 1e-13;  // mm: what the walk has left
      if (least >= best_ - kRoundingOfDistance * std::sqrt(best_)) return true;
      const double det = here.uu * here.vv - here.uv * here.uv;
      if (!(here.uu > 0 && det > 0)) return false;
      const Vector2d next = at + least_step(here, det, box.low - at, box.high - at);
      const Vector2d moved = next - at;
      at = next;
      // Quadratic convergence: what a step of this size leaves is below rounding.
      constexpr double kLastStep = 1e-6;
      const bool last_one = moved.cwiseAbs().cwiseQuotient(box.half()).maxCoeff() < kLastStep;
      jet = index_.jet(bound, at);
      if (last_one) {
        const double end = (jet.point - p_).squaredNorm();
        if (end < best_) {
          best_ = end;
          parameter_ = at;
          point_ = jet.point;
        }
        return true;
      }
    }
    return false;
  }

  void halve(Patch patch, const PatchBound& bound, int halvings) {
    const int direction = direction_to_halve(bound);
    if (halvings == kMostHalvings || cells_ >= kMostCells || !patch.can_halve(direction)) {
      give_up(bound);
      return;
    }
    Patch after = patch.halve(direction);
    // The nearer half first: what it finds may spare the other.
    PatchBound bounds[2];
    double least[2];
    Patch* patches[2] = {&patch, &after};
    for (int i = 0; i < 2; ++i) {
      bounds[i] = index_.bound(*patches[i]);
      least[i] = least_square(bounds[i], bounds[i].jet.point - p_);
    }
    const int near = least[1] < least[0] ? 1 : 0;
    for (const int i : {near, 1 - near}) {
      if (least[i] >= best_) continue;
      ++cells_;
      const Vector3d r = bounds[i].jet.point - p_;
      if (settle(bounds[i], r)) continue;
      keep_if_better(bounds[i]);
      if (cannot_be_nearer(*patches[i])) continue;
      halve(std::move(*patches[i]), bounds[i], halvings + 1);
    }
  }

  void keep_if_better(const PatchBound& bound) {
    const double f = (bound.jet.point - p_).squaredNorm();
    if (f >= best_) return;
    best_ = f;
    parameter_ = bound.box.center();
    point_ = bound.jet.point;
  }

  void give_up(const PatchBound& bound) {
    abandoned_ = std::min(abandoned_, std::sqrt(least_square(bound, bound.jet.point - p_)));
  }

  /// Across the direction in which the distance changes more, where ties run along the other.
  int direction_to_halve(const PatchBound& bound) const {
    const Vector3d r = bound.jet.point - p_;
    const Objective middle = objective(bound.jet, r);
    const Vector2d half = bound.box.half();
    const double u =
        std::abs(middle.gradient.x()) * half.x() + std::abs(middle.uu) * square(half.x());
    const double v =
        std::abs(middle.gradient.y()) * half.y() + std::abs(middle.vv) * square(half.y());
    if (u > 2 * v) return 0;
    if (v > 2 * u) return 1;
    return wider_direction(bound);
  }

  /// Whether |A - w p|^2 >= (best - kGeometric)^2 w^2 on the patch: all Bernstein coefficients of
  /// the difference are 0 or more. This is sharp where the distance is the same all over, as from a
  /// sphere's centre.
  bool cannot_be_nearer(const Patch& patch) {
    const double within = std::max(0.0, std::sqrt(best_) - kGeometric);
    const int nu = patch.shape.count[0];
    const int nv = patch.shape.count[1];
    // In the scaled Bernstein basis, binom(p, i) times a coefficient, products are convolutions.
    scaled_.clear();
    double in_v = 1;
    for (int j = 0; j < nv; ++j) {
      double in_u = in_v;
      for (int i = 0; i < nu; ++i) {
        const double* x = patch.net.data() + 4 * (i + nu * j);
        scaled_.emplace_back(x[0] - x[3] * p_.x(), x[1] - x[3] * p_.y(), x[2] - x[3] * p_.z(),
                             x[3] * within);
        scaled_.back() *= in_u;
        in_u = in_u * (nu - 1 - i) / (i + 1);
      }
      in_v = in_v * (nv - 1 - j) / (j + 1);
    }
    for (int k = 0; k <= 2 * (nu - 1); ++k) {
      for (int l = 0; l <= 2 * (nv - 1); ++l) {
        double sum = 0;
        for (int j = std::max(0, l - nv + 1); j <= std::min(l, nv - 1); ++j) {
          for (int i = std::max(0, k - nu + 1); i <= std::min(k, nu - 1); ++i) {
            const Eigen::Vector4d& a = scaled_[static_cast<std::size_t>(i + nu * j)];
            const Eigen::Vector4d& b = scaled_[static_cast<std::size_t>(k - i + nu * (l - j))];
            sum += a.x() * b.x() + a.y() * b.y() + a.z() * b.z() - a.w() * b.w();
          }
        }
        if (sum < 0) return false;
      }
    }
    abandoned_ = std::min(abandoned_, within);
    return true;
  }

  const SurfaceIndex& index_;
  Vector3d p_;
  double best_ = std::numeric_limits<double>::infinity();
  Vector2d parameter_ = Vector2d::Constant(std::numeric_limits<double>::infinity());
  Vector3d point_ = Vector3d::Zero();
  double abandoned_ = std::numeric_limits<double>::infinity();  ///< least distance not searched
  std::vector<Later> later_;
  std::vector<Eigen::Vector4d> scaled_;
  int cells_ = 0;
};

}  // namespace

ClosestPoint SurfaceIndex::closest_point(const Vector3d& p) const {
  return ClosestSearch(*this, p).run();
}

}  // namespace limn
