#include "modeler/fit/fit_curve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace limn {
namespace {

using Point = Eigen::Vector2d;
using testing::HasSubstr;

constexpr double kPi = 3.14159265358979323846;

FitOptions within(double tolerance_mm) {
  FitOptions options;
  options.tolerance_mm = tolerance_mm;
  return options;
}

/// Fits and checks every promise that holds for all fits.
CurveFit<2> fit(const std::vector<Point>& points, const FitOptions& options,
                const std::vector<double>& times = {}) {
  const auto fitted = fit_curve<2>(points, times, options);
  EXPECT_TRUE(fitted.has_value()) << (fitted ? "" : fitted.error().what);
  if (!fitted) return {};
  const auto& knots = fitted->curve.knots();
  EXPECT_EQ(fitted->sample_parameters.size(), points.size());
  double worst = 0;
  double before = knots.domain_begin();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double u = fitted->sample_parameters[i];
    EXPECT_GE(u, before) << "sample " << i;
    EXPECT_LE(u, knots.domain_end()) << "sample " << i;
    before = u;
    worst = std::max(worst, (fitted->curve.point(u) - points[i]).norm());
  }
  EXPECT_LE(worst, options.tolerance_mm);
  // Evaluated another way, so equal up to rounding of coordinates of this size.
  EXPECT_NEAR(fitted->deviation_max, worst, 1e-13 * (1 + points[0].norm()));
  EXPECT_LE(fitted->deviation_rms, fitted->deviation_max);
  EXPECT_EQ(fitted->closed, knots.is_periodic());
  for (const double corner : fitted->corners) EXPECT_EQ(knots.multiplicity(corner), 3);
  return *fitted;
}

std::vector<Point> circle(int count, double radius, double turns, double lag = 0) {
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) {
    const double a = 2 * kPi * turns * i / (count - 1 + lag);
    points.emplace_back(radius * std::cos(a), radius * std::sin(a));
  }
  return points;
}

/// Along the polygon through `vertices`, `count` samples an edge, slowing down at its vertices.
std::vector<Point> polygon(const std::vector<Point>& vertices, int count) {
  std::vector<Point> points = {vertices[0]};
  for (std::size_t v = 1; v < vertices.size(); ++v) {
    for (int i = 1; i <= count; ++i) {
      const double t = static_cast<double>(i) / count;
      const double s = t * t * t * (10 - 15 * t + 6 * t * t);  // minimum jerk
      points.push_back(vertices[v - 1] + s * (vertices[v] - vertices[v - 1]));
    }
  }
  return points;
}

