#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "tests/peers/known_surfaces.hpp"
#include "tests/support/rng.hpp"
#include "tests/unit/peers/distance.hpp"

namespace limn::peers {

// What every peer must answer about shapes whose answers are known. Each function makes the peer's
// surface (or curve) and asks it through `ask`.

constexpr double kMajor = 5.0, kMinor = 2.0;  // of the torus
constexpr double kFound = 1e-6;               // peers search to about 1e-7 themselves

/// ask(surface, point) is the place closest to the point.
template <typename Surface, typename Ask>
void expect_closest_points_of_a_torus(const Ask& ask) {
  const Surface surface(torus(kMajor, kMinor));
  test::Rng rng(0x70125);
  for (int k = 0; k < 100; ++k) {
    const double turn = rng.uniform(0, 2 * std::numbers::pi);
    const double tube = rng.uniform(0, 2 * std::numbers::pi);
    // Off the circle inside the tube, and not as far as the axis, whence all answers are right.
    const double radius = rng.chance(0.5) ? rng.uniform(0.3, 1.7) : rng.uniform(2.3, 4.5);
    const auto at = [&](double r) {
      const double from_axis = kMajor + r * std::cos(tube);
      return PeerPoint{from_axis * std::cos(turn), from_axis * std::sin(turn), r * std::sin(tube)};
    };
    const std::optional<PeerParameters> place = ask(surface, at(radius));
    ASSERT_TRUE(place.has_value()) << "point " << k;
    EXPECT_LE(distance(surface.jet(place->u, place->v).point, at(kMinor)), kFound) << "point " << k;
  }
}

/// ask(surface, ray) is the first hit.
template <typename Surface, typename Ask>
void expect_rays_at_a_torus(const Ask& ask) {
  const Surface surface(torus(kMajor, kMinor));
  test::Rng rng(0x70126);
  for (int k = 0; k < 100; ++k) {
    const double turn = rng.uniform(0, 2 * std::numbers::pi);
    const double height = rng.uniform(-0.9, 0.9) * kMinor;
    const double speed = rng.uniform(0.5, 2.0);  // the direction's length
    const double c = std::cos(turn), s = std::sin(turn);
    const PeerRay inwards = {{10 * c, 10 * s, height}, {-speed * c, -speed * s, 0}};
    const double outermost = kMajor + std::sqrt(kMinor * kMinor - height * height);
    const std::optional<PeerHit> hit = ask(surface, inwards);
    ASSERT_TRUE(hit.has_value()) << "ray " << k;
    EXPECT_NEAR(hit->t, (10 - outermost) / speed, kFound) << "ray " << k;
    EXPECT_LE(distance(surface.jet(hit->u, hit->v).point, along(inwards, hit->t)), kFound);

    const PeerRay outwards = {inwards.origin, {speed * c, speed * s, 0}};
    EXPECT_FALSE(ask(surface, outwards).has_value()) << "what lies behind is no hit";
    const PeerRay above = {{10 * c, 10 * s, kMinor + 0.1}, {-speed * c, -speed * s, 0}};
    EXPECT_FALSE(ask(surface, above).has_value());
  }
}

/// ask(surface, ray) is the first hit.
template <typename Surface, typename Ask>
void expect_rays_at_a_paraboloid(const Ask& ask) {
  const Surface surface(paraboloid());
  test::Rng rng(0x70127);
  for (int k = 0; k < 100; ++k) {
    const double x = rng.uniform(-0.9, 0.9), y = rng.uniform(-0.9, 0.9);
    const std::optional<PeerHit> hit = ask(surface, PeerRay{{x, y, 3}, {0, 0, -1}});
    ASSERT_TRUE(hit.has_value()) << "ray " << k;
    EXPECT_NEAR(hit->u, x, kFound);
    EXPECT_NEAR(hit->v, y, kFound);
    EXPECT_NEAR(hit->t, 3 - x * x - y * y, kFound);
  }
}

/// z = height over [-1, 1]^2.
inline PeerSurface level(double height) {
  PeerSurface out;
  out.degree = {1, 1};
  out.count = {2, 2};
  out.knots = {{{-1, -1, 1, 1}, {-1, -1, 1, 1}}};
  out.points = {-1, -1, height, 1, -1, height, -1, 1, height, 1, 1, height};
  return out;
}

/// The paraboloid meets z = 0.5 in one circle, z = 1.5 in four arcs at its corners and z = -0.5
/// nowhere. ask(first, second) is the intersection.
template <typename Surface, typename Ask>
void expect_levels_of_a_paraboloid(const Ask& ask) {
  const Surface surface(paraboloid());
  for (const auto& [height, count] : {std::pair(0.5, 1U), {1.5, 4U}, {-0.5, 0U}}) {
    const Surface plane(level(height));
    const std::optional<PeerIntersection> found = ask(surface, plane);
    ASSERT_TRUE(found.has_value()) << height;
    EXPECT_EQ(found->points.size(), 0U) << height;
    ASSERT_EQ(found->branches.size(), count) << height;
    for (const auto& branch : found->branches) {
      EXPECT_EQ(branch.is_closed, count == 1) << height;
      ASSERT_GE(branch.places.size(), 3U);
      for (const auto& [a, b] : branch.places) {
        EXPECT_LE(distance(surface.jet(a.u, a.v).point, plane.jet(b.u, b.v).point), kFound);
        EXPECT_NEAR(a.u * a.u + a.v * a.v, height, kFound);
      }
    }
  }
}

inline PeerCurve line(int dimension, PeerPoint from, PeerPoint to) {
  PeerCurve out;
  out.dimension = dimension;
  out.degree = 1;
  out.count = 2;
  out.knots = {0, 0, 1, 1};
  for (const auto& p : {from, to}) out.points.insert(out.points.end(), &p[0], &p[0] + dimension);
  return out;
}

/// A line crosses a circle twice. ask(first, second) is the pairs of parameters.
template <typename Curve, typename Ask>
void expect_a_line_to_cross_a_circle(const Ask& ask) {
  for (const int dimension : {2, 3}) {
    const Curve round(circle(dimension, 5));
    const Curve straight(line(dimension, {-10, 3, 0}, {10, 3, 0}));  // crosses at (-4, 3), (4, 3)
    std::vector<PeerCurvePair> found = ask(round, straight);
    ASSERT_EQ(found.size(), 2U) << dimension;
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.second < b.second; });
    EXPECT_NEAR(found[0].second, 0.3, kFound);
    EXPECT_NEAR(found[1].second, 0.7, kFound);
    for (const auto& pair : found)
      EXPECT_LE(distance(round.jet(pair.first).point, straight.jet(pair.second).point), kFound);
  }
}

/// ask(curve, point, normal) is the parameters where the curve crosses that plane.
template <typename Curve, typename Ask>
void expect_a_plane_to_cross_a_circle(const Ask& ask) {
  const Curve round(circle(3, 5));
  std::vector<double> found = ask(round, PeerPoint{0, 3, 0}, PeerPoint{0, 2, 0});
  ASSERT_EQ(found.size(), 2U);
  std::sort(found.begin(), found.end());
  EXPECT_LE(distance(round.jet(found[0]).point, {4, 3, 0}), kFound);
  EXPECT_LE(distance(round.jet(found[1]).point, {-4, 3, 0}), kFound);
}

}  // namespace limn::peers
