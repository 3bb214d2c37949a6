// Pens that their descriptors explain. Descriptors are made here, item by item.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <set>

#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

using test::DecodedDevice;
using test::kDegree;
using test::ReportBytes;
using ::testing::IsEmpty;

PenSample only(const std::vector<PenSample>& samples) {
  EXPECT_EQ(samples.size(), 1U);
  return samples.empty() ? PenSample{} : samples.back();
}

ReportBytes join(std::initializer_list<ReportBytes> parts) {
  ReportBytes out;
  for (const ReportBytes& part : parts) out.insert(out.end(), part.begin(), part.end());
  return out;
}

const ReportBytes kPenBegin = {0x05, 0x0D, 0x09, 0x02, 0xA1, 0x01, 0x85, 0x07,
                               0x09, 0x20, 0xA1, 0x00, 0x15, 0x00, 0x25, 0x01};
/// Six switches and two bits of padding: tip, barrel, eraser, invert, barrel 2, in range.
const ReportBytes kSwitches = {0x75, 0x01, 0x95, 0x06, 0x09, 0x42, 0x09, 0x44, 0x09, 0x45, 0x09,
                               0x3C, 0x09, 0x5A, 0x09, 0x32, 0x81, 0x02, 0x95, 0x02, 0x81, 0x03};
/// Tip and barrel alone.
const ReportBytes kTwoSwitches = {0x75, 0x01, 0x95, 0x02, 0x09, 0x42, 0x09,
                                  0x44, 0x81, 0x02, 0x95, 0x06, 0x81, 0x03};
/// X 100..20100 over 200 mm, Y 0..10000 over 100 mm, 16 bits each, in hundredths of cm.
const ReportBytes kPosition = {0x05, 0x01, 0x75, 0x10, 0x95, 0x01, 0x55, 0x0E, 0x65, 0x11, 0x35,
                               0x00, 0x46, 0xD0, 0x07, 0x16, 0x64, 0x00, 0x26, 0x84, 0x4E, 0x09,
                               0x30, 0x81, 0x02, 0x46, 0xE8, 0x03, 0x15, 0x00, 0x26, 0x10, 0x27,
                               0x09, 0x31, 0x81, 0x02, 0x45, 0x00, 0x65, 0x00, 0x55, 0x00};
const ReportBytes kPositionWithoutUnit = {0x05, 0x01, 0x75, 0x10, 0x95, 0x01, 0x16, 0x64, 0x00,
                                          0x26, 0x84, 0x4E, 0x09, 0x30, 0x81, 0x02, 0x15, 0x00,
                                          0x26, 0x10, 0x27, 0x09, 0x31, 0x81, 0x02};
/// Pressure 0..1000.
const ReportBytes kPressure = {0x05, 0x0D, 0x26, 0xE8, 0x03, 0x09, 0x30, 0x81, 0x02};
/// Tilt X and Y, -60..60, one byte each.
const ReportBytes kTilt = {0x15, 0xC4, 0x25, 0x3C, 0x75, 0x08, 0x95,
                           0x02, 0x09, 0x3D, 0x09, 0x3E, 0x81, 0x02};
/// A serial number of 32 bits.
const ReportBytes kSerial = {0x15, 0x00, 0x25, 0x00, 0x75, 0x20,
                             0x95, 0x01, 0x09, 0x5B, 0x81, 0x02};
/// Twist 0..359, 16 bits.
const ReportBytes kTwist = {0x15, 0x00, 0x26, 0x67, 0x01, 0x75, 0x10,
                            0x95, 0x01, 0x09, 0x41, 0x81, 0x02};
const ReportBytes kEnd = {0xC0, 0xC0};

const ReportBytes kPen =
    join({kPenBegin, kSwitches, kPosition, kPressure, kTilt, kSerial, kTwist, kEnd});

constexpr unsigned kTip = 1;
constexpr unsigned kBarrel = 2;
constexpr unsigned kEraser = 4;
constexpr unsigned kInvert = 8;
constexpr unsigned kBarrel2 = 16;
constexpr unsigned kInRange = 32;