TEST(FitCurve, NamesBadInput) {
  const std::vector<Point> two = {{0, 0}, {1, 0}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fit_curve<2>(std::vector<Point>{}, {}, {}).error().code, ErrorCode::kMissing);
  EXPECT_EQ(fit_curve<2>(two, std::vector{0.0}, {}).error().code, ErrorCode::kPointCount);
  for (const double tolerance : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(fit_curve<2>(two, {}, within(tolerance)).error().code, ErrorCode::kOutOfRange);
  }
  FitOptions angle;
  for (const double bad : {0.0, -1.0, 3.2, nan}) {
    angle.corner_angle_rad = bad;
    EXPECT_EQ(fit_curve<2>(two, {}, angle).error().code, ErrorCode::kOutOfRange);
  }
  const auto not_finite = fit_curve<2>(std::vector<Point>{{0, 0}, {1, 0}, {nan, 0}}, {}, {});
  EXPECT_EQ(not_finite.error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(not_finite.error().at, "sample 2");
  const auto huge = fit_curve<2>(std::vector<Point>{{0, 0}, {0, -1e101}}, {}, {});
  EXPECT_EQ(huge.error().at, "sample 1");
  EXPECT_THAT(huge.error().what, HasSubstr("1e100"));
  const auto backwards = fit_curve<2>(two, std::vector{1.0, 0.5}, {});
  EXPECT_EQ(backwards.error().at, "sample 1");
  EXPECT_EQ(fit_curve<2>(two, std::vector{1.0, nan}, {}).error().at, "sample 1");
}

TEST(FitCurve, OnePlaceIsADot) {
  for (const std::size_t count : {1u, 2u, 50u}) {
    const std::vector<Point> points(count, Point(3, -4));
    const auto dot = fit(points, within(0.1));
    EXPECT_EQ(dot.curve.knots().degree(), 0);
    ASSERT_EQ(dot.curve.control_points().size(), 1u);
    EXPECT_EQ(dot.curve.control_points()[0], points[0]);
    EXPECT_EQ(dot.deviation_max, 0);
  }
}

TEST(FitCurve, AWobbleWithinToleranceIsADot) {
  const std::vector<Point> points = {{3, 4}, {3.08, 4.02}, {3.02, 4.06}, {3.04, 4}};
  const auto dot = fit(points, within(0.05));
  ASSERT_EQ(dot.curve.control_points().size(), 1u);
  EXPECT_TRUE(dot.curve.control_points()[0].isApprox(Point(3.04, 4.03)));
  EXPECT_NEAR(dot.deviation_max, 0.05, 1e-12);
  EXPECT_NEAR(dot.deviation_rms, std::sqrt((0.0025 + 0.0017 + 0.0013 + 0.0009) / 4), 1e-12);
  EXPECT_EQ(dot.sample_parameters, std::vector<double>(4, 0.0));
  EXPECT_EQ(fit(points, within(0.04)).curve.knots().degree(), 3);
}

TEST(FitCurve, TwoSamplesAreAStraightCubic) {
  const auto line = fit({{0, 0}, {3, 6}}, within(0.01));
  EXPECT_EQ(line.curve.knots().degree(), 3);
  ASSERT_EQ(line.curve.control_points().size(), 4u);
  constexpr double kRounding = 1e-6;  // of the weak regularisation that picks one of many cubics
  for (const Point& p : line.curve.control_points()) EXPECT_NEAR(p.y(), 2 * p.x(), kRounding);
  EXPECT_LT(line.polyline_deviation_max, kRounding);
}

TEST(FitCurve, FewSamplesAreMet) {
  const auto curve = fit({{0, 0}, {1, 0}, {1, 1}}, within(1e-6));
  EXPECT_LE(curve.curve.control_points().size(), 5u);
  fit({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, within(1e-6));
  fit({{0, 0}, {1, 0}, {0, 0}}, within(1e-6));
}

TEST(FitCurve, CollinearSamplesAreOneSpan) {
  std::vector<Point> points;
  for (int i = 0; i < 100; ++i) points.emplace_back(0.1 * i + 0.03 * std::sin(i), 5.0);
  EXPECT_EQ(fit(points, within(0.01)).curve.control_points().size(), 4u);
}

TEST(FitCurve, ACubicInTimeComesBack) {
  // Law: fitting an exact spline returns it.
  const auto knots = KnotVector::make_clamped(3, 0, 2);
  const std::vector<Point> points = {{0, 0}, {10, 0}, {-5, 8}, {4, 9}};
  const auto truth = *BsplineCurve<2>::make(*knots, points);
  std::vector<Point> samples;
  std::vector<double> times;
  for (int i = 0; i <= 60; ++i) {
    times.push_back(2 * std::pow(i / 60.0, 1.3));
    samples.push_back(truth.point(times.back()));
  }
  const auto fitted = fit(samples, within(1e-7), times);
  ASSERT_EQ(fitted.curve.control_points().size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((fitted.curve.control_points()[i] - points[i]).norm(), 1e-6);
  }
}

TEST(FitCurve, CornersAreSharp) {
  const std::vector<Point> vertices = {{0, 0}, {20, 0}, {20, 10}, {5, 12}, {15, 30}};
  const auto fitted = fit(polygon(vertices, 40), within(0.05));
  ASSERT_EQ(fitted.corners.size(), 3u);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_LT((fitted.curve.point(fitted.corners[c]) - vertices[c + 1]).norm(), 0.05);
  }
  EXPECT_EQ(fitted.curve.control_points().size(), 13u) << "one span an edge";
}

TEST(FitCurve, CornersCanBeSwitchedOff) {
  FitOptions options = within(0.05);
  options.detect_corners = false;
  const auto fitted = fit(polygon({{0, 0}, {20, 0}, {20, 10}}, 40), options);
  EXPECT_TRUE(fitted.corners.empty());
}

TEST(FitCurve, NoCornersOnSmoothCurves) {
  for (const double radius : {0.5, 5.0, 50.0}) {
    EXPECT_TRUE(fit(circle(400, radius, 1.7), within(0.02)).corners.empty()) << radius;
  }
}

TEST(FitCurve, BacktrackingTurnsBackInACorner) {
  const auto there_and_back = polygon({{0, 0}, {20, 5}, {0, 0}}, 50);
  FitOptions open = within(0.05);
  open.allow_closing = false;
  EXPECT_EQ(fit(there_and_back, open).corners.size(), 1u);
  const auto closed = fit(there_and_back, within(0.05));
  EXPECT_TRUE(closed.closed);
  EXPECT_EQ(closed.corners.size(), 2u);
}

TEST(FitCurve, AReturnAtEvenSpeedTurnsAtItsTip) {
  std::vector<Point> points;
  for (int i = 0; i <= 40; ++i) points.emplace_back(0.5 * i, 0);
  for (int i = 1; i <= 50; ++i) points.emplace_back(20 - 0.5 * i, 0);
  const auto fitted = fit(points, within(0.05));
  ASSERT_EQ(fitted.corners.size(), 1u);
  EXPECT_NEAR(fitted.curve.point(fitted.corners[0]).x(), 20, 1e-9);
}

TEST(FitCurve, AClosedStrokeKeepsACornerAtItsLastSample) {
  // A square of 20 mm from a step behind its first corner round to that corner.
  const std::vector<Point> vertices = {{0, 0}, {20, 0}, {20, 20}, {0, 20}, {0, 0}};
  std::vector<Point> points;
  for (std::size_t side = 0; side + 1 < vertices.size(); ++side) {
    for (int i = 1; i <= 40; ++i) {
      points.push_back(vertices[side] + i / 40.0 * (vertices[side + 1] - vertices[side]));
    }
  }
  const auto fitted = fit(points, within(0.05));
  EXPECT_TRUE(fitted.closed);
  ASSERT_EQ(fitted.corners.size(), 4u);
  for (const double u : fitted.corners) {
    const Point corner = fitted.curve.point(u);
    EXPECT_NEAR(std::abs(corner.x() - 10), 10, 1e-9);
    EXPECT_NEAR(std::abs(corner.y() - 10), 10, 1e-9);
  }
}

TEST(FitCurve, RepeatedLapsAreAllDrawn) {
  FitOptions options = within(0.05);
  options.allow_closing = false;
  const auto fitted = fit(circle(900, 10, 6), options);
  // The parameter is about arc length: six laps of 20 pi.
  const double length = fitted.sample_parameters.back() - fitted.sample_parameters.front();
  EXPECT_NEAR(length, 6 * 20 * kPi, 6);
  EXPECT_LE(fitted.polyline_deviation_max, 0.1);
}

TEST(FitCurve, ClosedStrokesArePeriodic) {
  const auto fitted = fit(circle(300, 12, 1, 1), within(0.02));
  EXPECT_TRUE(fitted.closed);
  EXPECT_TRUE(fitted.corners.empty());
  const auto& points = fitted.curve.control_points();
  ASSERT_GE(points.size(), 7u);
  EXPECT_LE(points.size(), 12u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(points[i], points[points.size() - 3 + i]);
  EXPECT_LE(fitted.polyline_deviation_max, 0.03);
}

TEST(FitCurve, ClosedStrokesThatEndOnTheirFirstSample) {
  EXPECT_TRUE(fit(circle(300, 12, 1), within(0.02)).closed);
}

TEST(FitCurve, ClosingCanBeSwitchedOff) {
  FitOptions options = within(0.02);
  options.allow_closing = false;
  EXPECT_FALSE(fit(circle(300, 12, 1), options).closed);
}

TEST(FitCurve, OpenStrokesStayOpen) {
  EXPECT_FALSE(fit(circle(300, 12, 0.9), within(0.02)).closed);
  EXPECT_FALSE(fit(circle(4, 12, 1), within(0.02)).closed) << "too few samples to be a loop";
}

TEST(FitCurve, AClosedStrokeWithItsCornerAtTheSeam) {
  const std::vector<Point> drop = {{0, 0}, {20, 3}, {15, 15}, {0, 0}};
  const auto fitted = fit(polygon(drop, 60), within(0.05));
  EXPECT_TRUE(fitted.closed);
  ASSERT_EQ(fitted.corners.size(), 3u);
  EXPECT_EQ(fitted.corners[0], fitted.curve.knots().domain_begin());
  EXPECT_LT((fitted.curve.point(fitted.corners[0]) - drop[0]).norm(), 1e-9);
}

TEST(FitCurve, AClosedStrokeWithCornersElsewhere) {
  // Begins in the middle of an edge: the seam is smooth, though corners make the pieces.
  const std::vector<Point> vertices = {{10, 0}, {20, 0}, {20, 20}, {0, 20}, {0, 0}, {10, 0}};
  std::vector<Point> points;
  for (const Point& p : polygon(vertices, 50)) points.push_back(p);
  const auto fitted = fit(points, within(0.05));
  EXPECT_TRUE(fitted.closed);
  EXPECT_EQ(fitted.corners.size(), 4u);
  const double seam = fitted.curve.knots().domain_begin();
  EXPECT_LE(fitted.curve.knots().multiplicity(seam), 1);
  EXPECT_LT((fitted.curve.point(seam) - Point(10, 0)).norm(), 0.05);
}

TEST(FitCurve, DwellsAtBothEndsDoNotHook) {
  std::vector<Point> points(40, Point(0, 0));
  for (int i = 0; i <= 100; ++i) points.emplace_back(0.2 * i, 0.002 * i * i);
  points.insert(points.end(), 60, points.back());
  const auto fitted = fit(points, within(0.02));
  EXPECT_LE(fitted.curve.control_points().size(), 6u);
  EXPECT_LE(fitted.polyline_deviation_max, 0.02);
}

TEST(FitCurve, TimesMayBeTruncatedOrEqual) {
  std::vector<Point> points = circle(200, 20, 0.4);
  std::vector<double> times;
  for (int i = 0; i < 200; ++i) times.push_back(std::floor(i * 0.4) * 1e-3);
  fit(points, within(0.01), times);
  fit(points, within(0.01), std::vector<double>(200, 7.0));
}

TEST(FitCurve, TinyTolerancesInterpolate) {
  std::vector<Point> points;
  for (int i = 0; i < 60; ++i) points.emplace_back(i, std::sin(i * 12.9898) * 5);
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-11}) fit(points, within(tolerance));
}

