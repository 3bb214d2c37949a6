#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "modeler/bspline/compose.hpp"
#include "modeler/bspline/refine.hpp"
#include "modeler/bspline/roots.hpp"
#include "modeler/bspline/simplify.hpp"

namespace limn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

template <class T>
T must(Expected<T> made) {
  if (!made) throw std::runtime_error(made.error().at + ": " + made.error().what);
  return *std::move(made);
}

BsplineCurve<2> wave() {
  const auto knots = *KnotVector::make_clamped(3, 0, 4, std::array{1.0, 2.0, 3.0});
  return must(
      BsplineCurve<2>::make(knots, {{0, 0}, {1, 2}, {2, -1}, {3, 3}, {4, 0}, {5, 1}, {6, 0}}));
}

BsplineCurve<2> ring() {
  const auto knots = *KnotVector::make_periodic(3, std::array{0.0, 1.0, 2.0, 3.0}, 4.0);
  return must(
      BsplineCurve<2>::make(knots, {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {3, 0}, {3, 3}}));
}

template <class Curve>
double largest_gap(const Curve& a, const Curve& b, double low, double high) {
  double gap = 0;
  for (int i = 0; i <= 200; ++i) {
    const double u = low + (high - low) * i / 200;
    gap = std::max(gap, (a.point(u) - b.point(u)).norm());
  }
  return gap;
}

TEST(Segment, IsTheSameShapeOnLess) {
  for (const auto& curve : {wave(), ring()}) {
    const auto part = must(segment(curve, 0, 0.7, 3.2));
    EXPECT_EQ(part.knots().domain_begin(), 0.7);
    EXPECT_EQ(part.knots().domain_end(), 3.2);
    EXPECT_FALSE(part.knots().is_periodic());
    EXPECT_LT(largest_gap(curve, part, 0.7, 3.2), 1e-14);
    EXPECT_LT((part.control_points().front() - curve.point(0.7)).norm(), 1e-14) << "clamped";
  }
  EXPECT_FALSE(segment(wave(), 0, 2, 2));
  EXPECT_FALSE(segment(wave(), 0, -1, 2));
  EXPECT_FALSE(segment(wave(), 0, NAN, 2));
}

TEST(Reverse, RunsBackwards) {
  const auto uneven =
      must(BsplineCurve<2>::make(*KnotVector::make_periodic(2, std::array{0.0, 0.0, 1.0, 1.5}, 4.0),
                                 {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}, {2, 0}}));
  for (const auto& curve : {wave(), ring(), uneven}) {
    const auto back = must(reverse(curve, 0));
    EXPECT_EQ(back.knots().is_periodic(), curve.knots().is_periodic());
    for (double u = 0; u <= 4; u += 0.125) {
      EXPECT_LT((back.point(u) - curve.point(4 - u)).norm(), 1e-14) << u;
    }
    const auto again = must(reverse(back, 0));
    EXPECT_EQ(again.knots(), curve.knots());
    EXPECT_LT(largest_gap(again, curve, 0, 4), 1e-14);
  }
}

TEST(ToBezier, GivesEachSpanItsBezierPoints) {
  for (const auto& curve : {wave(), ring()}) {
    const auto bezier = must(to_bezier(curve, 0));
    EXPECT_EQ(bezier.control_points().size(), 13U);
    EXPECT_LT(largest_gap(curve, bezier, 0, 4), 1e-14);
    for (int i = 0; i < 4; ++i) {
      EXPECT_LT((bezier.control_points()[3 * i] - curve.point(i)).norm(), 1e-14);
    }
  }
}

TEST(RemoveKnot, UndoesAnInsertion) {
  for (const auto& curve : {wave(), ring()}) {
    for (const std::vector<double>& added :
         {std::vector{0.4}, std::vector{2.0}, std::vector{1.7, 1.7}}) {
      auto fine = must(insert_knots(curve, 0, added));
      for (const double u : added) {
        const auto removed = must(remove_knot(fine, 0, u));
        EXPECT_LT(removed.deviation, 1e-13);
        fine = removed.spline;
      }
      EXPECT_EQ(fine.knots(), curve.knots());
      EXPECT_LT(largest_gap(fine, curve, 0, 4), 1e-13);
    }
  }
}

