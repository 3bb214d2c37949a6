#include "input/sample/tilt.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "input/base/expect.hpp"

namespace limn {
namespace {

constexpr double kPi = std::numbers::pi;

struct SineCosine {
  double sine;
  double cosine;
};

/// Taylor series about 0. For |r| <= pi/4 the first term left out is below 1e-18.
SineCosine small_angle(double r) noexcept {
  const double s = r * r;
  double sine = 0;
  double cosine = 0;
  for (int n = 17; n >= 1; n -= 2) {
    sine = 1 - sine * s / ((n + 1) * (n + 2));
    cosine = 1 - cosine * s / (n * (n + 1));
  }
  return {r * sine, cosine};
}

/// Exact at multiples of 90 degrees, because the quadrant is split off before any rounding.
SineCosine sine_cosine(double degrees) noexcept {
  const double turn = std::fmod(degrees, 360.0);  // fmod is exact
  const double quarter = std::floor(turn / 90.0 + 0.5);
  const SineCosine r = small_angle((turn - quarter * 90.0) * (kPi / 180.0));
  switch ((static_cast<int>(quarter) + 8) % 4) {
    case 0:
      return r;
    case 1:
      return {r.cosine, -r.sine};
    case 2:
      return {-r.sine, -r.cosine};
    default:
      return {-r.cosine, r.sine};
  }
}

/// atan(t) for 0 <= t <= 1: two halvings, atan t = 2 atan(t / (1 + sqrt(1 + t^2))), bring t below
/// 0.199, where 12 terms of the series leave less than 1e-18.
double arc_tangent_to_one(double t) noexcept {
  t = t / (1 + std::sqrt(1 + t * t));
  t = t / (1 + std::sqrt(1 + t * t));
  const double s = t * t;
  double sum = 0;
  for (int n = 25; n >= 1; n -= 2) sum = 1.0 / n - s * sum;
  return 4 * t * sum;
}

/// atan2(y, x) for x >= 0; 0 where both are 0.
double arc_tangent(double y, double x) noexcept {
  const double height = std::fabs(y);
  if (height == 0) return 0;
  const double angle =
      height <= x ? arc_tangent_to_one(height / x) : kPi / 2 - arc_tangent_to_one(x / height);
  return y < 0 ? -angle : angle;
}

}  // namespace

Tilt tilt_from_altitude_azimuth(double altitude_deg, double azimuth_deg) noexcept {
  LIMN_EXPECT(std::isfinite(altitude_deg) && std::isfinite(azimuth_deg));
  const SineCosine altitude = sine_cosine(std::clamp(altitude_deg, 0.0, 90.0));
  const SineCosine azimuth = sine_cosine(azimuth_deg);
  return {arc_tangent(azimuth.cosine * altitude.cosine, altitude.sine),
          arc_tangent(azimuth.sine * altitude.cosine, altitude.sine)};
}

}  // namespace limn
