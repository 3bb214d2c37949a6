#include "drivers/spnav_server/spnav_events.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace limn::test {
namespace {

using namespace std::chrono_literals;
using Six = SpnavEvents::Six;

/// "1 2 3 4 5 6 @8", "+0", "-0".
class TextSink final : public SpnavSink {
 public:
  void motion(const SpnavMotion& motion) override {
    std::string text;
    for (const int axis : motion.axes) text += std::to_string(axis) + " ";
    told.push_back(text + "@" + std::to_string(motion.period_ms));
  }
  void button(unsigned number, bool pressed) override {
    told.push_back((pressed ? "+" : "-") + std::to_string(number));
  }
  std::vector<std::string> told;
};

MotionSample sample_at(Timestamp time, DeviceIndex device = 0) {
  MotionSample sample;
  sample.time = time;
  sample.device = device;
  sample.translation_told = true;
  return sample;
}

TEST(SpnavEvents, HasSpacenavdsFrameAndScale) {
  TextSink sink;
  SpnavEvents events(sink);
  events.push(sample_at(100ms), Six{0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  events.push(sample_at(108ms), Six{1, -1, 0.001, 0.0009, 2, 0});
  EXPECT_THAT(sink.told,
              testing::ElementsAre("50 150 100 200 300 250 @0", "500 1 -500 0 0 1000 @8"));
}

TEST(SpnavEvents, TellsADevicesOwnCountsWhereSpacenavdDoes) {
  TextSink sink;
  SpnavEvents events(sink);
  SpnavDevice navigator;
  navigator.index = 3;
  navigator.full_deflection = 350;
  events.describe(navigator);
  events.push(sample_at(0ms, 3), Six{1, 0, 1.0 / 350, 0, 0, -0.5});
  events.push(sample_at(8ms, 4), Six{0.5});
  EXPECT_THAT(sink.told, testing::ElementsAre("350 1 0 0 -175 0 @0", "600 1 0 0 -175 0 @8"));
}

TEST(SpnavEvents, NumbersTheButtonsOfTheSpaceMouseProAsSpacenavdDoes) {
  TextSink sink;
  SpnavEvents events(sink);
  SpnavDevice pro;
  pro.vendor = 0x256F;
  pro.product = 0xC631;
  events.describe(pro);
  MotionSample sample = sample_at(0ms);
  sample.translation_told = false;
  // Key 1, menu, lock; and one that it does not have.
  for (const unsigned number : {13U, 1U, 27U, 4U}) {
    sample.buttons = {};
    sample.buttons.set(number, true);
    events.push(sample, Six{});
  }
  EXPECT_THAT(sink.told, testing::ElementsAre("+0", "-0", "+4", "-4", "+10", "-10"));
}

TEST(SpnavButton, HasADifferentNumberForEveryKeyOfTheGreatMice) {
  struct Mouse {
    std::uint16_t product;
    unsigned keys;
  };
  for (const Mouse mouse : {Mouse{0xC631, 15}, Mouse{0xC632, 15}, Mouse{0xC633, 31}}) {
    std::set<unsigned> told;
    for (unsigned number = 1; number <= MotionButtons::kMost; ++number) {
      const auto button = spnav_button(0x256F, mouse.product, number);
      EXPECT_TRUE(!button || told.insert(*button).second) << number;
    }
    EXPECT_EQ(told.size(), mouse.keys);
    EXPECT_EQ(*told.rbegin(), mouse.keys - 1);
  }
  EXPECT_EQ(spnav_button(0x046D, 0xC626, 2), 1U);
  EXPECT_EQ(spnav_button(0x256F, 0xC633, 176), 26U) << "the space bar";
}

TEST(SpnavEvents, TellsWhatDoesNotChangeAgainButRestOnce) {
  TextSink sink;
  SpnavEvents events(sink);
  events.push(sample_at(0ms), Six{});
  events.push(sample_at(8ms), Six{0.5});
  events.push(sample_at(16ms), Six{0.5});
  events.push(sample_at(24ms), Six{});
  events.push(sample_at(32ms), Six{});
  events.push(sample_at(5000ms), Six{0.5});
  EXPECT_THAT(sink.told, testing::ElementsAre("250 0 0 0 0 0 @0", "250 0 0 0 0 0 @8",
                                              "0 0 0 0 0 0 @8", "250 0 0 0 0 0 @4976"));
}

TEST(SpnavEvents, NumbersButtonsFromZero) {
  TextSink sink;
  SpnavEvents events(sink);
  MotionSample sample = sample_at(0ms);
  sample.translation_told = false;
  sample.buttons.set(1, true);
  sample.buttons.set(255, true);
  events.push(sample, Six{});
  sample.buttons.set(1, false);
  events.push(sample, Six{});
  EXPECT_THAT(sink.told, testing::ElementsAre("+0", "+254", "-0"));
}

TEST(SpnavEvents, AddsTwoMiceUp) {
  TextSink sink;
  SpnavEvents events(sink);
  MotionSample left = sample_at(0ms, 0);
  left.buttons.set(1, true);
  MotionSample right = sample_at(4ms, 7);
  right.buttons.set(1, true);
  events.push(left, Six{0.5});
  events.push(right, Six{0.5, 0.1});
  left.buttons = {};
  left.time = 8ms;
  events.push(left, Six{});
  right.time = 12ms;
  right.buttons = {};
  events.push(right, Six{});
  EXPECT_THAT(sink.told, testing::ElementsAre("250 0 0 0 0 0 @0", "+0", "500 0 50 0 0 0 @4",
                                              "250 0 50 0 0 0 @4", "0 0 0 0 0 0 @4", "-0"));
}

TEST(SpnavEvents, EndsAtRestWithAllButtonsUp) {
  TextSink sink;
  SpnavEvents events(sink);
  MotionSample sample = sample_at(0ms, 3);
  sample.buttons.set(2, true);
  events.push(sample, Six{0, 0, 0, 0, 0, -1});
  events.end();
  events.end();
  EXPECT_THAT(sink.told, testing::ElementsAre("0 0 0 0 -500 0 @0", "+1", "0 0 0 0 0 0 @0", "-1"));
}

TEST(SpnavEvents, BearsAnyNumbersAndTimes) {
  TextSink sink;
  SpnavEvents events(sink);
  const double infinite = std::numeric_limits<double>::infinity();
  events.push(sample_at(9ms), Six{std::nan(""), infinite, -infinite, 1e300, 0, 0});
  events.push(sample_at(1ms), Six{1e-300, 0, 0, 0, 0, 0});
  events.push(sample_at(Timestamp(std::chrono::hours(24 * 60))), Six{1});
  EXPECT_THAT(sink.told, testing::ElementsAre("0 -1000000 1000000 1000000 0 0 @0", "0 0 0 0 0 0 @0",
                                              "500 0 0 0 0 0 @2147483647"));
}

}  // namespace
}  // namespace limn::test
