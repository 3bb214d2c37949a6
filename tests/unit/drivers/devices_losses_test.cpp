// What disturbs a stream: the pace of steps, the device's own clock, and what is told with samples.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <string>
#include <vector>

#include "drivers/devices/loss_tracker.hpp"
#include "drivers/devices/scan_time.hpp"
#include "drivers/devices/usual_step.hpp"
#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

using namespace std::chrono_literals;
using test::decode_trace;
using test::DecodedTrace;
using ::testing::Each;
using ::testing::ElementsAre;

/// What each of `steps` lacks, after one block of `usual` ones.
std::vector<std::uint32_t> missing(const std::vector<std::int64_t>& usual,
                                   const std::vector<std::int64_t>& steps) {
  UsualStep learned;
  for (std::size_t i = 0; i < UsualStep::kBlock; ++i) learned.push(usual[i % usual.size()]);
  EXPECT_TRUE(learned.known());
  std::vector<std::uint32_t> missing;
  for (const auto step : steps) missing.push_back(learned.push(step));
  return missing;
}

TEST(UsualStep, OfASteadyClockCountsEveryMissingStep) {
  EXPECT_THAT(missing({75, 75, 76}, {75, 150, 76, 226, 7500}), ElementsAre(0, 1, 0, 2, 99));
}

TEST(UsualStep, JitterOfTwiceTheLengthIsOrdinary) {
  EXPECT_THAT(missing({40, 80}, {40, 80, 79, 41, 160}), ElementsAre(0, 0, 0, 0, 0));
  EXPECT_THAT(missing({40, 80}, {240, 600}), ElementsAre(3, 9)) << "at 60 on the average";
}

TEST(UsualStep, ThreeLossesInABlockAreNotOrdinary) {
  EXPECT_THAT(missing({75, 75, 75, 75, 75, 750}, {75, 150}), ElementsAre(0, 1));
}

TEST(UsualStep, LearnsANewPaceOnlyAfterHalfABlock) {
  std::vector<std::int64_t> slower(UsualStep::kBlock / 2 + UsualStep::kBlock + 1, 150);
  auto found = missing({75}, slower);
  EXPECT_EQ(std::count(found.begin(), found.end(), 1U),
            static_cast<std::ptrdiff_t>(UsualStep::kBlock / 2));
  EXPECT_EQ(found.back(), 0U);
  slower = {150, 75, 150, 75, 150, 75, 150, 75, 150, 75, 150, 75, 150, 75, 150, 75, 150, 75, 150};
  found = missing({75}, slower);
  EXPECT_EQ(std::count(found.begin(), found.end(), 1U), 10) << "every second report lost";
}

TEST(UsualStep, EnormousStepsAreCountedToTheLimit) {
  EXPECT_THAT(missing({1}, {std::numeric_limits<std::int64_t>::max()}),
              ElementsAre(std::numeric_limits<std::uint32_t>::max()));
  EXPECT_THAT(missing({std::numeric_limits<std::int64_t>::max()},
                      {std::numeric_limits<std::int64_t>::max(), 1}),
              ElementsAre(0, 0));
}

/// A pen that reports every 7.5 ms by a clock of 100 us, from 65000 on so that it wraps.
class ScanTimeAt75 : public ::testing::Test {
 protected:
  ScanTime clock_;
  std::int64_t ticks_ = 65000;
  Timestamp time_ = 10s;

  ScanTime::Step step(std::int64_t ticks, Timestamp elapsed, bool touching = true) {
    ticks_ = (ticks_ + ticks) % 65536;
    time_ += elapsed;
    return clock_.push({ticks_, 65536, 1e-4, time_, touching});
  }
  void learn(bool touching = true) {
    for (int i = 0; i < 40; ++i) {
      const auto usual = step(75, 7500us, touching);
      EXPECT_EQ(usual.lost, 0U);
      EXPECT_FALSE(usual.jumped);
    }
  }
};

