#include "input/stroke/rest_tracker.hpp"

#include <gtest/gtest.h>

#include "tests/support/motion_stream.hpp"

namespace limn {
namespace {

using namespace std::chrono_literals;
using test::pushed;
using Kind = RestTracker::Kind;

/// Says `counts` every 8 ms for so long.
Timestamp say(RestTracker& rest, Timestamp from, Timestamp length, int counts,
              bool rests_exactly = false) {
  const Timestamp end = from + length;
  for (Timestamp time = from; time < end; time += 8ms)
    rest.push(pushed(time, counts, rests_exactly));
  return end;
}

TEST(RestTracker, WhatATableSaysHolds) {
  RestTracker rest;
  say(rest, 0ms, 20s, 3, true);
  EXPECT_EQ(rest.kind(), Kind::kExact);
  EXPECT_EQ(rest.noise(0), 0);
}

TEST(RestTracker, AWornDeviceNeverRestsExactly) {
  RestTracker rest;
  say(rest, 0ms, 31s, 3, true);
  EXPECT_EQ(rest.kind(), Kind::kNoisy);
  EXPECT_NEAR(rest.bias(0) * test::kFullCounts, 3, 1e-9);
}

TEST(RestTracker, FineWorkIsNoWornRest) {
  RestTracker rest;
  for (int i = 0; i < 5000; ++i) rest.push(pushed(i * 8ms, 3 + i / 100 % 10));
  EXPECT_EQ(rest.kind(), Kind::kExact);
}

TEST(RestTracker, ARestThatWasADeflectionIsForgottenAtAZero) {
  RestTracker rest;
  const Timestamp time = say(rest, 0ms, 31s, 10, true);
  EXPECT_EQ(rest.kind(), Kind::kNoisy);
  rest.push(pushed(time, 0));
  EXPECT_EQ(rest.kind(), Kind::kExact);
  EXPECT_EQ(rest.bias(0), 0);
}

TEST(RestTracker, AButtonInThePauseHidesItNot) {
  RestTracker rest;
  const Timestamp time = say(rest, 0ms, 24ms, 0);
  MotionSample button = pushed(time + 80ms, 0, false);
  button.translation_told = button.rotation_told = false;
  rest.push(button);
  rest.push(pushed(time + 160ms, 100, false));
  EXPECT_EQ(rest.kind(), Kind::kExact);
}

TEST(RestTracker, ThreeZerosAndSilenceAreAnExactRestForGood) {
  RestTracker rest;
  Timestamp time = say(rest, 0ms, 200ms, 100);
  EXPECT_EQ(rest.kind(), Kind::kUnknown);
  time = say(rest, time, 24ms, 0);
  EXPECT_TRUE(rest.at_rest());
  time = say(rest, time + 5s, 60s, 3);
  EXPECT_EQ(rest.kind(), Kind::kExact);
}

TEST(RestTracker, ZerosThatGoOnAreNone) {
  RestTracker rest;
  say(rest, 0ms, 900ms, 0);
  rest.push(pushed(2s, 100));
  EXPECT_EQ(rest.kind(), Kind::kUnknown);
}

TEST(RestTracker, BelowFivePercentNothingCountsUntilTheNoiseIsKnown) {
  RestTracker rest;
  const Timestamp time = say(rest, 0ms, 900ms, 5);
  EXPECT_EQ(rest.kind(), Kind::kUnknown);
  EXPECT_EQ(rest.noise(0), RestTracker::kSmall);
  say(rest, time, 200ms, 5);
  EXPECT_EQ(rest.kind(), Kind::kNoisy);
  EXPECT_NEAR(rest.bias(0) * test::kFullCounts, 5, 1e-9);
  EXPECT_LT(rest.noise(0) * test::kFullCounts, 2);
}

TEST(RestTracker, ABiasThatWasNoneIsLearnedAnew) {
  RestTracker rest;
  Timestamp time = say(rest, 0ms, 1100ms, 12);  // a finger lay on it
  time = say(rest, time, 4500ms, 1);
  EXPECT_NEAR(rest.bias(0) * test::kFullCounts, 1, 1e-9);
  EXPECT_TRUE(rest.at_rest());
}

TEST(RestTracker, TheBiasFollowsWhatWarmsUp) {
  RestTracker rest;
  Timestamp time = 0ms;
  int count = 0;
  for (; time < 120s; time += 8ms) {
    // From 2 to 8 counts, a count up and down at a time.
    const int drifted = 2 + static_cast<int>(6 * to_seconds(time) / 120);
    rest.push(pushed(time, drifted + ++count % 3 - 1, false));
  }
  EXPECT_NEAR(rest.bias(0) * test::kFullCounts, 7, 1);
}

TEST(RestTracker, MotionTeachesNothing) {
  RestTracker rest;
  say(rest, 0ms, 10s, 100);
  EXPECT_EQ(rest.kind(), Kind::kUnknown);
  EXPECT_FALSE(rest.at_rest());
}

}  // namespace
}  // namespace limn
