#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/devices/evdev_pen_decoder.hpp"
#include "tests/unit/drivers/devices_support.hpp"
#include "tests/unit/drivers/hid_items.hpp"

namespace limn {
namespace {

using test::kDegree;
using ::testing::IsEmpty;

constexpr std::uint16_t kKey = 1;
constexpr std::uint16_t kAbs = 3;
constexpr std::uint16_t kMsc = 4;
constexpr std::uint16_t kX = 0;
constexpr std::uint16_t kY = 1;
constexpr std::uint16_t kZ = 2;
constexpr std::uint16_t kPressure = 0x18;
constexpr std::uint16_t kDistance = 0x19;
constexpr std::uint16_t kTiltX = 0x1A;
constexpr std::uint16_t kTiltY = 0x1B;
constexpr std::uint16_t kToolPen = 0x140;
constexpr std::uint16_t kToolRubber = 0x141;
constexpr std::uint16_t kToolFinger = 0x145;
constexpr std::uint16_t kToolMouse = 0x146;
constexpr std::uint16_t kTouch = 0x14A;

struct Change {
  std::uint16_t type;
  std::uint16_t code;
  std::int32_t value;
};

TraceDevice tablet(std::uint16_t vendor = 0x1234, std::int32_t resolution = 100) {
  TraceDevice device;
  device.vendor = vendor;
  device.product = 0x5678;
  device.axes = {{kX, 100, 20100, 0, 0, resolution}, {kY, 0, 10000, 0, 0, resolution},
                 {kZ, -900, 899, 0, 0, 0},           {kPressure, 0, 1000, 0, 0, 0},
                 {kDistance, 0, 63, 0, 0, 0},        {kTiltX, -64, 63, 0, 0, 57},
                 {kTiltY, 0, 127, 0, 0, 0}};
  return device;
}

class EvdevPen : public ::testing::Test {
 protected:
  std::optional<EvdevPenDecoder> decoder_;

  void use(const TraceDevice& device) {
    auto made = EvdevPenDecoder::make(device);
    ASSERT_TRUE(made) << made.error().what;
    decoder_.emplace(std::move(*made));
  }

  std::vector<PenSample> frame(const std::vector<Change>& changes, Timestamp time = {}) {
    std::vector<EvdevEvent> events;
    for (const Change& change : changes) {
      events.push_back({time, change.type, change.code, change.value});
    }
    const auto samples = decoder_->decode(EvdevFrame{2, time, events});
    return {samples.begin(), samples.end()};
  }

