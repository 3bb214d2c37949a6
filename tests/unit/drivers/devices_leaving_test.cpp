// Pens that never say that they leave: a sample supplied by the times of their reports alone.

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

using namespace std::chrono_literals;
using test::ReportBytes;

constexpr std::uint16_t kHuion = 0x256C;
constexpr std::uint16_t kNew1060Plus = 0x006E;

const ReportBytes kHover = {8, 0x80, 0x10, 0x27, 0x10, 0x27, 0, 0, 0, 0, 0, 0};
const ReportBytes kContact = {8, 0x81, 0x10, 0x27, 0x10, 0x27, 9, 0, 0, 0, 0, 0};
const ReportBytes kLeft = {8, 0x00, 0x10, 0x27, 0x10, 0x27, 0, 0, 0, 0, 0, 0};

/// Report 7 of a pen: tip, in range, then X and Y of 16 bits in hundredths of cm.
const ReportBytes kOtherForm = {
    0x05, 0x0D, 0x09, 0x02, 0xA1, 0x01, 0x85, 0x07, 0x09, 0x20, 0xA1, 0x00, 0x15, 0x00, 0x25, 0x01,
    0x75, 0x01, 0x95, 0x02, 0x09, 0x42, 0x09, 0x32, 0x81, 0x02, 0x95, 0x06, 0x81, 0x03, 0x05, 0x01,
    0x75, 0x10, 0x95, 0x01, 0x55, 0x0E, 0x65, 0x11, 0x46, 0xD0, 0x07, 0x26, 0x20, 0x4E, 0x09, 0x30,
    0x81, 0x02, 0x46, 0xE8, 0x03, 0x26, 0x10, 0x27, 0x09, 0x31, 0x81, 0x02, 0xC0, 0xC0};
const ReportBytes kOtherContact = {7, 0x03, 0x10, 0x27, 0x10, 0x27};
const ReportBytes kOtherLeft = {7, 0x00, 0x10, 0x27, 0x10, 0x27};

std::vector<PenState> states(std::span<const PenSample> samples) {
  std::vector<PenState> states;
  for (const PenSample& sample : samples) states.push_back(sample.state);
  return states;
}

TEST(SilentLeaving, IsDueATimeoutAfterTheLastReport) {
  test::DecodedDevice tablet(kHuion, kNew1060Plus);
  EXPECT_FALSE(tablet.decoder().due());
  tablet(kHover, 1s);
  EXPECT_EQ(tablet.decoder().due(), 1s + kLeavingTimeout);
  tablet(kHover, 1050ms);
  EXPECT_EQ(tablet.decoder().due(), 1050ms + kLeavingTimeout);
  EXPECT_TRUE(tablet.decoder().advance(3, 1149ms).empty());
  const auto left = tablet.decoder().advance(3, 5s);
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left[0].state, PenState::kOutOfRange);
  EXPECT_EQ(left[0].time, 1150ms) << "not when it was asked for";
  EXPECT_EQ(left[0].device, 3U);
  EXPECT_FALSE(left[0].axes.has_position());
  EXPECT_FALSE(tablet.decoder().due());
  EXPECT_TRUE(tablet.decoder().advance(3, 6s).empty());
}

TEST(SilentLeaving, ComesBeforeALaterReport) {
  test::DecodedDevice tablet(kHuion, kNew1060Plus);
  tablet(kContact, 1s);
  const auto samples = tablet(kHover, 3s);
  EXPECT_EQ(states(samples),
            (std::vector<PenState>{PenState::kInRange, PenState::kOutOfRange, PenState::kInRange}));
  EXPECT_EQ(samples[0].time, 1100ms);
  EXPECT_EQ(samples[1].time, 1100ms);
  EXPECT_EQ(samples[2].time, 3s);
  EXPECT_EQ(tablet.decoder().repaired_transitions(), 1U) << "only its entering in contact";
}

TEST(SilentLeaving, ExactlyAtTheTimeoutThePenHasLeft) {
  test::DecodedDevice tablet(kHuion, kNew1060Plus);
  tablet(kHover, 0ms);
  EXPECT_EQ(tablet(kHover, 99999us).size(), 1U);
  EXPECT_EQ(tablet(kHover, 99999us + kLeavingTimeout).size(), 2U);
}

TEST(SilentLeaving, IsNotDueOnceItWasReported) {
  test::DecodedDevice tablet(kHuion, kNew1060Plus);
  tablet(kHover, 0ms);
  EXPECT_EQ(states(tablet(kLeft, 10ms)), std::vector<PenState>{PenState::kOutOfRange});
  EXPECT_FALSE(tablet.decoder().due());
  EXPECT_TRUE(tablet(kLeft, 20ms).empty());
}

