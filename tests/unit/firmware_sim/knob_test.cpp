// The simulated 3D mice, read by limn's report descriptor parser.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>

#include "drivers/devices/trace_decoder.hpp"
#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/field_reader.hpp"
#include "firmware_sim/devices/catalogue.hpp"
#include "firmware_sim/devices/knob_hand.hpp"
#include "firmware_sim/devices/space_mouse.hpp"
#include "firmware_sim/devices/space_navigator.hpp"
#include "firmware_sim/usb/usb_device.hpp"
#include "input/stroke/drag_velocity.hpp"
#include "tests/unit/firmware_sim/recording_host.hpp"

namespace limn::firmware {
namespace {

using namespace std::chrono_literals;
using test::RecordingHost;
using testing::ElementsAre;

/// A knob held as the test says.
class HeldKnob final : public KnobSensor {
 public:
  KnobPose measure(std::chrono::microseconds time) noexcept override {
    pose.time = time;
    return pose;
  }
  KnobPose pose;
};

using Bytes = std::vector<std::uint8_t>;

template <class Device>
class Bench {
 public:
  Bench() {
    device_.reset();
    test::ask(device_, {0x00, 9, 1, 0, 0});
  }
  /// The report of the next period, empty where there is none.
  Bytes next() {
    Bytes report(64);
    const auto result = device_.interrupt_in(0x81, now_, report);
    now_ += Device::kReportPeriod;
    report.resize(result.bytes);
    return report;
  }
  HeldKnob knob;
  Device function{knob};

 private:
  UsbDevice device_{function};
  std::chrono::microseconds now_{};

