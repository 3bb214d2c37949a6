#include <cmath>
#include <functional>
#include <numbers>

#include "tests/bench/strokes.hpp"
#include "tests/support/rng.hpp"

namespace limn::bench {

namespace {

using Eigen::Vector2d;
using std::numbers::pi;

constexpr double kSamplesPerSecond = 200;
constexpr double kCountsPerMm = 200;  // 5080 lines an inch

/// Place on the shape at s = 0..1 of its duration.
using Shape = std::function<Vector2d(double s)>;

Vector2d lissajous(double s) {
  const double a = 2 * pi * 0.97 * s;
  return {105 + 60 * std::sin(3 * a), 74 + 45 * std::sin(2 * a + 0.5)};
}

Vector2d spiral(double s) {
  const double a = 2 * pi * 6 * s;
  const double radius = 4 + 50 * s;
  return {105 + radius * std::cos(a), 74 + radius * std::sin(a)};
}

Vector2d cursive(double s) {
  const double a = 2 * pi * 14 * s;
  const double height = 7 + 2.5 * std::sin(2 * pi * 2.3 * s);
  const double y = height * std::sin(a);
  return {15 + 175 * s + 4 * std::cos(a) - 0.35 * y, 74 - y};
}

// Straight strokes between 26 points, each a minimum-jerk movement: 10 t^3 - 15 t^4 + 6 t^5.
Vector2d corners(double s) {
  constexpr int kLegs = 25;
  const auto vertex = [](int i) {
    const double up = i % 2 == 0 ? 1.0 : -1.0;
    return Vector2d(15 + 7.2 * i + 1.3 * std::sin(2.0 * i), 74 + up * (22 + 9 * std::cos(1.7 * i)));
  };
  const int leg = std::min(static_cast<int>(s * kLegs), kLegs - 1);
  const double t = s * kLegs - leg;
  const double way = t * t * t * (10 + t * (-15 + 6 * t));
  return vertex(leg) + way * (vertex(leg + 1) - vertex(leg));
}

SampledStroke draw(const std::string& name, const Shape& shape, int count, double sigma_mm,
                   test::Rng& rng) {
  const auto measured = [&rng, sigma_mm](double mm) {
    return std::round((mm + sigma_mm * rng.normal()) * kCountsPerMm) / kCountsPerMm;
  };
  SampledStroke stroke{name, {}, {}};
  for (int i = 0; i < count; ++i) {
    const Vector2d place = shape(static_cast<double>(i) / (count - 1));
    const double x = measured(place.x());
    stroke.positions.emplace_back(x, measured(place.y()));
    stroke.times.push_back(i / kSamplesPerSecond);
  }
  return stroke;
}

}  // namespace

std::vector<SampledStroke> drawn_strokes(int count, double sigma_mm) {
  test::Rng rng(20);
  return {draw("lissajous", lissajous, count, sigma_mm, rng),
          draw("spiral", spiral, count, sigma_mm, rng),
          draw("cursive", cursive, count, sigma_mm, rng),
          draw("corners", corners, count, sigma_mm, rng)};
}

}  // namespace limn::bench
