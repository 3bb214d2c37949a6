#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "input/sample/pen_state_machine.hpp"
#include "tests/support/for_all.hpp"

namespace limn {
namespace {

using ::testing::ElementsAre;
using S = PenState;

constexpr std::array<PenState, 5> kStates = {S::kOutOfRange, S::kInRange, S::kInContact,
                                             S::kInRangeErasing, S::kErasing};

Tool tool_of(PenState state) {
  return state == S::kErasing || state == S::kInRangeErasing ? Tool::kEraser : Tool::kPen;
}

PenSample sample_of(PenState state, double x_mm = 0, Timestamp time = {}) {
  PenSample sample;
  sample.time = time;
  sample.state = state;
  sample.tool = tool_of(state);
  sample.axes.add(PenAxis::kX);
  sample.axes.add(PenAxis::kY);
  sample.axes.add(PenAxis::kPressure);
  sample.x_mm = x_mm;
  sample.raw.x = static_cast<std::int32_t>(x_mm * 100);
  sample.pressure = 0.5;
  return sample;
}

/// A machine whose samples come as a vector.
class Machine : public PenStateMachine {
 public:
  std::vector<PenSample> push(const PenSample& sample) {
    std::array<PenSample, kMaxSamples> out;
    const std::size_t count = PenStateMachine::push(sample, out);
    return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count)};
  }
};

std::vector<PenState> states(std::span<const PenSample> samples) {
  std::vector<PenState> out;
  for (const PenSample& sample : samples) out.push_back(sample.state);
  return out;
}

TEST(PenStateMachine, TheTableHasTheFourWaysBothDirectionsAndItself) {
  int legal = 0;
  for (const PenState from : kStates) {
    EXPECT_TRUE(is_legal_transition(from, from));
    for (const PenState to : kStates) {
      EXPECT_EQ(is_legal_transition(from, to), is_legal_transition(to, from));
      legal += is_legal_transition(from, to) ? 1 : 0;
    }
  }
  EXPECT_EQ(legal, 5 + 2 * 4);
  EXPECT_TRUE(is_legal_transition(S::kOutOfRange, S::kInRange));
  EXPECT_TRUE(is_legal_transition(S::kInRange, S::kInContact));
  EXPECT_TRUE(is_legal_transition(S::kOutOfRange, S::kInRangeErasing));
  EXPECT_TRUE(is_legal_transition(S::kInRangeErasing, S::kErasing));
}

TEST(PenStateMachine, LegalSamplesPassUnchangedAndUncounted) {
  Machine machine;
  for (const PenState state :
       {S::kInRange, S::kInContact, S::kInContact, S::kInRange, S::kOutOfRange, S::kInRangeErasing,
        S::kErasing, S::kInRangeErasing, S::kOutOfRange, S::kOutOfRange}) {
    EXPECT_THAT(states(machine.push(sample_of(state))), ElementsAre(state));
  }
  EXPECT_EQ(machine.repaired(), 0U);
}

TEST(PenStateMachine, ContactOutOfNowhereFirstComesInRangeAtTheSamePlaceAndTime) {
  Machine machine;
  PenSample contact = sample_of(S::kInContact, 7, std::chrono::milliseconds(40));
  contact.lost = 3;
  contact.lost_estimated = true;
  contact.disturbances = Disturbance::kGap;
  const auto samples = machine.push(contact);
  ASSERT_THAT(states(samples), ElementsAre(S::kInRange, S::kInContact));
  EXPECT_EQ(samples[0].x_mm, 7);
  EXPECT_EQ(samples[0].raw, contact.raw);
  EXPECT_EQ(samples[0].time, contact.time);
  EXPECT_EQ(samples[0].lost, 3U) << "the loss lies before the first sample given";
  EXPECT_TRUE(samples[0].lost_estimated);
  EXPECT_TRUE(samples[0].disturbances.has(Disturbance::kGap));
  EXPECT_TRUE(samples[0].disturbances.has(Disturbance::kRepaired));
  EXPECT_EQ(samples[1].lost, 0U);
  EXPECT_FALSE(samples[1].lost_estimated);
  EXPECT_TRUE(samples[1].disturbances.empty());
  EXPECT_EQ(machine.repaired(), 1U);
}

TEST(PenStateMachine, LeavingFromContactLiftsFirstWhereThePenWas) {
  Machine machine;
  machine.push(sample_of(S::kInRange, 1));
  machine.push(sample_of(S::kInContact, 2));
  PenSample gone;
  gone.time = std::chrono::milliseconds(9);
  const auto samples = machine.push(gone);
  ASSERT_THAT(states(samples), ElementsAre(S::kInRange, S::kOutOfRange));
  EXPECT_EQ(samples[0].x_mm, 2);
  EXPECT_EQ(samples[0].time, gone.time);
  EXPECT_FALSE(samples[1].axes.has_position());
  EXPECT_EQ(machine.repaired(), 1U);
}

