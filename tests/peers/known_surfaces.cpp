#include "tests/peers/known_surfaces.hpp"

#include <cmath>
#include <numbers>

namespace limn::peers {

namespace {

/// A quadratic arc in quarters of a circle, beginning at angle `start_quarter`; its control points
/// are corners and middles of the square round the unit circle.
struct Arc {
  Arc(int quarters, int start_quarter) {
    constexpr double kSide[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                    {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    count = 2 * quarters + 1;
    for (int i = 0; i < count; ++i) {
      const auto& corner = kSide[(i + 2 * start_quarter) % 8];
      x.push_back(corner[0]);
      y.push_back(corner[1]);
      weight.push_back(i % 2 == 0 ? 1.0 : std::numbers::sqrt2 / 2.0);
    }
    knots.push_back(0.0);
    for (int i = 0; i <= quarters; ++i)
      knots.insert(knots.end(), 2, static_cast<double>(i) / quarters);
    knots.push_back(1.0);
  }

  int count = 0;
  std::vector<double> x, y, weight, knots;
};

/// `section`, in the half plane of a distance from the z axis (middle + radius x) and a height
/// (radius y), turned about that axis.
PeerSurface revolved(const Arc& section, double middle, double radius) {
  const Arc turn(4, 0);
  PeerSurface out;
  out.degree = {2, 2};
  out.count = {turn.count, section.count};
  out.knots = {turn.knots, section.knots};
  for (std::size_t j = 0; j < section.x.size(); ++j) {
    const double distance = middle + radius * section.x[j];
    for (std::size_t i = 0; i < turn.x.size(); ++i) {
      out.points.insert(out.points.end(),
                        {distance * turn.x[i], distance * turn.y[i], radius * section.y[j]});
      out.weights.push_back(turn.weight[i] * section.weight[j]);
    }
  }
  return out;
}

double sheet_height_mm(double x, double y) {
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  const double hills = 2.5 * std::sin(kTwoPi * x / 37.0) * std::cos(kTwoPi * y / 33.0) +
                       1.5 * std::sin(kTwoPi * (x + 0.6 * y) / 41.0 + 0.7) +
                       1.0 * std::cos(kTwoPi * (0.4 * x - y) / 29.0);
  const double from_middle = (x - 50.0) / 50.0;
  return hills - 8.0 * from_middle * from_middle;
}

}  // namespace

PeerSurface wavy_sheet(int n) {
  constexpr int kDegree = 3;
  constexpr double kSize_mm = 100.0;
  std::vector<double> knots(kDegree, 0.0);
  const int spans = n - kDegree;
  for (int i = 0; i <= spans; ++i) knots.push_back(static_cast<double>(i) / spans);
  knots.insert(knots.end(), kDegree, 1.0);
  std::vector<double> places;  // at Greville abscissae, so that x and y are linear in u and v
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
    places.push_back(kSize_mm * (knots[i + 1] + knots[i + 2] + knots[i + 3]) / kDegree);
  PeerSurface out;
  out.degree = {kDegree, kDegree};
  out.count = {n, n};
  out.knots = {knots, knots};
  out.points.reserve(3 * places.size() * places.size());
  for (const double y : places)
    for (const double x : places)
      out.points.insert(out.points.end(), {x, y, sheet_height_mm(x, y)});
  return out;
}

PeerSurface paraboloid() {
  const std::vector<double> knots = {-1, -1, -1, 1, 1, 1};
  constexpr double kPlaces[] = {-1, 0, 1};
  constexpr double kSquares[] = {1, -1, 1};  // control points of t^2 over [-1, 1]
  PeerSurface out;
  out.degree = {2, 2};
  out.count = {3, 3};
  out.knots = {knots, knots};
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i)
      out.points.insert(out.points.end(), {kPlaces[i], kPlaces[j], kSquares[i] + kSquares[j]});
  return out;
}

PeerSurface torus(double major_radius, double minor_radius) {
  return revolved(Arc(4, 0), major_radius, minor_radius);
}

PeerSurface sphere(double radius) { return revolved(Arc(2, 3), 0.0, radius); }

PeerCurve circle(int dimension, double radius) {
  const Arc turn(4, 0);
  PeerCurve out;
  out.dimension = dimension;
  out.degree = 2;
  out.count = turn.count;
  out.knots = turn.knots;
  out.weights = turn.weight;
  for (std::size_t i = 0; i < turn.x.size(); ++i) {
    out.points.insert(out.points.end(), {radius * turn.x[i], radius * turn.y[i]});
    if (dimension == 3) out.points.push_back(0.0);
  }
  return out;
}

}  // namespace limn::peers
