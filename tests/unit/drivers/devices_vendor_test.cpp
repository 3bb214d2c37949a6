// Vendor reports of the UC-Logic line and its kin, byte by byte: what each bit means.

#include <gtest/gtest.h>

#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

using test::DecodedDevice;
using test::kDegree;
using test::ReportBytes;

constexpr std::uint16_t kHuion = 0x256C;
constexpr std::uint16_t kUgee = 0x28BD;
constexpr std::uint16_t kVeikk = 0x2FEB;
constexpr std::uint16_t kKye = 0x0458;
constexpr std::uint16_t kUcLogic = 0x5543;

/// The sample of a report; the others only lead to its state.
PenSample last(const std::vector<PenSample>& samples) {
  EXPECT_FALSE(samples.empty());
  return samples.empty() ? PenSample{} : samples.back();
}

TEST(UcLogicV1, ReadsPositionPressureAndSwitches) {
  DecodedDevice tablet(kUcLogic, 0x0781);
  const PenSample hover = last(tablet({7, 0x86, 0x10, 0x27, 0xA0, 0x0F, 0, 0}));
  EXPECT_EQ(hover.state, PenState::kInRange);
  EXPECT_EQ(hover.buttons, 0b11);
  EXPECT_DOUBLE_EQ(hover.x_mm, 10000 / (4000 / 25.4));
  EXPECT_DOUBLE_EQ(hover.y_mm, 4000 / (4000 / 25.4));
  EXPECT_FALSE(hover.axes.has(PenAxis::kTiltX));
  const PenSample contact = last(tablet({7, 0x81, 0x10, 0x27, 0xA0, 0x0F, 0xFF, 0x07}));
  EXPECT_EQ(contact.state, PenState::kInContact);
  EXPECT_EQ(contact.pressure, 1);
}

TEST(UcLogicV1, Bit6MeansOutOfRangeOnceInitialised) {
  DecodedDevice tablet(kUcLogic, 0x0781);
  EXPECT_TRUE(tablet({7, 0xC0, 0, 0, 0, 0, 0, 0}).empty()) << "it was not in range";
  EXPECT_EQ(tablet.kind(), ReportClass::kPen);
  tablet({7, 0x80, 1, 0, 1, 0, 0, 0});
  const PenSample gone = last(tablet({7, 0xC0, 1, 0, 1, 0, 0, 0}));
  EXPECT_EQ(gone.state, PenState::kOutOfRange);
  EXPECT_FALSE(gone.axes.has_position());
  EXPECT_TRUE(tablet({7, 0xE0, 1, 1, 1, 0, 0, 0}).empty());
  EXPECT_EQ(tablet.kind(), ReportClass::kPad);
}

TEST(UcLogicV1, Bit6WithASwitchMeansInRangeFromThenOn) {
  DecodedDevice tablet(kUcLogic, 0x0781);
  EXPECT_TRUE(tablet({7, 0xC0, 1, 0, 1, 0, 0, 0}).empty());
  EXPECT_EQ(last(tablet({7, 0xC2, 1, 0, 1, 0, 0, 0})).state, PenState::kInRange);
  EXPECT_EQ(last(tablet({7, 0xC0, 1, 0, 1, 0, 0, 0})).state, PenState::kInRange);
  EXPECT_EQ(last(tablet({7, 0x80, 0, 0, 0, 0, 0, 0})).state, PenState::kOutOfRange);
}

TEST(UcLogicV2, CoordinatesHave24Bits) {
  DecodedDevice tablet(kHuion, 0x006C);
  const PenSample sample = last(tablet({8, 0x81, 0x37, 0xD2, 0x3C, 0x06, 0xFF, 0x3F, 1, 1, 0, 0}));
  EXPECT_EQ(sample.raw.x, 119351);
  EXPECT_EQ(sample.raw.y, 67132);
  EXPECT_DOUBLE_EQ(sample.y_mm, 335.66);
  EXPECT_EQ(sample.pressure, 1);
}

TEST(UcLogicV2, TiltIsTurnedTowardsTheUser) {
  DecodedDevice tablet(kHuion, 0x0066);
  const PenSample sample = last(tablet({8, 0x80, 0, 1, 0, 1, 0, 0, 0, 0, 30, 0xEC}));
  EXPECT_DOUBLE_EQ(sample.tilt_x_rad, 30 * kDegree);
  EXPECT_DOUBLE_EQ(sample.tilt_y_rad, 20 * kDegree);
}

