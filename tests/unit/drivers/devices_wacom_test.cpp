// The Wacom families with plain reports, byte by byte. Reports are made up from the layouts that
// stand with the decoders.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

using test::DecodedDevice;
using test::kWacom;
using test::ReportBytes;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

PenSample only(const std::vector<PenSample>& samples) {
  EXPECT_EQ(samples.size(), 1U);
  return samples.empty() ? PenSample{} : samples.back();
}

TEST(WacomGraphire, PenEraserAndButtons) {
  DecodedDevice device(kWacom, 0x13);  // 80 counts a mm, pressure to 511
  const PenSample hover = only(device({0x02, 0x90, 0x40, 0x1F, 0x20, 0x03, 0x00, 0x00}));
  EXPECT_EQ(hover.device, 3U);
  EXPECT_EQ(hover.state, PenState::kInRange);
  EXPECT_EQ(hover.x_mm, 100);
  EXPECT_EQ(hover.y_mm, 10);
  EXPECT_EQ(hover.raw, (RawCounts{8000, 800, 0}));
  EXPECT_FALSE(hover.axes.has(PenAxis::kTiltX));
  EXPECT_FALSE(hover.axes.has(PenAxis::kDistance));

  const PenSample touch = only(device({0x02, 0x97, 0x40, 0x1F, 0x20, 0x03, 0xFF, 0x01}));
  EXPECT_EQ(touch.state, PenState::kInContact);
  EXPECT_EQ(touch.pressure, 1);
  EXPECT_EQ(touch.raw.pressure, 511);
  EXPECT_EQ(touch.buttons, 3);
}

