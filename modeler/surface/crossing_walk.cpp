#include "modeler/surface/crossing_walk.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "modeler/base/tolerance.hpp"

namespace limn {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr std::size_t kMostPoints = 100'000;
constexpr int kMostSettlings = 20;  ///< of one Newton iteration
/// Quadratic convergence: what a step of this size (mm) leaves is below rounding.
constexpr double kLastMove = 1e-7;
constexpr double kLeastStep = 10 * kGeometric;
/// Surfaces that meet at a smaller angle are tangent: rounding alone may turn the curve.
constexpr double kLeastSine = 1e-7;
constexpr double kMostTurn = 0.9;  ///< cosine of the angle that a segment may turn by
/// Rates across a wall below this (rad) are those of a curve that runs along it.
constexpr double kAlong = 1e-9;
/// Parameters nearer to an edge than this part of the domain are on it.
constexpr double kOnEdge = 1e-9;

/// The rates of both parameters with which a point moves along a tangent.
Vector2d rates_along(const SurfaceJet& jet, const Vector3d& tangent) {
  const FirstForm form = first_form(jet);
  const double a = tangent.dot(jet.du);
  const double b = tangent.dot(jet.dv);
  return Vector2d(form.g * a - form.f * b, form.e * b - form.f * a) / form.determinant();
}

CrossingPoint turned(CrossingPoint point) {
  point.rate = -point.rate;
  return point;
}

}  // namespace

CrossingSegment::CrossingSegment(const CrossingPoint& from, const CrossingPoint& to)
    : length_((to.point() - from.point()).norm()),
      control_points_{from.at, from.at + length_ / 3 * from.rate, to.at - length_ / 3 * to.rate,
                      to.at} {}

CrossingSegment::Vector CrossingSegment::at(double x) const {
  const double y = 1 - x;
  return y * y * y * control_points_[0] + 3 * x * y * y * control_points_[1] +
         3 * x * x * y * control_points_[2] + x * x * x * control_points_[3];
}

CrossingWalk::CrossingWalk(const SurfaceIndex& first, const SurfaceIndex& second, double tolerance)
    : surfaces_{&first, &second}, tolerance_(tolerance) {
  for (std::size_t k = 0; k < 4; ++k) {
    Direction& direction = directions_[k];
    direction.knots = &surfaces_[k / 2]->surface().knots(static_cast<int>(k % 2));
    const KnotVector& knots = *direction.knots;
    const auto& values = knots.values();
    for (const double u : knots.breakpoints()) {
      const bool end = u == knots.domain_begin() || u == knots.domain_end();
      if (end || knots.multiplicity(u) >= knots.degree()) direction.walls.push_back(u);
    }
    for (std::size_t i = 0; i + 1 < direction.walls.size(); ++i) {
      const auto last =
          std::lower_bound(values.begin() + knots.degree(), values.end(), direction.walls[i + 1]);
      direction.spans.push_back(
          {knots.find_span(direction.walls[i]), static_cast<int>(last - values.begin()) - 1});
    }
  }
}

CrossingWalk::Pieces CrossingWalk::pieces_at(const CrossingPlace& place) const {
  Pieces out{};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& walls = directions_[k].walls;
    const double x = place[static_cast<Eigen::Index>(k)];
    while (out[k] + 2 < walls.size() && walls[out[k] + 1] <= x) ++out[k];
  }
  return out;
}

int CrossingWalk::span(std::size_t direction, std::size_t piece, double x) const {
  const auto& [first, last] = directions_[direction].spans[piece];
  return std::clamp(directions_[direction].knots->find_span(x), first, last);
}

double CrossingWalk::span_length(std::size_t direction, std::size_t piece, double x) const {
  const auto at = static_cast<std::size_t>(span(direction, piece, x));
  const auto& values = directions_[direction].knots->values();
  return values[at + 1] - values[at];
}

CrossingWalk::Pair CrossingWalk::jets(const CrossingPlace& place, const Pieces& pieces) const {
  const auto jet = [&](std::size_t k) {
    const Vector2d at = place.segment<2>(static_cast<Eigen::Index>(k));
    return surfaces_[k / 2]->evaluator().jet_in_spans(
        {span(k, pieces[k], at.x()), span(k + 1, pieces[k + 1], at.y())}, at.x(), at.y());
  };
  return {jet(0), jet(2)};
}