TEST(PenStateMachine, CopiesOfTheLastSampleHaveNoneOfItsLosses) {
  Machine machine;
  machine.push(sample_of(S::kInRange));
  PenSample contact = sample_of(S::kInContact);
  contact.lost = 5;
  contact.disturbances = Disturbance::kOverrun;
  EXPECT_EQ(machine.push(contact).front().disturbances, Disturbance::kOverrun);
  const auto samples = machine.push(sample_of(S::kOutOfRange));
  ASSERT_THAT(states(samples), ElementsAre(S::kInRange, S::kOutOfRange));
  EXPECT_EQ(samples[0].lost, 0U);
  EXPECT_EQ(samples[0].disturbances, Disturbance::kRepaired) << "of this transition";
  EXPECT_TRUE(samples[1].disturbances.empty());
}

TEST(PenStateMachine, PenToEraserGoesThroughOutOfRangeWithoutPosition) {
  Machine machine;
  machine.push(sample_of(S::kInRange, 1));
  machine.push(sample_of(S::kInContact, 2));
  const auto samples = machine.push(sample_of(S::kErasing, 3));
  ASSERT_THAT(states(samples),
              ElementsAre(S::kInRange, S::kOutOfRange, S::kInRangeErasing, S::kErasing));
  EXPECT_EQ(samples[0].x_mm, 2);
  EXPECT_EQ(samples[1].axes.has_position(), false);
  EXPECT_EQ(samples[1].tool, Tool::kPen) << "the tool that leaves";
  EXPECT_EQ(samples[2].x_mm, 3);
  EXPECT_EQ(machine.repaired(), 1U);
}

TEST(PenStateMachine, AnotherToolInRangeLeavesBetween) {
  Machine machine;
  PenSample mouse = sample_of(S::kInRange, 4);
  mouse.tool = Tool::kTabletMouse;
  machine.push(mouse);
  EXPECT_THAT(states(machine.push(sample_of(S::kInRange, 5))),
              ElementsAre(S::kOutOfRange, S::kInRange));
  EXPECT_EQ(machine.repaired(), 1U);
}

TEST(PenStateMachine, AnOutOfRangeSampleKeepsItsCoordinates) {
  Machine machine;
  machine.push(sample_of(S::kInRange, 1));
  const auto samples = machine.push(sample_of(S::kOutOfRange, 8));
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_TRUE(samples[0].axes.has_position());
  EXPECT_EQ(samples[0].x_mm, 8);
}

TEST(PenStateMachine, ResetForgetsTheStateButNotTheCount) {
  Machine machine;
  machine.push(sample_of(S::kInContact));
  machine.reset();
  EXPECT_EQ(machine.last().state, S::kOutOfRange);
  EXPECT_EQ(machine.push(sample_of(S::kInRange)).size(), 1U);
  EXPECT_EQ(machine.repaired(), 1U);
}

// The law: whatever a device says, only legal transitions come out, the device's own sample is the
// last of each batch, and a repair is counted exactly where the device broke the rules.
TEST(PenStateMachineProperty, OnlyLegalTransitionsComeOut) {
  test::for_all(200, [](test::Rng& rng) {
    Machine machine;
    PenSample before;  // out of range
    std::uint64_t broken = 0;
    for (int i = 0; i < 200; ++i) {
      PenSample sample = sample_of(kStates[static_cast<std::size_t>(rng.integer(0, 4))], i,
                                   std::chrono::milliseconds(i));
      if (sample.state == S::kInRange && rng.chance(0.3)) sample.tool = Tool::kTabletMouse;
      const bool both_in_range = before.state != S::kOutOfRange && sample.state != S::kOutOfRange;
      if (!is_legal_transition(before.state, sample.state) ||
          (both_in_range && before.tool != sample.tool)) {
        ++broken;
      }
      PenSample last = before;
      const auto batch = machine.push(sample);
      ASSERT_LE(batch.size(), PenStateMachine::kMaxSamples);
      for (const PenSample& next : batch) {
        ASSERT_TRUE(is_legal_transition(last.state, next.state))
            << name(last.state) << " -> " << name(next.state);
        ASSERT_EQ(next.time, sample.time);
        if (last.tool != next.tool) {
          ASSERT_TRUE(last.state == S::kOutOfRange || next.state == S::kOutOfRange);
        }
        last = next;
      }
      ASSERT_EQ(last.state, sample.state);
      ASSERT_EQ(last.x_mm, sample.x_mm);
      before = sample;
    }
    EXPECT_EQ(machine.repaired(), broken);
  });
}

}  // namespace
}  // namespace limn
