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

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMostSteps = 40;  ///< of one Newton iteration
constexpr int kMostWalkSteps = 8;
constexpr int kMostHalvings = 100;             ///< of a leaf
constexpr int kMostCells = 4096;               ///< halves looked at in one query
constexpr double kLastStep = 1e-6;             ///< of an iteration, in half sides
constexpr double kRoundingOfDistance = 1e-13;  ///< mm: what an iteration leaves

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

  double determinant() const noexcept { return uu * vv - uv * uv; }
};

/// Written out, for here the compiler's vectors of two cost more than they save.
double dot(const Vector3d& a, const Vector3d& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Objective objective(const SurfaceJet& jet, const Vector3d& r) noexcept {
  return {{dot(r, jet.du), dot(r, jet.dv)},
          dot(jet.du, jet.du) + dot(r, jet.duu),
          dot(jet.du, jet.dv) + dot(r, jet.duv),
          dot(jet.dv, jet.dv) + dot(r, jet.dvv)};
}

bool contains(const ParameterBox& box, const Vector2d& at) noexcept {
  return at.x() >= box.low.x() && at.x() <= box.high.x() && at.y() >= box.low.y() &&
         at.y() <= box.high.y();
}

/// The larger part of a distance in half sides of a box.
double part_of(const Vector2d& distance, const Vector2d& half) noexcept {
  return std::max(std::abs(distance.x()) / half.x(), std::abs(distance.y()) / half.y());
}

/// Where the quadratic g . d + d H d / 2 is least for low <= d <= high. Its direction leads down,
/// which a step of Newton's that is cut off at the box need not do.
Vector2d least_step(const Objective& f, const Vector2d& low, const Vector2d& high) noexcept {
  const double per_det = 1 / f.determinant();
  Vector2d free((f.uv * f.gradient.y() - f.vv * f.gradient.x()) * per_det,
                (f.uv * f.gradient.x() - f.uu * f.gradient.y()) * per_det);
  if (contains({low, high}, free)) return free;
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

/// A lower bound of the curvature of f on all of the patch, in the coordinates that flatten it
/// (PatchBound::flatten); f is strictly convex where it is positive. The Hessian there is J^T J +
/// Q, Q_ab = r . S_ab. The first part is at least (1 - t)^2, where the tangents change by t along
/// the tangent plane (off it, they only add); Q is that of the middle but for what the reaches
/// allow.
double least_curvature(const PatchBound& b, const Vector3d& r) noexcept {
  if (!(b.turn_along < b.least_stretch)) return -1;
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
  return square(1 - b.turn_along / b.least_stretch) + least_q - change / square(b.least_stretch);
}

/// What |S - p|^2 may fall by within the patch from a place in it where f has that gradient, at
/// most: f lies above g . d + k |y|^2 / 2, y being d flattened and k the least curvature, and where
/// the place is on an edge that f falls towards, above that without this part of g.
double most_descent(const PatchBound& b, const Vector2d& at, const Vector2d& gradient,
                    double curvature) noexcept {
  Vector2d g = gradient.cwiseProduct(b.box.half());
  double linear = 0;
  for (Eigen::Index d = 0; d < 2; ++d) {
    const double room = gradient[d] > 0 ? at[d] - b.box.low[d] : b.box.high[d] - at[d];
    if (room <= 0) g[d] = 0;
    linear += 2 * std::abs(gradient[d]) * room;
  }
  return std::min(linear, (b.flatten.transpose() * g).squaredNorm() / curvature);
}

class ClosestSearch {
 public:
  ClosestSearch(const SurfaceIndex& index, const Vector3d& p) : index_(index), p_(p) {}

  ClosestPoint run() {
    if (index_.nodes().empty()) {
      for (std::int32_t i = 0; i < std::ssize(index_.leaves()); ++i) visit_leaf(i);
    } else {
      search();
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
  /// Children of a node, by their distances.
  using Squares = std::array<double, BoxNode::kWidth>;

  /// Deeper than any tree of int32 leaves, which has up to 8 children a node.
  static constexpr std::size_t kMostDepth = 11;

  void search() {
    // Down to the leaf that seems nearest, and from it to a first answer, which spares most of the
    // search; then everything beside the way down, from the bottom up.
    struct Step {
      const BoxNode* node;
      Squares square;
    };
    std::array<Step, kMostDepth> way;
    std::size_t depth = 0;
    std::int32_t at = 0;
    while (at >= 0) {
      Step& step = way[depth++];
      step.node = &index_.nodes()[static_cast<std::size_t>(at)];
      const std::size_t next = step.node->nearest_child(p_, step.square.data());
      at = step.node->child[next];
      if (at >= 0) step.square[next] = std::numeric_limits<double>::infinity();  // not again
    }
    walk(~at);
    for (std::size_t i = 0; i < depth; ++i) {
      unsigned nearer = 0;
      for (unsigned k = 0; k < BoxNode::kWidth; ++k) {
        nearer |= static_cast<unsigned>(way[i].square[k] < best_) << k;
      }
      push_children(*way[i].node, way[i].square, nearer);
    }
    while (size_ > 0) {
      const Waiting next = stack_[--size_];
      if (next.square >= best_) continue;
      if (next.node < 0) {
        visit_leaf(~next.node);
        continue;
      }
      const BoxNode& node = index_.nodes()[static_cast<std::size_t>(next.node)];
      Squares square;
      push_children(node, square, node.square_distances(p_, best_, square.data()));
    }
  }

  /// Those of `which`, bit i for child i, the nearest on top.
  void push_children(const BoxNode& node, const Squares& square, unsigned which) noexcept {
    const std::size_t bottom = size_;
    for (; which != 0; which &= which - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(which));
      index_.prefetch(node.child[i]);
      std::size_t to = size_++;
      for (; to > bottom && stack_[to - 1].square < square[i]; --to) stack_[to] = stack_[to - 1];
      stack_[to] = {square[i], node.child[i]};
    }
  }

  /// From the middle of a leaf by Newton's iteration over the whole surface, wherever it leads:
  /// proves nothing.
  void walk(std::int32_t number) {
    const PatchBound& leaf = index_.leaves()[static_cast<std::size_t>(number)];
    const BsplineSurface& surface = index_.surface();
    const Vector2d low(surface.knots(0).domain_begin(), surface.knots(1).domain_begin());
    const Vector2d high(surface.knots(0).domain_end(), surface.knots(1).domain_end());
    const Vector2d half = leaf.box.half();
    std::array<int, 2> spans = leaf.spans;
    ParameterBox piece = leaf.box;
    Vector2d place = leaf.box.center();
    keep(place, leaf.jet.point);
    Objective here = objective(leaf.jet, leaf.jet.point - p_);
    if (!make_definite(here, leaf.jet)) return;
    // The first step is of the leaf's own jet, and no farther than that is good for.
    place +=
        least_step(here, (-1.5 * half).cwiseMax(low - place), (1.5 * half).cwiseMin(high - place));
    for (int step = 0; step < kMostWalkSteps; ++step) {
      if (!contains(piece, place)) {
        spans = {surface.knots(0).find_span(place.x()), surface.knots(1).find_span(place.y())};
        for (std::size_t d = 0; d < 2; ++d) {
          const double* knot = surface.knots(static_cast<int>(d)).values().data() + spans[d];
          piece.low[static_cast<Eigen::Index>(d)] = knot[0];
          piece.high[static_cast<Eigen::Index>(d)] = knot[1];
        }
      }
      const SurfaceJet jet = index_.evaluator().jet_in_spans(spans, place.x(), place.y());
      const Vector3d r = jet.point - p_;
      if (r.squaredNorm() >= best_) return;
      keep(place, jet.point);
      here = objective(jet, r);
      if (!make_definite(here, jet)) return;
      const Vector2d moved = least_step(here, low - place, high - place);
      if (part_of(moved, half) < kLastStep && contains(piece, place + moved)) {
        return finish(spans, place, moved, jet);
      }
      place += moved;
    }
  }

  /// Gauss-Newton leads down where Newton does not. False where neither does.
  static bool make_definite(Objective& f, const SurfaceJet& jet) noexcept {
    if (f.uu > 0 && f.determinant() > 0) return true;
    f.uu = jet.du.squaredNorm();
    f.uv = jet.du.dot(jet.dv);
    f.vv = jet.dv.squaredNorm();
    return f.determinant() > 0;
  }

  bool keep(const Vector2d& place, const Vector3d& point) noexcept {
    const double f = (point - p_).squaredNorm();
    if (f >= best_) return false;
    best_ = f;
    parameter_ = place;
    point_ = point;
    spans_ = {-1, -1};
    return true;
  }

  /// The last step of an iteration on the piece of `spans`. Convergence is quadratic, so that what
  /// it leaves is below rounding, and it is so short that third derivatives do not count.
  void finish(const std::array<int, 2>& spans, const Vector2d& place, const Vector2d& moved,
              const SurfaceJet& jet) noexcept {
    const SurfaceJet end = expand(jet, moved);
    if (!keep(place + moved, end.point)) return;
    gradient_ = objective(end, end.point - p_).gradient;
    spans_ = spans;
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
    keep(leaf.box.center(), leaf.jet.point);
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
    const double curvature = least_curvature(bound, r);
    if (!(curvature > 0)) return false;
    const ParameterBox& box = bound.box;
    // From the best place if it is near: on the edge towards it, where the least is likely.
    const Vector2d edge = parameter_.cwiseMax(box.low).cwiseMin(box.high);
    if (spans_[0] == bound.spans[0] && spans_[1] == bound.spans[1] && edge == parameter_ &&
        most_descent(bound, edge, gradient_, curvature) <= kRoundingOfDistance * std::sqrt(best_)) {
      return true;  // it is the best of this patch
    }
    if (part_of(edge - parameter_, box.half()) < 4) {
      return descend(bound, curvature, edge, index_.jet(bound, edge));
    }
    return descend(bound, curvature, box.center(), bound.jet);
  }

  /// Newton's iteration on f within a box, in which f is convex; keeps what is better than the
  /// best. Whether it converged.
  bool descend(const PatchBound& bound, double curvature, Vector2d at, SurfaceJet jet) {
    const ParameterBox& box = bound.box;
    double before = std::numeric_limits<double>::infinity();
    Vector2d last = at;
    for (int step = 0; step < kMostSteps; ++step) {
      const Vector3d r = jet.point - p_;
      const double f = r.squaredNorm();
      keep(at, jet.point);
      if (f > before) {                         // too far: half way back
        constexpr double kRoundingStep = 1e-7;  // a step that only rounding can make worse
        if (part_of(at - last, box.half()) < kRoundingStep) return true;
        at = 0.5 * (at + last);
        jet = index_.jet(bound, at);
        continue;
      }
      before = f;
      last = at;
      const Objective here = objective(jet, r);
      // Where nothing in the box is nearer than the best; the best itself is looked for to the end.
      if (at != parameter_ && f - most_descent(bound, at, here.gradient, curvature) >=
                                  best_ - kRoundingOfDistance * std::sqrt(best_)) {
        return true;
      }
      if (!(here.uu > 0 && here.determinant() > 0)) return false;
      const Vector2d moved = least_step(here, box.low - at, box.high - at);
      if (part_of(moved, box.half()) < kLastStep) {
        finish(bound.spans, at, moved, jet);
        return true;
      }
      at += moved;
      jet = index_.jet(bound, at);
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
      keep(bounds[i].box.center(), bounds[i].jet.point);
      if (cannot_be_nearer(*patches[i])) continue;
      halve(std::move(*patches[i]), bounds[i], halvings + 1);
    }
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
  /// Where the best place is the end of an iteration: the spans of its piece and the gradient
  /// there.
  std::array<int, 2> spans_ = {-1, -1};
  Vector2d gradient_ = Vector2d::Zero();
  std::array<Waiting, BoxNode::kWidth * kMostDepth> stack_;
  std::size_t size_ = 0;
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
