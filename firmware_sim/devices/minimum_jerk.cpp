#include "firmware_sim/devices/minimum_jerk.hpp"

#include <algorithm>
#include <cmath>

#include "firmware_sim/devices/portable_math.hpp"

namespace limn::firmware {
namespace {

/// A 2x2 matrix by rows, acting on the pair (velocity, acceleration) of a knot.
struct Block {
  double a = 0, b = 0, c = 0, d = 0;
};

struct Pair {
  PlanePoint velocity;
  PlanePoint acceleration;
};

Pair operator*(const Block& m, const Pair& p) {
  return {m.a * p.velocity + m.b * p.acceleration, m.c * p.velocity + m.d * p.acceleration};
}
Pair operator-(const Pair& p, const Pair& q) {
  return {p.velocity - q.velocity, p.acceleration - q.acceleration};
}
Block operator*(const Block& m, const Block& n) {
  return {m.a * n.a + m.b * n.c, m.a * n.b + m.b * n.d, m.c * n.a + m.d * n.c,
          m.c * n.b + m.d * n.d};
}
Block operator-(const Block& m, const Block& n) {
  return {m.a - n.a, m.b - n.b, m.c - n.c, m.d - n.d};
}
Block inverse(const Block& m) {
  const double determinant = m.a * m.d - m.b * m.c;
  return {m.d / determinant, -m.b / determinant, -m.c / determinant, m.a / determinant};
}

/// What the quintic from knot 0 to knot 1 over T seconds, D apart, adds to the conditions at its
/// ends that neither snap nor jerk jumps there:
///     snap(0) = (-360 D + (192 v0 + 168 v1) T + (36 a0 - 24 a1) T^2) / T^4
///     jerk(0) = (  60 D - ( 36 v0 +  24 v1) T - ( 9 a0 -  3 a1) T^2) / T^3
///     snap(T) = ( 360 D - (168 v0 + 192 v1) T - (24 a0 - 36 a1) T^2) / T^4
///     jerk(T) = (  60 D - ( 24 v0 +  36 v1) T - ( 3 a0 -  9 a1) T^2) / T^3
/// First row: snap after the knot minus snap before it; second row: jerk before minus jerk after.
/// These signs make the whole system symmetric and positive definite.
struct Segment {
  Block start_start, start_end, end_start, end_end;
  Pair start_right_side, end_right_side;

  Segment(PlanePoint d, double t) {
    const double t2 = t * t;
    const double t3 = t2 * t;
    start_start = {192 / t3, 36 / t2, 36 / t2, 9 / t};
    start_end = {168 / t3, -24 / t2, 24 / t2, -3 / t};
    end_start = {168 / t3, 24 / t2, -24 / t2, -3 / t};
    end_end = {192 / t3, -36 / t2, -36 / t2, 9 / t};
    start_right_side = {(360 / (t2 * t2)) * d, (60 / t3) * d};
    end_right_side = {(360 / (t2 * t2)) * d, (-60 / t3) * d};
  }
};

/// 1 / radius of the circle through three points (Menger): 4 area / product of the sides.
double curvature(PlanePoint a, PlanePoint b, PlanePoint c) noexcept {
  const PlanePoint ab = b - a;
  const PlanePoint bc = c - b;
  const double twice_area = std::abs(ab.x * bc.y - ab.y * bc.x);
  const double sides = length(ab) * length(bc) * length(c - a);
  // Three points of which the outer two coincide: the path turns back on itself.
  constexpr double kTurningBack = 10;  // per mm
  return sides > 0 ? std::min(2 * twice_area / sides, kTurningBack) : kTurningBack;
}

}  // namespace

MinimumJerk MinimumJerk::rest(PlanePoint at, double seconds) {
  MinimumJerk out;
  out.knots_ = {{0, at, {}, {}}, {seconds, at, {}, {}}};
  return out;
}

MinimumJerk::MinimumJerk(std::span<const PlanePoint> points, std::span<const double> durations) {
  knots_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    knots_[i].position = points[i];
    if (i > 0) knots_[i].time = knots_[i - 1].time + durations[i - 1];
  }
  solve_inner_knots();
}