/// The point of the curve in a place where both surfaces are, with the tangent n_1 x n_2.
std::optional<CrossingPoint> CrossingWalk::point_at(const CrossingPlace& place,
                                                    const Pieces& pieces) const {
  const Pair pair = jets(place, pieces);
  const auto n1 = normal(pair.first);
  const auto n2 = normal(pair.second);
  if (!n1 || !n2) return std::nullopt;
  const Vector3d across = n1->cross(*n2);
  const double sine = across.norm();
  if (!(sine >= kLeastSine)) return std::nullopt;
  const Vector3d tangent = across / sine;
  CrossingPoint out;
  out.at << 0.5 * (pair.first.point + pair.second.point), place;
  out.rate << tangent, rates_along(pair.first, tangent), rates_along(pair.second, tangent);
  if (!out.rate.allFinite()) return std::nullopt;
  return out;
}

double CrossingWalk::sine_at(const CrossingPlace& place) const {
  const Pair pair = jets(place, pieces_at(place));
  const auto n1 = normal(pair.first);
  const auto n2 = normal(pair.second);
  return n1 && n2 ? n1->cross(*n2).norm() : 0.0;
}

std::optional<CrossingWalk::Edge> CrossingWalk::edge_along(const CrossingBranch& branch) const {
  for (int k = 0; k < 4; ++k) {
    const auto& walls = directions_[static_cast<std::size_t>(k)].walls;
    const double room = kOnEdge * (walls.back() - walls.front());
    for (const bool upper : {false, true}) {
      const double end = upper ? walls.back() : walls.front();
      const auto there = [&](const CrossingPoint& p) {
        return std::abs(p.at[3 + k] - end) <= room;
      };
      if (std::all_of(branch.points.begin(), branch.points.end(), there)) return Edge{k, upper};
    }
  }
  return std::nullopt;
}

/// Newton's iteration on S_1 = S_2 in a slice.
bool CrossingWalk::settle(CrossingPlace& place, const Pieces& pieces, const Slice& slice) const {
  CrossingPlace x = place;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostSettlings; ++i) {
    const Pair pair = jets(x, pieces);
    Matrix4d m;
    m.topRows<3>() << pair.first.du, pair.first.dv, -pair.second.du, -pair.second.dv;
    const Vector4d lengths = m.topRows<3>().colwise().norm();
    Vector4d r;
    r.head<3>() = pair.second.point - pair.first.point;
    if (slice.fixed >= 0) {
      m.row(3).setZero();
      m(3, slice.fixed) = lengths[slice.fixed];
      r[3] = 0;
    } else {
      const Vector3d middle = 0.5 * (pair.first.point + pair.second.point);
      m.row(3) = 0.5 * slice.normal.transpose() * m.topRows<3>();
      m.row(3).tail<2>() *= -1;
      r[3] = slice.normal.dot(slice.point - middle);
    }
    const Vector4d move = m.partialPivLu().solve(r);
    const double size = move.cwiseAbs().cwiseProduct(lengths).maxCoeff();
    if (!std::isfinite(size) || (i > 2 && size > 2 * before)) return false;
    before = size;
    x += move;
    for (std::size_t k = 0; k < 4; ++k) {  // far outside, the pieces' polynomials mean nothing
      const auto& walls = directions_[k].walls;
      const double low = walls[pieces[k]];
      const double high = walls[pieces[k] + 1];
      const double at = x[static_cast<Eigen::Index>(k)];
      if (!(at > low - (high - low) && at < high + (high - low))) return false;
    }
    if (size < kLastMove) {
      place = x;
      return true;
    }
  }
  return false;
}

/// |S_u| and |S_v| of both surfaces.
Vector4d CrossingWalk::speeds(const CrossingPlace& place, const Pieces& pieces) const {
  const Pair pair = jets(place, pieces);
  return {pair.first.du.norm(), pair.first.dv.norm(), pair.second.du.norm(), pair.second.dv.norm()};
}

