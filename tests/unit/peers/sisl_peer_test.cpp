#include "tests/peers/sisl_peer.hpp"

#include <gtest/gtest.h>

#include "tests/unit/peers/shape_answers.hpp"

namespace limn::peers {
namespace {

constexpr double kAsked = 1e-8;  // tolerance of a search

TEST(SislPeer, KeepsTheData) {
  const PeerSurface made = torus(kMajor, kMinor);
  const PeerSurface kept = SislSurface(made).data();
  EXPECT_EQ(kept.degree, made.degree);
  EXPECT_EQ(kept.count, made.count);
  EXPECT_EQ(kept.knots, made.knots);
  EXPECT_EQ(kept.weights, made.weights);
  ASSERT_EQ(kept.points.size(), made.points.size());
  for (std::size_t i = 0; i < made.points.size(); ++i)
    EXPECT_DOUBLE_EQ(kept.points[i], made.points[i]);  // times the weight and back
  EXPECT_EQ(SislSurface(made).control_point_count(), 81);
}

TEST(SislPeer, FindsClosestPointsOfATorus) {
  expect_closest_points_of_a_torus<SislSurface>(
      [](const SislSurface& surface, const PeerPoint& point) {
        return surface.closest(point, kAsked);
      });
}

TEST(SislPeer, HitsATorus) {
  expect_rays_at_a_torus<SislSurface>([](const SislSurface& surface, const PeerRay& ray) {
    return surface.first_hit(ray, kAsked);
  });
}

TEST(SislPeer, HitsAParaboloid) {
  expect_rays_at_a_paraboloid<SislSurface>([](const SislSurface& surface, const PeerRay& ray) {
    return surface.first_hit(ray, kAsked);
  });
}

TEST(SislPeer, IntersectsAParaboloidWithPlanes) {
  expect_levels_of_a_paraboloid<SislSurface>(
      [](const SislSurface& a, const SislSurface& b) { return a.intersection_with(b, kAsked); });
}

TEST(SislPeer, CrossesCurves) {
  expect_a_line_to_cross_a_circle<SislCurve>(
      [](const SislCurve& a, const SislCurve& b) { return a.intersections_with(b, kAsked); });
}

TEST(SislPeer, CrossesAPlane) {
  expect_a_plane_to_cross_a_circle<SislCurve>(
      [](const SislCurve& curve, const PeerPoint& point, const PeerPoint& normal) {
        return curve.plane_crossings(point, normal, kAsked);
      });
}

TEST(SislPeer, MeasuresCurves) {
  for (const int dimension : {2, 3})
    EXPECT_NEAR(SislCurve(circle(dimension, 5)).length(1e-9), 10 * std::numbers::pi, 1e-6);
}

}  // namespace
}  // namespace limn::peers