TEST(SilentLeaving, IsNotDueOnceAReportOfAnotherFormToldIt) {
  test::DecodedDevice tablet(kHuion, kNew1060Plus, kOtherForm);
  tablet(kHover, 0ms);
  EXPECT_EQ(states(tablet(kOtherLeft, 10ms)), std::vector<PenState>{PenState::kOutOfRange});
  EXPECT_FALSE(tablet.decoder().due());
  tablet(kHover, 20ms);
  EXPECT_EQ(tablet.decoder().due(), 20ms + kLeavingTimeout);
}

TEST(SilentLeaving, IsNoneOfAPenThatReportsInAnotherForm) {
  test::DecodedDevice tablet(kHuion, kNew1060Plus, kOtherForm);
  tablet(kHover, 0ms);
  EXPECT_EQ(states(tablet(kOtherContact, 60ms)), std::vector<PenState>{PenState::kInContact});
  EXPECT_FALSE(tablet.decoder().due());
  EXPECT_EQ(states(tablet(kOtherContact, 120ms)), std::vector<PenState>{PenState::kInContact})
      << "no leaving between";
  EXPECT_EQ(states(tablet(kLeft, 130ms)),
            (std::vector<PenState>{PenState::kInRange, PenState::kOutOfRange}))
      << "either form tells of the same pen";
}

TEST(SilentLeaving, KeysDoNotKeepThePenInRange) {
  test::DecodedDevice tablet(kHuion, kNew1060Plus);
  const ReportBytes keys = {8, 0xE0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0};
  tablet(kHover, 0ms);
  EXPECT_TRUE(tablet(keys, 60ms).empty());
  const auto samples = tablet(keys, 120ms);
  EXPECT_EQ(states(samples), std::vector<PenState>{PenState::kOutOfRange});
  EXPECT_EQ(tablet.kind(), ReportClass::kPad);
}

TEST(SilentLeaving, DisconnectionComesAfterIt) {
  test::DecodedDevice tablet(kHuion, kNew1060Plus);
  tablet(kHover, 0ms);
  const auto late = tablet.decoder().disconnect(3, 5s);
  ASSERT_EQ(late.size(), 1U);
  EXPECT_EQ(late[0].time, kLeavingTimeout);
  tablet(kHover, 6s);
  const auto soon = tablet.decoder().disconnect(3, 6050ms);
  ASSERT_EQ(soon.size(), 1U);
  EXPECT_EQ(soon[0].time, 6050ms);
  EXPECT_FALSE(tablet.decoder().due());
}

TEST(SilentLeaving, EndsWithTime) {
  test::DecodedDevice tablet(kHuion, kNew1060Plus);
  tablet(kHover, Timestamp::max() - 1ms);
  EXPECT_EQ(tablet.decoder().due(), Timestamp::max());
  EXPECT_EQ(tablet.decoder().advance(3, Timestamp::max()).size(), 1U);
}

TEST(SilentLeaving, IsOfTheMarkedRowsOnly) {
  for (const PenSpec& spec : pen_specs()) {
    const bool marked =
        spec.family == PenFamily::kUcLogicV2 || spec.family == PenFamily::kPenAsMouse;
    EXPECT_EQ(spec.leaves_silently, marked) << spec.name;
  }
  test::DecodedDevice ugee(0x28BD, 0x0905);
  ugee({2, 0xA0, 0, 1, 0, 1, 0, 0, 0, 0}, 0ms);
  EXPECT_FALSE(ugee.decoder().due());
  EXPECT_EQ(ugee({2, 0xA0, 0, 1, 0, 1, 0, 0, 0, 0}, 9s).size(), 1U);
}

TEST(SilentLeaving, EndsATrace) {
  // Two devices: their samples come in the order of their times.
  const std::string text =
      "D: 0\nI: 3 256c 006e\nD: 1\nI: 3 2feb 0002\n"
      "D: 0\nE: 000001.000000 12 08 81 10 27 10 27 09 00 00 00 00 00\n"
      "E: 000001.020000 12 08 81 10 27 10 27 09 00 00 00 00 00\n"
      "D: 1\nE: 000001.010000 8 01 00 10 27 10 27 00 00\n";
  const auto trace = test::decode_trace(text);
  ASSERT_FALSE(trace.failed) << trace.error.what;
  ASSERT_EQ(trace.samples.size(), 7U);
  EXPECT_EQ(trace.samples[4].device, 1U);
  EXPECT_EQ(trace.samples[4].state, PenState::kOutOfRange);
  EXPECT_EQ(trace.samples[4].time, 10ms + kLeavingTimeout) << "from the first report on";
  EXPECT_EQ(trace.samples[5].device, 0U);
  EXPECT_EQ(trace.samples[5].state, PenState::kInRange);
  EXPECT_EQ(trace.samples[6].state, PenState::kOutOfRange);
  EXPECT_EQ(trace.samples[6].time, 20ms + kLeavingTimeout);
  EXPECT_EQ(trace.summary.samples, 7U);
}

}  // namespace
}  // namespace limn
