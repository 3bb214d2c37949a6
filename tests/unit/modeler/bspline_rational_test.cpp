#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "modeler/bspline/jet.hpp"
#include "modeler/bspline/refine.hpp"
#include "modeler/bspline/surface_evaluator.hpp"
#include "modeler/bspline/tensor_spline.hpp"

namespace limn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const double kHalf = std::numbers::sqrt2 / 2;

template <class T>
T must(Expected<T> made) {
  EXPECT_TRUE(made.has_value()) << (made ? "" : made.error().at + ": " + made.error().what);
  return made.value_or(T());
}

/// A quarter of the unit circle from (1, 0) to (0, 1).
BsplineCurve<2> quarter() {
  return must(BsplineCurve<2>::make_rational({*KnotVector::make_clamped(2, 0, 1)},
                                             {{1, 0}, {1, 1}, {0, 1}}, {1, kHalf, 1}));
}

/// An eighth of the unit sphere; v = 1 is its north pole.
BsplineSurface octant() {
  const auto knots = *KnotVector::make_clamped(2, 0, 1);
  std::vector<Vector3d> points;
  std::vector<double> weights;
  const std::array<Vector2d, 3> round = {Vector2d(1, 0), Vector2d(1, 1), Vector2d(0, 1)};
  const std::array<double, 3> weight = {1, kHalf, 1};
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      points.emplace_back(round[j].x() * round[i].x(), round[j].x() * round[i].y(), round[j].y());
      weights.push_back(weight[i] * weight[j]);
    }
  }
  return must(BsplineSurface::make_rational({knots, knots}, points, weights));
}

TEST(RationalSpline, IsACircle) {
  const auto curve = quarter();
  EXPECT_TRUE(curve.is_rational());
  EXPECT_EQ(curve.weight(1), kHalf);
  EXPECT_EQ(curve.control_points()[1], Vector2d(1, 1)) << "weights stay inside";
  for (double u = 0; u <= 1; u += 0.0625) {
    std::array<Vector2d, 4> d;
    curve.derivatives(u, d);
    EXPECT_NEAR(d[0].norm(), 1, 1e-15);
    EXPECT_NEAR(*curvature(CurveJet<2>{d[0], d[1], d[2], d[3]}), 1, 1e-13) << u;
  }
}

TEST(RationalSpline, DerivativesAreThoseOfTheQuotient) {
  const auto curve = quarter();
  // Richardson's extrapolation of central differences of derivative r - 1.
  for (std::size_t r = 1; r <= 5; ++r) {
    const auto at = [&](double u) {
      std::vector<Vector2d> d(r);
      curve.derivatives(u, d);
      return d[r - 1];
    };
    constexpr double kStep = 1e-3;
    const Vector2d wide = (at(0.4 + 2 * kStep) - at(0.4 - 2 * kStep)) / (4 * kStep);
    const Vector2d close = (at(0.4 + kStep) - at(0.4 - kStep)) / (2 * kStep);
    std::vector<Vector2d> d(r + 1);
    curve.derivatives(0.4, d);
    EXPECT_LT((d[r] - (4 * close - wide) / 3).norm(), 1e-8 * (1 + d[r].norm())) << "order " << r;
  }
}

TEST(RationalSpline, StaysItselfWhenRefined) {
  const auto curve = quarter();
  const auto finer = must(insert_knots(curve, 0, std::array{0.25, 0.5, 0.5}));
  const auto raised = must(elevate_degree(curve, 0, 3));
  for (double u = 0; u <= 1; u += 0.0625) {
    EXPECT_LT((finer.point(u) - curve.point(u)).norm(), 1e-15);
    EXPECT_LT((raised.point(u) - curve.point(u)).norm(), 1e-15);
  }
}

