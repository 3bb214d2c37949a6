#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "drivers/hid/pen_layout.hpp"
#include "drivers/hid/report_layout.hpp"
#include "tests/support/alloc_guard.hpp"
#include "tests/unit/drivers/hid_items.hpp"

namespace limn::hid {
namespace {

using test::Items;
using testing::IsEmpty;
using testing::SizeIs;
using Bytes = std::vector<std::uint8_t>;

constexpr double kPi = 3.14159265358979323846;
constexpr double kTight = 1e-12;

ReportDescriptor parsed(const Items& items) {
  auto descriptor = parse_descriptor(items.bytes());
  EXPECT_TRUE(descriptor.has_value()) << descriptor.error().at << ": " << descriptor.error().what;
  return descriptor ? *descriptor : ReportDescriptor{};
}

void add_position(Items& items) {
  items.push().usage_page(0x01).logical(0, 20000).physical(0, 100).unit(0x11).unit_exponent(0x0F);
  items.report_size(16).report_count(1);
  items.usage(0x30).input(test::kVariable).usage(0x31).input(test::kVariable).pop();
}

/// Report 2: five switches, 3 bits of padding, X, Y, pressure, tilts; scan time in the application.
Items stylus() {
  Items items;
  items.usage_page(0x0D).usage(0x02).collection(test::kApplication).report_id(2);
  items.usage(0x20).collection(test::kPhysical);
  items.logical(0, 1).report_size(1).report_count(5);
  items.usage(0x42).usage(0x44).usage(0x3C).usage(0x45).usage(0x32).input(test::kVariable);
  items.report_count(3).input(test::kConstant);
  add_position(items);
  items.report_size(16).report_count(1).logical(0, 8191).usage(0x30).input(test::kVariable);
  items.report_size(8).report_count(2).logical(-60, 60).physical(-60, 60).unit(0x14);
  items.usage(0x3D).usage(0x3E).input(test::kNullState);
  items.end_collection();
  items.report_size(16).report_count(1).logical(0, 65535).physical(0, 0).unit(0);
  items.usage(0x56).input(test::kVariable);
  return items.end_collection();
}

const Bytes kStylusReport = {0x02, 0x13, 0x10, 0x27, 0x88, 0x13,
                             0xFF, 0x0F, 0x1E, 0xE2, 0x10, 0x27};

TEST(HidReportLayout, LocatesUsagesInsideACollection) {
  const auto descriptor = parsed(stylus());
  const auto inside = locate(descriptor, 2, 1, usage::kTipPressure);
  ASSERT_THAT(inside, SizeIs(1));
  EXPECT_EQ(inside[0].reader.bit_offset(), 48U);
  EXPECT_THAT(locate(descriptor, 2, 1, usage::kScanTime), IsEmpty());  // outside the stylus
  EXPECT_THAT(locate(descriptor, 2, kNoCollection, usage::kScanTime), SizeIs(1));
  EXPECT_THAT(locate(descriptor, 3, kNoCollection, usage::kScanTime), IsEmpty());
}

TEST(HidReportLayout, FindsSwitchesInArrays) {
  Items items;
  items.usage_page(0x0D).usage(0x02).collection(test::kApplication);
  items.logical(3, 6).report_size(4).report_count(2);
  items.usage(0x42).usage(0x44).usage(0x5A).input(test::kArray).end_collection();
  const auto descriptor = parsed(items);
  const auto barrel = locate(descriptor, 0, kNoCollection, usage::kBarrelSwitch);
  ASSERT_THAT(barrel, SizeIs(1));
  EXPECT_EQ(barrel[0].reader.read(Bytes{0x43}), 1);  // tip (3) and barrel (4)
  EXPECT_EQ(barrel[0].reader.read(Bytes{0x53}), 0);  // tip and second barrel
  EXPECT_EQ(barrel[0].reader.read(Bytes{0x00}), 0);
}

TEST(HidReportLayout, ConstantFieldsAndSurplusUsagesLieNowhere) {
  Items items;
  items.usage_page(0x0D).usage(0x02).collection(test::kApplication);
  items.report_size(1).report_count(1).usage(0x42).input(test::kConstant | test::kVariable);
  items.usage(0x44).usage(0x45).input(test::kVariable).end_collection();
  const auto descriptor = parsed(items);
  EXPECT_THAT(locate(descriptor, 0, kNoCollection, usage::kTipSwitch), IsEmpty());
  EXPECT_THAT(locate(descriptor, 0, kNoCollection, usage::kBarrelSwitch), SizeIs(1));
  EXPECT_THAT(locate(descriptor, 0, kNoCollection, usage::kEraser), IsEmpty());
}

TEST(HidPenLayout, ReadsAWholePen) {
  const auto pens = pen_layouts(parsed(stylus()));
  ASSERT_THAT(pens, SizeIs(1));
  const PenLayout& pen = pens[0];
  EXPECT_EQ(pen.transducer, Transducer::kStylus);
  EXPECT_EQ(pen.report_id, 2);
  EXPECT_TRUE(pen.numbered);
  EXPECT_EQ(pen.byte_length, 12U);
  EXPECT_EQ(pen.application, usage::kPen);
  EXPECT_EQ(pen.collection, 1);
  EXPECT_TRUE(pen.matches(kStylusReport));
  EXPECT_TRUE(pen.tip_switch.is_set(kStylusReport));
  EXPECT_TRUE(pen.barrel_switch.is_set(kStylusReport));
  EXPECT_FALSE(pen.invert.is_set(kStylusReport));
  EXPECT_FALSE(pen.eraser.is_set(kStylusReport));
  EXPECT_TRUE(pen.in_range.is_set(kStylusReport));
  EXPECT_NEAR(pen.x.map(*pen.x.reader.read(kStylusReport)), 50.0, 50 * kTight);
  EXPECT_NEAR(pen.y.map(*pen.y.reader.read(kStylusReport)), 25.0, 25 * kTight);
  EXPECT_TRUE(pen.x.has_unit && pen.y.has_unit);
  EXPECT_NEAR(pen.pressure.map(*pen.pressure.reader.read(kStylusReport)), 4095.0 / 8191, kTight);
  EXPECT_NEAR(pen.tilt_x.map(*pen.tilt_x.reader.read(kStylusReport)), kPi / 6, kTight);
  EXPECT_NEAR(pen.tilt_y.map(*pen.tilt_y.reader.read(kStylusReport)), -kPi / 6, kTight);
  EXPECT_TRUE(pen.tilt_x.has_unit);
  // Shared with the application collection.
  EXPECT_NEAR(pen.scan_time.map(*pen.scan_time.reader.read(kStylusReport)), 1.0, kTight);
  EXPECT_FALSE(pen.scan_time.has_unit);
  EXPECT_FALSE(pen.twist);
  EXPECT_FALSE(pen.serial);
}

TEST(HidPenLayout, AShortReportKeepsItsFirstFields) {
  const auto pen = pen_layouts(parsed(stylus())).at(0);
  const Bytes cut(kStylusReport.begin(), kStylusReport.begin() + 7);
  EXPECT_TRUE(pen.x.reader.read(cut).has_value());
  EXPECT_FALSE(pen.pressure.reader.read(cut).has_value());
  EXPECT_FALSE(pen.tilt_x.reader.read(cut).has_value());
}

TEST(HidPenLayout, ReadingAllocatesNothing) {
  const auto pen = pen_layouts(parsed(stylus())).at(0);
  std::int64_t sum = 0;
  const limn::test::AllocGuard guard;
  for (const AxisReader* axis : {&pen.x, &pen.y, &pen.pressure, &pen.tilt_x, &pen.twist}) {
    sum += axis->reader.read(kStylusReport).value_or(0);
  }
  sum += pen.tip_switch.is_set(kStylusReport) ? 1 : 0;
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_EQ(sum, 10000 + 5000 + 4095 + 30 + 1);
}

TEST(HidPenLayout, WacomPagesRepeatTheStandardUsages) {
  Items items;
  items.usage_page(0xFF0D).usage(0x01).collection(test::kApplication).report_id(16);
  items.usage(0x20).collection(test::kPhysical);
  items.logical(0, 1).report_size(1).report_count(8);
  items.usage(0x42).usage(0x44).usage(0x5A).usage(0x5D).usage(0x45).usage(0x3C).usage(0x32);
  items.usage(0x36).input(test::kVariable);
  items.report_size(24).report_count(1).logical(0, 44704).physical(0, 22352).unit(0x11);
  items.unit_exponent(0x0D).usage(0x130).input(test::kVariable).usage(0x131);
  items.input(test::kVariable);
  items.report_size(16).logical(0, 8191).physical(0, 0).unit(0).unit_exponent(0);
  items.usage(0x30).input(test::kVariable);
  items.report_size(32).report_count(2).logical(INT32_MIN, INT32_MAX).usage(0x5B).usage(0x5C);
  items.input(test::kVariable);
  items.report_size(16).report_count(1).logical(0, 4095).usage(0x77).input(test::kVariable);
  items.report_size(8).logical(0, 63).usage(0x132).input(test::kVariable);
  items.report_size(16).logical(0, 65535).usage(0x220).input(test::kVariable);
  items.logical(0, 2047).usage(0xD03).input(test::kVariable);
  items.end_collection().end_collection();
  const auto pens = pen_layouts(parsed(items));
  ASSERT_THAT(pens, SizeIs(1));
  const PenLayout& pen = pens[0];
  Bytes report = {16,   0x89, 0xA0, 0xAE, 0,    0x92, 0x36, 0,  0xFF, 0x1F, 0x78, 0x56, 0x34,
                  0xF2, 0xEF, 0xCD, 0xAB, 0x90, 0x02, 0x08, 63, 0x34, 0x12, 0xFF, 0x07};
  EXPECT_EQ(pen.byte_length, report.size());
  EXPECT_TRUE(pen.tip_switch.is_set(report) && pen.barrel_switch3.is_set(report));
  EXPECT_TRUE(pen.sense.is_set(report));
  EXPECT_FALSE(pen.in_range.is_set(report));
  EXPECT_NEAR(pen.x.map(*pen.x.reader.read(report)), 223.52, 224 * kTight);
  EXPECT_EQ(pen.y.reader.read(report), 0x3692);
  EXPECT_EQ(pen.pressure.map(*pen.pressure.reader.read(report)), 1.0);
  EXPECT_EQ(pen.serial.read_bits(report), 0xF2345678U);  // declared signed, still bits
  EXPECT_EQ(pen.serial_high.read_bits(report), 0x90ABCDEFU);
  EXPECT_EQ(pen.tool_type.read(report), 0x802);
  EXPECT_EQ(pen.distance.map(*pen.distance.reader.read(report)), 1.0);
  EXPECT_EQ(pen.sequence.read(report), 0x1234);
  EXPECT_EQ(pen.wheel.map(*pen.wheel.reader.read(report)), 1.0);
}

TEST(HidPenLayout, HeightTurnsIntoDistance) {
  Items items;
  items.usage_page(0x0D).usage(0x02).collection(test::kApplication).usage(0x32).logical(0, 1);
  items.report_size(8).report_count(1).input(test::kVariable);
  add_position(items);
  items.usage_page(0x01).report_size(16).logical(-255, 0).usage(0x32).input(test::kVariable);
  items.end_collection();
  const auto pen = pen_layouts(parsed(items)).at(0);
  EXPECT_EQ(pen.distance.map(0), 0.0);
  EXPECT_EQ(pen.distance.map(-255), 1.0);
}

TEST(HidPenLayout, FingersAreNoPens) {
  Items items;
  items.usage_page(0x0D).usage(0x04).collection(test::kApplication).report_id(1);
  for (int finger = 0; finger < 2; ++finger) {
    items.usage(0x22).collection(test::kLogical);
    items.logical(0, 1).report_size(8).report_count(1).usage(0x42).input(test::kVariable);
    items.logical(0, 255).usage(0x51).input(test::kVariable).usage(0x30).input(test::kVariable);
    add_position(items);
    items.end_collection();
  }
  items.report_size(8).report_count(1).usage(0x54).input(test::kVariable).end_collection();
  const auto descriptor = parsed(items);
  EXPECT_THAT(pen_layouts(descriptor), IsEmpty());
  const auto fingers = transducer_layouts(descriptor);
  ASSERT_THAT(fingers, SizeIs(2));
  EXPECT_EQ(fingers[1].transducer, Transducer::kFinger);
  EXPECT_EQ(fingers[0].x.reader.bit_offset(), 32U);
  EXPECT_EQ(fingers[1].x.reader.bit_offset(), 32U + 56U);
  EXPECT_TRUE(fingers[1].contact_count.present());  // shared
}

Items touch_with_stylus(bool pressure) {
  Items items;
  items.usage_page(0x0D).usage(0x04).collection(test::kApplication);
  items.usage(0x20).collection(test::kPhysical).logical(0, 1).report_size(8).report_count(1);
  items.usage(0x42).input(test::kVariable);
  if (pressure) items.logical(0, 255).usage(0x30).input(test::kVariable);
  add_position(items);
  return items.end_collection().end_collection();
}

TEST(HidPenLayout, AStylusInATouchScreenNeedsMoreThanAContact) {
  EXPECT_THAT(pen_layouts(parsed(touch_with_stylus(true))), SizeIs(1));
  EXPECT_THAT(pen_layouts(parsed(touch_with_stylus(false))), IsEmpty());
}

Items mouse(std::uint32_t position_flags, bool pressure) {
  Items items;
  items.usage_page(0x01).usage(0x02).collection(test::kApplication).report_id(9);
  items.usage(0x01).collection(test::kPhysical).usage_page(0x09).usages(1, 3).logical(0, 1);
  items.report_size(1).report_count(3).input(test::kVariable).report_count(5);
  items.input(test::kConstant).usage_page(0x01).usage(0x30).usage(0x31).logical(0, 32767);
  items.report_size(16).report_count(2).input(position_flags);
  items.usage_page(0x0D).logical(0, 1023).report_count(1);
  if (pressure) items.usage(0x30).input(test::kVariable);
  return items.end_collection().end_collection();
}

TEST(HidPenLayout, APenMayPoseAsAMouse) {
  const auto pens = pen_layouts(parsed(mouse(test::kVariable, true)));
  ASSERT_THAT(pens, SizeIs(1));
  EXPECT_FALSE(pens[0].x.has_unit);
  EXPECT_EQ(pens[0].x.map(1234), 1234.0);  // counts
  const Bytes report = {9, 0x05, 0, 0, 0, 0, 0, 0};
  EXPECT_TRUE(pens[0].tip_switch.is_set(report));
  EXPECT_FALSE(pens[0].barrel_switch.is_set(report));
  EXPECT_TRUE(pens[0].secondary_barrel_switch.is_set(report));
}

TEST(HidPenLayout, MiceAreNoPens) {
  EXPECT_THAT(transducer_layouts(parsed(mouse(test::kVariable, false))), IsEmpty());
  EXPECT_THAT(transducer_layouts(parsed(mouse(test::kRelative, true))), IsEmpty());
}

TEST(HidPenLayout, APuckIsATabletMouse) {
  Items items;
  items.usage_page(0x0D).usage(0x01).collection(test::kApplication);
  items.usage(0x21).collection(test::kPhysical).logical(0, 1).report_size(1).report_count(1);
  items.usage(0x32).input(test::kVariable).usage_page(0x09).usages(1, 3).report_count(7);
  items.input(test::kVariable);
  add_position(items);
  items.end_collection().end_collection();
  const auto pens = pen_layouts(parsed(items));
  ASSERT_THAT(pens, SizeIs(1));
  EXPECT_EQ(pens[0].transducer, Transducer::kPuck);
  EXPECT_FALSE(pens[0].tip_switch.present());
  EXPECT_TRUE(pens[0].buttons[1].is_set(Bytes{0x04, 0, 0, 0, 0}));
  EXPECT_FALSE(pens[0].buttons[3].present());
}

TEST(HidPenLayout, StandardPagesComeFirst) {
  Items items = mouse(test::kVariable, true);
  items.usage_page(0xFF11).usage(0x02).collection(test::kApplication).report_id(1);
  items.usage(0x20).collection(test::kPhysical).report_size(8).usage(0x42).input(test::kVariable);
  add_position(items);
  items.end_collection().end_collection();
  items.usage_page(0x0D).usage(0x02).collection(test::kApplication).report_id(5);
  items.usage(0x42).report_size(8).input(test::kVariable);
  add_position(items);
  items.end_collection();
  const auto pens = pen_layouts(parsed(items));
  ASSERT_THAT(pens, SizeIs(3));
  EXPECT_EQ(pens[0].report_id, 5);
  EXPECT_EQ(pens[1].report_id, 1);
  EXPECT_EQ(pens[2].report_id, 9);
}

TEST(HidPenLayout, NothingWithoutAPosition) {
  Items items;
  items.usage_page(0x0D).usage(0x02).collection(test::kApplication).report_size(16).report_count(1);
  items.usage(0x30).input(test::kVariable).usage(0x42).input(test::kVariable).end_collection();
  EXPECT_THAT(transducer_layouts(parsed(items)), IsEmpty());
}

}  // namespace
}  // namespace limn::hid
