#include "modeler/model/sewing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "modeler/bspline/refine.hpp"
#include "modeler/bspline/simplify.hpp"

namespace limn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The four borders of a surface in the order of its loop, counter-clockwise in (u, v).
struct Side {
  int direction;  ///< along which it runs
  bool last;      ///< of the other direction
  bool reversed;  ///< the loop runs against it
};
constexpr std::array<Side, 4> kSides = {
    {{0, false, false}, {1, true, false}, {0, true, true}, {1, false, true}}};

/// A straight line in (u, v) on [low, high].
BsplineCurve<2> straight(double low, double high, const Vector2d& from, const Vector2d& to) {
  return *BsplineCurve<2>::make(*KnotVector::make_clamped(1, low, high, {}), {from, to});
}

BsplineCurve<3> dot(const Vector3d& at) { return *BsplineCurve<3>::make(KnotVector(), {at}); }

/// The curve with its domain stretched to [low, high].
Expected<BsplineCurve<3>> stretched(const BsplineCurve<3>& curve, double low, double high) {
  const KnotVector& knots = curve.knots();
  const double begin = knots.domain_begin();
  const double end = knots.domain_end();
  std::vector<double> values = knots.values();
  for (double& u : values) {
    // The ends exactly.
    u = u == begin ? low : u == end ? high : low + (u - begin) / (end - begin) * (high - low);
  }
  auto made = KnotVector::make(knots.degree(), std::move(values));
  if (!made) return tl::unexpected(std::move(made.error()));
  const KnotVector all[] = {*std::move(made)};
  return BsplineCurve<3>::from(
      SplineData::make(all, 3, curve.data().form(), curve.data().coordinates()));
}

/// How far two curves with the same ends of their domains are from each other at equal parameters:
/// a bound, infinite where they cannot be compared.
double gap_between(const BsplineCurve<3>& a, const BsplineCurve<3>& b) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto both = make_compatible(a.data(), b.data(), 0);
  if (!both) return kInfinity;
  if (both->first.form() != both->second.form()) return kInfinity;
  return largest_difference(both->first, both->second);
}

class Sewing {
 public:
  Sewing(std::string name, double tolerance) : tolerance_(tolerance) {
    body_.name = std::move(name);
  }

  void add(BsplineSurface surface) {
    Face face{std::move(surface), {Loop()}, false};
    for (const Side& side : kSides) face.loops.front().push_back(trim_of(face.surface, side));
    body_.faces.push_back(std::move(face));
  }

  Body take() { return std::move(body_); }

 private:
  Trim trim_of(const BsplineSurface& surface, const Side& side) {
    const KnotVector& along = surface.knots(side.direction);
    const KnotVector& across = surface.knots(1 - side.direction);
    const double at = side.last ? across.domain_end() : across.domain_begin();
    Vector2d from = Vector2d::Constant(at);
    Vector2d to = from;
    from[side.direction] = along.domain_begin();
    to[side.direction] = along.domain_end();

    BsplineCurve<3> curve = border_curve(surface, side.direction, side.last);
    const double reach = reach_of(curve);
    if (reach <= tolerance_) {
      const Vector3d place = curve.control_points().front();
      const std::size_t vertex = vertex_at(place);
      body_.edges.push_back({dot(place), {vertex, vertex}, reach});
      is_open_.push_back(false);
      return {body_.edges.size() - 1, side.reversed,
              straight(along.domain_begin(), along.domain_end(), from, to)};
    }
    for (std::size_t e = 0; e < body_.edges.size(); ++e) {
      if (!is_open_[e]) continue;
      for (const bool against : {false, true}) {
        if (!joins(e, curve, against)) continue;
        is_open_[e] = false;
        const KnotVector& knots = body_.edges[e].curve.knots();
        if (against) std::swap(from, to);
        return {e, side.reversed != against,
                straight(knots.domain_begin(), knots.domain_end(), from, to)};
      }
    }
    const std::array ends = {vertex_at(curve.point(along.domain_begin())),
                             vertex_at(curve.point(along.domain_end()))};
    body_.edges.push_back({std::move(curve), ends, 0});
    is_open_.push_back(true);
    return {body_.edges.size() - 1, side.reversed,
            straight(along.domain_begin(), along.domain_end(), from, to)};
  }

