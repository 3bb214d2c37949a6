#include "firmware_sim/devices/hand_sensor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "firmware_sim/devices/hid_pen.hpp"

namespace limn::firmware {
namespace {

using namespace std::chrono_literals;

/// A dot, held for as long as the hand does.
Drawing dot_at(PlanePoint point) {
  Drawing drawing;
  drawing.strokes.push_back({{{point}}, PenEnd::kTip, 1, 0.5});
  return drawing;
}

/// Standard deviation of x about the hand's, over 20 seeds of a dot.
double deviation_at(PlanePoint point) {
  double squares = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    HandSensor sensor(dot_at(point), {210, 148}, seed);
    for (auto time = 0us; time < sensor.duration(); time += 1ms) {
      const PenPose pose = sensor.pose(time);
      if (pose.proximity != Proximity::kTouching) continue;
      const double off = sensor.measure(time).x_mm - pose.x_mm;
      squares += off * off;
      ++count;
    }
  }
  EXPECT_GT(count, 500);
  return std::sqrt(squares / count);
}

TEST(HandSensor, NoiseGrowsTowardsTheEdge) {
  // 10 %: more than five standard errors of 500 deviates.
  EXPECT_NEAR(deviation_at({105, 74}), 0.02, 0.002);
  EXPECT_NEAR(deviation_at({11, 74}), 0.02, 0.002);
  EXPECT_NEAR(deviation_at({5, 74}), 0.04, 0.004) << "1 + 4 / 4";
  EXPECT_NEAR(deviation_at({210, 74}), 0.1, 0.01) << "1 + 4";
  EXPECT_NEAR(deviation_at({105, 0}), 0.1, 0.01);
}

TEST(HandSensor, ADrawingIsMadeSmallerWhereItWouldNotFit) {
  const Drawing drawing = dot_at({200, 100});
  const HandSensor whole(drawing, {300, 300}, 1, 0);
  const HandSensor small(drawing, {105, 300}, 1, 0);
  for (auto time = 0us; time < whole.duration(); time += 10ms) {
    if (whole.pose(time).proximity != Proximity::kTouching) continue;
    EXPECT_DOUBLE_EQ(whole.pose(time).x_mm, 200);
    EXPECT_DOUBLE_EQ(small.pose(time).x_mm, 100);
    EXPECT_DOUBLE_EQ(small.pose(time).y_mm, 50);
  }
}

TEST(HandSensor, WhatItMeasuresDependsOnTheInstantAlone) {
  HandSensor often(dot_at({100, 100}), {210, 148}, 1);
  HandSensor seldom(dot_at({100, 100}), {210, 148}, 1);
  for (auto time = 0us; time < often.duration(); time += 1ms) {
    const PenPose pose = often.measure(time);
    if (time % 7ms != 0us) continue;
    EXPECT_EQ(pose.x_mm, seldom.measure(time).x_mm);
  }
}

}  // namespace
}  // namespace limn::firmware
