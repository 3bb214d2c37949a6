#include "modeler/surface/curve_crossings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "modeler/base/tolerance.hpp"
#include "modeler/bspline/refine.hpp"
#include "modeler/bspline/roots.hpp"

namespace limn {
namespace {

constexpr int kMostHalvings = 60;
constexpr int kMostPairs = 20'000;
constexpr int kMostSteps = 20;  ///< of Newton's iteration

/// A part of a curve in Bézier form: Cartesian control points times their weights, and the weights.
template <int kDimension>
struct Arc {
  using Point = Eigen::Matrix<double, kDimension, 1>;
  double low = 0;
  double high = 0;
  std::vector<Point> net;  ///< w P
  std::vector<double> weights;

  Point control(std::size_t i) const { return net[i] / weights[i]; }

  /// Point and derivative in x, 0 to 1 over the part.
  std::pair<Point, Point> at(double x) const {
    std::vector<Point> a = net;
    std::vector<double> w = weights;
    std::size_t left = a.size();
    for (; left > 2; --left) {
      for (std::size_t i = 0; i + 1 < left; ++i) {
        a[i] += x * (a[i + 1] - a[i]);
        w[i] += x * (w[i + 1] - w[i]);
      }
    }
    if (left == 1) return {a[0] / w[0], Point(Point::Zero())};
    const auto degree = static_cast<double>(net.size() - 1);
    const Point d = degree * (a[1] - a[0]);
    const double dw = degree * (w[1] - w[0]);
    const double weight = w[0] + x * (w[1] - w[0]);
    const Point point = (a[0] + x * (a[1] - a[0])) / weight;
    return {point, (d - dw * point) / weight};
  }

  Arc halve() {
    Arc after{low + 0.5 * (high - low), high, net, weights};
    const std::size_t n = net.size();
    std::vector<Point> line = net;
    std::vector<double> w = weights;
    for (std::size_t level = 0; level < n; ++level) {
      net[level] = line[0];
      weights[level] = w[0];
      after.net[n - 1 - level] = line[n - 1 - level];
      after.weights[n - 1 - level] = w[n - 1 - level];
      for (std::size_t i = 0; i + 1 < n - level; ++i) {
        line[i] = 0.5 * (line[i] + line[i + 1]);
        w[i] = 0.5 * (w[i] + w[i + 1]);
      }
    }
    high = after.low;
    return after;
  }

  bool has_positive_weights() const {
    return std::all_of(weights.begin(), weights.end(), [](double w) { return w > 0; });
  }
  double parameter(double x) const { return low + x * (high - low); }
};

/// The curve's Bézier parts, halved until their weights are positive. None where numbers overflow.
template <int kDimension>
std::optional<std::vector<Arc<kDimension>>> arcs_of(const BsplineCurve<kDimension>& curve) {
  const auto bezier = to_bezier(curve, 0);
  if (!bezier) return std::nullopt;
  std::vector<Arc<kDimension>> out;
  const int p = bezier->knots().degree();
  const auto ends = bezier->knots().breakpoints();
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    Arc<kDimension> arc{ends[i], ends[i + 1], {}, {}};
    const auto first = static_cast<std::size_t>(bezier->knots().find_span(ends[i]) - p);
    for (std::size_t k = first; k <= first + static_cast<std::size_t>(p); ++k) {
      arc.weights.push_back(bezier->weight(k));
      arc.net.push_back(bezier->weight(k) * bezier->control_points()[k]);
    }
    std::vector<Arc<kDimension>> open = {std::move(arc)};
    while (!open.empty()) {
      Arc<kDimension> next = std::move(open.back());
      open.pop_back();
      if (next.has_positive_weights() || next.high - next.low < 1e-12 * (ends[i + 1] - ends[i])) {
        out.push_back(std::move(next));
        continue;
      }
      Arc<kDimension> after = next.halve();
      open.push_back(std::move(after));
      open.push_back(std::move(next));
    }
  }
  return out;
}

/// What the control points say of a part.
template <int kDimension>
struct Hull {
  using Point = Eigen::Matrix<double, kDimension, 1>;
  Point low;
  Point high;
  Point chord;  ///< from the first control point to the last
  /// How far points are from those that run evenly along the chord: from the line at equal x.
  double unevenness = 0;
  double cosine = 1;  ///< of the largest angle between a leg and the chord, for straight parts