TEST_F(ScanTimeAt75, CountsMissingReportsWhateverTheirDelivery) {
  learn();
  EXPECT_EQ(step(4 * 75, 30ms).lost, 3U);
  EXPECT_EQ(step(2 * 75, 1us).lost, 1U) << "out of a queue that had run full";
  EXPECT_EQ(step(75, 400ms).lost, 0U) << "late, not lost";
}

TEST_F(ScanTimeAt75, HoveringAndTouchingMayHaveAPaceEach) {
  learn(true);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(step(300, 30ms, false).lost, 0U);
  EXPECT_EQ(step(300, 30ms, true).lost, 0U) << "of either pace";
  EXPECT_EQ(step(300, 30ms, true).lost, 3U);
}

TEST_F(ScanTimeAt75, CountsNothingAcrossALeaving) {
  learn();
  clock_.leave();
  const auto back = step(7500, 3s);
  EXPECT_EQ(back.lost, 0U);
  EXPECT_FALSE(back.jumped);
}

TEST_F(ScanTimeAt75, AClockThatDisagreesByASecondHasJumped) {
  learn();
  const auto reset = step(40000, 7500us);
  EXPECT_TRUE(reset.jumped);
  EXPECT_EQ(reset.lost, 0U);
  EXPECT_FALSE(step(75, 7500us).jumped) << "once";
  EXPECT_TRUE(step(75, 3s).jumped) << "the reports' clock was set";
  const auto turned = step(75, 2 * 6553600us + 7500us);
  EXPECT_FALSE(turned.jumped) << "whole turns do not show";
}

TEST_F(ScanTimeAt75, AFieldThatStandsStillIsNoClock) {
  for (int i = 0; i < 40; ++i) {
    const auto still = step(0, 2s);
    EXPECT_EQ(still.lost, 0U);
    EXPECT_FALSE(still.jumped);
  }
}

/// Samples of a pen in contact, every 4 ms and 0.1 mm to the right.
class PacedTracker : public ::testing::Test {
 protected:
  LossTracker tracker_;
  PenSample last_;

  PacedTracker() {
    last_.state = PenState::kInContact;
    last_.axes.add(PenAxis::kX);
    last_.axes.add(PenAxis::kY);
  }
  PenSample next(Timestamp elapsed, double moved_mm, PenState state = PenState::kInContact) {
    last_.time += elapsed;
    last_.x_mm += moved_mm;
    last_.state = state;
    PenSample sample = last_;
    tracker_.complete(sample, true);
    return sample;
  }
  void write(int samples) {
    for (int i = 0; i < samples; ++i) EXPECT_TRUE(next(4ms, 0.1).disturbances.empty());
  }
};

TEST_F(PacedTracker, AStrokeThatJumpsInALongSilenceHasAGap) {
  write(100);
  const PenSample after = next(80ms, 2);
  EXPECT_EQ(after.disturbances, Disturbance::kGap);
  EXPECT_EQ(after.lost, 19U);
  EXPECT_TRUE(after.lost_estimated);
  write(10);
  EXPECT_EQ(tracker_.losses().gaps, 1U);
  EXPECT_EQ(tracker_.losses().lost, 19U);
  EXPECT_TRUE(tracker_.losses().lost_estimated);
}

TEST_F(PacedTracker, WhatMayBeAPauseIsNone) {
  write(100);
  EXPECT_TRUE(next(2s, 0.02).disturbances.empty()) << "a pen at rest that is not reported";
  LossTracker fresh;
  tracker_ = fresh;
  write(20);
  EXPECT_TRUE(next(80ms, 2).disturbances.empty()) << "nothing is known of the pace yet";
}

TEST_F(PacedTracker, LateBatchesAreNone) {
  // A radio delivers eight reports at once, and now and then far too late.
  for (int batch = 0; batch < 100; ++batch) {
    for (int i = 0; i < 8; ++i) {
      const bool late = batch % 10 == 9;
      ASSERT_TRUE(next(i > 0 ? 0ms : late ? 300ms : 32ms, 0.1).disturbances.empty());
    }
  }
}