/// Parameters nearer than these to a wall are on it: kGeometric on the surface.
CrossingPlace CrossingWalk::margins(const CrossingPlace& place, const Pieces& pieces) const {
  const Vector4d per_unit = speeds(place, pieces);
  CrossingPlace out;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& walls = directions_[k].walls;
    const double most = kOnEdge * (walls[pieces[k] + 1] - walls[pieces[k]]);
    const auto at = static_cast<Eigen::Index>(k);
    out[at] = std::min(most, kGeometric / per_unit[at]);
  }
  return out;
}

double CrossingWalk::wall(int direction, bool upper, const Pieces& pieces) const {
  const auto k = static_cast<std::size_t>(direction);
  return directions_[k].walls[pieces[k] + (upper ? 1 : 0)];
}

/// The parameter that is furthest beyond its walls, in parts of the distance between them.
std::optional<int> CrossingWalk::wall_beyond(const CrossingPlace& place,
                                             const CrossingPlace& margins,
                                             const Pieces& pieces) const {
  std::optional<int> out;
  double furthest = 0;
  for (int k = 0; k < 4; ++k) {
    const double low = wall(k, false, pieces);
    const double high = wall(k, true, pieces);
    const double beyond = std::max(low - place[k], place[k] - high);
    if (beyond > margins[k] && beyond > furthest * (high - low)) {
      furthest = beyond / (high - low);
      out = k;
    }
  }
  return out;
}

double CrossingWalk::longest_step(const CrossingPoint& from, const Pieces& pieces) const {
  double out = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 4; ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    out = std::min(out, span_length(k, pieces[k], from.at[3 + at]) / std::abs(from.rate[3 + at]));
  }
  return out;
}

/// The next point at about this distance, or where the curve meets a wall before it.
std::optional<CrossingPoint> CrossingWalk::step(const CrossingPoint& from, const Pieces& pieces,
                                                double length) const {
  const CrossingPlace start = from.place();
  const CrossingPlace rate = from.rate.tail<4>();
  const CrossingPlace room = margins(start, pieces);
  CrossingPlace place = start + length * rate;
  std::optional<int> beyond = wall_beyond(place, room, pieces);
  if (!beyond) {
    const Slice ahead{-1, from.point() + length * from.direction(), from.direction()};
    if (!settle(place, pieces, ahead)) return std::nullopt;
    beyond = wall_beyond(place, room, pieces);
  }
  for (int tries = 0; beyond && tries < 4; ++tries) {
    const int k = *beyond;
    const double end = wall(k, rate[k] > 0, pieces);
    const double part = rate[k] != 0 ? (end - start[k]) / (length * rate[k]) : 0.0;
    if (!(part >= 0 && part <= 2)) return std::nullopt;
    place = start + part * length * rate;
    place[k] = end;
    if (!settle(place, pieces, {k, {}, {}})) return std::nullopt;
    beyond = wall_beyond(place, room, pieces);
  }
  if (beyond) return std::nullopt;
  for (int k = 0; k < 4; ++k) {
    const double low = wall(k, false, pieces);
    const double high = wall(k, true, pieces);
    place[k] = std::clamp(place[k], low, high);
  }
  auto next = point_at(place, pieces);
  if (!next) return std::nullopt;
  if (next->direction().dot(from.direction()) < 0) next = turned(*next);
  if (!(next->direction().dot(from.direction()) >= kMostTurn)) return std::nullopt;
  if (!((next->point() - from.point()).dot(from.direction()) > 0)) return std::nullopt;
  return next;
}

double CrossingWalk::deviation_of(const CrossingSegment& segment, const Pieces& pieces) const {
  double out = 0;
  for (const double x : {0.25, 0.5, 0.75}) {
    const CrossingSegment::Vector at = segment.at(x);
    const Pair pair = jets(at.tail<4>(), pieces);
    for (const SurfaceJet* jet : {&pair.first, &pair.second}) {
      const double off = (jet->point - at.head<3>()).norm();
      if (!std::isfinite(off)) return std::numeric_limits<double>::infinity();
      out = std::max(out, off);
    }
  }
  return out;
}

