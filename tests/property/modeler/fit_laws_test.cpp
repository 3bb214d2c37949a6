// Laws of fits, on random strokes and splines.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "modeler/fit/fit_curve.hpp"
#include "tests/property/modeler/random_splines.hpp"
#include "tests/support/for_all.hpp"

namespace limn {
namespace {

using Point = Eigen::Vector2d;
using test::Rng;

FitOptions within(double tolerance_mm) {
  FitOptions options;
  options.tolerance_mm = tolerance_mm;
  return options;
}

/// A smooth random stroke: sums of sines, some 100 mm across.
std::vector<Point> any_smooth_stroke(Rng& rng, int count) {
  std::array<double, 8> a;
  for (double& x : a) x = rng.uniform(-1, 1);
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) {
    const double t = 6.0 * i / count;
    points.emplace_back(
        20 * t + 15 * a[0] * std::sin((1 + a[1]) * t + 3 * a[2]),
        30 * a[3] * std::sin((2 + a[4]) * t + 3 * a[5]) + 10 * a[6] * std::cos((1 + a[7]) * t));
  }
  return points;
}

/// What no pen would draw: steps of all sizes and directions, dwells, jumps, returns.
std::vector<Point> any_nasty_stroke(Rng& rng) {
  std::vector<Point> points = {{rng.uniform(-50, 50), rng.uniform(-50, 50)}};
  const auto count = rng.integer(1, 120);
  double heading = rng.uniform(0, 6.3);
  for (int i = 1; i < count; ++i) {
    const double kind = rng.uniform(0, 1);
    if (kind < 0.2) {
      points.push_back(points.back());
    } else if (kind < 0.3) {
      points.push_back(points[static_cast<std::size_t>(rng.integer(0, i - 1))]);
    } else {
      heading += kind < 0.4 ? rng.uniform(0, 6.3) : rng.uniform(-0.3, 0.3);
      const double leg = std::pow(10, rng.uniform(-6, 1));
      points.emplace_back(points.back() + leg * Point(std::cos(heading), std::sin(heading)));
    }
  }
  return points;
}

TEST(FitLaw, EverySampleOfAnyStrokeIsWithinTolerance) {
  test::for_all(150, [](Rng& rng) {
    const auto points = any_nasty_stroke(rng);
    FitOptions options = within(std::pow(10, rng.uniform(-8, 1)));
    options.detect_corners = rng.chance(0.7);
    options.allow_closing = rng.chance(0.7);
    const auto fitted = fit_curve<2>(points, {}, options);
    ASSERT_TRUE(fitted.has_value()) << fitted.error().what;
    double before = fitted->curve.knots().domain_begin();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double u = fitted->sample_parameters[i];
      EXPECT_GE(u, before);
      before = u;
      EXPECT_LE((fitted->curve.point(u) - points[i]).norm(), options.tolerance_mm) << i;
    }
    EXPECT_LE(before, fitted->curve.knots().domain_end());
  });
}

TEST(FitLaw, RigidMotionsMoveTheCurveWithThem) {
  test::for_all(30, [](Rng& rng) {
    const auto points = any_smooth_stroke(rng, 200);
    const Eigen::Rotation2Dd turn(rng.uniform(-3, 3));
    const Point shift(rng.uniform(-200, 200), rng.uniform(-200, 200));
    std::vector<Point> moved;
    for (const Point& p : points) moved.push_back(turn * p + shift);
    const auto here = fit_curve<2>(points, {}, within(0.05));
    const auto there = fit_curve<2>(moved, {}, within(0.05));
    ASSERT_TRUE(here.has_value() && there.has_value());
    ASSERT_EQ(here->curve.control_points().size(), there->curve.control_points().size());
    // Rounding of 1e-14 mm, grown by some forty nonlinear iterations.
    constexpr double kAgreement = 1e-6;
    for (std::size_t i = 0; i < here->curve.control_points().size(); ++i) {
      const Point mapped = turn * here->curve.control_points()[i] + shift;
      EXPECT_LE((there->curve.control_points()[i] - mapped).norm(), kAgreement);
    }
  });
}