TEST_F(PacedTracker, HoveringAndLandingAreNotJudged) {
  write(100);
  EXPECT_TRUE(next(4ms, 0.1, PenState::kInRange).disturbances.empty());
  EXPECT_TRUE(next(1s, 50, PenState::kInRange).disturbances.empty());
  EXPECT_TRUE(next(1s, 50, PenState::kInContact).disturbances.empty());
}

TEST_F(PacedTracker, ANewPaceIsLearned) {
  write(100);
  for (int i = 0; i < 100; ++i) (void)next(40ms, 3);
  EXPECT_EQ(tracker_.losses().gaps, 4U);
}

TEST_F(PacedTracker, WhatTheDeviceCountsHoldsWhatWasToldOfIt) {
  const auto counted = [this](std::uint32_t lost) {
    last_.time += 4ms;
    PenSample sample = last_;
    sample.lost = lost;
    sample.disturbances.add(Disturbance::kGap);
    tracker_.complete(sample, true);
    return sample;
  };
  tracker_.overrun(5, false);
  const PenSample same = counted(5);
  EXPECT_EQ(same.lost, 5U);
  EXPECT_EQ(same.disturbances, Disturbance::kOverrun);
  tracker_.overrun(2, true);
  const PenSample more = counted(7);
  EXPECT_EQ(more.lost, 7U);
  EXPECT_FALSE(more.lost_estimated) << "the device counted them";
  EXPECT_TRUE(more.disturbances.has(Disturbance::kGap));
  EXPECT_EQ(tracker_.losses().lost, 12U);
  EXPECT_EQ(tracker_.losses().overruns, 2U);
  EXPECT_EQ(tracker_.losses().gaps, 1U);
}

TEST_F(PacedTracker, AFullQueueThatMayHaveDroppedNoneIsAnOverrun) {
  tracker_.overrun(0, true);
  const PenSample after = next(4ms, 0.1);
  EXPECT_EQ(after.lost, 0U);
  EXPECT_TRUE(after.lost_estimated);
  EXPECT_EQ(after.disturbances, Disturbance::kOverrun);
  EXPECT_EQ(tracker_.losses().overruns, 1U);
}

TEST_F(PacedTracker, TellsEverythingOnceWithTheNextSample) {
  tracker_.described();
  write(1);
  tracker_.overrun(3, false);
  tracker_.overrun(0, false);
  tracker_.damage(2, true);
  tracker_.gone();
  tracker_.described();
  const PenSample sample = next(4ms, 0.1);
  EXPECT_EQ(sample.lost, 5U);
  EXPECT_FALSE(sample.lost_estimated);
  for (const auto what : {Disturbance::kOverrun, Disturbance::kDamage, Disturbance::kClockJump,
                          Disturbance::kReset}) {
    EXPECT_TRUE(sample.disturbances.has(what)) << name(what);
  }
  EXPECT_FALSE(sample.disturbances.has(Disturbance::kGap));
  write(1);
  EXPECT_EQ(tracker_.losses().overruns, 1U);
  EXPECT_EQ(tracker_.losses().resets, 1U) << "it went and came back";
  EXPECT_EQ(tracker_.losses().clock_jumps, 1U);
}

TEST_F(PacedTracker, TimeThatGoesBackIsAClockJump) {
  write(2);
  EXPECT_EQ(next(-1ms, 0).disturbances, Disturbance::kClockJump);
  EXPECT_EQ(tracker_.losses().clock_jumps, 1U);
}

constexpr std::string_view kGraphire = "N: a\nI: 3 056a 0013\n";