TEST(RationalSpline, RefusesWeightsThatDoNotFit) {
  const BsplineCurve<2>::Knots knots = {*KnotVector::make_clamped(2, 0, 1)};
  const std::vector<Vector2d> points = {{1, 0}, {1, 1}, {0, 1}};
  const auto few = BsplineCurve<2>::make_rational(knots, points, {1, 1});
  ASSERT_FALSE(few);
  EXPECT_EQ(few.error().code, ErrorCode::kPointCount);
  const auto endless = BsplineCurve<2>::make_rational(knots, points, {1, INFINITY, 1});
  ASSERT_FALSE(endless);
  EXPECT_EQ(endless.error().code, ErrorCode::kOutOfRange);
  EXPECT_FALSE(BsplineCurve<2>::make_rational(knots, points, {1, NAN, 1}));
  EXPECT_FALSE(BsplineCurve<2>::make_rational(knots, points, {0, 1, 1}));
}

TEST(RationalSpline, AWeightMayBeNegativeWhereTheDenominatorIsNot) {
  const BsplineCurve<2>::Knots knots = {*KnotVector::make_clamped(2, 0, 1)};
  const std::vector<Vector2d> points = {{1, 0}, {1, 1}, {0, 1}};
  // w(1/2) = (1 + w_1) / 2: positive, zero and negative.
  EXPECT_TRUE(BsplineCurve<2>::make_rational(knots, points, {1, -0.99, 1}));
  const auto zero = BsplineCurve<2>::make_rational(knots, points, {1, -1, 1});
  ASSERT_FALSE(zero);
  EXPECT_EQ(zero.error().code, ErrorCode::kNumeric);
  EXPECT_EQ(zero.error().at, "weights near u = 0.5");
  EXPECT_FALSE(BsplineCurve<2>::make_rational(knots, points, {1, -1.2, 1}));
  // It touches 0 at a place that halving never meets: not proved.
  const double touching = -std::sqrt(1 * 4.0);
  const auto touch = BsplineCurve<2>::make_rational(knots, points, {1, touching, 4});
  ASSERT_FALSE(touch);
  EXPECT_EQ(touch.error().code, ErrorCode::kNumeric);
}

TEST(RationalSpline, OfASurfaceIsProvedPositiveToo) {
  const auto knots = *KnotVector::make_clamped(2, 0, 1);
  const std::vector<Vector3d> points(9, Vector3d::Zero());
  std::vector<double> weights(9, 1.0);
  weights[4] = -0.9;  // w(1/2, 1/2) = (12 - 0.9 * 4) / 16
  EXPECT_TRUE(BsplineSurface::make_rational({knots, knots}, points, weights));
  weights[4] = -3.1;
  EXPECT_FALSE(BsplineSurface::make_rational({knots, knots}, points, weights));
}

TEST(SurfaceJet, OfASphere) {
  const auto sphere = octant();
  const SurfaceEvaluator evaluator(sphere);
  for (const double u : {0.0, 0.2, 0.7, 1.0}) {
    for (const double v : {0.0, 0.3, 0.9}) {
      const SurfaceJet jet = evaluator.jet(u, v);
      EXPECT_NEAR(jet.point.norm(), 1, 1e-15);
      ASSERT_TRUE(normal(jet));
      EXPECT_LT((*normal(jet) - jet.point).norm(), 1e-13) << "outwards";
      const auto k = curvature(jet);
      ASSERT_TRUE(k);
      EXPECT_NEAR(k->gaussian, 1, 1e-11);
      EXPECT_NEAR(k->mean, -1, 1e-12) << "away from the normal";
      EXPECT_NEAR(k->max, -1, 1e-6);
      EXPECT_NEAR(k->min, -1, 1e-6);
    }
  }
  EXPECT_FALSE(normal(evaluator.jet(0.5, 1))) << "the pole";
  EXPECT_FALSE(curvature(evaluator.jet(0.5, 1)));
}

