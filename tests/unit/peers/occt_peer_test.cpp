#include "tests/peers/occt_peer.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/unit/peers/shape_answers.hpp"

namespace limn::peers {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kIntegral = 1e-6;  // relative: ten times what is asked for

TEST(OcctPeer, KeepsTheData) {
  const PeerSurface made = torus(kMajor, kMinor);
  const PeerSurface kept = OcctSurface(made).data();
  EXPECT_EQ(kept.degree, made.degree);
  EXPECT_EQ(kept.count, made.count);
  EXPECT_EQ(kept.knots, made.knots);
  EXPECT_EQ(kept.points, made.points);
  EXPECT_EQ(kept.weights, made.weights);
  EXPECT_EQ(OcctSurface(made).control_point_count(), 81);
}

TEST(OcctPeer, RefusesKnotsThatDecrease) {
  PeerSurface surface = paraboloid();
  surface.knots[0] = {1, 1, 1, -1, -1, -1};
  EXPECT_THROW(OcctSurface{surface}, std::runtime_error);
}

TEST(OcctPeer, FindsClosestPointsOfATorus) {
  expect_closest_points_of_a_torus<OcctSurface>(
      [](const OcctSurface& surface, const PeerPoint& point) { return surface.closest(point); });
}

TEST(OcctPeer, HitsATorus) {
  expect_rays_at_a_torus<OcctSurface>(
      [](const OcctSurface& surface, const PeerRay& ray) { return surface.first_hit(ray); });
}

TEST(OcctPeer, HitsAParaboloid) {
  expect_rays_at_a_paraboloid<OcctSurface>(
      [](const OcctSurface& surface, const PeerRay& ray) { return surface.first_hit(ray); });
}

TEST(OcctPeer, IntersectsAParaboloidWithPlanes) {
  expect_levels_of_a_paraboloid<OcctSurface>(
      [](const OcctSurface& a, const OcctSurface& b) { return a.intersection_with(b, 1e-7); });
}

TEST(OcctPeer, MeasuresAreas) {
  EXPECT_NEAR(*OcctSurface(torus(kMajor, kMinor)).area(1e-7), 4 * kPi * kPi * kMajor * kMinor,
              kIntegral * 400);
  EXPECT_NEAR(*OcctSurface(sphere(3)).area(1e-7), 36 * kPi, kIntegral * 110);
}

TEST(OcctPeer, MeasuresVolumes) {
  EXPECT_NEAR(*OcctSurface(torus(kMajor, kMinor)).volume(1e-7),
              2 * kPi * kPi * kMajor * kMinor * kMinor, kIntegral * 400);
  EXPECT_NEAR(*OcctSurface(sphere(3)).volume(1e-7), 36 * kPi, kIntegral * 110);
}

TEST(OcctPeer, TessellatesOnTheSurface) {
  const OcctSurface surface(torus(kMajor, kMinor));
  const std::size_t coarse = surface.tessellate(0.1, 1.0);
  const std::size_t count = surface.tessellate(0.01, 1.0);
  EXPECT_GT(coarse, 100U);
  EXPECT_GT(count, 2 * coarse);
  const PeerMesh mesh = surface.mesh();
  ASSERT_EQ(mesh.triangle_count(), count);
  ASSERT_EQ(mesh.parameters.size() / 2, mesh.positions.size() / 3);
  for (std::size_t i = 0; i < mesh.positions.size() / 3; ++i) {
    const PeerPoint on_surface =
        surface.jet(mesh.parameters[2 * i], mesh.parameters[2 * i + 1]).point;
    EXPECT_LE(distance(on_surface, triple(mesh.positions, 3 * i)), kFound);
  }
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    std::array<PeerPoint, 3> corner;
    for (std::size_t k = 0; k < 3; ++k)
      corner[k] = triple(mesh.positions, 3 * static_cast<std::size_t>(mesh.triangles[i + k]));
    PeerPoint a, b;
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = corner[1][k] - corner[0][k];
      b[k] = corner[2][k] - corner[0][k];
    }
    area += norm(cross(a, b)) / 2;
  }
  // Chords of 0.01 on a radius of 2 shorten it by some thousandths.
  EXPECT_NEAR(area / (4 * kPi * kPi * kMajor * kMinor), 1.0, 0.01);
}

TEST(OcctPeer, CrossesCurves) {
  expect_a_line_to_cross_a_circle<OcctCurve>(
      [](const OcctCurve& a, const OcctCurve& b) { return a.intersections_with(b, 1e-7); });
}

TEST(OcctPeer, CrossesAPlane) {
  expect_a_plane_to_cross_a_circle<OcctCurve>(
      [](const OcctCurve& curve, const PeerPoint& point, const PeerPoint& normal) {
        return curve.plane_crossings(point, normal);
      });
}

TEST(OcctPeer, MeasuresCurves) {
  for (const int dimension : {2, 3})
    EXPECT_NEAR(OcctCurve(circle(dimension, 5)).length(1e-9), 10 * kPi, 1e-7);
}

}  // namespace
}  // namespace limn::peers
