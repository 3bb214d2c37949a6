// Closest points, rays and crossings of surfaces at the ends of what is accepted: periodic ones,
// degree 0 to 25, breaks, degenerate edges, identical surfaces, huge coordinates.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "modeler/bspline/refine.hpp"
#include "modeler/surface/surface_index.hpp"
#include "tests/property/modeler/crossing_checks.hpp"

namespace limn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;
using test::ball;
using test::cross;
using test::expect_length;
using test::frame_at;
using test::square;
using test::total_length;

constexpr double kSame = 1e-9;  // mm: kGeometric

/// Whatever is found consists of numbers.
void expect_numbers(const SurfaceCrossings& found) {
  for (const SurfaceCrossing& c : found.curves) {
    for (const BsplineCurve<2>* on : {&c.on_first, &c.on_second}) {
      for (std::size_t i = 0; i < on->control_points().size(); ++i) {
        EXPECT_TRUE(on->control_points()[i].allFinite());
      }
    }
    EXPECT_TRUE(std::isfinite(c.deviation));
  }
  for (const SurfaceTouch& t : found.touches) {
    EXPECT_TRUE(t.point.allFinite() && t.on_first.allFinite() && t.on_second.allFinite());
    EXPECT_TRUE(std::isfinite(t.extent));
  }
}

/// A round tube about the z axis, 10 long, periodic around.
BsplineSurface periodic_tube() {
  constexpr int kCount = 8;
  constexpr int kDegree = 3;
  const std::array<double, kCount> round = {0, 1, 2, 3, 4, 5, 6, 7};
  std::vector<Vector3d> points;
  for (const double z : {0.0, 10.0}) {
    for (int i = 0; i < kCount + kDegree; ++i) {
      const double a = 2 * pi * (i % kCount) / kCount;
      points.emplace_back(5 * std::cos(a), 5 * std::sin(a), z);
    }
  }
  return *BsplineSurface::make(
      {*KnotVector::make_periodic(kDegree, round, kCount), *KnotVector::make_clamped(1, 0, 1)},
      points);
}

/// The same questions have the same answers as those of its clamped form.
TEST(SurfaceExtremes, PeriodicSurface) {
  const BsplineSurface tube = periodic_tube();
  const auto cut = segment(tube, 0, tube.knots(0).domain_begin(), tube.knots(0).domain_end());
  ASSERT_TRUE(cut) << cut.error().what;
  const BsplineSurface& open = *cut;
  ASSERT_FALSE(open.knots(0).is_periodic());
  const SurfaceIndex index(tube);
  const SurfaceIndex other(open);
  for (const Vector3d& p : {Vector3d(1, 2, 3), Vector3d(9, 0, 4), Vector3d(4, -1e-7, 20)}) {
    const ClosestPoint found = index.closest_point(p);
    EXPECT_NEAR(found.distance, other.closest_point(p).distance, kSame);
    EXPECT_LE(found.slack, 1.001 * kSame);
    const Ray ray{p, {-3, 0.2, 0.1}};
    const RayHits hits = index.all_hits(ray);
    const RayHits others = other.all_hits(ray);
    EXPECT_TRUE(hits.complete);
    ASSERT_EQ(hits.hits.size(), others.hits.size());
    for (std::size_t i = 0; i < hits.hits.size(); ++i) {
      EXPECT_NEAR(hits.hits[i].t, others.hits[i].t, kSame);
    }
  }
  const BsplineSurface level = square({0, 0, 4}, 20);
  const double round = total_length(cross(open, level));
  EXPECT_GT(round, 25);
  expect_length(tube, level, round);
  // Along rulings, one of them the seam.
  expect_length(tube, square({0, 0, 5}, 30, Vector3d(1, 1, 0).normalized(), Vector3d::UnitZ()), 20);
}

TEST(SurfaceExtremes, ADirectionOfDegreeZero) {
  // Two lines along z, at x = 0 and x = 3.
  const auto lines =
      *BsplineSurface::make({*KnotVector::make(0, {0, 1, 2}), *KnotVector::make_clamped(1, 0, 1)},
                            {{0, 0, -1}, {3, 0, -1}, {0, 0, 1}, {3, 0, 1}});
  const SurfaceIndex index(lines);
  const ClosestPoint closest = index.closest_point({3.5, 0, 0.25});
  EXPECT_NEAR(closest.distance, 0.5, kSame);
  EXPECT_LT((closest.point - Vector3d(3, 0, 0.25)).norm(), 1e-6);
  const RayHits hits = index.all_hits({{3, -5, 0.5}, {0, 1, 0}});
  ASSERT_EQ(hits.hits.size(), 1U);
  EXPECT_NEAR(hits.hits[0].t, 5, 1e-6);
  EXPECT_TRUE(index.all_hits({{1.5, -5, 0.5}, {0, 1, 0}}).hits.empty()) << "between them";
  const SurfaceCrossings found = cross(lines, square({0, 0, 0}, 20));
  expect_numbers(found);
  EXPECT_TRUE(found.complete && found.curves.empty());
  EXPECT_EQ(found.touches.size(), 2U);

  const auto points = *BsplineSurface::make(
      {*KnotVector::make(0, {0, 1, 2}), *KnotVector::make(0, {0, 1})}, {{0, 0, 0}, {3, 0, 0}});
  EXPECT_NEAR(SurfaceIndex(points).closest_point({3, 4, 0}).distance, 4, kSame);
  const SurfaceCrossings in_points = cross(points, square({0, 0, 0}, 20));
  expect_numbers(in_points);
  EXPECT_TRUE(in_points.curves.empty());
  EXPECT_EQ(in_points.touches.size(), 2U);
}