ReportBytes report(unsigned switches, int x = 0, int y = 0, int pressure = 0, int tilt_x = 0,
                   int tilt_y = 0, std::uint32_t serial = 0, int twist = 0) {
  const auto byte = [](std::uint32_t bits) { return static_cast<std::uint8_t>(bits); };
  const auto ux = static_cast<unsigned>(x);
  const auto uy = static_cast<unsigned>(y);
  const auto up = static_cast<unsigned>(pressure);
  const auto ut = static_cast<unsigned>(twist);
  return {0x07,
          byte(switches),
          byte(ux),
          byte(ux >> 8),
          byte(uy),
          byte(uy >> 8),
          byte(up),
          byte(up >> 8),
          byte(static_cast<unsigned>(tilt_x)),
          byte(static_cast<unsigned>(tilt_y)),
          byte(serial),
          byte(serial >> 8),
          byte(serial >> 16),
          byte(serial >> 24),
          byte(ut),
          byte(ut >> 8)};
}

TEST(GenericPen, EveryAxisInLimnsUnits) {
  DecodedDevice device(0x1234, 0x5678, kPen);
  const PenSample sample =
      only(device(report(kInRange, 10100, 2500, 250, -60, 30, 0xCAFE1234, 90)));
  EXPECT_EQ(sample.state, PenState::kInRange);
  EXPECT_DOUBLE_EQ(sample.x_mm, 100) << "0 at the Logical Minimum";
  EXPECT_DOUBLE_EQ(sample.y_mm, 25);
  EXPECT_EQ(sample.raw, (RawCounts{10100, 2500, 250}));
  EXPECT_DOUBLE_EQ(sample.pressure, 0.25);
  EXPECT_DOUBLE_EQ(sample.tilt_x_rad, -60 * kDegree);
  EXPECT_DOUBLE_EQ(sample.tilt_y_rad, 30 * kDegree);
  EXPECT_DOUBLE_EQ(sample.twist_rad, 90 * kDegree);
  EXPECT_EQ(sample.serial, 0xCAFE1234U);
  EXPECT_FALSE(sample.axes.has(PenAxis::kDistance));
  EXPECT_EQ(sample.lost, 0U);
  EXPECT_DOUBLE_EQ(device.decoder().range().width_mm, 200);
  EXPECT_DOUBLE_EQ(device.decoder().range().height_mm, 100);
  EXPECT_EQ(device.decoder().range().x_min, 100);
  EXPECT_EQ(device.decoder().range().pressure_max, 1000);
}

TEST(GenericPen, TheSwitchesGiveTheFiveStates) {
  struct Case {
    unsigned switches;
    PenState state;
    Tool tool;
  };
  for (const Case& wanted : {
           Case{kInRange, PenState::kInRange, Tool::kPen},
           Case{kInRange | kTip, PenState::kInContact, Tool::kPen},
           Case{kInRange | kInvert, PenState::kInRangeErasing, Tool::kEraser},
           Case{kInRange | kInvert | kEraser, PenState::kErasing, Tool::kEraser},
           Case{kInRange | kEraser, PenState::kErasing, Tool::kEraser},
           Case{kInRange | kInvert | kTip, PenState::kErasing, Tool::kEraser},
           Case{kTip, PenState::kOutOfRange, Tool::kPen},
           Case{0, PenState::kOutOfRange, Tool::kPen},
       }) {
    DecodedDevice device(0x1234, 0x5678, kPen);
    const auto samples = device(report(wanted.switches, 200, 200));
    ASSERT_FALSE(samples.empty());
    EXPECT_EQ(samples.back().state, wanted.state) << wanted.switches;
    EXPECT_EQ(samples.back().tool, wanted.tool) << wanted.switches;
  }
}

TEST(GenericPen, BarrelSwitches) {
  DecodedDevice device(0x1234, 0x5678, kPen);
  EXPECT_EQ(only(device(report(kInRange | kBarrel))).buttons, 1);
  EXPECT_EQ(only(device(report(kInRange | kBarrel2))).buttons, 2);
  EXPECT_EQ(only(device(report(kInRange | kBarrel | kBarrel2))).buttons, 3);
}

TEST(GenericPen, AnOutOfRangeReportKeepsItsCoordinatesAndTheTool) {
  DecodedDevice device(0x1234, 0x5678, kPen);
  device(report(kInRange | kInvert, 300, 300));
  const PenSample gone = only(device(report(0, 1100, 100)));
  EXPECT_EQ(gone.state, PenState::kOutOfRange);
  EXPECT_EQ(gone.tool, Tool::kEraser);
  EXPECT_TRUE(gone.axes.has_position());
  EXPECT_DOUBLE_EQ(gone.x_mm, 10);
}