  explicit Hull(const Arc<kDimension>& arc) {
    low = high = arc.control(0);
    const std::size_t n = arc.net.size();
    chord = arc.control(n - 1) - arc.control(0);
    const double length = chord.norm();
    for (std::size_t i = 0; i < n; ++i) {
      const Point p = arc.control(i);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
      // The line in the same form; unequal weights shift points along it by as much of it at most.
      const double x = n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0.0;
      const double weight = std::abs(arc.weights[i] / arc.weights[0] - 1);
      unevenness =
          std::max(unevenness, (p - arc.control(0) - x * chord).norm() + 2 * weight * length);
    }
    // A rational part's derivative is a positive combination of P_j - P_i, i < j.
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        const Point leg = arc.control(j) - arc.control(i);
        const double size = leg.norm();
        if (!(size > 0) || !(length > 0)) continue;
        cosine = std::min(cosine, leg.dot(chord) / (size * length));
      }
    }
    if (!(length > 0)) cosine = -1;
  }
};

template <int kDimension>
bool apart(const Hull<kDimension>& a, const Hull<kDimension>& b) {
  return ((a.low - b.high).array() > kGeometric).any() ||
         ((b.low - a.high).array() > kGeometric).any();
}

template <int kDimension>
class CrossingSearch {
 public:
  using Point = Eigen::Matrix<double, kDimension, 1>;
  using OneArc = Arc<kDimension>;
  using OneHull = Hull<kDimension>;

  CurveCrossings run(const BsplineCurve<kDimension>& first,
                     const BsplineCurve<kDimension>& second) {
    const auto ones = arcs_of(first);
    const auto others = arcs_of(second);
    if (!ones || !others) return {{}, false};
    for (const OneArc& a : *ones) {
      for (const OneArc& b : *others) visit(a, b, 0);
    }
    merge();
    return std::move(found_);
  }

 private:
  /// Where a crossing is, and how long the parts are that touch there: they say no more.
  struct Place {
    Point point;
    double reach;
    Point end;  ///< where the touch ends: what crosses there is part of it
  };

  void visit(const OneArc& a, const OneArc& b, int halvings) {
    const OneHull ha(a);
    const OneHull hb(b);
    if (apart(ha, hb)) return;
    if (crosses_once(ha, hb) && newton(a, b)) return;
    if ((ha.unevenness <= 0.5 * kGeometric && hb.unevenness <= 0.5 * kGeometric) ||
        halvings >= kMostHalvings) {
      touch(a, b, ha, hb);
      return;
    }
    if (++pairs_ > kMostPairs) {
      found_.complete = false;
      return;
    }
    const bool first = (ha.high - ha.low).norm() >= (hb.high - hb.low).norm();  // the longer one
    OneArc part = first ? a : b;
    const OneArc after = part.halve();
    if (first) {
      visit(part, b, halvings + 1);
      visit(after, b, halvings + 1);
    } else {
      visit(a, part, halvings + 1);
      visit(a, after, halvings + 1);
    }
  }

  /// Directions are within a cone about each chord; where the cones do not meet, nor one the
  /// other's opposite, the difference of the curves is never zero twice.
  static bool crosses_once(const OneHull& a, const OneHull& b) {
    if (!(a.cosine > 0.5 && b.cosine > 0.5)) return false;
    const double cosine = std::abs(a.chord.dot(b.chord)) / (a.chord.norm() * b.chord.norm());
    return std::acos(std::min(cosine, 1.0)) > std::acos(a.cosine) + std::acos(b.cosine);
  }

  /// The one crossing of two parts, if it is inside; false where the iteration tells nothing.
  bool newton(const OneArc& a, const OneArc& b) {
    double x = 0.5;
    double y = 0.5;
    for (int step = 0; step < kMostSteps; ++step) {
      const auto [p, dp] = a.at(x);
      const auto [q, dq] = b.at(y);
      const Point r = q - p;
      // Least squares: dp dx - dq dy = r.
      const double aa = dp.squaredNorm();
      const double bb = dq.squaredNorm();
      const double ab = dp.dot(dq);
      const double det = aa * bb - ab * ab;
      if (!(det > 1e-12 * aa * bb)) return false;
      const double ra = dp.dot(r);
      const double rb = dq.dot(r);
      const double dx = (bb * ra - ab * rb) / det;
      const double dy = (ab * ra - aa * rb) / det;
      if (std::abs(dx) < 1e-13 && std::abs(dy) < 1e-13) {
        constexpr double kEdge = 1e-9;
        if (x < -kEdge || x > 1 + kEdge || y < -kEdge || y > 1 + kEdge) return false;
        if (r.norm() > kGeometric) return false;
        found_.crossings.push_back(
            {a.parameter(std::clamp(x, 0.0, 1.0)), b.parameter(std::clamp(y, 0.0, 1.0)), 0});
        places_.push_back({p, 0, p});
        return true;
      }
      x = std::clamp(x + dx, -0.5, 1.5);
      y = std::clamp(y + dy, -0.5, 1.5);
    }
    return false;
  }