TEST(UcLogicV2, TiltOfAnUnknownModelComesWithItsFirstValue) {
  DecodedDevice tablet(kHuion, 0x006D);
  EXPECT_FALSE(last(tablet({8, 0x80, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0})).axes.has(PenAxis::kTiltX));
  EXPECT_TRUE(last(tablet({8, 0x80, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0})).axes.has(PenAxis::kTiltX));
  EXPECT_TRUE(last(tablet({8, 0x80, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0})).axes.has(PenAxis::kTiltX));
}

TEST(UcLogicV2, KeysStripsAndDialsAreThePads) {
  DecodedDevice tablet(kHuion, 0x006E);
  for (const std::uint8_t flags : {0xE0, 0xE3, 0xF0, 0xF1}) {
    EXPECT_TRUE(tablet({8, flags, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0}).empty());
    EXPECT_EQ(tablet.kind(), ReportClass::kPad) << int{flags};
  }
  tablet({8, 0x88, 1, 1, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(tablet.kind(), ReportClass::kTooShort);
  EXPECT_EQ(last(tablet({8, 0x88, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0})).buttons, 0b100);
}

TEST(Ugee, LongerReportsCarryTiltAndThirdBytes) {
  DecodedDevice tablet(kUgee, 0x092D);  // Artist 24 Pro: 105370 counts
  const PenSample tilted = last(tablet({2, 0xA1, 0, 1, 0, 1, 0xFF, 0x1F, 0xC4, 60}));
  EXPECT_EQ(tilted.state, PenState::kInContact);
  EXPECT_EQ(tilted.pressure, 1);
  EXPECT_DOUBLE_EQ(tilted.tilt_x_rad, -60 * kDegree);
  EXPECT_DOUBLE_EQ(tilted.tilt_y_rad, 60 * kDegree);
  const PenSample far = last(tablet({2, 0xA0, 0x9A, 0x9B, 0, 0, 0, 0, 0, 0, 1, 0}));
  EXPECT_EQ(far.raw.x, 105370);
  EXPECT_DOUBLE_EQ(far.x_mm, 526.85);
}

TEST(Ugee, PressureIgnoresBitsAboveItsRange) {
  DecodedDevice tablet(kUgee, 0x0936);  // Deco M: bit 13 means something else
  const PenSample sample = last(tablet({2, 0xA1, 0, 1, 0, 1, 0x01, 0x20, 0, 0}));
  EXPECT_EQ(sample.raw.pressure, 1);
}

TEST(Ugee, SaysEraserSwitchesAndLeaving) {
  DecodedDevice tablet(kUgee, 0x0905);
  EXPECT_EQ(last(tablet({2, 0xA6, 0, 1, 0, 1, 0, 0, 0, 0})).buttons, 0b11);
  const PenSample gone = last(tablet({2, 0xC0, 0, 1, 0, 1, 0, 0, 0, 0}));
  EXPECT_EQ(gone.state, PenState::kOutOfRange);
  const PenSample eraser = last(tablet({2, 0xA8, 0, 1, 0, 1, 0, 0, 0, 0}));
  EXPECT_EQ(eraser.state, PenState::kInRangeErasing);
  EXPECT_EQ(eraser.tool, Tool::kEraser);
  EXPECT_EQ(last(tablet({2, 0xA9, 0, 1, 0, 1, 9, 0, 0, 0})).state, PenState::kErasing);
  EXPECT_TRUE(tablet({2, 0xF0, 1, 0, 0, 0, 0, 0, 0, 0}).empty());
  EXPECT_EQ(tablet.kind(), ReportClass::kPad);
  EXPECT_TRUE(tablet({2, 0xF2, 1, 0x64, 0, 0, 0, 0, 0, 0}).empty());
  EXPECT_EQ(tablet.kind(), ReportClass::kStatus);
}

TEST(UgeeGen2, PressureHas14Bits) {
  DecodedDevice tablet(kUgee, 0x0942);
  const ReportBytes hard = {2, 0xA1, 0, 1, 0, 1, 0xFF, 0x5F, 0, 0, 0, 0, 0, 1};
  EXPECT_EQ(last(tablet(hard)).raw.pressure, 16383);
  const ReportBytes half = {2, 0xA1, 0, 1, 0, 1, 0xFF, 0x1F, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(last(tablet(half)).raw.pressure, 8191);
}

TEST(Veikk, TellsItsTwoFormsByLength) {
  DecodedDevice tablet(kVeikk, 0x0008);
  const PenSample older = last(tablet({9, 0x41, 0xA1, 0x10, 0x27, 0xC8, 0, 0xFF, 0x1F}));
  EXPECT_DOUBLE_EQ(older.x_mm, 50);
  EXPECT_DOUBLE_EQ(older.y_mm, 1);
  EXPECT_EQ(older.pressure, 1);
  const PenSample newer = last(tablet({9, 0x41, 0xA0, 0x10, 0x27, 0, 0xC8, 0, 0, 0, 0, 30, 0xE2}));
  EXPECT_DOUBLE_EQ(newer.x_mm, 50);
  EXPECT_DOUBLE_EQ(newer.y_mm, 1);
  EXPECT_DOUBLE_EQ(newer.tilt_x_rad, 30 * kDegree);
  EXPECT_DOUBLE_EQ(newer.tilt_y_rad, -30 * kDegree);
  EXPECT_EQ(last(tablet({9, 0x41, 0xC0, 0, 0, 0, 0, 0, 0})).state, PenState::kOutOfRange);
}

TEST(Veikk, KeysAndTouchPadAreNotThePen) {
  DecodedDevice tablet(kVeikk, 0x0002);
  EXPECT_TRUE(tablet({9, 0x42, 1, 1, 1, 0, 0, 0, 0}).empty());
  EXPECT_EQ(tablet.kind(), ReportClass::kPad);
  EXPECT_TRUE(tablet({9, 0x43, 1, 1, 0, 0, 0, 0, 0}).empty());
  EXPECT_EQ(tablet.kind(), ReportClass::kTouch);
}

TEST(Kye, PenAndMouseHaveTheirReports) {
  DecodedDevice tablet(kKye, 0x5015);
  const PenSample pen = last(tablet({0x10, 0x83, 0, 0xF0, 0, 0xB4, 0xFF, 0x07}));
  EXPECT_NEAR(pen.x_mm, 304.8, 1e-9);
  EXPECT_NEAR(pen.y_mm, 228.6, 1e-9);
  EXPECT_EQ(pen.state, PenState::kInContact);
  EXPECT_EQ(pen.buttons, 1);
  EXPECT_EQ(pen.pressure, 1);
  tablet({0x10, 0x80, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(last(tablet({0x10, 0x00, 0, 0, 0, 0, 0, 0})).state, PenState::kOutOfRange);
  const PenSample mouse = last(tablet({0x11, 0x85, 1, 0, 1, 0, 0, 0}));
  EXPECT_EQ(mouse.tool, Tool::kTabletMouse);
  EXPECT_EQ(mouse.buttons, 0b101);
  EXPECT_FALSE(mouse.axes.has(PenAxis::kPressure));
  tablet({0x12, 1, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(tablet.kind(), ReportClass::kPad);
}

TEST(KyeMouse, TheTipsBitBesideASwitchIsNoContact) {
  DecodedDevice tablet(kKye, 0x5015);
  const PenSample pressed = last(tablet({9, 0x83, 0, 0x78, 0, 0x5A, 0, 0}));
  EXPECT_EQ(pressed.state, PenState::kInRange);
  EXPECT_EQ(pressed.buttons, 1);
  EXPECT_NEAR(pressed.x_mm, 304.8, 1e-9);
  EXPECT_EQ(last(tablet({9, 0x81, 0, 0x78, 0, 0x5A, 0, 0})).state, PenState::kInContact);
}

TEST(PenAsMouse, OneDeviceSpeaksTwoWays) {
  DecodedDevice tablet(kVeikk, 0x0002);
  const PenSample plain = last(tablet({1, 0x01, 0xFF, 0x7F, 0xFF, 0x7F, 0xFF, 0x1F}));
  EXPECT_DOUBLE_EQ(plain.x_mm, 254);
  EXPECT_DOUBLE_EQ(plain.y_mm, 152.4);
  EXPECT_EQ(tablet.decoder().range().x_max, 32767);
  last(tablet({9, 0x41, 0xA1, 0x10, 0x27, 0xC8, 0, 0xFF, 0x1F}));
  EXPECT_EQ(tablet.decoder().range().x_max, 50800);
}

// What the descriptor of a Huion or UGEE tablet calls an eraser is the second barrel switch.
const ReportBytes kUgeeDescriptor = {
    0x05, 0x0D, 0x09, 0x02, 0xA1, 0x01, 0x85, 0x07, 0x09, 0x20, 0xA1, 0x00, 0x09, 0x42,
    0x09, 0x44, 0x09, 0x45, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x03, 0x81, 0x02,
    0x95, 0x02, 0x81, 0x03, 0x09, 0x32, 0x95, 0x01, 0x81, 0x02, 0x95, 0x02, 0x81, 0x03,
    0x75, 0x10, 0x95, 0x01, 0x35, 0x00, 0x05, 0x01, 0x65, 0x13, 0x55, 0x0D, 0x46, 0x10,
    0x27, 0x26, 0xFF, 0x7F, 0x09, 0x30, 0x81, 0x02, 0x09, 0x31, 0x81, 0x02, 0xC0, 0xC0};

TEST(Descriptor, ItsEraserIsTheSecondSwitchOfTheseVendors) {
  DecodedDevice ugee(kUgee, 0x0907, kUgeeDescriptor);
  const PenSample pressed = last(ugee({7, 0xA4, 0xFF, 0x7F, 0, 0}));
  EXPECT_EQ(pressed.state, PenState::kInRange);
  EXPECT_EQ(pressed.buttons, 0b10);
  EXPECT_NEAR(pressed.x_mm, 254, 1e-9);
  DecodedDevice other(0x1234, 0x0907, kUgeeDescriptor);
  EXPECT_EQ(last(other({7, 0xA4, 0xFF, 0x7F, 0, 0})).tool, Tool::kEraser);
}

TEST(Descriptor, ThatExplainsTheReportBeatsARowOfUcLogic) {
  DecodedDevice by_descriptor(kUcLogic, 0x0781, kUgeeDescriptor);
  EXPECT_EQ(by_descriptor.decoder().spec(), nullptr);
  PenIdentity identity;
  identity.vendor = kUcLogic;
  identity.product = 0x0781;
  PenParameters parameters;
  parameters.x_max = 1000;
  parameters.y_max = 500;
  parameters.pressure_max = 255;
  parameters.counts_per_mm = 10;
  const auto initialised = PenDecoder::make(identity, kUgeeDescriptor, &parameters);
  ASSERT_TRUE(initialised);
  ASSERT_NE(initialised->spec(), nullptr);
  EXPECT_EQ(initialised->range().width_mm, 100);
  EXPECT_EQ(initialised->spec()->name, "UC-Logic TWHA60");
}

TEST(Rows, WhoseReportsTheDescriptorLacksCountOnceTheyCome) {
  // The keyboard of a tablet: its pen is on another interface.
  const ReportBytes keyboard = {0x05, 0x01, 0x09, 0x06, 0xA1, 0x01, 0x85, 0x03, 0x05,
                                0x07, 0x19, 0xE0, 0x29, 0xE7, 0x15, 0x00, 0x25, 0x01,
                                0x75, 0x01, 0x95, 0x08, 0x81, 0x02, 0xC0};
  DecodedDevice device(kHuion, 0x006E, keyboard);
  EXPECT_FALSE(device.decoder().has_pen());
  EXPECT_EQ(device.decoder().spec(), nullptr);
  EXPECT_EQ(device.decoder().range().x_max, 0);
  last(device({8, 0x80, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(device.decoder().has_pen());
  DecodedDevice pen(kUgee, 0x0905, kUgeeDescriptor);
  EXPECT_EQ(pen.decoder().spec(), nullptr) << "report 2 is on another interface";
  EXPECT_TRUE(pen.decoder().has_pen());
}

TEST(Rows, TheMostSpecificOneWins) {
  PenIdentity identity;
  identity.vendor = kHuion;
  identity.product = 0x006E;
  EXPECT_EQ(find_pen_forms(identity).rows[0]->name, "Huion tablet");
  identity.firmware = "HUION_T164_170520";
  const PenForms q11k = find_pen_forms(identity);
  EXPECT_EQ(q11k.rows[0]->name, "Huion Q11K");
  identity.product = 0x0999;
  EXPECT_EQ(find_pen_forms(identity).rows[0]->name, "Huion Q11K") << "whatever the product id";
  identity.firmware = "HUION_T999_170520";
  EXPECT_EQ(find_pen_forms(identity).count, 0U);
  identity.vendor = kUgee;
  identity.product = 0x0075;
  EXPECT_EQ(find_pen_forms(identity).count, 0U);
  identity.product_name = "XP-PEN G430S";
  EXPECT_EQ(find_pen_forms(identity).rows[0]->name, "XP-Pen Star G430S");
}

TEST(Rows, AnUnknownModelWithADescriptorsLengthIsKnown) {
  PenIdentity identity;
  identity.vendor = kHuion;
  identity.product = 0x006E;
  identity.descriptor_bytes = 244;
  const PenForms forms = find_pen_forms(identity);
  ASSERT_EQ(forms.count, 3U) << "reports 7, 8 and 10";
  EXPECT_EQ(forms.rows[2]->name, "Huion W58");
  identity.descriptor_bytes = 0;
  EXPECT_EQ(find_pen_forms(identity).rows[2]->name, "Huion tablet");
}

}  // namespace
}  // namespace limn
