#include "firmware_sim/devices/minimum_jerk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/for_all.hpp"

namespace limn::firmware {
namespace {

using test::for_all;
using test::Rng;

struct Task {
  std::vector<PlanePoint> points;
  std::vector<double> durations;
  std::vector<double> times;
};

Task any_task(Rng& rng) {
  Task task;
  const auto segments = rng.integer(1, 12);
  task.times.push_back(0);
  for (std::int64_t i = 0; i <= segments; ++i) {
    task.points.push_back({rng.uniform(0, 200), rng.uniform(0, 140)});
    if (i == segments) break;
    task.durations.push_back(rng.uniform(0.02, 0.5));
    task.times.push_back(task.times.back() + task.durations.back());
  }
  return task;
}

double distance(PlanePoint a, PlanePoint b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(MinimumJerk, OneSegmentIsThePolynomialOfFlashAndHogan) {
  const PlanePoint ends[] = {{10, 20}, {40, 60}};
  const double durations[] = {0.8};
  const MinimumJerk path(ends, durations);
  for (int i = 0; i <= 10; ++i) {
    const double u = i / 10.0;
    const double s = 10 * std::pow(u, 3) - 15 * std::pow(u, 4) + 6 * std::pow(u, 5);
    EXPECT_NEAR(path.position(0.8 * u).x, 10 + 30 * s, 1e-12);
    EXPECT_NEAR(path.position(0.8 * u).y, 20 + 40 * s, 1e-12);
  }
}

TEST(MinimumJerk, PassesItsPointsAtTheirTimesAndRestsAtBothEnds) {
  for_all(200, [](Rng& rng) {
    const Task task = any_task(rng);
    const MinimumJerk path(task.points, task.durations);
    EXPECT_DOUBLE_EQ(path.duration(), task.times.back());
    for (std::size_t i = 0; i < task.points.size(); ++i) {
      EXPECT_LT(distance(path.position(task.times[i]), task.points[i]), 1e-9);
    }
    EXPECT_LT(distance(path.velocity(0), {}), 1e-9);
    EXPECT_LT(distance(path.velocity(path.duration()), {}), 1e-6);
    EXPECT_EQ(path.position(-1), path.position(0)) << "time is clamped";
    EXPECT_EQ(path.position(99), path.position(path.duration()));
  });
}

/// Around a knot at 0 the path is p(t) + c max(t, 0)^5, p a quintic, exactly if it is four times
/// continuously differentiable there. Sixth differences remove p; those of max(t, 0)^5 at the
/// steps -4..2, -3..3 and -2..4 are 26, 66 and 26 (the values of the quintic B-spline).
TEST(MinimumJerk, JerkAndSnapAreContinuousAtInnerPoints) {
  for_all(200, [](Rng& rng) {
    const Task task = any_task(rng);
    const MinimumJerk path(task.points, task.durations);
    for (std::size_t i = 1; i + 1 < task.points.size(); ++i) {
      const double step = 0.99 * std::min(task.durations[i - 1], task.durations[i]) / 4;
      const auto sixth_difference = [&](int first) {
        constexpr int kBinomial[] = {1, -6, 15, -20, 15, -6, 1};
        double sum = 0;
        for (int k = 0; k <= 6; ++k) {
          sum += kBinomial[k] * path.position(task.times[i] + (first + k) * step).x;
        }
        return sum;
      };
      constexpr double kRounding = 1e-8;  // mm; a jump in the jerk makes tenths of a mm
      EXPECT_NEAR(sixth_difference(-4), sixth_difference(-2), kRounding);
      EXPECT_NEAR(66 * sixth_difference(-4), 26 * sixth_difference(-3), kRounding);
    }
  });
}

/// The integral of the product of two movements' jerks, by third differences.
double jerk_product(const std::vector<PlanePoint>& a, const std::vector<PlanePoint>& b) {
  const auto third_difference = [](const std::vector<PlanePoint>& x, std::size_t i) {
    return x[i + 3] - 3 * x[i + 2] + 3 * x[i + 1] - x[i];
  };
  double sum = 0;
  for (std::size_t i = 0; i + 3 < a.size(); ++i) {
    const PlanePoint p = third_difference(a, i);
    const PlanePoint q = third_difference(b, i);
    sum += p.x * q.x + p.y * q.y;
  }
  return sum;
}

/// The least integral of squared jerk is where the jerk is orthogonal to that of every change which
/// leaves the points and the rest at both ends as they are: no such change can then lower it.
TEST(MinimumJerk, NoOtherMovementThroughThePointsHasLessJerk) {
  for_all(50, [](Rng& rng) {
    const Task task = any_task(rng);
    const MinimumJerk path(task.points, task.durations);
    constexpr int kSamples = 16000;
    const double tilt = rng.uniform(-1, 1);
    std::vector<PlanePoint> best, change;
    for (int i = 0; i <= kSamples; ++i) {
      const double t = path.duration() * i / kSamples;
      const double u = static_cast<double>(i) / kSamples;
      double bump = u * u * (1 - u) * (1 - u) * (1 + tilt * u);
      for (const double at : task.times) bump *= 2 * (t - at) / path.duration();
      best.push_back(path.position(t));
      change.push_back({bump, tilt * bump});
    }
    const double scale = std::sqrt(jerk_product(best, best) * jerk_product(change, change));
    constexpr double kDiscretisation = 5e-3;
    EXPECT_NEAR(jerk_product(best, change) / scale, 0, kDiscretisation);
  });
}

TEST(PowerLawDurations, TheHandIsSlowWhereThePathBends) {
  // An arc of radius 4 mm, then one of radius 32 mm, points 2 mm apart.
  std::vector<PlanePoint> points;
  double heading = 0;
  PlanePoint at{};
  for (int i = 0; i < 80; ++i) {
    points.push_back(at);
    heading += 2.0 / (i < 40 ? 4 : 32);
    at = at + PlanePoint{2 * std::cos(heading), 2 * std::sin(heading)};
  }
  const auto durations = power_law_durations(points, 1);
  ASSERT_EQ(durations.size(), points.size() - 1);
  // v ~ curvature^(-1/3): eight times the radius, twice the speed (a chord is a little shorter
  // than its arc, hence the tolerance of 1 %).
  EXPECT_NEAR(durations[20] / durations[60], 2, 0.02);
  EXPECT_GT(durations.front(), 1.9 * durations[20]) << "it starts from rest";
  const auto twice = power_law_durations(points, 2);
  for (std::size_t i = 0; i < durations.size(); ++i) EXPECT_DOUBLE_EQ(2 * twice[i], durations[i]);
}

}  // namespace
}  // namespace limn::firmware