 public:
  UsbDevice& device() { return device_; }
};

TEST(SpaceNavigator, AlternatesAndRestsWithExactlyThreeZeros) {
  Bench<SpaceNavigator> bench;
  EXPECT_THAT(bench.next(), ElementsAre()) << "at rest from the beginning";
  bench.knob.pose.deflection = {1, -1, 0.5, 0, 0.1, -0.002};
  EXPECT_THAT(bench.next(), ElementsAre(1, 0x5E, 0x01, 0xA2, 0xFE, 0xAF, 0x00));
  EXPECT_THAT(bench.next(), ElementsAre(2, 0, 0, 0x23, 0, 0xFF, 0xFF));
  EXPECT_THAT(bench.next(), ElementsAre(1, 0x5E, 0x01, 0xA2, 0xFE, 0xAF, 0x00));
  bench.knob.pose.deflection = {};
  EXPECT_THAT(bench.next(), ElementsAre(2, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(bench.next(), ElementsAre(1, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(bench.next(), ElementsAre(2, 0, 0, 0, 0, 0, 0));
  for (int i = 0; i < 100; ++i) ASSERT_THAT(bench.next(), ElementsAre());
}

TEST(SpaceNavigator, ButtonsLightAndZero) {
  Bench<SpaceNavigator> bench;
  bench.knob.pose.buttons = 2;
  EXPECT_THAT(bench.next(), ElementsAre(3, 2, 0));
  EXPECT_THAT(bench.next(), ElementsAre()) << "only when they change";
  bench.knob.pose.buttons = 0;
  EXPECT_THAT(bench.next(), ElementsAre(3, 0, 0));
  const Bytes on = {4, 1};
  const Bytes off = {4, 0};
  EXPECT_EQ(bench.device().interrupt_out(0x02, 1s, on).status, TransferStatus::kDone);
  EXPECT_TRUE(bench.function.light());
  EXPECT_EQ(bench.device().interrupt_out(0x02, 1s, off).status, TransferStatus::kDone);
  EXPECT_FALSE(bench.function.light());

  bench.knob.pose.deflection = {0.02, 0, 0, 0, 0, 0};  // it does not come back to zero
  EXPECT_THAT(bench.next(), ElementsAre(1, 7, 0, 0, 0, 0, 0));
  Bytes zero = {7, 0};
  EXPECT_EQ(bench.device().control({0x21, 9, 0x0307, 0, 2}, 1s, zero).status,
            TransferStatus::kDone);
  for (int i = 0; i < 3; ++i) EXPECT_THAT(bench.next(), testing::SizeIs(7));
  EXPECT_THAT(bench.next(), ElementsAre());
}

TEST(SpaceMouse, GivesAllSixAxesInOneReport) {
  Bench<SpaceMouse> bench;
  bench.knob.pose.deflection = {1, -1, 0.5, 0, 0.1, -0.002};
  EXPECT_THAT(bench.next(),
              ElementsAre(1, 0x5E, 0x01, 0xA2, 0xFE, 0xAF, 0x00, 0, 0, 0x23, 0, 0xFF, 0xFF));
  bench.knob.pose.deflection = {};
  for (int i = 0; i < 3; ++i) {
    EXPECT_THAT(bench.next(), ElementsAre(1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0));
  }
  EXPECT_THAT(bench.next(), ElementsAre());
}

class EachKnob : public testing::TestWithParam<std::tuple<std::string_view, std::string_view>> {};

// Every report's axes, read by the device's own descriptor, are the hand's within one count.
TEST_P(EachKnob, ReportsWhatTheHandDoes) {
  constexpr std::uint64_t kSeed = 3;
  const auto& [name, motion] = GetParam();
  const auto device = make_simulated_device(name, motion, kSeed);
  ASSERT_NE(device, nullptr);
  RecordingHost host(device->bus());
  host.run(device->duration() + 1s);
  const auto parsed = hid::parse_descriptor(host.report_descriptor(0));
  ASSERT_TRUE(parsed) << parsed.error().what;
  KnobHand hand(find_motion(motion).value(), kSeed);
  const auto period =
      name == "spacemouse" ? SpaceMouse::kReportPeriod : SpaceNavigator::kReportPeriod;
  int axes = 0;
  int buttons = 0;
  std::array<double, 6> most{};
  for (const auto& report : host.reports()) {
    if (report.bytes[0] == 3) ++buttons;
    const auto held = hand.measure(report.time - report.time % period);
    for (const hid::Field& field : parsed->fields) {
      if (field.kind != hid::ReportKind::kInput || field.report_id != report.bytes[0]) continue;
      for (std::uint32_t element = 0; element < field.count; ++element) {
        const auto usage = parsed->element_usage(field, element);
        constexpr std::uint16_t kX = 0x30;
        if (!usage || usage->page != 0x01 || usage->id < kX || usage->id >= kX + 6) continue;
        const std::size_t axis = usage->id - kX;
        const auto count = hid::FieldReader::of_element(field, element).read(report.bytes);
        ASSERT_TRUE(count);
        EXPECT_NEAR(static_cast<double>(*count), 350 * held.deflection[axis], 1) << axis;
        most[axis] = std::max(most[axis], std::abs(static_cast<double>(*count)));
        ++axes;
      }
    }
  }
  EXPECT_GT(axes, 300);
  EXPECT_EQ(buttons, motion == "push" ? 4 : 0);
  const std::map<std::string_view, std::array<bool, 6>> moves = {
      {"push", {true, true, true, false, false, false}},
      {"twist", {false, false, false, true, false, true}},
      {"orbit", {false, false, true, true, true, false}}};
  for (std::size_t axis = 0; axis < 6; ++axis) {
    EXPECT_EQ(most[axis] > 50, moves.at(motion)[axis]) << axis;
  }
}

// Every pause is exactly three reports of zeros, then silence.
TEST_P(EachKnob, RestsWithThreeZeros) {
  const auto& [name, motion] = GetParam();
  const auto device = make_simulated_device(name, motion, 3);
  RecordingHost host(device->bus());
  host.run(device->duration() + 1s);
  KnobHand hand(find_motion(motion).value(), 3);
  const auto period =
      name == "spacemouse" ? SpaceMouse::kReportPeriod : SpaceNavigator::kReportPeriod;
  int zeros = 0;
  int pauses = 0;
  std::chrono::microseconds before{};
  for (const auto& report : host.reports()) {
    if (report.bytes[0] == 3) continue;
    if (report.time - before > 100ms && before > 0us) {
      EXPECT_EQ(zeros, 3);
      ++pauses;
    }
    before = report.time;
    // Of alternating reports one can be zero while the other axes move.
    bool rests = true;
    for (const double axis : hand.measure(report.time - report.time % period).deflection) {
      rests = rests && std::abs(axis) * 350 < 0.5;
    }
    zeros = rests ? zeros + 1 : 0;
    for (std::size_t i = 1; rests && i < report.bytes.size(); ++i) ASSERT_EQ(report.bytes[i], 0);
  }
  EXPECT_EQ(zeros, 3);
  EXPECT_EQ(pauses, motion == "orbit" ? 0 : 2);
}

std::string name_of(const testing::TestParamInfo<EachKnob::ParamType>& tested) {
  return std::string(std::get<0>(tested.param)) + "_" + std::string(std::get<1>(tested.param));
}

INSTANTIATE_TEST_SUITE_P(Knobs, EachKnob,
                         testing::Combine(testing::Values("spacenavigator", "spacemouse"),
                                          testing::Values("push", "twist", "orbit")),
                         name_of);

// Minimum jerk has continuous velocity: no step from one millisecond to the next is more than the
// fastest movement's, 0.9 in 0.45 s, allows (1.875 times its mean).
TEST(KnobHand, MovesSmoothlyFromRestToRest) {
  for (const MotionInfo& info : motions()) {
    const KnobHand hand(find_motion(info.name).value(), 1);
    KnobPose before = hand.pose(0us);
    for (auto time = 0us; time <= hand.duration(); time += 1ms) {
      const KnobPose pose = hand.pose(time);
      for (std::size_t axis = 0; axis < kKnobAxes; ++axis) {
        ASSERT_LE(std::abs(pose.deflection[axis]), 1) << info.name;
        ASSERT_LE(std::abs(pose.deflection[axis] - before.deflection[axis]), 0.008) << info.name;
      }
      before = pose;
    }
    EXPECT_EQ(hand.pose(hand.duration()).deflection, Deflection{}) << info.name;
  }
}

/// Where a hand's deflections lead at 100 mm/s and 1 rad/s, in limn's frame.
std::array<double, kKnobAxes> way_of(const KnobHand& hand) {
  std::array<double, kKnobAxes> way{};
  constexpr auto kStep = 100us;
  for (auto time = 0us; time < hand.duration(); time += kStep) {
    for (std::size_t i = 0; i < kKnobAxes; ++i) {
      way[i] += hand.pose(time).deflection[i] * 1e-4 * (i < 3 ? 100 : 1);
    }
  }
  return {way[0], -way[1], -way[2], way[3], -way[4], -way[5]};
}

TEST(KnobDrags, WhatLimnMakesOfTheReportsGoesWhereTheHandWent) {
  for (const char* name : {"spacenavigator", "spacemouse"}) {
    for (const MotionInfo& info : motions()) {
      SCOPED_TRACE(std::string(name) + ", " + std::string(info.name));
      const auto made = make_simulated_device(name, info.name, 1);
      ASSERT_TRUE(made);
      RecordingHost host(made->bus());
      const KnobHand hand(*find_motion(info.name), 1);
      host.run(hand.duration() + 200ms);
      limn::TraceDecoder decoder(*open_trace(memory_bytes(host.trace())));
      DragVelocity drag;
      std::array<double, kKnobAxes> way{};
      Drag last;
      std::uint64_t lost = 0;
      for (;;) {
        const auto sample = decoder.next_any();
        ASSERT_TRUE(sample) << sample.error().what;
        const auto* const motion = std::get_if<const MotionSample*>(&*sample);
        if (motion == nullptr) break;
        last = drag.push(**motion);
        lost += (*motion)->lost;
        for (std::size_t i = 0; i < 3; ++i) {
          way[i] += last.mm[i];
          way[3 + i] += last.rad[i];
        }
      }
      EXPECT_TRUE(last.at_rest);
      EXPECT_EQ(last.mm_per_s, (std::array<double, 3>{}));
      EXPECT_EQ(lost, 0U);
      const auto expected = way_of(hand);
      for (std::size_t i = 0; i < kKnobAxes; ++i) {
        EXPECT_NEAR(way[i], expected[i], i < 3 ? 0.2 : 0.002) << "axis " << i;
      }
    }
  }
}

}  // namespace
}  // namespace limn::firmware