TEST(GenericPen, WithoutInRangeEveryReportIsInRange) {
  DecodedDevice device(0x1234, 0x5678, join({kPenBegin, kTwoSwitches, kPosition, kPressure, kEnd}));
  EXPECT_EQ(only(device({0x07, 0x00, 100, 0, 0, 0, 0, 0})).state, PenState::kInRange);
  EXPECT_EQ(only(device({0x07, 0x01, 100, 0, 0, 0, 9, 0})).state, PenState::kInContact);
  EXPECT_EQ(only(device({0x07, 0x00, 100, 0, 0, 0, 0, 0})).state, PenState::kInRange);
}

TEST(GenericPen, PressureBeyondTheDeclaredMaximumIsFullPressure) {
  DecodedDevice device(0x1234, 0x5678, kPen);
  const PenSample sample = only(device(report(kInRange, 200, 200, 1023)));
  EXPECT_EQ(sample.pressure, 1);
  EXPECT_EQ(sample.raw.pressure, 1023);
}

TEST(GenericPen, AShortReportGivesTheAxesThatItHas) {
  DecodedDevice device(0x1234, 0x5678, kPen);
  ReportBytes bytes = report(kInRange, 1100, 100, 500, 10, 10, 77, 5);
  bytes.resize(8);  // up to the pressure
  const PenSample sample = only(device(bytes));
  EXPECT_TRUE(sample.axes.has(PenAxis::kPressure));
  EXPECT_FALSE(sample.axes.has(PenAxis::kTiltX));
  EXPECT_FALSE(sample.axes.has(PenAxis::kSerial));
  bytes.resize(5);  // amid Y
  EXPECT_THAT(device(bytes), IsEmpty());
  EXPECT_EQ(device.kind(), ReportClass::kTooShort);
}

TEST(GenericPen, AUselessSizeIsToldOnlyWhereAReportNeedsIt) {
  DecodedDevice device(0x1234, 0x5678,
                       join({kPenBegin, kTwoSwitches, kPositionWithoutUnit, kPressure, kEnd}));
  EXPECT_FALSE(device.decoder().has_pen());
  EXPECT_THAT(device({0x07, 0x01, 100, 0, 0, 0, 9, 0}), IsEmpty());
  EXPECT_EQ(device.kind(), ReportClass::kNoSize);
  EXPECT_THAT(device({0x08, 0x01}), IsEmpty());
  EXPECT_EQ(device.kind(), ReportClass::kUnknownId);
}

TEST(GenericPen, APuckIsATabletMouseThatHovers) {
  // Puck: in range, Buttons 1 to 5, two bits of padding, X and Y.
  const ReportBytes puck =
      join({{0x05, 0x0D, 0x09, 0x02, 0xA1, 0x01, 0x85, 0x07, 0x09, 0x21, 0xA1, 0x00, 0x15,
             0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x01, 0x09, 0x32, 0x81, 0x02, 0x05, 0x09,
             0x19, 0x01, 0x29, 0x05, 0x95, 0x05, 0x81, 0x02, 0x95, 0x02, 0x81, 0x03},
            kPosition,
            kEnd});
  DecodedDevice device(0x1234, 0x5678, puck);
  const PenSample pressed = only(device({0x07, 0x01 | 0x02 | 0x20, 200, 0, 200, 0}));
  EXPECT_EQ(pressed.tool, Tool::kTabletMouse);
  EXPECT_EQ(pressed.state, PenState::kInRange);
  EXPECT_EQ(pressed.buttons, 0x11);  // left and extra
  EXPECT_DOUBLE_EQ(pressed.x_mm, 1);
  const PenSample gone = only(device({0x07, 0x00, 200, 0, 200, 0}));
  EXPECT_EQ(gone.state, PenState::kOutOfRange);
  EXPECT_EQ(gone.tool, Tool::kTabletMouse);
}

TEST(GenericPen, ReportsMissingFromTheSequenceAreCounted) {
  // Wacom's Sequence Number, 16 bits, after the position.
  const ReportBytes sequence = {0x06, 0x0D, 0xFF, 0x15, 0x00, 0x27, 0xFF, 0xFF, 0x00, 0x00,
                                0x75, 0x10, 0x95, 0x01, 0x0A, 0x20, 0x02, 0x81, 0x02};
  DecodedDevice device(0x1234, 0x5678, join({kPenBegin, kSwitches, kPosition, sequence, kEnd}));
  const auto lost = [&](unsigned number) {
    return only(device({0x07, kInRange, 200, 0, 200, 0, static_cast<std::uint8_t>(number),
                        static_cast<std::uint8_t>(number >> 8)}))
        .lost;
  };
  EXPECT_EQ(lost(0xFFFC), 0U);  // the first: nothing is known to be missing
  EXPECT_EQ(lost(0xFFFD), 0U);
  EXPECT_EQ(lost(0xFFFD), 0U);  // repeated
  EXPECT_EQ(lost(0x0001), 3U);  // FFFE, FFFF and 0
}