TEST(SurfaceExtremes, ASurfaceThatBreaksOff) {
  const KnotVector v = *KnotVector::make_clamped(1, 0, 1);
  const auto sheets = *BsplineSurface::make(
      {*KnotVector::make(1, {0, 0, 1, 1, 2, 2}), v},
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {3, 1, 0}});
  const SurfaceIndex index(sheets);
  EXPECT_NEAR(index.closest_point({1.2, 0.5, 0}).distance, 0.2, kSame);
  EXPECT_NEAR(index.closest_point({1.9, 0.5, 0}).distance, 0.1, kSame);
  EXPECT_EQ(index.all_hits({{0.5, 0.5, 1}, {0, 0, -1}}).hits.size(), 1U);
  EXPECT_TRUE(index.all_hits({{1.5, 0.5, 1}, {0, 0, -1}}).hits.empty()) << "in the gap";
  expect_length(sheets, square({1, 0.5, 0}, 20, Vector3d::UnitX(), Vector3d::UnitZ()), 2);
  // The second sheet is a step higher: a slanted plane meets both, and nothing between them.
  const auto steps = *BsplineSurface::make(
      {*KnotVector::make(1, {0, 0, 1, 1, 2, 2}), v},
      {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {2, 0, 1}, {0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {2, 1, 1}});
  expect_length(steps, square({1, 0.5, 0}, 20, Vector3d::UnitX(), Vector3d::UnitZ()), 2);
}

/// z = x^2 + y^2 for -1 <= x, y <= 1, of any degree from 2.
BsplineSurface paraboloid(int degree) {
  const KnotVector knots = *KnotVector::make_clamped(2, 0, 1);
  const std::array<double, 3> square = {1, -1, 1};
  std::vector<Vector3d> points;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      points.emplace_back(double(i) - 1, double(j) - 1, square[i] + square[j]);
    }
  }
  const auto quadratic = *BsplineSurface::make({knots, knots}, points);
  return *elevate_degree(*elevate_degree(quadratic, 0, degree - 2), 1, degree - 2);
}

TEST(SurfaceExtremes, HighDegrees) {
  for (const int degree : {9, 15, 20, 25}) {
    const testing::ScopedTrace trace(__FILE__, __LINE__, degree);
    const BsplineSurface bowl = paraboloid(degree);
    ASSERT_EQ(bowl.knots(1).degree(), degree);
    const SurfaceIndex index(bowl);
    EXPECT_NEAR(index.closest_point({0.1, 0.2, -1}).distance,
                SurfaceIndex(paraboloid(2)).closest_point({0.1, 0.2, -1}).distance, kSame);
    const RayHits hits = index.all_hits({{0.3, 0.2, 5}, {0, 0, -1}});
    EXPECT_TRUE(hits.complete);
    ASSERT_EQ(hits.hits.size(), 1U);
    EXPECT_NEAR(hits.hits[0].t, 5 - 0.13, kSame);
    expect_length(bowl, square({0, 0, 0.25}, 4), pi);
    const SurfaceCrossings touching = cross(bowl, square({0, 0, 0}, 4));
    EXPECT_TRUE(touching.complete && touching.curves.empty());
    ASSERT_EQ(touching.touches.size(), 1U);
    EXPECT_LT(touching.touches[0].point.norm(), 1e-6);
  }
}