TEST(FitCurve, LegsOfAllSizesAreMet) {
  // Ratios of 1e15 between legs.
  std::vector<Point> points = {{0, 0}};
  for (int i = 0; i < 40; ++i) {
    const double leg = std::pow(10.0, (i * 7) % 15 - 12);
    points.emplace_back(points.back() + leg * Point(std::cos(i * 2.4), std::sin(i * 2.4)));
  }
  for (const double tolerance : {1.0, 1e-3, 1e-9}) fit(points, within(tolerance));
}

TEST(FitCurve, ToleranceBelowResolutionIsRefused) {
  std::vector<Point> points;
  for (int i = 0; i < 50; ++i) points.emplace_back(1e9 + 0.1 * i, 1e9 + std::sin(0.1 * i));
  const auto refused = fit_curve<2>(points, {}, within(1e-7));
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::kNumeric);
  EXPECT_THAT(refused.error().remedy, HasSubstr("tolerance"));
  fit(points, within(1e-3));
}

TEST(FitCurve, ExtremeScales) {
  for (const double scale : {1e-90, 1e-9, 1e9, 1e90}) {
    std::vector<Point> points = circle(150, scale, 0.7);
    const auto fitted = fit_curve<2>(points, {}, within(0.001 * scale));
    ASSERT_TRUE(fitted.has_value()) << scale;
    EXPECT_LE(fitted->deviation_max, 0.001 * scale);
    EXPECT_LE(fitted->curve.control_points().size(), 12u);
  }
  // A tolerance beyond the stroke's size.
  EXPECT_EQ(fit(circle(150, 1, 0.7), within(1e300)).curve.control_points().size(), 1u);
}