  /// Two straight parts that are near each other: the stretch of the first that is.
  void touch(const OneArc& a, const OneArc& b, const OneHull& ha, const OneHull& hb) {
    const Point a0 = a.control(0);
    const Point b0 = b.control(0);
    const double length_a = ha.chord.norm();
    const double length_b = hb.chord.norm();
    // Parameters along a's chord where b's ends are nearest, and how far off.
    const auto along = [&](const Point& p) {
      return length_a > 0 ? (p - a0).dot(ha.chord) / (length_a * length_a) : 0.0;
    };
    const double first = along(b0);
    const double last = along(b0 + hb.chord);
    const double low = std::clamp(std::min(first, last), 0.0, 1.0);
    const double high = std::clamp(std::max(first, last), 0.0, 1.0);
    const auto distance = [&](double x) {
      const Point p = a0 + x * ha.chord;
      const double y =
          length_b > 0 ? std::clamp((p - b0).dot(hb.chord) / (length_b * length_b), 0.0, 1.0) : 0.0;
      return std::pair((p - b0 - y * hb.chord).norm(), y);
    };
    const auto [d_low, y_low] = distance(low);
    const auto [d_high, y_high] = distance(high);
    constexpr double kNear = 2 * kGeometric;  // both are up to half of it off their chords
    if (std::min(d_low, d_high) > kNear) {
      // Nearly parallel, they may cross between: d changes linearly along both.
      const Point from = a0 + low * ha.chord - b0;
      const Point to = a0 + high * ha.chord - b0;
      const Point along_b = length_b > 0 ? Point(hb.chord / length_b) : Point(Point::Zero());
      const Point off_low = from - from.dot(along_b) * along_b;
      const Point change = to - to.dot(along_b) * along_b - off_low;
      const double square = change.squaredNorm();
      if (!(square > 0)) return;
      const double part = std::clamp(-off_low.dot(change) / square, 0.0, 1.0);
      const double between = low + part * (high - low);
      const auto [d, y] = distance(between);
      if (d > kNear) return;
      found_.crossings.push_back({a.parameter(between), b.parameter(y), 0});
      const Point p = a0 + between * ha.chord;
      places_.push_back({p, 0, p});
      return;
    }
    const bool both = d_low <= kNear && d_high <= kNear;
    const double x = d_low <= kNear ? low : high;
    const double y = d_low <= kNear ? y_low : y_high;
    const double run = both ? (high - low) * length_a : 0.0;
    found_.crossings.push_back({a.parameter(x), b.parameter(y), run > 10 * kGeometric ? run : 0.0});
    places_.push_back(
        {a0 + x * ha.chord, std::min(length_a, length_b), a0 + (both ? high : x) * ha.chord});
  }

  void merge() {
    std::vector<std::size_t> order(found_.crossings.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [this](std::size_t i, std::size_t j) {
      const CurveCrossing& a = found_.crossings[i];
      const CurveCrossing& b = found_.crossings[j];
      return std::pair(a.s, a.t) < std::pair(b.s, b.t);
    });
    struct Kept {
      CurveCrossing crossing;
      Place end;  ///< of its run
    };
    std::vector<Kept> kept;
    for (const std::size_t i : order) {
      const CurveCrossing& next = found_.crossings[i];
      const Place& place = places_[i];
      Kept* known = nullptr;
      for (Kept& k : kept) {
        // What crosses clearly is no part of a touch beside it.
        const bool both_touch = k.end.reach > 0 && place.reach > 0;
        const double touching = both_touch ? k.end.reach + place.reach : 0.0;
        const double near_it = 10 * kGeometric + touching;
        const bool same = (k.end.point - place.point).norm() <= near_it ||
                          (k.end.end - place.point).norm() <= near_it ||
                          (k.end.point - place.end).norm() <= near_it;
        // A closed curve passes its first point again at another parameter of the other curve.
        if (same && (k.end.reach > 0 || place.reach > 0 || near(k.crossing, next))) known = &k;
      }
      if (known == nullptr) {
        kept.push_back({next, place});
      } else {
        known->crossing.run += next.run;
        if (place.reach > 0) known->end = place;
      }
    }
    found_.crossings.clear();
    for (const Kept& k : kept) found_.crossings.push_back(k.crossing);
  }

  static bool near(const CurveCrossing& a, const CurveCrossing& b) {
    constexpr double kSame = 1e-6;
    return std::abs(a.s - b.s) <= kSame * (1 + std::abs(a.s)) &&
           std::abs(a.t - b.t) <= kSame * (1 + std::abs(a.t));
  }

  CurveCrossings found_;
  std::vector<Place> places_;
  int pairs_ = 0;
};

