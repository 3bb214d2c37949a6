// The same pen twice: its raw reports, and the events that a Linux kernel made of them.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "input/stroke/stroke_sampler.hpp"
#include "tests/support/recordings.hpp"
#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

using test::decode_trace;
using test::DecodedTrace;

constexpr std::uint16_t kEvAbs = 3;
constexpr std::uint16_t kAbsX = 0;
constexpr std::uint16_t kAbsY = 1;
constexpr std::uint16_t kAbsPressure = 0x18;

/// The kernel's X, Y and pressure after each of its frames, read from the events alone.
std::vector<RawCounts> kernel_frames(const std::string& text) {
  std::vector<RawCounts> frames;
  auto reader = open_trace(memory_bytes(text), {});
  EXPECT_TRUE(reader);
  RawCounts now;
  for (;;) {
    auto event = (*reader)->next();
    EXPECT_TRUE(event);
    if (std::holds_alternative<TraceEnd>(*event)) return frames;
    const auto* frame = std::get_if<EvdevFrame>(&*event);
    if (frame == nullptr) continue;
    for (const EvdevEvent& change : frame->events) {
      if (change.type != kEvAbs) continue;
      if (change.code == kAbsX) now.x = change.value;
      if (change.code == kAbsY) now.y = change.value;
      if (change.code == kAbsPressure) now.pressure = change.value;
    }
    frames.push_back(now);
  }
}

/// evdev sends changes only, so neighbours that agree count once on both sides.
std::vector<RawCounts> without_repeats(const std::vector<RawCounts>& counts) {
  std::vector<RawCounts> out;
  for (const RawCounts& next : counts) {
    if (out.empty() || !(out.back() == next)) out.push_back(next);
  }
  return out;
}

std::vector<RawCounts> raw_of(const std::vector<PenSample>& samples) {
  std::vector<RawCounts> out;
  for (const PenSample& sample : samples) {
    EXPECT_TRUE(sample.axes.has_position());
    out.push_back(sample.raw);
  }
  return out;
}

class KernelOracle : public ::testing::Test {
 protected:
  void SetUp() override {
    LIMN_NEEDS_RECORDINGS();
    const auto folder = test::shared_folder() / "traces/pens-kernel-oracle";
    reports_ = decode_trace(test::read_file(folder / "n-trig_1b96_0c01.hid"));
    events_text_ = test::read_file(folder / "n-trig_1b96_0c01_1.ev");
    touch_text_ = test::read_file(folder / "n-trig_1b96_0c01_0.ev");
    ASSERT_FALSE(reports_.failed) << reports_.error.at << ": " << reports_.error.what;
  }

  DecodedTrace reports_;
  std::string events_text_;
  std::string touch_text_;
};

TEST_F(KernelOracle, PositionAndPressureEqualTheKernelsFramesAllOfThemInOrder) {
  const std::vector<RawCounts> kernel = kernel_frames(events_text_);
  EXPECT_EQ(kernel.size(), 496U);
  const std::vector<RawCounts> limn = raw_of(reports_.samples);
  EXPECT_EQ(limn.size(), 498U) << "497 pen reports and one repaired transition";
  EXPECT_EQ(without_repeats(kernel).size(), 491U);
  EXPECT_EQ(without_repeats(limn), without_repeats(kernel));
}

TEST_F(KernelOracle, TheKernelsEventsDecodeToTheSameFrames) {
  const DecodedTrace events = decode_trace(events_text_);
  ASSERT_FALSE(events.failed) << events.error.what;
  EXPECT_EQ(without_repeats(raw_of(events.samples)), without_repeats(raw_of(reports_.samples)));
  EXPECT_EQ(events.count(PenState::kInContact), reports_.count(PenState::kInContact));
  EXPECT_EQ(events.count(PenState::kInContact), 453U);
  EXPECT_EQ(events.summary.devices[0].kind, "kernel pen");
  test::expect_legal_transitions(events.samples);
  test::expect_legal_transitions(reports_.samples);
}

TEST_F(KernelOracle, TheSizeIsTheDescriptorsNotTheKernelsRoundedOne) {
  const PenRange& range = reports_.summary.devices[0].range;
  EXPECT_NEAR(range.width_mm, 258.10, 0.01);  // 10.161 inch
  EXPECT_NEAR(range.height_mm, 146.0, 0.05);
  const DecodedTrace events = decode_trace(events_text_);
  EXPECT_GT(events.summary.devices[0].range.width_mm, range.width_mm + 1);
}

TEST_F(KernelOracle, TheTouchPanelsEventsGiveNoPenSamples) {
  const DecodedTrace touch = decode_trace(touch_text_);
  ASSERT_FALSE(touch.failed) << touch.error.what;
  EXPECT_TRUE(touch.samples.empty());
  EXPECT_EQ(touch.summary.devices[0].kind, "no pen");
  EXPECT_EQ(touch.summary.devices[0].frames, 611U);
  EXPECT_EQ(reports_.summary.devices[0].count(ReportClass::kTouch), 2436U);
}

TEST(KernelRecordings, WacomPensWithoutResolutionTakeTheirSizeFromTheTable) {
  LIMN_NEEDS_RECORDINGS();
  const auto folder = test::shared_folder() / "traces/pens-evemu";
  const DecodedTrace cintiq = decode_trace(test::read_file(folder / "Wacom Cintiq 13HD.events"));
  ASSERT_FALSE(cintiq.failed) << cintiq.error.what;
  EXPECT_EQ(cintiq.summary.devices[0].frames, 10037U);
  EXPECT_EQ(cintiq.count(PenState::kInContact), 648U);
  EXPECT_EQ(cintiq.count(PenState::kErasing), 225U);
  EXPECT_NEAR(cintiq.summary.devices[0].range.width_mm, 297.76, 1e-9);
  std::size_t turned = 0;
  for (const PenSample& sample : cintiq.samples) {
    if (sample.state == PenState::kOutOfRange) {
      EXPECT_FALSE(sample.axes.has_position());
    } else {
      EXPECT_TRUE(sample.axes.has_position());
      EXPECT_NE(sample.serial, 0U);
    }
    turned += sample.axes.has(PenAxis::kTwist) ? 1 : 0;
  }
  EXPECT_GT(turned, 259U) << "the art pen's ABS_Z events and the samples between them";
  test::expect_legal_transitions(cintiq.samples);

  const DecodedTrace dth = decode_trace(test::read_file(folder / "Wacom DTH2242 Pen.events"));
  ASSERT_FALSE(dth.failed) << dth.error.what;
  EXPECT_EQ(dth.samples.size(), 1200U) << "one a frame";
  EXPECT_EQ(dth.count(PenState::kInContact), 174U);
  EXPECT_EQ(dth.summary.repaired_transitions(), 0U);
  test::expect_legal_transitions(dth.samples);
}

}  // namespace
}  // namespace limn
