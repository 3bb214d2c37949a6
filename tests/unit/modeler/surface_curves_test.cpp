#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "modeler/bspline/refine.hpp"
#include "modeler/surface/constructions.hpp"
#include "modeler/surface/curve_crossings.hpp"
#include "modeler/surface/measures.hpp"
#include "modeler/surface/primitives.hpp"

namespace limn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::DoubleNear;
using testing::Pointwise;

constexpr double kPi = std::numbers::pi;

BsplineCurve<2> line(const Vector2d& a, const Vector2d& b) {
  return *BsplineCurve<2>::make(*KnotVector::make_clamped(1, 0, 1), {a, b});
}

BsplineCurve<2> parabola() {  // y = x^2 over [-1, 1], t = x
  return *BsplineCurve<2>::make(*KnotVector::make_clamped(2, -1, 1), {{-1, 1}, {0, -1}, {1, 1}});
}

BsplineCurve<2> circle(const Vector2d& center, double radius) {
  const double w = std::sqrt(0.5);
  std::vector<Vector2d> points;
  for (const Vector2d& p :
       {Vector2d(1, 0), {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}}) {
    points.push_back(center + radius * p);
  }
  return *BsplineCurve<2>::make_rational(
      {*KnotVector::make_clamped(2, 0, 4, std::array{1.0, 1.0, 2.0, 2.0, 3.0, 3.0})}, points,
      {1, w, 1, w, 1, w, 1, w, 1});
}

TEST(CrossPlane, FindsEveryPlace) {
  const auto ring = *make_circle(Frame(), 2);
  const auto both = cross_plane(ring, {1, 0, 0}, {5, 0, 0});
  ASSERT_EQ(both.at.size(), 2U);
  for (const double t : both.at) EXPECT_NEAR(ring.point(t).x(), 1, 1e-12);
  EXPECT_EQ(cross_plane(ring, {2, 0, 0}, {1, 0, 0}).at.size(), 2U) << "begin and end, a seam";
  const auto touch = cross_plane(ring, {0, 2, 0}, {0, 1, 0});
  ASSERT_EQ(touch.at.size(), 1U);
  EXPECT_NEAR(touch.at[0], kPi / 2, 1e-6);
  EXPECT_TRUE(cross_plane(ring, {3, 0, 0}, {1, 0, 0}).at.empty());
  const auto flat = cross_plane(ring, {7, 7, 0}, {0, 0, 1});
  EXPECT_TRUE(flat.at.empty());
  ASSERT_EQ(flat.within.size(), 1U) << "all of it lies in the plane";
  EXPECT_EQ(flat.within[0].first, 0);
  EXPECT_EQ(flat.within[0].last, 2 * kPi);
}

TEST(CrossCurves, InThePlane) {
  const auto found = cross_curves(parabola(), line({-2, 0.25}, {2, 0.25}));
  EXPECT_TRUE(found.complete);
  ASSERT_EQ(found.crossings.size(), 2U);
  EXPECT_NEAR(found.crossings[0].s, -0.5, 1e-12);
  EXPECT_NEAR(found.crossings[0].t, 0.375, 1e-12);
  EXPECT_NEAR(found.crossings[1].s, 0.5, 1e-12);
  EXPECT_TRUE(cross_curves(parabola(), line({-2, -0.1}, {2, -0.1})).crossings.empty());
  EXPECT_EQ(cross_curves(circle({0, 0}, 2), circle({3, 0}, 2)).crossings.size(), 2U);
  EXPECT_EQ(cross_curves(circle({0, 0}, 2), circle({5, 0}, 2)).crossings.size(), 0U);
  EXPECT_EQ(cross_curves(line({0, 0}, {1, 1}), line({1, 0}, {0, 1})).crossings.size(), 1U);
  EXPECT_EQ(cross_curves(line({0, 0}, {1, 1}), line({1, 1}, {2, 0})).crossings.size(), 1U)
      << "in their ends";
}

TEST(CrossCurves, ThatTouch) {
  const auto found = cross_curves(parabola(), line({-2, 0}, {2, 0}));
  EXPECT_TRUE(found.complete);
  ASSERT_EQ(found.crossings.size(), 1U);
  EXPECT_NEAR(found.crossings[0].s, 0, 1e-4) << "1e-9 off is 3e-5 along";
  EXPECT_GT(found.crossings[0].run, 0);
  EXPECT_EQ(cross_curves(circle({0, 0}, 2), circle({0, 4}, 2)).crossings.size(), 1U);
}

TEST(CrossCurves, ThatRunTogether) {
  const auto found = cross_curves(line({0, 0}, {4, 0}), line({1, 0}, {9, 0}));
  EXPECT_TRUE(found.complete);
  ASSERT_EQ(found.crossings.size(), 1U);
  EXPECT_NEAR(found.crossings[0].s, 0.25, 1e-12);
  EXPECT_NEAR(found.crossings[0].run, 3, 1e-9);
}

TEST(CrossCurves, NearlyParallelLinesCrossInTheirMiddles) {
  const auto found = cross_curves(line({-500, 0}, {500, 0}), line({-500, -4.5e-4}, {500, 4.5e-4}));
  ASSERT_EQ(found.crossings.size(), 1U);
  EXPECT_NEAR(found.crossings[0].s, 0.5, 1e-5);
}