void MinimumJerk::solve_inner_knots() {
  const std::size_t last = knots_.size() - 1;
  const auto segment_after = [&](std::size_t i) {
    return Segment(knots_[i + 1].position - knots_[i].position,
                   knots_[i + 1].time - knots_[i].time);
  };
  // Elimination: knot i = carry_i - link_i * knot i+1. The ends are known to be 0.
  std::vector<Block> link(knots_.size());
  std::vector<Pair> carry(knots_.size());
  for (std::size_t i = 1; i < last; ++i) {
    const Segment before = segment_after(i - 1);
    const Segment after = segment_after(i);
    const Block diagonal = {
        before.end_end.a + after.start_start.a, before.end_end.b + after.start_start.b,
        before.end_end.c + after.start_start.c, before.end_end.d + after.start_start.d};
    const Pair right_side = {
        before.end_right_side.velocity + after.start_right_side.velocity,
        before.end_right_side.acceleration + after.start_right_side.acceleration};
    const Block pivot = inverse(diagonal - before.end_start * link[i - 1]);
    link[i] = pivot * after.start_end;
    carry[i] = pivot * (right_side - before.end_start * carry[i - 1]);
  }
  for (std::size_t i = last; i-- > 1;) {
    const Pair next = {knots_[i + 1].velocity, knots_[i + 1].acceleration};
    const Pair solved = carry[i] - link[i] * next;
    knots_[i].velocity = solved.velocity;
    knots_[i].acceleration = solved.acceleration;
  }
}

MinimumJerk::Quintic MinimumJerk::segment_at(double t) const noexcept {
  t = std::clamp(t, 0.0, duration());
  const auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, t,
                                      [](double value, const Knot& k) { return value < k.time; });
  const Knot& one = *after;
  const Knot& zero = *(after - 1);
  const double span = one.time - zero.time;
  // In units of the segment: u = t / T in 0..1, velocities times T, accelerations times T^2.
  const PlanePoint d = one.position - zero.position;
  const PlanePoint v0 = span * zero.velocity;
  const PlanePoint v1 = span * one.velocity;
  const PlanePoint a0 = (span * span) * zero.acceleration;
  const PlanePoint a1 = (span * span) * one.acceleration;
  Quintic q;
  q.t = t - zero.time;
  const double s = 1 / span;
  q.c[0] = zero.position;
  q.c[1] = zero.velocity;
  q.c[2] = 0.5 * zero.acceleration;
  q.c[3] = (s * s * s) * (10 * d - 4 * v1 - 6 * v0 - 1.5 * a0 + 0.5 * a1);
  q.c[4] = (s * s * s * s) * (7 * v1 + 8 * v0 - 15 * d + 1.5 * a0 - a1);
  q.c[5] = (s * s * s * s * s) * (6 * d - 3 * v1 - 3 * v0 + 0.5 * a1 - 0.5 * a0);
  return q;
}

PlanePoint MinimumJerk::position(double t) const noexcept {
  const Quintic q = segment_at(t);
  PlanePoint sum = q.c[5];
  for (int i = 4; i >= 0; --i) sum = q.t * sum + q.c[i];
  return sum;
}

PlanePoint MinimumJerk::velocity(double t) const noexcept {
  const Quintic q = segment_at(t);
  PlanePoint sum = 5 * q.c[5];
  for (int i = 4; i >= 1; --i) sum = q.t * sum + static_cast<double>(i) * q.c[i];
  return sum;
}

std::vector<double> power_law_durations(std::span<const PlanePoint> points, double tempo) {
  constexpr double kGain = 15;             // mm/s at a curvature of 1/mm
  constexpr double kStraight = 1.0 / 120;  // per mm; the hand is no faster on straighter paths
  constexpr double kAcceleration = 400;    // mm/s^2
  const std::size_t last = points.size() - 1;
  std::vector<double> speed(points.size());
  for (std::size_t i = 1; i < last; ++i) {
    const double bend = std::max(curvature(points[i - 1], points[i], points[i + 1]), kStraight);
    speed[i] = tempo * kGain / portable_cbrt(bend);
  }
  const double twice_acceleration = 2 * kAcceleration * tempo * tempo;
  const auto limit = [&](std::size_t to, std::size_t from) {
    const double gained = twice_acceleration * length(points[to] - points[from]);
    speed[to] = std::min(speed[to], std::sqrt(speed[from] * speed[from] + gained));
  };
  for (std::size_t i = 1; i < last; ++i) limit(i, i - 1);
  for (std::size_t i = last; i-- > 1;) limit(i, i + 1);

  std::vector<double> durations(last);
  for (std::size_t i = 0; i < last; ++i) {
    const double distance = length(points[i + 1] - points[i]);
    // From rest to rest in one go the mean speed is that of constant acceleration and braking.
    durations[i] = last == 1 ? 2 * std::sqrt(2 * distance / twice_acceleration)
                             : 2 * distance / (speed[i] + speed[i + 1]);
  }
  return durations;
}

}  // namespace limn::firmware