/// A sheet of which one edge is one point.
TEST(SurfaceExtremes, DegenerateEdge) {
  const KnotVector knots = *KnotVector::make_clamped(1, 0, 1);
  const auto triangle =
      *BsplineSurface::make({knots, knots}, {{0, 0, 0}, {0, 0, 0}, {-1, 2, 0}, {1, 2, 0}});
  const SurfaceIndex index(triangle);
  EXPECT_NEAR(index.closest_point({0, -3, 4}).distance, 5, kSame);
  const RayHits hits = index.all_hits({{0, 0, 1}, {0, 0, -1}});
  ASSERT_EQ(hits.hits.size(), 1U);
  EXPECT_NEAR(hits.hits[0].t, 1, kSame);
  const Vector3d z = Vector3d::UnitZ();
  expect_length(triangle, square({0, 0, 0}, 10, Vector3d::UnitY(), z), 2);        // from the point
  expect_length(triangle, square({0, 1e-5, 0}, 10, Vector3d::UnitX(), z), 1e-5);  // beside it
  const SurfaceCrossings found = cross(triangle, square({0, 0, 0}, 10, Vector3d::UnitX(), z));
  EXPECT_TRUE(found.complete && found.curves.empty());
  ASSERT_EQ(found.touches.size(), 1U) << "the point itself";
  EXPECT_LT(found.touches[0].point.norm(), 1e-6);
  EXPECT_LT(found.touches[0].extent, 1e-5);
}

TEST(SurfaceExtremes, IdenticalSurfaces) {
  const BsplineSurface plane = square({0, 0, 0}, 10);
  const SurfaceCrossings planes = cross(plane, plane);
  EXPECT_TRUE(planes.curves.empty());
  ASSERT_EQ(planes.touches.size(), 1U);
  EXPECT_GT(planes.touches[0].extent, 10);
  const BsplineSurface tube = periodic_tube();
  const SurfaceCrossings tubes = cross(tube, tube);
  expect_numbers(tubes);
  EXPECT_TRUE(!tubes.complete || !tubes.touches.empty());
}

TEST(SurfaceExtremes, ARayAlongARulingRunsAlongIt) {
  const BsplineSurface tube = periodic_tube();
  const Vector3d foot = tube.point({0.5, 0});
  const RayHits hits = SurfaceIndex(tube).all_hits({foot - Vector3d(0, 0, 2), {0, 0, 1}});
  EXPECT_TRUE(hits.complete);
  ASSERT_EQ(hits.hits.size(), 1U);
  EXPECT_NEAR(hits.hits[0].t, 2, 1e-6);
  EXPECT_NEAR(hits.hits[0].run, 10, 1e-3);
  // Bounds of long rational parts are too wide for that: then no hit is said to be certain.
  const SurfaceIndex round(*make_cylinder(frame_at({0, 0, 0}), 5, 10));
  const RayHits all = round.all_hits({{5, 0, -2}, {0, 0, 1}});
  EXPECT_FALSE(all.complete);
  ASSERT_FALSE(all.hits.empty());
  EXPECT_NEAR(all.hits[0].t, 2, 1e-6);
  for (const RayHit& hit : all.hits) EXPECT_FALSE(hit.certain);
}

BsplineSurface scaled(const BsplineSurface& surface, double by) {
  std::vector<Vector3d> points;
  std::vector<double> weights;
  for (std::size_t i = 0; i < surface.control_points().size(); ++i) {
    points.push_back(by * surface.control_points()[i]);
    weights.push_back(surface.weight(i));
  }
  return *BsplineSurface::make_rational({surface.knots(0), surface.knots(1)}, points, weights);
}

/// Where numbers overflow, or rounding is larger than what is asked: no hang, no claim, no NaN.
TEST(SurfaceExtremes, HugeCoordinates) {
  for (const double size : {1e9, 1e12, 1e40, 1e100, 1e150, 1e200, 1e300}) {
    const testing::ScopedTrace trace(__FILE__, __LINE__, size);
    const SurfaceIndex first(scaled(ball({0, 0, 0}, 1), size));
    const SurfaceIndex second(scaled(square({0, 0, 0.3}, 2), size));
    const SurfaceCrossings found = cross_surfaces(first, second, test::kTolerance);
    expect_numbers(found);
    const bool all_of_it =
        std::abs(total_length(found) / (2 * pi * std::sqrt(0.91) * size) - 1) < 1e-3;
    EXPECT_TRUE(!found.complete || all_of_it);
    EXPECT_TRUE(size < 1e100 || (found.curves.empty() && found.touches.empty()));
    for (const SurfaceIndex* index : {&first, &second}) {
      const ClosestPoint closest = index->closest_point({0.1 * size, 0.2 * size, -3 * size});
      EXPECT_TRUE(closest.parameter.allFinite());
      EXPECT_TRUE(closest.point.allFinite());
      EXPECT_FALSE(std::isnan(closest.distance) || std::isnan(closest.slack));
      const RayHits hits = index->all_hits({{0.1 * size, 0.2 * size, -3 * size}, {0, 0, 1}, 1e308});
      for (const RayHit& hit : hits.hits) {
        EXPECT_TRUE(hit.parameter.allFinite() && hit.point.allFinite() && std::isfinite(hit.t));
      }
      EXPECT_TRUE(size <= 1e150 || hits.hits.empty() || !hits.complete);
    }
  }
}

}  // namespace
}  // namespace limn
