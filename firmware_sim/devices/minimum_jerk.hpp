#pragma once

#include <cmath>
#include <span>
#include <vector>

namespace limn::firmware {

/// A point of the tablet, in mm as in PenPose, or a difference or rate of such points.
struct PlanePoint {
  double x = 0;
  double y = 0;
  friend constexpr bool operator==(const PlanePoint&, const PlanePoint&) = default;
};

constexpr PlanePoint operator+(PlanePoint a, PlanePoint b) { return {a.x + b.x, a.y + b.y}; }
constexpr PlanePoint operator-(PlanePoint a, PlanePoint b) { return {a.x - b.x, a.y - b.y}; }
constexpr PlanePoint operator*(double factor, PlanePoint a) { return {factor * a.x, factor * a.y}; }
inline double length(PlanePoint a) noexcept { return std::sqrt(a.x * a.x + a.y * a.y); }

/// The movement from rest to rest through given points at given times that has the least integral
/// of squared jerk, which is how an arm moves a hand:
///
///     x(t) minimises  integral |x'''|^2 dt,   x(t_i) = P_i,   x' = x'' = 0 at both ends.
///
/// Its solution is a spline of degree 5, four times continuously differentiable: one quintic a
/// segment, with velocities v_i and accelerations a_i at the inner points such that jerk and snap
/// are continuous there. Those conditions are a symmetric positive definite block tridiagonal
/// system, solved once by block elimination.
/// Source: T. Flash and N. Hogan, "The coordination of arm movements", J. Neuroscience 5 (1985).
class MinimumJerk {
 public:
  /// Rests at one point for `seconds`.
  static MinimumJerk rest(PlanePoint at, double seconds);

  /// Preconditions: points.size() >= 2, durations.size() == points.size() - 1, durations > 0 (s).
  MinimumJerk(std::span<const PlanePoint> points, std::span<const double> durations);

  double duration() const noexcept { return knots_.back().time; }

  /// Position in mm at t seconds from the start; t is clamped to 0..duration().
  PlanePoint position(double t) const noexcept;
  /// Velocity in mm/s.
  PlanePoint velocity(double t) const noexcept;

 private:
  struct Knot {
    double time = 0;
    PlanePoint position;
    PlanePoint velocity;
    PlanePoint acceleration;
  };
  struct Quintic {
    PlanePoint c[6];
    double t = 0;
  };

  MinimumJerk() = default;
  void solve_inner_knots();
  Quintic segment_at(double t) const noexcept;

  std::vector<Knot> knots_;
};

/// Seconds for each segment between neighbouring points such that the hand is slow where the path
/// bends, as hands are: v = gain * curvature^(-1/3), the two-thirds power law (F. Lacquaniti,
/// C. Terzuolo, P. Viviani, Acta Psychologica 54, 1983), from rest to rest with bounded
/// acceleration. `tempo` multiplies every speed: 1 is careful drawing, 2 fluent writing.
/// Preconditions: points.size() >= 2, neighbours differ, tempo > 0.
std::vector<double> power_law_durations(std::span<const PlanePoint> points, double tempo);

}  // namespace limn::firmware