template <int kDimension>
ClosestOnCurve<kDimension> find_closest(const BsplineCurve<kDimension>& curve,
                                        const Eigen::Matrix<double, kDimension, 1>& p) {
  using Point = Eigen::Matrix<double, kDimension, 1>;
  // Stationary places of |C - p|^2 on each part: roots of (A - w p) . (A' w - A w'), a polynomial.
  const double begin = curve.knots().domain_begin();
  ClosestOnCurve<kDimension> best{begin, curve.point(begin), 0};
  best.distance = (best.point - p).stableNorm();
  const auto consider = [&](double t) {
    const Point point = curve.point(t);
    const double distance = (point - p).stableNorm();
    if (distance < best.distance) best = {t, point, distance};
  };
  const auto arcs = arcs_of(curve);
  if (!arcs) return best;
  for (const auto& arc : *arcs) {
    consider(arc.low);
    consider(arc.high);
    const Hull<kDimension> hull(arc);
    if ((hull.low - p).cwiseMax(p - hull.high).cwiseMax(0.0).norm() >= best.distance) continue;
    const std::size_t n = arc.net.size();
    if (n < 2) continue;
    const auto degree = static_cast<double>(n - 1);
    std::vector<double> dw;
    for (std::size_t i = 0; i + 1 < n; ++i)
      dw.push_back(degree * (arc.weights[i + 1] - arc.weights[i]));
    std::vector<double> f;
    double scale = 0;
    for (Eigen::Index c = 0; c < kDimension; ++c) {
      std::vector<double> a;  // A - w p, which keeps the same numerator A' w - A w'
      std::vector<double> da;
      for (std::size_t i = 0; i < n; ++i) a.push_back(arc.net[i][c] - arc.weights[i] * p[c]);
      for (std::size_t i = 0; i + 1 < n; ++i) da.push_back(degree * (a[i + 1] - a[i]));
      auto one = bernstein_product(da, arc.weights);
      const auto other = bernstein_product(a, dw);
      for (std::size_t i = 0; i < one.size(); ++i) one[i] -= other[i];
      const auto product = bernstein_product(a, one);
      f.resize(product.size());
      for (std::size_t i = 0; i < product.size(); ++i) {
        f[i] += product[i];
        scale = std::max(scale, std::abs(product[i]));
      }
    }
    constexpr double kRounding = 1e-15;
    const Roots roots = bernstein_roots(f, kRounding * scale);
    for (const double x : roots.at) consider(arc.parameter(x));
  }
  return best;
}

}  // namespace

PlaneCrossings cross_plane(const BsplineCurve<3>& curve, const Eigen::Vector3d& point,
                           const Eigen::Vector3d& normal) {
  const Eigen::Vector3d n = normal.stableNormalized();
  PlaneCrossings out;
  const auto arcs = arcs_of(curve);
  if (!arcs) return {{}, {}, false};
  for (const auto& arc : *arcs) {
    std::vector<double> f;
    double rounding = 0;
    bool flat = true;
    for (std::size_t i = 0; i < arc.net.size(); ++i) {
      f.push_back((arc.net[i] - arc.weights[i] * point).dot(n));
      flat = flat && std::abs(f.back()) <= kGeometric * arc.weights[i];
      rounding = std::max(rounding, 4e-16 * (arc.net[i].norm() + arc.weights[i] * point.norm()));
    }
    if (flat) {
      if (!out.within.empty() && out.within.back().last == arc.low) {
        out.within.back().last = arc.high;
      } else {
        out.within.push_back({arc.low, arc.high});
      }
      continue;
    }
    for (const double x : bernstein_roots(f, rounding).at) out.at.push_back(arc.parameter(x));
  }
  std::sort(out.at.begin(), out.at.end());
  // An end that two parts share is found by both; the end of a flat part is part of that.
  const double same = 1e-11 * (curve.knots().domain_end() - curve.knots().domain_begin());
  const auto off = [&](double t) { return std::abs((curve.point(t) - point).dot(n)); };
  std::vector<double> kept;
  for (const double t : out.at) {
    const bool in_run = std::any_of(out.within.begin(), out.within.end(), [&](const auto& range) {
      return t >= range.first - same && t <= range.last + same;
    });
    const bool again =
        !kept.empty() && (t - kept.back() <= same ||
                          (off(0.5 * (t + kept.back())) < kGeometric &&
                           (curve.point(t) - curve.point(kept.back())).norm() < 1e3 * kGeometric));
    if (!in_run && !again) kept.push_back(t);
  }
  out.at = std::move(kept);
  return out;
}

CurveCrossings cross_curves(const BsplineCurve<2>& first, const BsplineCurve<2>& second) {
  return CrossingSearch<2>().run(first, second);
}

CurveCrossings cross_curves(const BsplineCurve<3>& first, const BsplineCurve<3>& second) {
  return CrossingSearch<3>().run(first, second);
}

ClosestOnCurve<2> closest_on_curve(const BsplineCurve<2>& curve, const Eigen::Vector2d& p) {
  return find_closest(curve, p);
}

ClosestOnCurve<3> closest_on_curve(const BsplineCurve<3>& curve, const Eigen::Vector3d& p) {
  return find_closest(curve, p);
}

}  // namespace limn