TEST(FitLaw, ScalingWithTheToleranceScalesTheCurve) {
  test::for_all(20, [](Rng& rng) {
    const auto points = any_smooth_stroke(rng, 150);
    std::vector<Point> scaled;
    for (const Point& p : points) scaled.push_back(1024 * p);  // a power of two: the same bits
    const auto here = fit_curve<2>(points, {}, within(0.05));
    const auto there = fit_curve<2>(scaled, {}, within(1024 * 0.05));
    ASSERT_TRUE(here.has_value() && there.has_value());
    ASSERT_EQ(here->curve.control_points().size(), there->curve.control_points().size());
    for (std::size_t i = 0; i < here->curve.control_points().size(); ++i) {
      EXPECT_EQ(there->curve.control_points()[i], 1024 * here->curve.control_points()[i]);
    }
  });
}

TEST(FitLaw, ASplineIsReproducedWithAboutItsOwnControlPoints) {
  // Samples of a known cubic spline: it is itself within any tolerance of them, so a fit that needs
  // many more control points would have missed it.
  test::for_all(20, [](Rng& rng) {
    auto stroke = any_smooth_stroke(rng, 28);
    stroke.resize(14);
    std::vector<double> inner;
    for (int i = 1; i < 11; ++i) inner.push_back(i + rng.uniform(-0.3, 0.3));
    const auto truth = *BsplineCurve<2>::make(*KnotVector::make_clamped(3, 0, 11, inner),
                                              {stroke.begin(), stroke.end()});
    std::vector<Point> points;
    std::vector<double> times;
    for (int i = 0; i <= 400; ++i) {
      times.push_back(11 * i / 400.0);
      points.push_back(truth.point(times.back()));
    }
    constexpr double kTolerance = 0.05;
    const auto fitted = fit_curve<2>(points, times, within(kTolerance));
    ASSERT_TRUE(fitted.has_value());
    EXPECT_LE(fitted->curve.control_points().size(), truth.control_points().size() + 2);
    EXPECT_TRUE(fitted->corners.empty());
    // Between samples as well: the curve is as near the spline as at them, and a little for the
    // bend of a leg of some 0.5 mm.
    EXPECT_LE(fitted->polyline_deviation_max, 1.5 * kTolerance);
  });
}

TEST(FitLaw, ACubicOfTimeComesBack) {
  test::for_all(30, [](Rng& rng) {
    const auto truth = test::any_spline<1, 3>(rng, {*KnotVector::make_clamped(3, 0, 1)});
    std::vector<Eigen::Vector3d> points;
    std::vector<double> times;
    for (int i = 0; i <= 50; ++i) {
      times.push_back(i / 50.0);
      points.push_back(truth.point(times.back()));
    }
    FitOptions options = within(1e-6);
    const auto fitted = fit_curve<3>(points, times, options);
    ASSERT_TRUE(fitted.has_value());
    ASSERT_EQ(fitted->curve.control_points().size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LE((fitted->curve.control_points()[i] - truth.control_points()[i]).norm(), 1e-5);
    }
  });
}

TEST(FitLaw, NoiseBelowTheToleranceHardlyCosts) {
  test::for_all(10, [](Rng& rng) {
    auto points = any_smooth_stroke(rng, 600);
    const auto clean = fit_curve<2>(points, {}, within(0.1));
    for (Point& p : points) p += Point(0.01 * rng.normal(), 0.01 * rng.normal());
    const auto noisy = fit_curve<2>(points, {}, within(0.1));
    ASSERT_TRUE(clean.has_value() && noisy.has_value());
    EXPECT_LE(noisy->curve.control_points().size(), clean->curve.control_points().size() + 6);
  });
}

}  // namespace
}  // namespace limn