TEST(RemoveKnot, TellsWhatItMovesAndLeavesTheRest) {
  const auto curve = wave();
  const auto removed = must(remove_knot(curve, 0, 2));
  const double moved = largest_gap(curve, removed.spline, 0, 4);
  EXPECT_GT(moved, 0.1);
  EXPECT_LE(moved, removed.deviation);
  EXPECT_EQ(removed.spline.control_points().front(), curve.control_points().front());
  EXPECT_EQ(removed.spline.control_points()[1], curve.control_points()[1]);
  EXPECT_FALSE(remove_knot(curve, 0, 0)) << "an end";
  EXPECT_FALSE(remove_knot(curve, 0, 1.5)) << "no knot";
}

TEST(RemoveKnots, TakesWhatToleranceAllows) {
  const auto curve = wave();
  const auto fine = must(insert_knots(curve, 0, std::array{0.3, 0.6, 1.4, 1.4, 2.5, 3.1}));
  const auto exact = remove_knots(fine, 0, 1e-10);
  EXPECT_EQ(exact.spline.control_points().size(), curve.control_points().size());
  EXPECT_LT(largest_gap(exact.spline, curve, 0, 4), 1e-10);
  const auto rough = remove_knots(fine, 0, 10);
  EXPECT_EQ(rough.spline.control_points().size(), 4U) << "one span";
  EXPECT_LE(largest_gap(rough.spline, curve, 0, 4), rough.deviation);
  const auto nothing = remove_knots(curve, 0, 0);
  EXPECT_EQ(nothing.spline, curve);
  EXPECT_EQ(nothing.deviation, 0);
}

TEST(ReduceDegree, UndoesAnElevation) {
  for (const auto& curve : {wave(), ring()}) {
    const auto raised = must(elevate_degree(curve, 0, 1));
    const auto reduced = must(reduce_degree(raised, 0));
    EXPECT_EQ(reduced.spline.knots(), curve.knots());
    EXPECT_LT(reduced.deviation, 1e-13);
    EXPECT_LT(largest_gap(reduced.spline, curve, 0, 4), 1e-13);
  }
}

TEST(ReduceDegree, TellsWhatItMoves) {
  const auto curve = wave();
  const auto reduced = must(reduce_degree(curve, 0));
  EXPECT_EQ(reduced.spline.knots().degree(), 2);
  EXPECT_LE(largest_gap(reduced.spline, curve, 0, 4), reduced.deviation);
  EXPECT_LT(reduced.deviation, 1.5) << "of a polygon that swings by 4";
  const auto flat = must(BsplineCurve<2>::make(KnotVector(), {{1, 2}}));
  EXPECT_FALSE(reduce_degree(flat, 0));
}

TEST(Join, PutsOneAfterTheOther) {
  const auto whole = wave();
  const auto first = must(segment(whole, 0, 0, 1.5));
  const auto second = must(segment(whole, 0, 1.5, 4));
  const auto joined = must(join(first, second));
  EXPECT_LT(joined.deviation, 1e-14);
  EXPECT_EQ(joined.spline.knots().domain_end(), 4);
  EXPECT_LT(largest_gap(joined.spline, whole, 0, 4), 1e-14);
  const auto smooth = remove_knots(joined.spline, 0, 1e-9);
  EXPECT_EQ(smooth.spline.knots(), whole.knots()) << "the joint goes as it came";
}

TEST(Join, RaisesDegreesAndClosesGaps) {
  const auto line =
      must(BsplineCurve<2>::make(*KnotVector::make_clamped(1, 5, 7), {{6, 0.2}, {9, 0}}));
  const auto joined = must(join(wave(), line));
  EXPECT_NEAR(joined.deviation, 0.1, 1e-14);
  EXPECT_EQ(joined.spline.knots().degree(), 3);
  EXPECT_EQ(joined.spline.knots().domain_end(), 6) << "its parameters go on";
  EXPECT_LT((joined.spline.point(4) - Vector2d(6, 0.1)).norm(), 1e-14);
  EXPECT_LT((joined.spline.point(6) - Vector2d(9, 0)).norm(), 1e-14);
  EXPECT_FALSE(join(ring(), line));
}

TEST(Join, ScalesWeights) {
  const double half = std::sqrt(0.5);
  const auto arc = must(BsplineCurve<2>::make_rational({*KnotVector::make_clamped(2, 0, 1)},
                                                       {{1, 0}, {1, 1}, {0, 1}}, {1, half, 1}));
  const auto next = must(BsplineCurve<2>::make_rational(
      {*KnotVector::make_clamped(2, 0, 1)}, {{0, 1}, {-1, 1}, {-1, 0}}, {3, 3 * half, 3}));
  const auto joined = must(join(arc, next));
  for (double u = 0; u <= 2; u += 0.0625) {
    EXPECT_NEAR(joined.spline.point(u).norm(), 1, 1e-15);
  }
}

