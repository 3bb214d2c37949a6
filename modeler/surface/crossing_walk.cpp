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

constexpr std::size_t kMostSegments = 100'000;
constexpr int kMostSettlings = 20;  ///< of one Newton iteration
/// Quadratic convergence: what a step of this size (mm) leaves is below rounding.
constexpr double kLastMove = 1e-7;
constexpr double kLeastStep = 10 * kGeometric;
/// Surfaces that meet at a smaller angle are tangent: rounding alone may turn the curve.
constexpr double kLeastSine = 1e-7;
/// Of the longest step, the first: nothing is known yet of how the curve bends.
constexpr double kFirstStep = 0.25;
/// How far off, in steps, the wall that ends a step may seem along the tangent.
constexpr double kMostBeyond = 2;
/// A curve ends at a pole or a tangency that is so near the last point that could be reached, mm.
constexpr double kEndRoom = 100 * kLeastStep;
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
    const auto next = std::upper_bound(walls.begin() + 1, walls.end() - 1, x);
    out[k] = static_cast<std::size_t>(next - walls.begin()) - 1;
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

CrossingJets CrossingWalk::jets(const CrossingPlace& place, const Pieces& pieces) const {
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
  const CrossingJets pair = jets(place, pieces);
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
  const CrossingJets pair = jets(place, pieces_at(place));
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
      const auto there = [&](const CrossingSegment& segment) {
        return std::abs(segment.at(0)[3 + k] - end) <= room &&
               std::abs(segment.at(1)[3 + k] - end) <= room;
      };
      if (std::all_of(branch.segments.begin(), branch.segments.end(), there)) {
        return Edge{k, upper};
      }
    }
  }
  return std::nullopt;
}