TEST(WacomGraphire, LeavingKeepsTheLastPositionAndTheToolButNothingKeepsNone) {
  DecodedDevice device(kWacom, 0x13);
  device({0x02, 0xB0, 0x40, 0x1F, 0x20, 0x03, 0x00, 0x00});
  const PenSample leaves = only(device({0x02, 0x30, 0x50, 0x00, 0x60, 0x00, 0x00, 0x00}));
  EXPECT_EQ(leaves.state, PenState::kOutOfRange);
  EXPECT_EQ(leaves.tool, Tool::kEraser);
  EXPECT_TRUE(leaves.axes.has_position());
  EXPECT_EQ(leaves.x_mm, 1);
  EXPECT_THAT(device({0x02, 0x00, 0, 0, 0, 0, 0, 0}), IsEmpty());
  EXPECT_EQ(device.kind(), ReportClass::kPen);

  device({0x02, 0x90, 0x40, 0x1F, 0x20, 0x03, 0x00, 0x00});
  const PenSample gone = only(device({0x02, 0x00, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(gone.state, PenState::kOutOfRange);
  EXPECT_FALSE(gone.axes.has_position());
}

TEST(WacomGraphire, MiceHoverWithDistanceAndTheirOwnButtons) {
  DecodedDevice graphire3(kWacom, 0x13);
  const PenSample mouse = only(graphire3({0x02, 0xD7, 0x40, 0x1F, 0x20, 0x03, 0x00, 0x3F}));
  EXPECT_EQ(mouse.tool, Tool::kTabletMouse);
  EXPECT_EQ(mouse.state, PenState::kInRange);
  EXPECT_EQ(mouse.buttons, 7);
  EXPECT_EQ(mouse.distance, 1);
  EXPECT_FALSE(mouse.axes.has(PenAxis::kPressure));

  DecodedDevice bamboo(kWacom, 0x65);  // distance in the byte before
  EXPECT_EQ(only(bamboo({0x02, 0xD0, 1, 0, 1, 0, 0x3F, 0x00, 0})).distance, 1);
  DecodedDevice bluetooth(kWacom, 0x81);
  EXPECT_EQ(only(bluetooth({0x03, 0xF0, 1, 0, 1, 0, 0xB0, 0x1C})).distance, 0);
}

TEST(WacomGraphire, BluetoothHasItsNinthPressureBitBesideTheSwitches) {
  DecodedDevice device(kWacom, 0x81);
  device({0x03, 0x90, 1, 0, 1, 0, 0, 0x1C});
  EXPECT_EQ(only(device({0x03, 0x99, 1, 0, 1, 0, 0x12, 0x1F})).raw.pressure, 0x112);
  EXPECT_EQ(only(device({0x03, 0x99, 1, 0, 1, 0, 0x13})).raw.pressure, 0x113);
  EXPECT_THAT(device({0x02, 0x90, 1, 0, 1, 0, 0, 0}), IsEmpty());
  EXPECT_EQ(device.kind(), ReportClass::kUnknownId);
}

TEST(WacomPenPartner, BothForms) {
  DecodedDevice device(kWacom, 0x00);  // 40 counts a mm
  EXPECT_THAT(device({0x01, 0, 0, 0, 0, 0x00, 0x81}), IsEmpty());
  const PenSample hover = only(device({0x01, 0x90, 0x01, 0x28, 0x00, 0x80, 0x81}));
  EXPECT_EQ(hover.state, PenState::kInRange);
  EXPECT_EQ(hover.x_mm, 10);
  EXPECT_EQ(hover.y_mm, 1);
  EXPECT_EQ(hover.raw.pressure, 0);
  const PenSample touch = only(device({0x01, 0x90, 0x01, 0x28, 0x00, 0xC0, 0x7F}));
  EXPECT_EQ(touch.state, PenState::kInContact);
  EXPECT_EQ(touch.raw.pressure, 254);
  EXPECT_EQ(touch.buttons, 1);
  EXPECT_EQ(only(device({0x02, 0x90, 0x01, 0x28, 0x00, 0x00, 0xB0})).state, PenState::kInRange);
  EXPECT_EQ(only(device({0x02, 0x90, 0x01, 0x28, 0x00, 0x00, 0xB1})).state, PenState::kInContact);
}

TEST(WacomPl, AssemblesItsSplitNumbersAndTellsTheEraserByBarrel2) {
  DecodedDevice device(kWacom, 0x38);  // PL510, 20 counts a mm, pressure to 511
  const PenSample hover = only(device({0x02, 0x40, 0x0F, 0x50, 0x00, 0x07, 0x68, 0x40}));
  EXPECT_EQ(hover.raw.x, 0x50 | 0x0F << 7);
  EXPECT_EQ(hover.raw.y, 0x68 | 0x07 << 7);
  EXPECT_EQ(hover.x_mm, 100);
  EXPECT_EQ(hover.state, PenState::kInRange);
  EXPECT_EQ(hover.raw.pressure, 0) << "the sensor's middle is -256";
  const PenSample touch = only(device({0x02, 0x40, 0x0F, 0x50, 0x7C, 0x07, 0x68, 0x3F}));
  EXPECT_EQ(touch.state, PenState::kInContact);
  EXPECT_EQ(touch.raw.pressure, 511);
  EXPECT_EQ(touch.buttons, 3) << "entered without barrel2, so it is the pen's";
  device({0x02, 0x40, 0x0F, 0x50, 0x00, 0x07, 0x68, 0x40});
  const PenSample gone = only(device({0x02, 0x00, 0x0F, 0x50, 0x00, 0x07, 0x68, 0x40}));
  EXPECT_EQ(gone.state, PenState::kOutOfRange);
  EXPECT_EQ(gone.raw.x, hover.raw.x) << "where it left";
  EXPECT_EQ(gone.y_mm, hover.y_mm);
  EXPECT_THAT(device({0x02, 0, 0, 0, 0, 0, 0, 0}), IsEmpty());

  EXPECT_EQ(only(device({0x02, 0x40, 1, 1, 0x20, 1, 1, 0x40})).tool, Tool::kEraser);
  const auto pen_after_all = device({0x02, 0x40, 1, 1, 0x00, 1, 1, 0x40});
  ASSERT_EQ(pen_after_all.size(), 2U);
  EXPECT_EQ(pen_after_all[0].state, PenState::kOutOfRange);
  EXPECT_EQ(pen_after_all[1].tool, Tool::kPen);
  EXPECT_EQ(device.decoder().repaired_transitions(), 0U);
}

TEST(WacomPl, TheDtu710CountsFinelyForItsSeventeenInches) {
  const PenSpec* spec = find_pen_spec(kWacom, 0x39);
  ASSERT_NE(spec, nullptr);
  EXPECT_NEAR(spec->width_mm(), 340, 2);
}

TEST(WacomCintiqPartner, EraserHasATipOfItsOwn) {
  DecodedDevice device(kWacom, 0x03);
  EXPECT_EQ(only(device({0x02, 0x24, 1, 0, 1, 0, 0, 0})).state, PenState::kInRangeErasing);
  EXPECT_EQ(only(device({0x02, 0x2C, 1, 0, 1, 0, 0xFF, 0x01})).state, PenState::kErasing);
  EXPECT_EQ(only(device({0x02, 0x24, 1, 0, 1, 0, 0, 0})).state, PenState::kInRangeErasing);
  EXPECT_EQ(only(device({0x02, 0x00, 1, 0, 1, 0, 0, 0})).axes.has_position(), true);
  EXPECT_EQ(only(device({0x02, 0x32, 1, 0, 1, 0, 0, 0})).buttons, 3);
  EXPECT_EQ(only(device({0x02, 0x21, 1, 0, 1, 0, 0xFF, 0x01})).pressure, 1);
}

TEST(WacomDtu, SwitchesPressureAndTheLastPosition) {
  DecodedDevice device(kWacom, 0xCE);  // 100 counts a mm
  EXPECT_EQ(only(device({0x02, 0x20, 0xE8, 0x03, 0x64, 0x00, 0, 0})).x_mm, 10);
  const PenSample touch = only(device({0x02, 0x33, 0xE8, 0x03, 0x64, 0x00, 0xFF, 0x01}));
  EXPECT_EQ(touch.state, PenState::kInContact);
  EXPECT_EQ(touch.pressure, 1);
  EXPECT_EQ(touch.buttons, 3);
  device({0x02, 0x20, 0xE8, 0x03, 0x64, 0x00, 0, 0});
  const PenSample gone = only(device({0x02, 0x00, 0xE8, 0x03, 0x64, 0x00, 0, 0}));
  EXPECT_EQ(gone.state, PenState::kOutOfRange);
  EXPECT_EQ(gone.x_mm, 10);
  EXPECT_EQ(only(device({0x02, 0x28, 1, 0, 1, 0, 0, 0})).state, PenState::kInRangeErasing);
}

TEST(WacomDtus, BigEndianWithTheToolInTwoBits) {
  DecodedDevice device(kWacom, 0xFB);  // 100 counts a mm, pressure to 511
  const PenSample hover = only(device({0x11, 0x80, 0x00, 0x03, 0xE8, 0x00, 0x64, 0, 0, 0, 0}));
  EXPECT_EQ(hover.x_mm, 10);
  EXPECT_EQ(hover.y_mm, 1);
  EXPECT_EQ(hover.state, PenState::kInRange);
  EXPECT_EQ(only(device({0x11, 0x90, 10, 3, 0xE8, 0, 0x64})).state, PenState::kInRange);
  const PenSample touch = only(device({0x11, 0xF1, 0xFF, 3, 0xE8, 0, 0x64}));
  EXPECT_EQ(touch.state, PenState::kInContact);
  EXPECT_EQ(touch.raw.pressure, 511);
  EXPECT_EQ(touch.buttons, 3);
  device({0x11, 0x80, 0, 3, 0xE8, 0, 0x64});
  const PenSample gone = only(device({0x11, 0x00, 0, 3, 0xE8, 0, 0x64}));
  EXPECT_EQ(gone.state, PenState::kOutOfRange);
  EXPECT_TRUE(gone.axes.has_position());
  EXPECT_EQ(only(device({0x11, 0x88, 0, 3, 0xE8, 0, 0x64})).tool, Tool::kEraser);
  EXPECT_THAT(device({0x15, 0x01}), IsEmpty());
  EXPECT_EQ(device.kind(), ReportClass::kPad);
}

TEST(WacomTabletPc, TheEraserIsDecidedWhenItEnters) {
  DecodedDevice device(kWacom, 0x90);
  EXPECT_EQ(only(device({0x02, 0x28, 1, 0, 1, 0, 0, 0})).tool, Tool::kEraser);
  EXPECT_EQ(only(device({0x02, 0x20, 1, 0, 1, 0, 0, 0})).tool, Tool::kEraser);
  device({0x02, 0x00, 1, 0, 1, 0, 0, 0});
  EXPECT_EQ(only(device({0x02, 0x20, 1, 0, 1, 0, 0, 0})).tool, Tool::kPen);
  const PenSample touch = only(device({0x02, 0x21, 1, 0, 1, 0, 0xFF, 0x00}));
  EXPECT_EQ(touch.state, PenState::kInContact);
  EXPECT_EQ(touch.pressure, 1);
}

TEST(WacomBamboo, RangeThenPositionThenReadiness) {
  DecodedDevice device(kWacom, 0xD4);  // 100 counts a mm, pressure to 1023, distance to 31
  EXPECT_THAT(device({0x02, 0x80, 0, 0, 0, 0, 0, 0, 0}), IsEmpty()) << "which end is not known";
  const PenSample edge = only(device({0x02, 0xD1, 0xE8, 0x03, 0x64, 0, 0xFF, 0x03, 31}));
  EXPECT_EQ(edge.state, PenState::kInRange) << "not ready: outside the active area";
  EXPECT_FALSE(edge.axes.has(PenAxis::kPressure));
  EXPECT_EQ(edge.distance, 0);
  const PenSample touch = only(device({0x02, 0xF7, 0xE8, 0x03, 0x64, 0, 0xFF, 0x03, 40}));
  EXPECT_EQ(touch.state, PenState::kInContact);
  EXPECT_EQ(touch.x_mm, 10);
  EXPECT_EQ(touch.y_mm, 1);
  EXPECT_EQ(touch.pressure, 1);
  EXPECT_EQ(touch.buttons, 3);
  EXPECT_EQ(touch.distance, 0);
  device({0x02, 0xF0, 0xE8, 0x03, 0x64, 0, 0, 0, 31});
  const PenSample far = only(device({0x02, 0x80, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(far.state, PenState::kInRange);
  EXPECT_FALSE(far.axes.has_position());
  EXPECT_EQ(far.distance, 1);
  EXPECT_EQ(only(device({0x02, 0x00, 0, 0, 0, 0, 0, 0, 0})).state, PenState::kOutOfRange);
  EXPECT_THAT(device({0x02, 0x00, 0, 0, 0, 0, 0, 0, 0}), IsEmpty());
  EXPECT_EQ(only(device({0x02, 0xF8, 1, 0, 1, 0, 0, 0, 0})).state, PenState::kInRangeErasing);
  EXPECT_EQ(device.decoder().repaired_transitions(), 0U);
}

TEST(WacomBamboo, FingersShareTheReportIdInLongerPackets) {
  DecodedDevice device(kWacom, 0xD1);
  EXPECT_THAT(device(ReportBytes(20, 0x02)), IsEmpty());
  EXPECT_EQ(device.kind(), ReportClass::kTouch);
  EXPECT_THAT(device(ReportBytes(64, 0x02)), IsEmpty());
  EXPECT_EQ(device.kind(), ReportClass::kTouch);
  EXPECT_THAT(device({0x02, 0xF0, 1, 0, 1, 0, 0, 0}), IsEmpty());
  EXPECT_EQ(device.kind(), ReportClass::kTooShort);
}

TEST(Wacom, OtherReportsAreToldApart) {
  DecodedDevice device(kWacom, 0x0315);
  const auto kind_of = [&device](ReportBytes bytes) {
    EXPECT_THAT(device(bytes), IsEmpty());
    return device.kind();
  };
  EXPECT_EQ(kind_of({0x01, 0, 1, 2, 3}), ReportClass::kMouse);
  EXPECT_EQ(kind_of({0x03, 0x80, 0, 0, 0, 0, 0, 0, 0, 0}), ReportClass::kPad);
  EXPECT_EQ(kind_of({0x0C, 0, 0, 0, 0, 0, 0, 0, 0, 0}), ReportClass::kPad);
  EXPECT_EQ(kind_of({0xC0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), ReportClass::kStatus);
  EXPECT_EQ(kind_of({0x7F, 0, 0, 0, 0, 0, 0, 0, 0, 0}), ReportClass::kUnknownId);
  EXPECT_EQ(kind_of({0x02, 0xE0, 0}), ReportClass::kTooShort);
  EXPECT_EQ(kind_of({}), ReportClass::kTooShort);
}

TEST(Wacom, AReportIdThatOnlyTheDescriptorKnowsIsNotUnknown) {
  // A keyboard report 0x7F beside the pen's.
  const ReportBytes descriptor = {0x05, 0x01, 0x09, 0x06, 0xA1, 0x01, 0x85, 0x7F, 0x75, 0x08,
                                  0x95, 0x07, 0x15, 0x00, 0x25, 0x7F, 0x81, 0x01, 0xC0};
  DecodedDevice device(kWacom, 0x0315, descriptor);
  device({0x7F, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(device.kind(), ReportClass::kOther);
}

}  // namespace
}  // namespace limn
