#include "tests/peers/random_surfaces.hpp"

#include <cmath>
#include <numbers>

namespace limn::peers {

namespace {

using test::Rng;

double rounded(double x, int decimals) {
  if (decimals == 0) return x;
  const double scale = std::pow(10.0, decimals);
  return std::round(x * scale) / scale;
}

std::vector<double> random_knots(Rng& rng, int degree, const RandomSplines& bounds) {
  const auto interior = rng.integer(1, bounds.max_interior_knots);
  double at = rng.uniform(-2.0, 2.0);
  std::vector<double> knots;
  const auto append = [&](std::int64_t multiplicity) {
    for (std::int64_t k = 0; k < multiplicity; ++k) knots.push_back(rounded(at, bounds.decimals));
    at += rng.uniform(0.2, 1.0);
  };
  append(degree + 1);
  for (std::int64_t i = 0; i < interior; ++i)
    append(rng.chance(bounds.repeated) ? rng.integer(1, degree) : 1);
  append(degree + 1);
  return knots;
}

int point_count(const std::vector<double>& knots, int degree) {
  return static_cast<int>(knots.size()) - degree - 1;
}

std::vector<double> random_weights(Rng& rng, int count, const RandomSplines& bounds) {
  std::vector<double> weights;
  if (!rng.chance(bounds.rational)) return weights;
  for (int i = 0; i < count; ++i)
    weights.push_back(rounded(rng.uniform(0.3, 3.0), bounds.decimals));
  return weights;
}

constexpr double kShift = 0.7;

/// Simple knots of equal spacing over 0 .. 1.
std::vector<double> uniform_knots(int degree, int count) {
  std::vector<double> knots(static_cast<std::size_t>(degree), 0.0);
  const int spans = count - degree;
  for (int i = 0; i <= spans; ++i) knots.push_back(static_cast<double>(i) / spans);
  knots.insert(knots.end(), static_cast<std::size_t>(degree), 1.0);
  return knots;
}

/// Over [-5, 5]^2, with control points up to 2 above and below.
PeerSurface random_sheet(Rng& rng) {
  constexpr double kHeight = 1.5;
  PeerSurface sheet;
  for (std::size_t d = 0; d < 2; ++d) {
    sheet.degree[d] = static_cast<int>(rng.integer(2, 4));
    sheet.count[d] = static_cast<int>(rng.integer(6, 10));
    sheet.knots[d] = uniform_knots(sheet.degree[d], sheet.count[d]);
  }
  const auto place = [](int i, int count) { return 10.0 * i / (count - 1) - 5.0; };
  for (int j = 0; j < sheet.count[1]; ++j)
    for (int i = 0; i < sheet.count[0]; ++i)
      sheet.points.insert(sheet.points.end(), {place(i, sheet.count[0]), place(j, sheet.count[1]),
                                               rng.uniform(-kHeight, kHeight)});
  return sheet;
}

/// Turned by `angle` about the axis (cos azimuth, sin azimuth, 0) through the origin.
void turn(std::vector<double>& points, double azimuth, double angle) {
  const double a = std::cos(azimuth), b = std::sin(azimuth);
  for (std::size_t i = 0; i < points.size(); i += 3) {
    const double x = points[i], y = points[i + 1], z = points[i + 2];
    const double along = a * x + b * y;
    const double across = a * y - b * x;
    const double turned = std::cos(angle) * across - std::sin(angle) * z;
    points[i] = a * along - b * turned;
    points[i + 1] = b * along + a * turned;
    points[i + 2] = std::sin(angle) * across + std::cos(angle) * z;
  }
}

}  // namespace

PeerSurface random_surface(Rng& rng, const RandomSplines& bounds) {
  PeerSurface out;
  for (std::size_t d = 0; d < 2; ++d) {
    out.degree[d] = static_cast<int>(rng.integer(1, bounds.max_degree));
    out.knots[d] = random_knots(rng, out.degree[d], bounds);
    out.count[d] = point_count(out.knots[d], out.degree[d]);
  }
  for (int j = 0; j < out.count[1]; ++j) {
    for (int i = 0; i < out.count[0]; ++i) {
      for (const double at : {static_cast<double>(i), static_cast<double>(j), 0.0})
        out.points.push_back(rounded(at + rng.uniform(-kShift, kShift), bounds.decimals));
    }
  }
  out.weights = random_weights(rng, out.count[0] * out.count[1], bounds);
  return out;
}

PeerCurve random_curve(Rng& rng, int dimension, const RandomSplines& bounds) {
  PeerCurve out;
  out.dimension = dimension;
  out.degree = static_cast<int>(rng.integer(1, bounds.max_degree));
  out.knots = random_knots(rng, out.degree, bounds);
  out.count = point_count(out.knots, out.degree);
  for (int i = 0; i < out.count; ++i)
    for (int k = 0; k < dimension; ++k)
      out.points.push_back(
          rounded((k == 0 ? i : 0) + rng.uniform(-kShift, kShift), bounds.decimals));
  out.weights = random_weights(rng, out.count, bounds);
  return out;
}

std::pair<PeerSurface, PeerSurface> random_crossing_pair(Rng& rng) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  PeerSurface first = random_sheet(rng);
  PeerSurface second = random_sheet(rng);
  const double azimuth = rng.uniform(0.0, 360.0 * kDegree);
  turn(second.points, azimuth, rng.uniform(10.0, 90.0) * kDegree);
  return {std::move(first), std::move(second)};
}

}  // namespace limn::peers