TEST(Roots, OfPolynomials) {
  // (t - 0.25)(t - 0.5)(t - 1) in Bernstein form: values of the blossom.
  const auto cubic = [](double a, double b, double c) {
    const auto f = [&](double x, double y, double z) {
      const double s = a + b + c;
      const double q = a * b + b * c + c * a;
      return x * y * z - s * (x * y + y * z + z * x) / 3 + q * (x + y + z) / 3 - a * b * c;
    };
    return std::array{f(0, 0, 0), f(0, 0, 1), f(0, 1, 1), f(1, 1, 1)};
  };
  EXPECT_THAT(bernstein_roots(cubic(0.25, 0.5, 1), 1e-15).at,
              Pointwise(DoubleNear(1e-14), {0.25, 0.5, 1.0}));
  EXPECT_THAT(bernstein_roots(cubic(-1, 2, 0.125), 1e-15).at,
              Pointwise(DoubleNear(1e-14), {0.125}));
  EXPECT_THAT(bernstein_roots(cubic(0.3, 0.3, 2), 1e-15).at, Pointwise(DoubleNear(1e-7), {0.3}))
      << "a double root, once";
  EXPECT_THAT(bernstein_roots(cubic(0.6, 0.6, 0.6), 1e-15).at, Pointwise(DoubleNear(1e-4), {0.6}));
  EXPECT_THAT(bernstein_roots(cubic(0, 2, 3), 1e-15).at, Pointwise(DoubleNear(1e-14), {0.0}));
  EXPECT_TRUE(bernstein_roots(cubic(-1, -2, 3), 1e-15).at.empty());
  EXPECT_TRUE(bernstein_roots(std::array{0.0, 1e-16, 0.0}, 1e-15).everywhere);
  EXPECT_THAT(bernstein_product(std::array{1.0, 2.0}, std::array{0.0, 3.0, 3.0}),
              Pointwise(DoubleNear(1e-15), {0.0, 2.0, 5.0, 6.0}));
}

TEST(Compose, IsTheCurveOnTheSurface) {
  const auto ku = *KnotVector::make_clamped(2, 0, 1, std::array{0.4});
  const auto kv = *KnotVector::make_clamped(2, 0, 1, std::array{0.5});
  std::vector<Vector3d> points;
  std::vector<double> weights;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      points.emplace_back(i, j, std::sin(1.0 + i * j));
      weights.push_back(1 + 0.3 * ((i + 2 * j) % 3));
    }
  }
  const auto flat = *KnotVector::make_clamped(3, -1, 2, std::array{0.5});
  const auto curve =
      must(BsplineCurve<2>::make(flat, {{0, 0.1}, {0.3, 1}, {0.5, 0}, {0.9, 0.9}, {1, 0.2}}));
  for (const bool rational : {false, true}) {
    const auto surface = must(rational ? BsplineSurface::make_rational({ku, kv}, points, weights)
                                       : BsplineSurface::make({ku, kv}, points));
    const auto on_surface = must(compose(surface, curve));
    EXPECT_EQ(on_surface.knots().degree(), 12);
    EXPECT_EQ(on_surface.is_rational(), rational);
    for (double t = -1; t <= 2; t += 0.01) {
      const Vector2d at = curve.point(t);
      EXPECT_LT((on_surface.point(t) - surface.point({at.x(), at.y()})).norm(), 1e-12) << t;
    }
  }
}

TEST(Compose, RefusesWhatLeavesTheSurfaceOrIsTooHigh) {
  const auto k = *KnotVector::make_clamped(1, 0, 1);
  const auto plane =
      must(BsplineSurface::make({k, k}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  const auto out = compose(plane, must(BsplineCurve<2>::make(k, {{0.5, 0.5}, {1.5, 0.5}})));
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, ErrorCode::kOutOfRange);
  const auto high = *KnotVector::make_clamped(13, 0, 1);
  const auto curve = must(BsplineCurve<2>::make(high, std::vector<Vector2d>(14, {0.5, 0.5})));
  const auto refused = compose(plane, curve);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kLimit);
  // Control points outside, the curve inside.
  const auto k2 = *KnotVector::make_clamped(2, 0, 1);
  EXPECT_TRUE(
      compose(plane, must(BsplineCurve<2>::make(k2, {{0.1, 0.5}, {0.5, 1.4}, {0.9, 0.5}}))));
}

}  // namespace
}  // namespace limn
