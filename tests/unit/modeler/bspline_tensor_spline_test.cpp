#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "modeler/bspline/refine.hpp"
#include "modeler/bspline/tensor_spline.hpp"

namespace limn {
namespace {

using Point1 = Eigen::Matrix<double, 1, 1>;
using Point2 = Eigen::Matrix<double, 2, 1>;

template <class T>
T must(Expected<T> made) {
  EXPECT_TRUE(made.has_value()) << (made ? "" : made.error().at + ": " + made.error().what);
  return made.value_or(T());
}

BsplineCurve<2> rounded_square() {
  const auto knots = KnotVector::make_periodic(3, std::array{0.0, 1.0, 2.0, 3.0}, 4.0);
  const std::vector<Point2> points = {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {3, 0}, {3, 3}};
  return must(BsplineCurve<2>::make(*knots, points));
}

TEST(BsplineCurve, ADotIsLegal) {
  const auto dot = must(BsplineCurve<3>::make(KnotVector(), {{1, 2, 3}}));
  EXPECT_EQ(dot.point(-4), Eigen::Vector3d(1, 2, 3));
  std::array<Eigen::Vector3d, 2> out;
  dot.derivatives(0.5, out);
  EXPECT_EQ(out[1], Eigen::Vector3d::Zero());
}

TEST(BsplineCurve, RefusesWhatDoesNotFit) {
  const auto knots = KnotVector::make_clamped(1, 0, 1);
  const auto count = BsplineCurve<2>::make(*knots, {{0, 0}, {1, 1}, {2, 2}});
  ASSERT_FALSE(count.has_value());
  EXPECT_EQ(count.error().code, ErrorCode::kPointCount);
  const auto infinite = BsplineCurve<2>::make(*knots, {{0, 0}, {1, INFINITY}});
  ASSERT_FALSE(infinite.has_value());
  EXPECT_EQ(infinite.error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(infinite.error().at, "control point 1");
  const auto periodic = KnotVector::make_periodic(1, std::array{0.0, 1.0, 2.0}, 3.0);
  const auto open = BsplineCurve<2>::make(*periodic, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  ASSERT_FALSE(open.has_value());
  EXPECT_EQ(open.error().code, ErrorCode::kOutOfRange);
  EXPECT_TRUE(BsplineCurve<2>::make(*periodic, {{0, 0}, {1, 0}, {1, 1}, {0, 0}}).has_value());
}

TEST(BsplineCurve, BezierGivesItsPolynomial) {
  // u^3 - 2 u + 1 in Bernstein form on [0, 2].
  const auto knots = KnotVector::make_clamped(3, 0, 2);
  const auto cubic = must(BsplineCurve<1>::make(
      *knots, {Point1(1), Point1(1 - 4.0 / 3), Point1(1 - 8.0 / 3), Point1(5)}));
  for (const double u : {0.0, 0.3, 1.0, 1.9, 2.0}) {
    std::array<Point1, 5> out;
    cubic.derivatives(u, out);
    EXPECT_NEAR(out[0][0], u * u * u - 2 * u + 1, 1e-14);
    EXPECT_NEAR(out[1][0], 3 * u * u - 2, 1e-13);
    EXPECT_NEAR(out[2][0], 6 * u, 1e-12);
    EXPECT_NEAR(out[3][0], 6, 1e-12);
    EXPECT_EQ(out[4][0], 0);
  }
}

TEST(BsplineCurve, LimitsAtABreak) {
  // Degree 1 with a knot of multiplicity 2: a jump from 1 to 5 at u = 1.
  const auto knots = KnotVector::make_clamped(1, 0, 2, std::array{1.0, 1.0});
  const auto jump =
      must(BsplineCurve<1>::make(*knots, {Point1(0), Point1(1), Point1(5), Point1(6)}));
  EXPECT_EQ(jump.point(1)[0], 5) << "right-hand limit";
  EXPECT_NEAR(jump.point(std::nextafter(1.0, 0.0))[0], 1, 1e-14);
  EXPECT_EQ(jump.point(2)[0], 6) << "left-hand limit at the end";
}

TEST(BsplineCurve, PeriodicWraps) {
  const auto curve = rounded_square();
  EXPECT_LT((curve.point(0) - curve.point(4)).norm(), 1e-14);
  EXPECT_LT((curve.point(0.7) - curve.point(4.7)).norm(), 1e-14);
  EXPECT_LT((curve.point(3.5) - curve.point(-0.5)).norm(), 1e-14);
}

TEST(BsplineCurve, NotANumberGivesNotANumber) {
  EXPECT_TRUE(std::isnan(rounded_square().point(NAN)[0]));
  const auto knots = KnotVector::make_clamped(2, 0, 1);
  const auto open = must(BsplineCurve<1>::make(*knots, {Point1(0), Point1(1), Point1(2)}));
  EXPECT_TRUE(std::isnan(open.point(NAN)[0]));
}

TEST(BsplineSurface, BilinearPatchAndItsDerivativeLayout) {
  using Surface = TensorSpline<2, 1>;
  const auto ku = *KnotVector::make_clamped(1, 0, 1);
  const auto kv = *KnotVector::make_clamped(1, 0, 2);
  // f(u, v) = 1 + 2 u + 3 v + 4 u v at the corners, u fastest.
  const auto f = [](double u, double v) { return 1 + 2 * u + 3 * v + 4 * u * v; };
  const auto patch = must(Surface::make(
      {ku, kv}, {Point1(f(0, 0)), Point1(f(1, 0)), Point1(f(0, 2)), Point1(f(1, 2))}));
  std::array<Point1, 6> out;  // orders 2 in u, 1 in v
  patch.derivatives({0.25, 1.5}, {2, 1}, out);
  EXPECT_DOUBLE_EQ(out[0][0], f(0.25, 1.5));
  EXPECT_DOUBLE_EQ(out[1][0], 2 + 4 * 1.5) << "d/du";
  EXPECT_EQ(out[2][0], 0) << "d2/du2, above the degree";
  EXPECT_DOUBLE_EQ(out[3][0], 3 + 4 * 0.25) << "d/dv";
  EXPECT_DOUBLE_EQ(out[4][0], 4) << "d2/du dv";
  EXPECT_EQ(out[5][0], 0);
}

TEST(BsplineVolume, TrilinearProduct) {
  using Volume = TensorSpline<3, 1>;
  const auto k = *KnotVector::make_clamped(1, 0, 1);
  std::vector<Point1> points(8, Point1(0));
  points[7] = Point1(1);  // u v w
  const auto volume = must(Volume::make({k, k, k}, points));
  EXPECT_DOUBLE_EQ(volume.point({0.5, 0.25, 0.2})[0], 0.5 * 0.25 * 0.2);
  std::array<Point1, 8> out;
  volume.derivatives({0.5, 0.25, 0.2}, {1, 1, 1}, out);
  EXPECT_DOUBLE_EQ(out[7][0], 1) << "d3/du dv dw";
  EXPECT_DOUBLE_EQ(out[6][0], 0.5) << "d2/dv dw = u";
}

TEST(Seam, MovesWithoutMovingTheShape) {
  const auto curve = rounded_square();
  for (const double seam : {0.0, 1.0, 1.3, 3.99}) {
    const auto moved = must(move_seam(curve, 0, seam));
    const double begin = moved.knots().domain_begin();
    EXPECT_EQ(begin, seam);
    EXPECT_DOUBLE_EQ(moved.knots().domain_end(), begin + 4);
    for (double u = begin; u < begin + 4; u += 0.0625) {
      EXPECT_LT((moved.point(u) - curve.point(u)).norm(), 1e-13) << "seam " << seam << " u " << u;
    }
  }
}

TEST(Seam, KeepsACornerSharp) {
  // Degree 2, a corner at 0; the seam moves away from it.
  const auto knots = KnotVector::make_periodic(2, std::array{0.0, 0.0, 1.0, 2.0}, 3.0);
  const std::vector<Point2> points = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}, {2, 0}};
  const auto curve = must(BsplineCurve<2>::make(*knots, points));
  const auto moved = must(move_seam(curve, 0, 1.5));
  EXPECT_EQ(moved.knots().multiplicity(3), 2);
  EXPECT_LT((moved.point(3) - curve.point(0)).norm(), 1e-14);
}

TEST(Refine, WorksAlongEachDirectionOfASurface) {
  using Surface = TensorSpline<2, 1>;
  const auto ku = *KnotVector::make_clamped(2, 0, 1);
  const auto kv = *KnotVector::make_clamped(1, 0, 1, std::array{0.5});
  std::vector<Point1> points;
  for (int i = 0; i < 9; ++i) points.emplace_back(i * i % 7);
  const auto surface = must(Surface::make({ku, kv}, points));
  const auto in_v = must(insert_knots(surface, 1, std::array{0.25}));
  EXPECT_EQ(in_v.control_points().size(), 12u);
  const auto in_u = must(elevate_degree(in_v, 0, 1));
  EXPECT_EQ(in_u.control_points().size(), 16u);
  for (double u = 0; u <= 1; u += 0.125) {
    for (double v = 0; v <= 1; v += 0.125) {
      EXPECT_NEAR(in_u.point({u, v})[0], surface.point({u, v})[0], 1e-13);
    }
  }
}

}  // namespace
}  // namespace limn