/// Newton's iteration on S_1 = S_2 in a slice.
bool CrossingWalk::settle(CrossingPlace& place, const Pieces& pieces, const Slice& slice) const {
  CrossingPlace x = place;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostSettlings; ++i) {
    const CrossingJets pair = jets(x, pieces);
    Matrix4d m;
    m.topRows<3>() = pair.jacobian();
    const Vector4d lengths = m.topRows<3>().colwise().norm();
    Vector4d r;
    r.head<3>() = pair.gap();
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
  const CrossingJets pair = jets(place, pieces);
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

/// The lower or the upper ends of the pieces.
CrossingPlace CrossingWalk::walls(bool upper, const Pieces& pieces) const {
  CrossingPlace out;
  for (std::size_t k = 0; k < 4; ++k) {
    out[static_cast<Eigen::Index>(k)] = directions_[k].walls[pieces[k] + (upper ? 1 : 0)];
  }
  return out;
}

/// The parameter that is furthest beyond its walls, in parts of the distance between them.
std::optional<int> CrossingWalk::wall_beyond(const CrossingPlace& place,
                                             const CrossingPlace& margins,
                                             const Pieces& pieces) const {
  std::optional<int> out;
  double furthest = 0;
  const CrossingPlace low = walls(false, pieces);
  const CrossingPlace high = walls(true, pieces);
  for (int k = 0; k < 4; ++k) {
    const double beyond = std::max(low[k] - place[k], place[k] - high[k]);
    if (beyond > margins[k] && beyond > furthest * (high[k] - low[k])) {
      furthest = beyond / (high[k] - low[k]);
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
std::optional<CrossingPoint> CrossingWalk::next_point(const CrossingPoint& from,
                                                      const Pieces& pieces, double length) const {
  const CrossingPlace start = from.place();
  const CrossingPlace rate = from.rate.tail<4>();
  const CrossingPlace room = margins(start, pieces);
  const CrossingPlace low = walls(false, pieces);
  const CrossingPlace high = walls(true, pieces);
  CrossingPlace place = start + length * rate;
  std::optional<int> beyond = wall_beyond(place, room, pieces);
  if (!beyond) {
    const Slice ahead{-1, from.point() + length * from.direction(), from.direction()};
    if (!settle(place, pieces, ahead)) return std::nullopt;
    beyond = wall_beyond(place, room, pieces);
  }
  for (int tries = 0; beyond && tries < 4; ++tries) {  // each parameter may have its wall
    const int k = *beyond;
    const double end = rate[k] > 0 ? high[k] : low[k];
    const double part = rate[k] != 0 ? (end - start[k]) / (length * rate[k]) : 0.0;
    if (!(part >= 0 && part <= kMostBeyond)) return std::nullopt;
    place = start + part * length * rate;
    place[k] = end;
    if (!settle(place, pieces, {k, {}, {}})) return std::nullopt;
    beyond = wall_beyond(place, room, pieces);
  }
  if (beyond) return std::nullopt;
  auto next = point_at(place.cwiseMax(low).cwiseMin(high), pieces);
  if (!next) return std::nullopt;
  if (next->direction().dot(from.direction()) < 0) next = turned(*next);
  if (!(next->direction().dot(from.direction()) >= kMostTurn)) return std::nullopt;
  if (!((next->point() - from.point()).dot(from.direction()) > 0)) return std::nullopt;
  return next;
}

/// Within the pieces: outside, the surfaces may be others.
CrossingSegment CrossingWalk::segment_between(const CrossingPoint& from, const CrossingPoint& to,
                                              const Pieces& pieces) const {
  return {from, to, walls(false, pieces), walls(true, pieces)};
}

double CrossingWalk::deviation_of(const CrossingSegment& segment, const Pieces& pieces) const {
  double out = 0;
  for (const double x : {0.25, 0.5, 0.75}) {
    const CrossingSegment::Vector at = segment.at(x);
    const CrossingJets pair = jets(at.tail<4>(), pieces);
    for (const SurfaceJet* jet : {&pair.first, &pair.second}) {
      const double off = (jet->point - at.head<3>()).norm();
      if (!std::isfinite(off)) return std::numeric_limits<double>::infinity();
      out = std::max(out, off);
    }
  }
  return out;
}

/// A step of about this length, whatever its segment's deviation.
std::optional<CrossingWalk::Step> CrossingWalk::step_of(const CrossingPoint& from,
                                                        const Pieces& pieces, double length) const {
  const auto next = next_point(from, pieces, length);
  if (!next) return std::nullopt;
  const CrossingSegment segment = segment_between(from, *next, pieces);
  return Step{*next, segment, deviation_of(segment, pieces)};
}

/// A step of at most `length`, shorter until its segment is good enough; `length` becomes what the
/// next step may be.
std::optional<CrossingWalk::Step> CrossingWalk::advance(const CrossingPoint& from,
                                                        const Pieces& pieces,
                                                        double& length) const {
  length = std::min(length, longest_step(from, pieces));
  while (length >= kLeastStep) {
    if (const auto step = step_of(from, pieces, length); step && step->deviation <= tolerance_) {
      // Deviations grow with the fourth power of the length.
      constexpr double kMostGrowth = 2;
      constexpr double kCaution = 0.9;
      const double off = step->deviation;
      const double growth = off > 0 ? kCaution * std::pow(tolerance_ / off, 0.25) : kMostGrowth;
      length = std::max(0.5 * length, std::min(growth, kMostGrowth) * step->segment.length());
      return step;
    }
    length *= 0.5;
  }
  return std::nullopt;
}

/// Leads a curve that has come to a wall into the next pieces, unless it ends there.
std::optional<WalkEnd> CrossingWalk::pass_walls(CrossingPoint& here, Pieces& pieces) const {
  constexpr int kMostWalls = 8;  // of all four parameters, in one place
  for (int tries = 0; tries < kMostWalls; ++tries) {
    const CrossingPlace room = margins(here.place(), pieces);
    int through = -1;
    bool upper = false;
    double end = 0;
    for (int k = 0; k < 4 && through < 0; ++k) {
      const double rate = here.rate[3 + k];
      upper = rate > 0;
      end = walls(upper, pieces)[k];
      const bool at_wall = std::abs(here.at[3 + k] - end) <= room[k];
      if (at_wall && std::abs(rate) * kGeometric > kAlong * room[k]) through = k;
    }
    if (through < 0) return std::nullopt;
    const auto k = static_cast<std::size_t>(through);
    if (upper ? pieces[k] + 2 == directions_[k].walls.size() : pieces[k] == 0) {
      return WalkEnd::kEdge;
    }
    CrossingPlace place = here.place();
    place[through] = end;
    pieces[k] += upper ? 1 : std::size_t(-1);
    if (jets(place, pieces).gap().norm() > kLeastStep) return WalkEnd::kBreak;
    auto next = point_at(place, pieces);
    if (!next) return end_near(here.place(), pieces);
    if ((next->rate[3 + through] > 0) != upper) next = turned(*next);
    constexpr double kSameRate = 1e-9;
    if ((next->rate - here.rate).norm() > kSameRate * here.rate.norm()) here = *next;
  }
  return WalkEnd::kCutOff;
}

/// Why no step leads on from a place: it is at a pole, or where the surfaces are tangent.
WalkEnd CrossingWalk::end_near(const CrossingPlace& last, const Pieces& pieces) const {
  const CrossingPlace low = walls(false, pieces);
  const CrossingPlace high = walls(true, pieces);
  for (int k = 0; k < 4; ++k) {
    for (const double edge : {low[k], high[k]}) {
      CrossingPlace place = last;
      const double off = std::abs(place[k] - edge) * speeds(place, pieces)[k];
      place[k] = edge;
      const int along = k ^ 1;  // the surface's other parameter
      const double length = speeds(place, pieces)[along] * (high[along] - low[along]);
      if (off <= kEndRoom && length <= kGeometric) return WalkEnd::kEdge;
    }
  }
  return tangency_near(last, kEndRoom) ? WalkEnd::kTangency : WalkEnd::kCutOff;
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

/// Appends the segments from a point to the curve's end.
WalkEnd CrossingWalk::walk(const CrossingPoint& start, std::vector<CrossingSegment>& segments,
                           double& deviation) const {
  Pieces pieces = pieces_at(start.place());
  CrossingPoint here = start;
  double length = kFirstStep * longest_step(start, pieces);
  while (segments.size() < kMostSegments) {
    if (const auto end = pass_walls(here, pieces)) return *end;
    const auto next = advance(here, pieces, length);
    if (!next) return end_near(here.place(), pieces);
    if (!segments.empty()) {
      const Vector3d chord = next->to.point() - here.point();
      const double x = (start.point() - here.point()).dot(chord) / chord.squaredNorm();
      const bool passes = x > 0 && x <= 1 && start.direction().dot(chord) > 0 &&
                          (next->segment.at(x).head<3>() - start.point()).norm() <= curve_room();
      if (passes && leads_through(next->segment, x, start.place())) {
        segments.push_back(segment_between(here, start, pieces));
        deviation = std::max(deviation, deviation_of(segments.back(), pieces));
        return WalkEnd::kLoop;
      }
    }
    segments.push_back(next->segment);
    deviation = std::max(deviation, next->deviation);
    here = next->to;
  }
  return WalkEnd::kCutOff;
}

std::optional<CrossingPoint> CrossingWalk::settled(const CrossingPlace& place) const {
  const Pieces pieces = pieces_at(place);
  const auto near = point_at(place, pieces);
  if (!near) return std::nullopt;
  CrossingPlace found = place;
  if (!settle(found, pieces, {-1, near->point(), near->direction()})) return std::nullopt;
  return point_at(found.cwiseMax(walls(false, pieces)).cwiseMin(walls(true, pieces)), pieces);
}

WalkEnd CrossingWalk::end_near(const CrossingPlace& place) const {
  return end_near(place, pieces_at(place));
}

CrossingBranch CrossingWalk::branch_through(const CrossingPoint& start) const {
  CrossingBranch out;
  std::vector<CrossingSegment> after;
  out.ends[1] = walk(start, after, out.deviation);
  if (out.is_closed()) {
    out.ends[0] = WalkEnd::kLoop;
  } else {
    out.ends[0] = walk(turned(start), out.segments, out.deviation);
    std::reverse(out.segments.begin(), out.segments.end());
    for (CrossingSegment& segment : out.segments) segment = segment.reversed();
  }
  out.segments.insert(out.segments.end(), after.begin(), after.end());
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
    const CrossingJets pair = jets(at, pieces);
    const Vector3d n1 = normal(pair.first).value_or(Vector3d::Zero());
    const Vector3d n2 = normal(pair.second).value_or(Vector3d::Zero());
    Vector4d out;
    out << plane.transpose() * pair.gap(), plane.transpose() * n1.cross(n2);
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
      const CrossingJets pair = jets(x, pieces);
      if (wall_beyond(x, margins(x, pieces), pieces) || pair.gap().norm() > kNearCrossing) break;
      return Tangency{x, solver.rank() == 4};
    }
  }
  return std::nullopt;
}

}  // namespace limn