TEST(FitCurve, ManySamplesOfOneStroke) {
  std::vector<Point> points;
  for (int i = 0; i < 20000; ++i) {
    const double a = i * 0.02;
    points.emplace_back(0.01 * i + 8 * std::cos(a), 8 * std::sin(a));
  }
  const auto fitted = fit(points, within(0.05));
  EXPECT_LE(fitted.curve.control_points().size(), 600u);
}

template <int kDimension>
void fits_in_dimension() {
  using P = Eigen::Matrix<double, kDimension, 1>;
  std::vector<P> points;
  for (int i = 0; i < 120; ++i) {
    P p;
    for (int d = 0; d < kDimension; ++d) p[d] = 10 * std::sin(0.03 * i * (1 + 0.3 * d) + d);
    points.push_back(p);
  }
  const auto fitted = fit_curve<kDimension>(points, {}, within(0.02));
  ASSERT_TRUE(fitted.has_value()) << fitted.error().what;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LE((fitted->curve.point(fitted->sample_parameters[i]) - points[i]).norm(), 0.02);
  }
  EXPECT_LE(fitted->curve.control_points().size(), 40u);
}

TEST(FitCurve, AllDimensions) {
  fits_in_dimension<1>();
  fits_in_dimension<2>();
  fits_in_dimension<3>();
  fits_in_dimension<4>();
  fits_in_dimension<5>();
  fits_in_dimension<6>();
  fits_in_dimension<7>();
  fits_in_dimension<8>();
  fits_in_dimension<9>();
  fits_in_dimension<10>();
}

}  // namespace
}  // namespace limn