TEST(CrossCurves, UnevenParametersOfAStraightLine) {
  const auto uneven =
      *BsplineCurve<2>::make(*KnotVector::make_clamped(2, 0, 1), {{0, 0}, {0.1, 0}, {1, 0}});
  for (const auto& other : {line({0.3, -1}, {0.3, 1}), line({0.3, 0}, {0.3001, 1})}) {
    const auto found = cross_curves(uneven, other);
    ASSERT_EQ(found.crossings.size(), 1U);
    EXPECT_LT((uneven.point(found.crossings[0].s) - Vector2d(0.3, 0)).norm(), 1e-8);
  }
}

TEST(CrossCurves, ACrossingBesideAnOverlapIsItsOwn) {
  // A polyline along the x axis for 4 mm, up, and down through it again 2 mm further.
  const auto zigzag = *BsplineCurve<2>::make(
      *KnotVector::make_clamped(1, 0, 3, std::array{1.0, 2.0}), {{0, 0}, {4, 0}, {6, 1}, {6, -1}});
  const auto found = cross_curves(zigzag, line({-5, 0}, {20, 0}));
  ASSERT_EQ(found.crossings.size(), 2U);
  EXPECT_NEAR(found.crossings[0].run, 4, 1e-9);
  EXPECT_NEAR(found.crossings[1].s, 2.5, 1e-12);
  EXPECT_EQ(found.crossings[1].run, 0);
}

TEST(CrossCurves, InSpace) {
  const auto helix_like = *BsplineCurve<3>::make(*KnotVector::make_clamped(3, 0, 1),
                                                 {{0, 0, 0}, {1, 2, 1}, {2, -2, 2}, {3, 0, 3}});
  const Vector3d through = helix_like.point(0.3);
  const auto needle =
      *BsplineCurve<3>::make(*KnotVector::make_clamped(1, 0, 1),
                             {through - Vector3d(1, 1, 5), through + Vector3d(1, 1, 5)});
  const auto found = cross_curves(helix_like, needle);
  ASSERT_EQ(found.crossings.size(), 1U);
  EXPECT_NEAR(found.crossings[0].s, 0.3, 1e-9);
  EXPECT_NEAR(found.crossings[0].t, 0.5, 1e-9);
  const auto beside = *BsplineCurve<3>::make(*KnotVector::make_clamped(1, 0, 1),
                                             {through - Vector3d(1, 1, 5) + Vector3d(0, 1e-6, 0),
                                              through + Vector3d(1, 1, 5) + Vector3d(0, 1e-6, 0)});
  EXPECT_TRUE(cross_curves(helix_like, beside).crossings.empty());
}

TEST(ClosestOnCurve, IsGlobal) {
  const auto curve = parabola();
  for (double x = -1.5; x <= 1.5; x += 0.25) {
    for (double y = -1; y <= 2; y += 0.25) {
      const auto found = closest_on_curve(curve, Vector2d(x, y));
      double least = 1e300;
      for (int i = 0; i <= 2000; ++i) {
        least = std::min(least, (curve.point(-1 + i / 1000.0) - Vector2d(x, y)).norm());
      }
      EXPECT_LE(found.distance, least + 1e-12);
      EXPECT_GE(found.distance, least - 1e-5);
      EXPECT_NEAR((curve.point(found.t) - Vector2d(x, y)).norm(), found.distance, 1e-12);
    }
  }
  EXPECT_NEAR(closest_on_curve(circle({0, 0}, 2), Vector2d(0, 0)).distance, 2, 1e-12);
  EXPECT_NEAR(closest_on_curve(*make_circle(Frame(), 2), Vector3d(0, 0, 3)).distance,
              std::hypot(2, 3), 1e-12);
}

TEST(Measures, OfKnownShapes) {
  const Frame f;
  EXPECT_NEAR(arc_length(*make_circle(f, 3)).value, 6 * kPi, 1e-9);
  EXPECT_NEAR(arc_length(circle({5, 5}, 3)).value, 6 * kPi, 1e-9);
  EXPECT_NEAR(arc_length(*make_circle(f, 3), 0, kPi, 1e-10).value, 3 * kPi, 1e-9);
  // y = x^2 from -1 to 1: sqrt(5) + asinh(2) / 2.
  EXPECT_NEAR(arc_length(parabola()).value, std::sqrt(5.0) + std::asinh(2.0) / 2, 1e-9);
  EXPECT_NEAR(area(*make_sphere(f, 2)).value, 16 * kPi, 1e-6);
  EXPECT_NEAR(volume(*make_sphere(f, 2)).value, 32 * kPi / 3, 1e-6);
  EXPECT_NEAR(area(*make_torus(f, 5, 2)).value, 40 * kPi * kPi, 1e-5);
  EXPECT_NEAR(volume(*make_torus(f, 5, 2)).value, 40 * kPi * kPi, 1e-5);
  EXPECT_NEAR(area(*make_disc(f, 3)).value, 9 * kPi, 1e-6);
  const auto box = *make_box({Vector3d(7, -3, 2)}, {2, 3, 4});
  double inside = 0;
  double skin = 0;
  for (const auto& face : box) {
    inside += volume(face).value;
    skin += area(face).value;
  }
  EXPECT_NEAR(inside, 24, 1e-12);
  EXPECT_NEAR(skin, 52, 1e-12);
  EXPECT_LE(area(*make_sphere(f, 2)).error, 1e-8 * 16 * kPi);
}

}  // namespace
}  // namespace limn