/// A step of at most `length`, shorter until its segment is good enough; `length` becomes what the
/// next step may be.
std::optional<CrossingPoint> CrossingWalk::advance(const CrossingPoint& from, const Pieces& pieces,
                                                   double& length, double& deviation) const {
  length = std::min(length, longest_step(from, pieces));
  while (length >= kLeastStep) {
    auto next = step(from, pieces, length);
    double off = std::numeric_limits<double>::infinity();
    double chord = 0;
    if (next) {
      const CrossingSegment segment(from, *next);
      off = deviation_of(segment, pieces);
      chord = segment.length();
    }
    if (!(off <= tolerance_)) {
      length *= 0.5;
      continue;
    }
    deviation = std::max(deviation, off);
    // Deviations grow with the fourth power of the length.
    constexpr double kMostGrowth = 2;
    constexpr double kCaution = 0.9;
    const double growth = off > 0 ? kCaution * std::pow(tolerance_ / off, 0.25) : kMostGrowth;
    length = std::max(0.5 * length, std::min(growth, kMostGrowth) * chord);
    return next;
  }
  return std::nullopt;
}

/// Whether the curve goes on: into the next pieces where it has come to a wall that is not the
/// surface's edge.
bool CrossingWalk::pass_walls(std::vector<CrossingPoint>& points, Pieces& pieces) const {
  constexpr int kMostWalls = 8;
  for (int tries = 0; tries < kMostWalls; ++tries) {
    const CrossingPoint here = points.back();
    const CrossingPlace room = margins(here.place(), pieces);
    int through = -1;
    bool upper = false;
    for (int k = 0; k < 4; ++k) {
      const double rate = here.rate[3 + k];
      upper = rate > 0;
      const bool at_wall = std::abs(here.at[3 + k] - wall(k, upper, pieces)) <= room[k];
      if (at_wall && std::abs(rate) * kGeometric > kAlong * room[k]) {
        through = k;
        break;
      }
    }
    if (through < 0) return true;
    const auto k = static_cast<std::size_t>(through);
    if (upper ? pieces[k] + 2 == directions_[k].walls.size() : pieces[k] == 0) return false;
    CrossingPlace place = here.place();
    place[through] = wall(through, upper, pieces);
    pieces[k] += upper ? 1 : std::size_t(-1);
    auto next = point_at(place, pieces);
    if (!next) return false;
    if ((next->point() - here.point()).norm() > kLeastStep) return false;  // a break
    if ((next->rate[3 + through] > 0) != upper) next = turned(*next);
    constexpr double kSameRate = 1e-9;
    if ((next->rate - here.rate).norm() > kSameRate * here.rate.norm()) points.push_back(*next);
  }
  return false;
}

bool CrossingWalk::leads_through(const CrossingSegment& segment, double x,
                                 const CrossingPlace& place) const {
  const Pieces pieces = pieces_at(place);
  const auto there = point_at(place, pieces);
  if (!there) return false;
  CrossingPlace found = segment.at(x).tail<4>();
  if (!settle(found, pieces, {-1, there->point(), there->direction()})) return false;
  // Compared on the surfaces: at a pole one parameter means little.
  const Vector4d off = (found - place).cwiseAbs().cwiseProduct(speeds(place, pieces));
  constexpr double kSamePlace = 100 * kGeometric;  // two roundings of Newton's at small angles
  return off.maxCoeff() <= kSamePlace;
}

/// From the last of `points` to the curve's end; whether it came back to that point.
bool CrossingWalk::walk(std::vector<CrossingPoint>& points, Pieces pieces,
                        double& deviation) const {
  const CrossingPoint start = points.back();
  double length = 0.25 * longest_step(start, pieces);
  for (std::size_t segments = 0; segments < kMostPoints; ++segments) {
    if (!pass_walls(points, pieces)) return false;
    const CrossingPoint from = points.back();
    const auto next = advance(from, pieces, length, deviation);
    if (!next) return false;
    if (segments > 0) {
      const CrossingSegment segment(from, *next);
      const Vector3d chord = next->point() - from.point();
      const double x = (start.point() - from.point()).dot(chord) / chord.squaredNorm();
      const bool passes = x > 0 && x <= 1 && start.direction().dot(chord) > 0 &&
                          (segment.at(x).head<3>() - start.point()).norm() <= 10 * tolerance_;
      if (passes && leads_through(segment, x, start.place())) {
        deviation = std::max(deviation, deviation_of(CrossingSegment(from, start), pieces));
        points.push_back(start);
        return true;
      }
    }
    points.push_back(*next);
  }
  return false;
}