TEST(GenericPen, TouchCollectionsGiveNoPenSamples) {
  // A touch screen: one finger with tip, X and Y.
  const ReportBytes touch_screen = join({{0x05, 0x0D, 0x09, 0x04, 0xA1, 0x01, 0x85, 0x07, 0x09,
                                          0x22, 0xA1, 0x00, 0x15, 0x00, 0x25, 0x01},
                                         kTwoSwitches,
                                         kPosition,
                                         kEnd});
  DecodedDevice device(0x1234, 0x5678, touch_screen);
  EXPECT_FALSE(device.decoder().has_pen());
  EXPECT_EQ(device.decoder().range().width_mm, 0);
  EXPECT_THAT(device({0x07, 0x01, 100, 0, 0, 0}), IsEmpty());
  EXPECT_EQ(device.kind(), ReportClass::kTouch);
}

TEST(GenericPen, ANotebookPenIsReadByItsDescriptorRatherThanItsRow) {
  DecodedDevice device(test::kWacom, 0x0090, kPen);
  EXPECT_EQ(device.decoder().spec(), nullptr);
  EXPECT_DOUBLE_EQ(only(device(report(kInRange, 10100, 2500))).x_mm, 100);
  DecodedDevice other(test::kWacom, 0x0315, kPen);
  ASSERT_NE(other.decoder().spec(), nullptr) << "the row wins elsewhere";
  EXPECT_DOUBLE_EQ(only(other(report(kInRange, 10100, 2500))).x_mm, 100)
      << "but for reports that only the descriptor knows";
}

TEST(PenDecoder, NeedsADescriptorOrARow) {
  const auto nothing = PenDecoder::make(0x1234, 0x5678, {});
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, ErrorCode::kMissing);
  const ReportBytes broken = {0x05};
  const auto unreadable = PenDecoder::make(0x1234, 0x5678, broken);
  ASSERT_FALSE(unreadable);
  EXPECT_EQ(unreadable.error().code, ErrorCode::kSyntax);
  EXPECT_EQ(unreadable.error().at.substr(0, 17), "report descriptor");
  EXPECT_TRUE(PenDecoder::make(test::kWacom, 0x0315, broken)) << "the row suffices";
}

TEST(PenDecoder, TheSinkGetsWhatTheSpanHolds) {
  auto decoder = PenDecoder::make(0x1234, 0x5678, kPen);
  ASSERT_TRUE(decoder);
  const ReportBytes bytes = report(kInRange | kTip, 200, 200);
  std::vector<PenState> states;
  const ReportClass kind = decoder->decode(
      Report{0, {}, bytes}, [&states](const PenSample& sample) { states.push_back(sample.state); });
  EXPECT_EQ(kind, ReportClass::kPen);
  EXPECT_THAT(states, ::testing::ElementsAre(PenState::kInRange, PenState::kInContact));
  EXPECT_EQ(decoder->repaired_transitions(), 1U);
}

TEST(PenDecoder, ADeviceThatGoesAwayLiftsAndLeaves) {
  auto decoder = PenDecoder::make(0x1234, 0x5678, kPen);
  ASSERT_TRUE(decoder);
  const ReportBytes hover = report(kInRange, 200, 200);
  const ReportBytes contact = report(kInRange | kTip, 300, 200);
  decoder->decode(Report{0, {}, hover});
  decoder->decode(Report{0, {}, contact});
  const auto gone = decoder->disconnect(5, std::chrono::seconds(2));
  ASSERT_EQ(gone.size(), 2U);
  EXPECT_EQ(gone[0].state, PenState::kInRange);
  EXPECT_EQ(gone[0].raw.x, 300);
  EXPECT_EQ(gone[1].state, PenState::kOutOfRange);
  EXPECT_EQ(gone[1].device, 5U);
  EXPECT_EQ(gone[1].time, std::chrono::seconds(2));
  EXPECT_EQ(decoder->repaired_transitions(), 0U);
  EXPECT_TRUE(decoder->disconnect(5, std::chrono::seconds(3)).empty());
}

TEST(ReportClass, EveryClassHasItsName) {
  std::set<std::string_view> names;
  for (int i = 0; i < kReportClassCount; ++i) names.insert(name(static_cast<ReportClass>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kReportClassCount));
  EXPECT_EQ(name(ReportClass::kNoSize), "pen without size");
}

}  // namespace
}  // namespace limn