  PenSample one(const std::vector<Change>& changes, Timestamp time = {}) {
    const auto samples = frame(changes, time);
    EXPECT_EQ(samples.size(), 1U);
    return samples.empty() ? PenSample{} : samples.back();
  }
};

TEST_F(EvdevPen, EveryAxisByItsDeclaredRangeAndResolution) {
  use(tablet());
  const PenSample sample = one({{kAbs, kX, 10100},
                                {kAbs, kY, 2500},
                                {kAbs, kPressure, 5},
                                {kAbs, kDistance, 21},
                                {kAbs, kTiltX, -57},
                                {kAbs, kTiltY, 94},
                                {kAbs, kZ, 0},
                                {kKey, kToolPen, 1},
                                {kMsc, 0, -2}},
                               std::chrono::seconds(3));
  EXPECT_EQ(sample.device, 2U);
  EXPECT_EQ(sample.time, std::chrono::seconds(3));
  EXPECT_EQ(sample.state, PenState::kInRange);
  EXPECT_EQ(sample.x_mm, 100);
  EXPECT_EQ(sample.y_mm, 25);
  EXPECT_EQ(sample.raw, (RawCounts{10100, 2500, 5}));
  EXPECT_EQ(sample.pressure, 0.005);
  EXPECT_DOUBLE_EQ(sample.distance, 1 / 3.0);
  EXPECT_DOUBLE_EQ(sample.tilt_x_rad, -1) << "57 counts a radian";
  EXPECT_DOUBLE_EQ(sample.tilt_y_rad, 30 * kDegree) << "0..127 has upright at 64";
  EXPECT_DOUBLE_EQ(sample.twist_rad, 180 * kDegree);
  EXPECT_EQ(sample.serial, 0xFFFFFFFEU);
  EXPECT_DOUBLE_EQ(decoder_->range().width_mm, 200);
}

TEST_F(EvdevPen, WacomsQuarterTurnOfTheArtPenIsUndone) {
  use(tablet(test::kWacom));
  const std::vector<Change> in_range = {{kAbs, kX, 200}, {kAbs, kY, 200}, {kKey, kToolPen, 1}};
  EXPECT_FALSE(one(in_range).axes.has(PenAxis::kTwist));
  EXPECT_NEAR(one({{kAbs, kZ, 450}}).twist_rad, 0, 1e-12);
  EXPECT_NEAR(one({{kAbs, kZ, -900}}).twist_rad, 90 * kDegree, 1e-12);
  EXPECT_NEAR(one({{kAbs, kZ, 0}}).twist_rad, 270 * kDegree, 1e-12);
}

TEST_F(EvdevPen, UnchangedAxesHoldAndAreAbsentBeforeTheirFirstEvent) {
  use(tablet());
  const PenSample first = one({{kAbs, kX, 200}, {kKey, kToolPen, 1}});
  EXPECT_FALSE(first.axes.has_position());
  EXPECT_FALSE(first.axes.has(PenAxis::kPressure));
  EXPECT_TRUE(one({{kAbs, kY, 300}}).axes.has_position());
  const PenSample touch = one({{kAbs, kPressure, 500}, {kKey, kTouch, 1}});
  EXPECT_EQ(touch.state, PenState::kInContact);
  EXPECT_EQ(touch.raw, (RawCounts{200, 300, 500}));
  EXPECT_EQ(one({{kAbs, kX, 210}}).pressure, 0.5);
}

TEST_F(EvdevPen, ToolsButtonsAndStates) {
  use(tablet());
  one({{kAbs, kX, 200}, {kAbs, kY, 200}, {kKey, kToolRubber, 1}});
  EXPECT_EQ(one({{kKey, kTouch, 1}}).state, PenState::kErasing);
  EXPECT_EQ(one({{kKey, kTouch, 0}}).state, PenState::kInRangeErasing);
  EXPECT_EQ(one({{kKey, kToolRubber, 0}}).state, PenState::kOutOfRange);
  EXPECT_EQ(one({{kKey, kToolPen, 1}}).tool, Tool::kPen);
  EXPECT_EQ(one({{kKey, 0x14B, 1}, {kKey, 0x14C, 1}, {kKey, 0x149, 1}}).buttons, 7);
  EXPECT_EQ(one({{kKey, kToolPen, 0}}).tool, Tool::kPen);
  const PenSample mouse = one({{kKey, kToolMouse, 1}, {kKey, 0x110, 1}, {kKey, 0x112, 1}});
  EXPECT_EQ(mouse.tool, Tool::kTabletMouse);
  EXPECT_EQ(mouse.buttons, 0b101) << "left, middle";
  EXPECT_EQ(decoder_->repaired_transitions(), 0U);
}

TEST_F(EvdevPen, AToolChangedInOneFrameLeavesBetween) {
  use(tablet());
  one({{kAbs, kX, 200}, {kAbs, kY, 200}, {kKey, kToolPen, 1}});
  const auto changed = frame({{kKey, kToolPen, 0}, {kKey, kToolRubber, 1}});
  ASSERT_EQ(changed.size(), 2U);
  EXPECT_EQ(changed[0].state, PenState::kOutOfRange);
  EXPECT_EQ(changed[1].state, PenState::kInRangeErasing);
  EXPECT_EQ(decoder_->repaired_transitions(), 1U);
}

TEST_F(EvdevPen, OutOfRangeKeepsThePositionExceptWacomsReset) {
  use(tablet());
  one({{kAbs, kX, 200}, {kAbs, kY, 300}, {kKey, kToolPen, 1}});
  EXPECT_TRUE(one({{kKey, kToolPen, 0}}).axes.has_position());
  EXPECT_EQ(one({{kAbs, kX, 220}}).raw.x, 220) << "moved out of range";
  EXPECT_THAT(frame({{kAbs, kPressure, 3}}), IsEmpty());

  use(tablet(test::kWacom));
  one({{kAbs, kX, 200}, {kAbs, kY, 300}, {kKey, kToolPen, 1}, {kMsc, 0, 77}});
  const PenSample gone = one({{kAbs, kX, 0}, {kAbs, kY, 0}, {kKey, kToolPen, 0}, {kMsc, 0, 77}});
  EXPECT_FALSE(gone.axes.has_position());
  EXPECT_EQ(gone.serial, 77U);
}

TEST_F(EvdevPen, DroppedEventsAreToldWithTheNextSample) {
  use(tablet());
  one({{kAbs, kX, 200}, {kAbs, kY, 300}, {kKey, kToolPen, 1}});
  EXPECT_THAT(frame({{kAbs, kY, 999}, {0, 3, 0}, {kAbs, kX, 888}}), IsEmpty());
  const PenSample next = one({{kAbs, kX, 400}});
  EXPECT_EQ(next.lost, 1U);
  EXPECT_TRUE(next.lost_estimated) << "nobody counts what the kernel dropped";
  EXPECT_EQ(next.disturbances, Disturbance::kOverrun);
  EXPECT_EQ(next.raw.y, 300) << "nothing of the frame counts, before the loss or after";
  EXPECT_EQ(one({{kAbs, kX, 401}}).lost, 0U);
}

TEST_F(EvdevPen, FingersAreNoPens) {
  use(tablet());
  EXPECT_THAT(frame({{kAbs, kX, 200}, {kAbs, kY, 300}, {kKey, kToolFinger, 1}, {kKey, kTouch, 1}}),
              IsEmpty());
  TraceDevice touch = tablet();
  touch.axes.push_back({0x35, 0, 4095, 0, 0, 0});
  use(touch);
  EXPECT_FALSE(decoder_->has_pen());
  EXPECT_THAT(frame({{kAbs, kX, 200}, {kAbs, kY, 300}, {kKey, kTouch, 1}}), IsEmpty());
}

TEST_F(EvdevPen, APenLeavesEvenIfAFingerIsOnThePad) {
  use(tablet());
  one({{kAbs, kX, 200}, {kAbs, kY, 300}, {kKey, kToolPen, 1}});
  one({{kKey, kToolFinger, 1}});
  EXPECT_EQ(one({{kKey, kToolPen, 0}}).state, PenState::kOutOfRange);
  EXPECT_THAT(frame({{kKey, kToolFinger, 1}, {kAbs, kX, 210}}), IsEmpty());
}

TEST_F(EvdevPen, ASerialAloneIsAPenThatDwellsAndMinusOneIsThePads) {
  use(tablet());
  one({{kAbs, kX, 200}, {kAbs, kY, 300}, {kKey, kToolPen, 1}, {kMsc, 0, 77}});
  EXPECT_EQ(one({{kMsc, 0, 77}}).raw.x, 200);
  EXPECT_THAT(frame({{kMsc, 0, -1}}), IsEmpty());
  EXPECT_EQ(one({{kAbs, kX, 210}}).serial, 77U);
}

TEST_F(EvdevPen, ASizeComesFromTheTableWhereTheKernelKnewNone) {
  TraceDevice device = tablet(test::kWacom, 0);
  device.product = 0x0304;  // Cintiq 13HD, 200 counts a mm
  use(device);
  EXPECT_EQ(one({{kAbs, kX, 2100}, {kAbs, kY, 200}, {kKey, kToolPen, 1}}).x_mm, 10);

  const auto unknown = EvdevPenDecoder::make(tablet(0x1234, 0));
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, ErrorCode::kMissing);
  EXPECT_NE(unknown.error().what.find("ABS_X"), std::string::npos);
  EXPECT_NE(unknown.error().what.find("1234:5678"), std::string::npos);
}

/// A pen whose X has 100 units a mm as declared, 0 to 20000 over 20 cm, whose tilt is in degrees,
/// and whose Y says nothing of its size.
std::vector<std::uint8_t> pen_descriptor(std::int64_t physical_x = 20000) {
  hid::test::Items items;
  items.usage_page(hid::page::kDigitizer).usage(0x02).collection(1).usage(0x20).collection(0);
  items.usage_page(hid::page::kGenericDesktop).report_size(16).report_count(1);
  items.unit(0x11).unit_exponent(0x0D);  // 10^-3 cm
  items.usage(0x30).logical(100, 20100).physical(0, physical_x).input(0x02);
  items.unit(0).physical(0, 0).usage(0x31).logical(0, 10000).input(0x02);
  items.usage_page(hid::page::kDigitizer).unit(0x14).unit_exponent(0).report_size(8);
  items.usage(0x3D).logical(-64, 63).physical(-64, 63).input(0x02);
  items.unit(0).physical(0, 0).usage(0x42).logical(0, 1).input(0x02).end_collection();
  items.end_collection();
  return {items.bytes().begin(), items.bytes().end()};
}

TEST_F(EvdevPen, SizesOfTheReportDescriptorBeatTheKernelsRoundedOnes) {
  TraceDevice device = tablet(0x1234, 96);  // as a kernel rounds: 4 % off
  device.report_descriptor = pen_descriptor();
  use(device);
  const PenSample sample =
      one({{kAbs, kX, 10100}, {kAbs, kY, 960}, {kAbs, kTiltX, 45}, {kKey, kToolPen, 1}});
  EXPECT_DOUBLE_EQ(sample.x_mm, 100) << "not 10000 / 96";
  EXPECT_DOUBLE_EQ(sample.y_mm, 10) << "the descriptor has no size of Y";
  EXPECT_DOUBLE_EQ(sample.tilt_x_rad, 45 * kDegree) << "not 45 / 57";
  EXPECT_DOUBLE_EQ(decoder_->range().width_mm, 200);
}

TEST_F(EvdevPen, ADescriptorOfAnotherRangeOrOfNoneDecidesNothing) {
  TraceDevice device = tablet();
  device.axes[0].maximum = 20101;  // a driver has changed it
  device.report_descriptor = pen_descriptor(40000);
  use(device);
  EXPECT_EQ(one({{kAbs, kX, 10100}, {kAbs, kY, 0}, {kKey, kToolPen, 1}}).x_mm, 100);
  device = tablet();
  device.report_descriptor = {0x05};  // broken
  use(device);
  EXPECT_EQ(one({{kAbs, kX, 10100}, {kAbs, kY, 0}, {kKey, kToolPen, 1}}).x_mm, 100);
}

TEST_F(EvdevPen, PensThatDisagreeDecideNothing) {
  TraceDevice device = tablet();
  device.report_descriptor = pen_descriptor(40000);
  use(device);
  EXPECT_EQ(one({{kAbs, kX, 10100}, {kAbs, kY, 0}, {kKey, kToolPen, 1}}).x_mm, 200);
  const auto other = pen_descriptor(20000);
  device.report_descriptor.insert(device.report_descriptor.end(), other.begin(), other.end());
  use(device);
  EXPECT_EQ(one({{kAbs, kX, 10100}, {kAbs, kY, 0}, {kKey, kToolPen, 1}}).x_mm, 100);
}

TEST_F(EvdevPen, TheDescriptorKnowsWhatTheKernelDoesNot) {
  TraceDevice device = tablet(0x1234, 0);
  device.axes[1].resolution = 100;
  device.report_descriptor = pen_descriptor();
  use(device);
  EXPECT_DOUBLE_EQ(decoder_->range().width_mm, 200);
}

TEST_F(EvdevPen, ATiltRangeWithoutResolutionIsDegreesOrHundredths) {
  TraceDevice device = tablet();
  device.axes[5] = {kTiltX, -9000, 9000, 0, 0, 0};
  use(device);
  EXPECT_DOUBLE_EQ(one({{kAbs, kTiltX, 4500}, {kKey, kToolPen, 1}}).tilt_x_rad, 45 * kDegree);
}

TEST_F(EvdevPen, ExtremeValuesStayInTheirRanges) {
  use(tablet());
  for (const std::int32_t value : {INT32_MIN, INT32_MAX}) {
    std::vector<Change> changes = {{kKey, kToolPen, 1}, {kKey, kTouch, 1}};
    for (const std::uint16_t axis : {kX, kY, kZ, kPressure, kDistance, kTiltX, kTiltY}) {
      changes.push_back({kAbs, axis, value});
    }
    const PenSample sample = frame(changes).back();
    EXPECT_GE(sample.pressure, 0);
    EXPECT_LE(sample.pressure, 1);
    EXPECT_GE(sample.distance, 0);
    EXPECT_LE(sample.distance, 1);
    EXPECT_LE(std::abs(sample.tilt_x_rad), 1.571);
    EXPECT_GE(sample.twist_rad, 0);
    EXPECT_LE(sample.twist_rad, 6.2832);
  }
}

}  // namespace
}  // namespace limn
