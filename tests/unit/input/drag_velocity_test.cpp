#include <gtest/gtest.h>

#include <limits>

#include "input/stroke/drag_sampler.hpp"
#include "tests/support/motion_stream.hpp"

namespace limn {
namespace {

using namespace std::chrono_literals;
using test::Counts;
using test::motion_of;
using test::pushed;
using Vector = std::array<double, 3>;

TEST(DragVelocity, FullDeflectionIsAHundredMillimetresAndOneRadianASecond) {
  DragVelocity drag;
  const Drag full = drag.push(motion_of(0ms, {350, -350, 350, -350, 350, -350}));
  EXPECT_EQ(full.mm_per_s, (Vector{100, -100, 100}));
  EXPECT_EQ(full.rad_per_s, (Vector{-1, 1, -1}));
}

TEST(DragVelocity, WhatGoesBeyondFullIsNotClamped) {
  DragVelocity drag;
  EXPECT_DOUBLE_EQ(drag.push(pushed(0ms, 700)).mm_per_s[0], 200);
}

TEST(DragVelocity, OneCountIsNeverSwallowed) {
  DragVelocity drag;
  double mm = 0;
  for (int i = 0; i <= 1000; ++i) mm += drag.push(pushed(i * 8ms, 1)).mm[0];
  EXPECT_NEAR(mm, 100.0 / 350 * 8, 1e-9);
}

TEST(DragVelocity, TheDeadZoneGrowsFromZeroAtItsEdge) {
  DragOptions options;
  options.dead_zone = 0.2;
  DragVelocity drag(options);
  EXPECT_EQ(drag.push(pushed(0ms, 70)).mm_per_s[0], 0);
  EXPECT_NEAR(drag.push(pushed(8ms, -77)).mm_per_s[0], -100 * 0.02 / 0.8, 1e-9);
  EXPECT_NEAR(drag.push(pushed(16ms, 350)).mm_per_s[0], 100, 1e-9);
}

TEST(DragVelocity, TheCurveKeepsFullDeflectionFull) {
  DragOptions options;
  options.curve = 1;
  DragVelocity drag(options);
  EXPECT_NEAR(drag.push(pushed(0ms, 175)).mm_per_s[0], 12.5, 1e-9);
  EXPECT_NEAR(drag.push(pushed(8ms, -350)).mm_per_s[0], -100, 1e-9);
}

TEST(DragVelocity, AxesAreChosenScaledAndInverted) {
  DragOptions options;
  options.source = {1, 0, 2, 3, 4, 4};
  options.sensitivity = {1, 2, 0, 1, 1, 1};
  options.inverted[1] = true;
  DragVelocity drag(options);
  const Drag moved = drag.push(motion_of(0ms, {35, 70, 350, 0, 350, 0}));
  EXPECT_DOUBLE_EQ(moved.mm_per_s[0], 20);
  EXPECT_DOUBLE_EQ(moved.mm_per_s[1], -20);
  EXPECT_DOUBLE_EQ(moved.mm_per_s[2], 0);
  EXPECT_EQ(moved.rad_per_s, (Vector{0, 1, 1}));
}

TEST(DragVelocity, TheDominantAxisIsLeftOnlyForAClearlyLargerOne) {
  DragOptions options;
  options.dominant_axis = true;
  DragVelocity drag(options);
  const auto x_and_y = [&drag](Timestamp time, int x, int y) {
    const Drag moved = drag.push(motion_of(time, {x, y, 0, 0, 0, 0}));
    return std::array{moved.mm_per_s[0] != 0, moved.mm_per_s[1] != 0};
  };
  EXPECT_EQ(x_and_y(0ms, 100, 90), (std::array{true, false}));
  EXPECT_EQ(x_and_y(8ms, 100, 120), (std::array{true, false}));
  EXPECT_EQ(x_and_y(16ms, 100, 130), (std::array{false, true}));
  EXPECT_EQ(x_and_y(24ms, 120, 100), (std::array{false, true}));
  EXPECT_EQ(x_and_y(32ms, 0, 0), (std::array{false, false}));
  EXPECT_EQ(x_and_y(40ms, 110, 100), (std::array{true, false}));
}

TEST(DragVelocity, AnAxisThatDrivesNothingIsNotDominant) {
  DragOptions options;
  options.dominant_axis = true;
  options.sensitivity = {1, 1, 1, 0, 0, 0};
  DragVelocity drag(options);
  EXPECT_NE(drag.push(motion_of(0ms, {175, 0, 0, 0, 0, 350})).mm_per_s[0], 0);
}

TEST(DragVelocity, ADominantAxisOfTheOtherHalfStopsThisOneAtOnce) {
  DragOptions options;
  options.dominant_axis = true;
  DragVelocity drag(options);
  drag.push(motion_of(0ms, {175, 0, 0, 0, 0, 0}));
  MotionSample turned = motion_of(10ms, {175, 0, 0, 0, 0, 350});
  turned.translation_told = false;
  EXPECT_NEAR(drag.push(turned).mm[0], 0.5, 1e-9);
  turned.time = 1s;
  EXPECT_EQ(drag.push(turned).mm[0], 0);
  EXPECT_EQ(drag.push(motion_of(2s, {175, 0, 0, 0, 0, 350})).mm[0], 0);
}

TEST(DragVelocity, ASlowFirstPushOfAnUnknownDeviceEndsAtItsRelease) {
  DragVelocity drag;
  Timestamp time = 0ms;
  for (; time < 2s; time += 8ms) drag.push(pushed(time, 10, false));
  for (int zero = 0; zero < 3; ++zero, time += 8ms) {
    EXPECT_EQ(drag.push(pushed(time, 0, false)).mm_per_s, (Vector{})) << zero;
  }
  EXPECT_EQ(drag.push(pushed(time + 60s, 35, false)).mm, (Vector{}));
}

TEST(DragVelocity, SilenceBeforeAMotionCountsNothing) {
  DragVelocity drag;
  for (int i = 0; i < 3; ++i) drag.push(pushed(i * 8ms, 0));
  EXPECT_EQ(drag.push(pushed(60s, 350)).mm[0], 0);
  EXPECT_NEAR(drag.push(pushed(60s + 10ms, 350)).mm[0], 1, 1e-9);
}

TEST(DragVelocity, ItEndsWhereTheDeviceFallsSilent) {
  DragVelocity drag;
  drag.push(pushed(0ms, 350));
  MotionSample silence = pushed(100ms, 0);
  silence.translation_told = silence.rotation_told = false;
  silence.silence = true;
  const Drag end = drag.push(silence);
  EXPECT_EQ(end.mm_per_s, (Vector{}));
  EXPECT_TRUE(end.at_rest);
  EXPECT_NEAR(end.mm[0], 10, 1e-9);
  EXPECT_EQ(drag.push(pushed(200ms, 350)).mm[0], 0);
}

TEST(DragVelocity, ThreeZeroReportsAreRest) {
  DragVelocity drag;
  EXPECT_FALSE(drag.push(pushed(0ms, 350)).at_rest);
  EXPECT_FALSE(drag.push(pushed(8ms, 0)).at_rest);
  EXPECT_FALSE(drag.push(pushed(16ms, 0)).at_rest);
  EXPECT_TRUE(drag.push(pushed(24ms, 0)).at_rest);
}

TEST(DragVelocity, ButtonsMoveNothing) {
  DragVelocity drag;
  drag.push(pushed(0ms, 350));
  MotionSample button = pushed(4ms, 350);
  button.translation_told = button.rotation_told = false;
  EXPECT_EQ(drag.push(button).mm, (Vector{}));
  EXPECT_NEAR(drag.push(pushed(8ms, 350)).mm[0], 0.8, 1e-9);
}

TEST(DragVelocity, TimeThatGoesBackMovesNothing) {
  DragVelocity drag;
  drag.push(pushed(100ms, 350));
  EXPECT_EQ(drag.push(pushed(50ms, 350)).mm[0], 0);
  EXPECT_NEAR(drag.push(pushed(110ms, 350)).mm[0], 1, 1e-9);
}

TEST(DragVelocity, ADeviceThatIsStuckStandsStillUntilItMoves) {
  DragVelocity drag;
  Timestamp time = 0ms;
  while (time < RestTracker::kStuckAfter) {
    EXPECT_EQ(drag.push(pushed(time, 350)).mm_per_s[0], 100);
    time += 16ms;
  }
  const Drag stuck = drag.push(pushed(time, 350));
  EXPECT_EQ(stuck.mm_per_s[0], 0);
  EXPECT_TRUE(stuck.at_rest);
  EXPECT_NEAR(drag.push(pushed(time + 16ms, 349)).mm_per_s[0], 100, 1);
}

TEST(DragSampler, DevicesAreMovedSideBySideAndReplugsBeginAnew) {
  DragSampler drags;
  const auto push = [&drags](DeviceIndex device, Timestamp time, int counts,
                             bool replugged = false) {
    MotionSample sample = pushed(time, counts);
    sample.device = device;
    if (replugged) sample.disturbances = Disturbance::kReset;
    return drags.push(sample).mm[0];
  };
  EXPECT_EQ(push(1, 0ms, 350), 0);
  EXPECT_EQ(push(2, 10ms, 175), 0);
  EXPECT_NEAR(push(1, 20ms, 350), 2, 1e-9);
  EXPECT_NEAR(push(2, 20ms, 175), 0.5, 1e-9);
  EXPECT_EQ(push(1, 30ms, 350, true), 0) << "nobody knows where it was";
  EXPECT_NEAR(push(1, 40ms, 350), 1, 1e-9);
}

TEST(DragVelocity, OptionsAreChecked) {
  EXPECT_TRUE(check(DragOptions()));
  const auto refused = [](auto change) {
    DragOptions options;
    change(options);
    const auto checked = check(options);
    return checked ? "" : checked.error().at;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused([](DragOptions& o) { o.mm_per_s = kNan; }), "mm_per_s");
  EXPECT_EQ(refused([](DragOptions& o) { o.rad_per_s = 1e300; }), "rad_per_s");
  EXPECT_EQ(refused([](DragOptions& o) { o.dead_zone = 1; }), "dead_zone");
  EXPECT_EQ(refused([](DragOptions& o) { o.dead_zone = -0.1; }), "dead_zone");
  EXPECT_EQ(refused([](DragOptions& o) { o.curve = 1.5; }), "curve");
  EXPECT_EQ(refused([](DragOptions& o) { o.sensitivity[3] = kNan; }), "sensitivity");
  EXPECT_EQ(refused([](DragOptions& o) { o.source[5] = 6; }), "source");
}

}  // namespace
}  // namespace limn
