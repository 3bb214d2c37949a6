#include "input/sample/tilt.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "input/base/expect.hpp"

namespace limn {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kTerms = 10;     // of the sine and cosine series
constexpr std::size_t kArcTerms = 13;  // of the arc tangent series

struct SineCosine {
  double sine;
  double cosine;
};

/// Coefficients in s = r^2 of sin(r) / r (`first` 1) and of cos(r) (`first` 0): alternating
/// reciprocals of factorials.
constexpr std::array<double, kTerms> sine_series(int first) {
  std::array<double, kTerms> series{1.0};
  for (int k = 1; k < static_cast<int>(kTerms); ++k) {
    const int n = 2 * k + first;
    series[static_cast<std::size_t>(k)] =
        -series[static_cast<std::size_t>(k - 1)] / static_cast<double>(n * (n - 1));
  }
  return series;
}

constexpr std::array<double, kTerms> kSine = sine_series(1);
constexpr std::array<double, kTerms> kCosine = sine_series(0);

/// Coefficients in s = t^2 of atan(t) / t: alternating reciprocals of odd numbers.
constexpr std::array<double, kArcTerms> arc_series() {
  std::array<double, kArcTerms> series{};
  double sign = 1;
  for (std::size_t k = 0; k < kArcTerms; ++k) {
    series[k] = sign / static_cast<double>(2 * k + 1);
    sign = -sign;
  }
  return series;
}

constexpr std::array<double, kArcTerms> kArcTangent = arc_series();

template <std::size_t kCount>
double polynomial(const std::array<double, kCount>& coefficients, double s) noexcept {
  double sum = coefficients[kCount - 1];
  for (std::size_t k = kCount - 1; k-- > 0;) sum = sum * s + coefficients[k];
  return sum;
}

/// For |r| <= pi/4 the first term left out is below 1e-18.
SineCosine small_angle(double r) noexcept {
  const double s = r * r;
  return {r * polynomial(kSine, s), polynomial(kCosine, s)};
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

/// atan(t) for 0 <= t <= 1. Two halvings, atan t = 2 atan(t / (1 + sqrt(1 + t^2))), bring t below
/// 0.199, where the first term left out is below 1e-18.
double arc_tangent_to_one(double t) noexcept {
  t = t / (1 + std::sqrt(1 + t * t));
  t = t / (1 + std::sqrt(1 + t * t));
  return 4 * t * polynomial(kArcTangent, t * t);
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