TEST(TraceDecoderLosses, NotesDamageAndReplugsAreToldWithTheNextSample) {
  const DecodedTrace trace =
      decode_trace(std::string(kGraphire) +
                       "E: 1.0 8 02 90 40 1f 20 03 00 00\n"
                       "#limn lost? 64\nE: 2.0 8 02 90 41 1f 20 03 00 00\n"
                       "E: 1.5 8 02 90 41 1f 20 03 00 00\nE: 3.0 8 02 90 41 1f 20 03 00 00\n"
                       "#limn gone\n" +
                       std::string(kGraphire) + "E: 4.0 8 02 90 41 1f 20 03 00 00\n",
                   {}, true);
  ASSERT_EQ(trace.samples.size(), 5U);
  EXPECT_TRUE(trace.samples[0].disturbances.empty()) << "described for the first time";
  EXPECT_EQ(trace.samples[1].disturbances, Disturbance::kOverrun);
  EXPECT_EQ(trace.samples[1].lost, 64U);
  EXPECT_TRUE(trace.samples[1].lost_estimated);
  Disturbances went_back = Disturbance::kDamage;
  went_back.add(Disturbance::kClockJump);
  EXPECT_EQ(trace.samples[2].disturbances, went_back);
  EXPECT_EQ(trace.samples[2].lost, 1U);
  EXPECT_FALSE(trace.samples[2].lost_estimated);
  EXPECT_EQ(trace.samples[3].disturbances, Disturbance::kReset);
  EXPECT_EQ(trace.samples[3].state, PenState::kOutOfRange);
  EXPECT_TRUE(trace.samples[4].disturbances.empty());
  const StreamLosses losses = trace.summary.losses();
  EXPECT_EQ(losses.lost, 65U);
  EXPECT_TRUE(losses.lost_estimated);
  EXPECT_EQ(losses.overruns, 1U);
  EXPECT_EQ(losses.resets, 1U);
  EXPECT_EQ(losses.clock_jumps, 1U);
  EXPECT_EQ(losses.gaps, 0U);
}

TEST(TraceDecoderLosses, AFullQueueThatMayHaveDroppedNoneIsTold) {
  const DecodedTrace trace = decode_trace(std::string(kGraphire) +
                                          "E: 1.0 8 02 90 40 1f 20 03 00 00\n"
                                          "#limn lost? 0\nE: 2.0 8 02 90 41 1f 20 03 00 00\n"
                                          "#limn lost 0\nE: 3.0 8 02 90 41 1f 20 03 00 00\n");
  ASSERT_EQ(trace.samples.size(), 3U);
  EXPECT_EQ(trace.samples[1].lost, 0U);
  EXPECT_TRUE(trace.samples[1].lost_estimated);
  EXPECT_EQ(trace.samples[1].disturbances, Disturbance::kOverrun);
  EXPECT_FALSE(trace.samples[2].lost_estimated);
  EXPECT_TRUE(trace.samples[2].disturbances.empty()) << "none was dropped";
  EXPECT_EQ(trace.summary.losses().overruns, 1U);
  EXPECT_EQ(trace.summary.losses().lost, 0U);
  EXPECT_TRUE(trace.summary.losses().lost_estimated);
}

TEST(TraceDecoderLosses, WhatNoSampleFollowsIsStillCounted) {
  const DecodedTrace trace = decode_trace(
      std::string(kGraphire) + "E: 1.0 8 02 80 40 1f 20 03 00 00\n#limn lost 7\n#limn gone\n");
  EXPECT_EQ(trace.summary.losses().lost, 7U);
  EXPECT_EQ(trace.summary.losses().resets, 1U);
}

TEST(TraceDecoderLosses, RepairsAreMarked) {
  const DecodedTrace trace =
      decode_trace(std::string(kGraphire) + "E: 1.0 8 02 91 40 1f 20 03 ff 01\n");
  ASSERT_GE(trace.samples.size(), 2U);
  EXPECT_EQ(trace.samples[0].state, PenState::kInRange);
  EXPECT_EQ(trace.samples[0].disturbances, Disturbance::kRepaired);
  EXPECT_TRUE(trace.samples[1].disturbances.empty());
}

}  // namespace
}  // namespace limn