std::optional<CrossingPoint> CrossingWalk::settled(const CrossingPlace& place) const {
  const Pieces pieces = pieces_at(place);
  const auto near = point_at(place, pieces);
  if (!near) return std::nullopt;
  CrossingPlace found = place;
  if (!settle(found, pieces, {-1, near->point(), near->direction()})) return std::nullopt;
  for (int k = 0; k < 4; ++k) {
    found[k] = std::clamp(found[k], wall(k, false, pieces), wall(k, true, pieces));
  }
  return point_at(found, pieces);
}

CrossingBranch CrossingWalk::branch_through(const CrossingPoint& start) const {
  const Pieces pieces = pieces_at(start.place());
  CrossingBranch out;
  out.points = {start};
  out.is_closed = walk(out.points, pieces, out.deviation);
  if (out.is_closed) return out;
  std::vector<CrossingPoint> before = {turned(start)};
  walk(before, pieces, out.deviation);
  std::vector<CrossingPoint> points;
  points.reserve(before.size() + out.points.size());
  for (std::size_t i = before.size(); i-- > 1;) points.push_back(turned(before[i]));
  points.insert(points.end(), out.points.begin(), out.points.end());
  out.points = std::move(points);
  return out;
}

std::optional<CrossingWalk::Tangency> CrossingWalk::tangency_near(const CrossingPlace& place,
                                                                  double reach) const {
  const Pieces pieces = pieces_at(place);
  const auto n = normal(jets(place, pieces).first);
  if (!n) return std::nullopt;
  Eigen::Matrix<double, 3, 2> plane;
  plane << n->unitOrthogonal(), n->cross(n->unitOrthogonal());
  // In the tangent plane: the gap, and how much the normals differ.
  const auto differences = [&](const CrossingPlace& at) -> Vector4d {
    const Pair pair = jets(at, pieces);
    const Vector3d n1 = normal(pair.first).value_or(Vector3d::Zero());
    const Vector3d n2 = normal(pair.second).value_or(Vector3d::Zero());
    Vector4d out;
    out << plane.transpose() * (pair.second.point - pair.first.point),
        plane.transpose() * n1.cross(n2);
    return out;
  };
  const Vector4d per_unit = speeds(place, pieces);
  CrossingPlace x = place;
  constexpr int kMostSteps = 10;
  constexpr double kSide = 1e-5;       // mm, of differences
  constexpr double kLeastBend = 1e-9;  // 1/mm: planes
  for (int i = 0; i < kMostSteps; ++i) {
    Matrix4d m;
    for (int k = 0; k < 4; ++k) {
      CrossingPlace side = CrossingPlace::Zero();
      side[k] = kSide / per_unit[k];
      m.col(k) = (differences(x + side) - differences(x - side)) / (2 * side[k]);
    }
    // In mm, both kinds of rows of the same size. Where a curve of places is tangent, the nearest.
    m = m * per_unit.cwiseInverse().asDiagonal();
    const double bend = m.bottomRows<2>().cwiseAbs().maxCoeff();
    if (!(bend > kLeastBend)) return std::nullopt;
    Vector4d right = -differences(x);
    m.bottomRows<2>() /= bend;
    right.tail<2>() /= bend;
    Eigen::CompleteOrthogonalDecomposition<Matrix4d> solver;
    constexpr double kSingular = 1e-4;
    solver.setThreshold(kSingular);
    const Vector4d move = solver.compute(m).solve(right).cwiseQuotient(per_unit);
    if (!move.allFinite()) return std::nullopt;
    x += move;
    if (!((x - place).cwiseAbs().cwiseProduct(per_unit).maxCoeff() < reach)) return std::nullopt;
    if (move.cwiseAbs().cwiseProduct(per_unit).maxCoeff() < kGeometric) {
      const Pair pair = jets(x, pieces);
      if (wall_beyond(x, margins(x, pieces), pieces) ||
          (pair.second.point - pair.first.point).norm() > 10 * kGeometric)
        break;
      return Tangency{x, solver.rank() == 4};
    }
  }
  return std::nullopt;
}

}  // namespace limn