  /// How far the hull of a curve reaches from its first point.
  static double reach_of(const BsplineCurve<3>& curve) {
    const Vector3d place = curve.control_points().front();
    double reach = 0;
    for (const Vector3d& p : curve.control_points()) reach = std::max(reach, (p - place).norm());
    return reach;
  }

  /// Whether a border is the same curve as an edge that has one use; then the edge's deviation
  /// covers it.
  bool joins(std::size_t number, const BsplineCurve<3>& border, bool against) {
    Edge& edge = body_.edges[number];
    const KnotVector& knots = edge.curve.knots();
    const double begin = border.knots().domain_begin();
    const double end = border.knots().domain_end();
    const Vector3d first = border.point(against ? end : begin);
    const Vector3d last = border.point(against ? begin : end);
    if (!((first - edge.curve.point(knots.domain_begin())).norm() <= tolerance_)) return false;
    if (!((last - edge.curve.point(knots.domain_end())).norm() <= tolerance_)) return false;
    auto same_way = against ? reverse(border, 0) : Expected<BsplineCurve<3>>(border);
    if (!same_way) return false;
    const auto on_edge = stretched(*same_way, knots.domain_begin(), knots.domain_end());
    if (!on_edge) return false;
    const double gap = gap_between(edge.curve, *on_edge);
    if (!(gap <= tolerance_)) return false;
    edge.deviation = std::max(edge.deviation, gap);
    return true;
  }

  std::size_t vertex_at(const Vector3d& place) {
    for (std::size_t i = 0; i < body_.vertices.size(); ++i) {
      if ((body_.vertices[i] - place).norm() <= tolerance_) return i;
    }
    body_.vertices.push_back(place);
    return body_.vertices.size() - 1;
  }

  double tolerance_;
  Body body_;
  std::vector<bool> is_open_;  ///< of each edge: it may have another use
};

}  // namespace

BsplineCurve<3> border_curve(const BsplineSurface& surface, int direction, bool last) {
  const int across = 1 - direction;
  SplineData data = surface.data();
  for (int d = 0; d < 2; ++d) {
    // Clamped, its first and last control points are those of the borders.
    const KnotVector& knots = surface.knots(d);
    data = *segment(data, d, knots.domain_begin(), knots.domain_end());
  }
  const auto width = static_cast<std::size_t>(data.width());
  const std::size_t along_step = data.stride(direction) * width;
  const std::size_t across_step = data.stride(across) * width;
  const auto count = static_cast<std::size_t>(data.knots(direction).basis_count());
  const auto layers = static_cast<std::size_t>(data.knots(across).basis_count());
  std::vector<double> coordinates;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < width; ++c) {
      coordinates.push_back(
          data.coordinates()[i * along_step + (last ? layers - 1 : 0) * across_step + c]);
    }
  }
  const KnotVector knots[] = {data.knots(direction)};
  return BsplineCurve<3>::of(*SplineData::make(knots, 3, data.form(), coordinates));
}

Expected<Body> sew(std::string name, std::vector<BsplineSurface> surfaces, double tolerance) {
  if (!(tolerance > 0 && std::isfinite(tolerance))) {
    return fail(ErrorCode::kOutOfRange, "tolerance", "it is not a length above 0",
                "give a tolerance in mm");
  }
  if (surfaces.empty()) {
    return fail(ErrorCode::kMissing, "surfaces", "there are none", "give at least one");
  }
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].knots(0).degree() > 0 && surfaces[i].knots(1).degree() > 0) continue;
    return fail(ErrorCode::kOutOfRange, "surface " + std::to_string(i + 1),
                "a direction of degree 0 has pieces that are not joined", "raise its degree");
  }
  Sewing sewing(std::move(name), tolerance);
  for (BsplineSurface& surface : surfaces) sewing.add(std::move(surface));
  return sewing.take();
}

bool is_closed(const Body& body) {
  std::vector<int> uses(body.edges.size(), 0);
  for (const Face& face : body.faces) {
    for (const Loop& loop : face.loops) {
      for (const Trim& trim : loop) ++uses[trim.edge];
    }
  }
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const bool is_pole = body.edges[i].curve.knots().degree() == 0;
    if (!is_pole && uses[i] != 2) return false;
  }
  return !body.faces.empty();
}

}  // namespace limn