TEST(SurfaceJet, PrincipalDirectionsOfACylinder) {
  // x = the quarter circle of radius 1, z along v, skewed so that S_u is not perpendicular to S_v.
  const auto ku = *KnotVector::make_clamped(2, 0, 1);
  const auto kv = *KnotVector::make_clamped(1, 0, 1);
  const auto cylinder = must(BsplineSurface::make_rational(
      {ku, kv}, {{1, 0, 0}, {1, 1, 1}, {0, 1, 2}, {1, 0, 3}, {1, 1, 4}, {0, 1, 5}},
      {1, kHalf, 1, 1, kHalf, 1}));
  const auto k = curvature(SurfaceEvaluator(cylinder).jet(0.3, 0.6));
  ASSERT_TRUE(k);
  EXPECT_NEAR(k->max, 0, 1e-13);
  EXPECT_NEAR(k->min, -1, 1e-13);
  EXPECT_NEAR(std::abs(k->max_direction.z()), 1, 1e-12) << "straight along the axis";
  EXPECT_NEAR(k->min_direction.z(), 0, 1e-12);
  EXPECT_NEAR(k->max_direction.dot(k->min_direction), 0, 1e-14);
}

TEST(CurveJet, OfAHelix) {
  // (cos t, sin t, t): curvature and torsion are both 1/2.
  const double t = 0.7;
  const CurveJet<3> jet{{std::cos(t), std::sin(t), t},
                        {-std::sin(t), std::cos(t), 1},
                        {-std::cos(t), -std::sin(t), 0},
                        {std::sin(t), -std::cos(t), 0}};
  EXPECT_NEAR(*curvature(jet), 0.5, 1e-15);
  EXPECT_NEAR(*torsion(jet), 0.5, 1e-15);
  const CurveJet<3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(*curvature(line), 0);
  EXPECT_FALSE(torsion(line));
  EXPECT_FALSE(curvature(CurveJet<3>{}));
}

TEST(SetControlPoint, MovesItAloneAndSharesTheRest) {
  const auto knots = *KnotVector::make_clamped(3, 0, 1, std::vector<double>{0.25, 0.5, 0.75});
  const auto before =
      must(BsplineSurface::make({knots, knots}, std::vector<Vector3d>(49, Vector3d(1, 2, 3))));
  auto after = before;
  ASSERT_TRUE(after.set_control_point(24, {5, 6, 7}));
  for (std::size_t i = 0; i < 49; ++i) {
    EXPECT_EQ(before.control_points()[i], Vector3d(1, 2, 3));
    EXPECT_EQ(after.control_points()[i], i == 24 ? Vector3d(5, 6, 7) : Vector3d(1, 2, 3));
  }
  const auto refused = after.set_control_point(3, {0, NAN, 0});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().at, "control point 3");
  EXPECT_EQ(after.control_points()[3], Vector3d(1, 2, 3));
}

TEST(SetControlPoint, MovesTheRepetitionsOfPeriodicDirections) {
  const auto round = *KnotVector::make_periodic(3, std::vector<double>{0, 1, 2, 3}, 4);
  auto torus =
      must(BsplineSurface::make({round, round}, std::vector<Vector3d>(49, Vector3d(0, 0, 0))));
  ASSERT_TRUE(torus.set_control_point(5 * 7 + 6, {1, 0, 0}));  // layer 6 = 2 in u, 5 = 1 in v
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; i < 49; ++i) {
    if (torus.control_points()[i].x() == 1) moved.push_back(i);
  }
  EXPECT_THAT(moved, testing::ElementsAre(1 * 7 + 2, 1 * 7 + 6, 5 * 7 + 2, 5 * 7 + 6));
  EXPECT_TRUE(BsplineSurface::from(SplineData::make(torus.data().knots(), 3, Form::kPolynomial,
                                                    torus.data().coordinates().to_vector())));
}

TEST(SetControlPoint, KeepsTheDenominatorPositive) {
  auto data = quarter().data();
  const auto before = data;
  const auto refused = data.set_control_point(1, std::array{1.0, 1.0, -1.5});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNumeric);
  EXPECT_EQ(data, before);
  EXPECT_TRUE(data.set_control_point(1, std::array{1.0, 1.0, -0.5}));
  // With a negative weight in place, a small weight beside it may break the proof.
  EXPECT_FALSE(data.set_control_point(0, std::array{1e-6, 0.0, 1e-6}));
}

}  // namespace
}  // namespace limn
