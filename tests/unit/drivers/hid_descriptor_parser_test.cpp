#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/hid/descriptor_parser.hpp"
#include "tests/unit/drivers/hid_items.hpp"

namespace limn::hid {
namespace {

using test::Items;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The descriptor, which must parse.
ReportDescriptor parsed(const Items& items) {
  auto descriptor = parse_descriptor(items.bytes());
  EXPECT_TRUE(descriptor.has_value()) << descriptor.error().at << ": " << descriptor.error().what;
  return descriptor ? *descriptor : ReportDescriptor{};
}

/// Its only field.
Field only_field(const Items& items) {
  const auto descriptor = parsed(items);
  EXPECT_EQ(descriptor.fields.size(), 1U);
  return descriptor.fields.empty() ? Field{} : descriptor.fields.front();
}

/// A pen collection around `count` elements of 8 bits.
Items in_pen() {
  Items items;
  items.usage_page(0x0D).usage(0x02).collection(test::kApplication);
  items.report_size(8).report_count(1);
  return items;
}

TEST(HidDescriptorParser, NestsCollections) {
  Items items;
  items.usage_page(0x0D).usage(0x02).collection(test::kApplication);
  items.usage(0x20).collection(test::kPhysical).end_collection();
  items.usage(0x39).collection(test::kLogical).end_collection();
  items.end_collection();
  items.collection(0x82).end_collection();
  const auto descriptor = parsed(items);
  ASSERT_EQ(descriptor.collections.size(), 4U);
  EXPECT_EQ(descriptor.collections[0].usage, usage::kPen);
  EXPECT_EQ(descriptor.collections[0].type, CollectionType::kApplication);
  EXPECT_EQ(descriptor.collections[0].parent, kNoCollection);
  EXPECT_EQ(descriptor.collections[0].offset, 4U);
  EXPECT_EQ(descriptor.collections[1].usage, usage::kStylus);
  EXPECT_EQ(descriptor.collections[1].parent, 0);
  EXPECT_EQ(descriptor.collections[2].usage, usage::kTabletFunctionKeys);
  EXPECT_EQ(descriptor.collections[2].parent, 0);
  EXPECT_EQ(descriptor.collections[3].usage, Usage{});  // usages end at each Main item
  EXPECT_EQ(descriptor.collections[3].type, static_cast<CollectionType>(0x82));
  EXPECT_EQ(descriptor.collections[3].parent, kNoCollection);
  EXPECT_TRUE(descriptor.inside(1, 0));
  EXPECT_FALSE(descriptor.inside(0, 1));
  EXPECT_FALSE(descriptor.inside(2, 1));
  EXPECT_EQ(descriptor.top_level(2), 0);
}

TEST(HidDescriptorParser, LaysFieldsOutByKindAndReport) {
  Items items = in_pen();
  items.report_id(2).usage(0x42).report_size(1).report_count(3).input(test::kVariable);
  items.report_size(5).report_count(1).input(test::kConstant);
  items.report_id(7).report_size(16).report_count(2).usage(0x30).input(test::kVariable);
  items.report_id(2).usage(0x30).report_count(1).input(test::kVariable);
  items.usage(0x52).feature(test::kVariable);
  items.end_collection();
  const auto descriptor = parsed(items);
  ASSERT_EQ(descriptor.fields.size(), 5U);
  EXPECT_EQ(descriptor.fields[0].bit_offset, 8U);
  EXPECT_EQ(descriptor.fields[1].bit_offset, 11U);  // padding still takes its bits
  EXPECT_EQ(descriptor.fields[2].bit_offset, 8U);   // another report
  EXPECT_EQ(descriptor.fields[3].bit_offset, 16U);  // report 2 goes on
  EXPECT_EQ(descriptor.fields[4].bit_offset, 8U);   // another kind
  ASSERT_EQ(descriptor.reports.size(), 3U);
  EXPECT_EQ(descriptor.report(ReportKind::kInput, 2)->byte_length, 4U);
  EXPECT_EQ(descriptor.report(ReportKind::kInput, 7)->byte_length, 5U);
  EXPECT_EQ(descriptor.report(ReportKind::kFeature, 2)->byte_length, 3U);
  EXPECT_EQ(descriptor.report(ReportKind::kOutput, 2), nullptr);
  EXPECT_TRUE(descriptor.numbered(ReportKind::kInput));
  EXPECT_FALSE(descriptor.numbered(ReportKind::kOutput));
}

TEST(HidDescriptorParser, UnnumberedReportsStartAtBitZero) {
  Items items = in_pen();
  items.usage(0x42).input(test::kVariable).report_size(3).output(test::kVariable);
  items.end_collection();
  const auto descriptor = parsed(items);
  EXPECT_EQ(descriptor.fields[0].bit_offset, 0U);
  EXPECT_EQ(descriptor.report(ReportKind::kInput, 0)->byte_length, 1U);
  EXPECT_EQ(descriptor.report(ReportKind::kOutput, 0)->byte_length, 1U);  // rounded up
  EXPECT_FALSE(descriptor.numbered(ReportKind::kInput));
}

TEST(HidDescriptorParser, MinimumIsAlwaysSigned) {
  EXPECT_EQ(only_field(in_pen().raw({0x15, 0x81, 0x25, 0x7F}).input(2).end_collection()).logical,
            (Range{-127, 127}));
  EXPECT_EQ(
      only_field(in_pen()
                     .raw({0x16, 0x01, 0x80, 0x26, 0xFF, 0x7F, 0x36, 0xD8, 0xDC, 0x46, 0x28, 0x23})
                     .input(2)
                     .end_collection())
          .physical,
      (Range{-9000, 9000}));
  EXPECT_EQ(only_field(in_pen()
                           .raw({0x17, 0x00, 0x00, 0x00, 0x80, 0x27, 0xFF, 0xFF, 0xFF, 0x7F})
                           .input(2)
                           .end_collection())
                .logical,
            (Range{INT32_MIN, INT32_MAX}));
}

TEST(HidDescriptorParser, MaximumIsUnsignedUnlessTheMinimumIsNegative) {
  EXPECT_EQ(only_field(in_pen().raw({0x15, 0x00, 0x25, 0xFF}).input(2).end_collection()).logical,
            (Range{0, 255}));
  EXPECT_EQ(only_field(in_pen().raw({0x15, 0xFE, 0x25, 0xFF}).input(2).end_collection()).logical,
            (Range{-2, -1}));
  EXPECT_EQ(
      only_field(in_pen().raw({0x35, 0x00, 0x46, 0xA0, 0x8C}).input(2).end_collection()).physical,
      (Range{0, 36000}));
  EXPECT_EQ(
      only_field(in_pen().raw({0x27, 0xFF, 0xFF, 0xFF, 0xFF}).input(2).end_collection()).logical,
      (Range{0, 4294967295}));
}

TEST(HidDescriptorParser, TheOrderOfMinimumAndMaximumDoesNotMatter) {
  EXPECT_EQ(only_field(in_pen().raw({0x25, 0xFF, 0x15, 0x00}).input(2).end_collection()).logical,
            (Range{0, 255}));
  EXPECT_EQ(only_field(in_pen().raw({0x25, 0xFF, 0x15, 0x80}).input(2).end_collection()).logical,
            (Range{-128, -1}));
}

TEST(HidDescriptorParser, UnitExponentIsANibbleOrAByte) {
  const auto exponent = [](std::initializer_list<std::uint8_t> item) {
    return only_field(in_pen().raw(item).input(2).end_collection()).unit_exponent;
  };
  EXPECT_EQ(exponent({0x55, 0x0D}), -3);
  EXPECT_EQ(exponent({0x55, 0xFD}), -3);
  EXPECT_EQ(exponent({0x56, 0xFD, 0xFF}), -3);
  EXPECT_EQ(exponent({0x57, 0xFD, 0xFF, 0xFF, 0xFF}), -3);
  EXPECT_EQ(exponent({0x56, 0x0E, 0x00}), -2);
  EXPECT_EQ(exponent({0x55, 0x07}), 7);
  EXPECT_EQ(exponent({0x55, 0x08}), -8);
  EXPECT_EQ(exponent({0x55, 0x10}), 16);
  EXPECT_EQ(exponent({0x54}), 0);
}

TEST(HidDescriptorParser, UnitExponentBeyondAByteIsZeroWithANote) {
  const auto descriptor = parsed(in_pen().raw({0x56, 0x00, 0x01}).input(2).end_collection());
  EXPECT_EQ(descriptor.fields[0].unit_exponent, 0);
  ASSERT_EQ(descriptor.notes.size(), 1U);
  EXPECT_THAT(descriptor.notes[0].what, HasSubstr("256"));
}

TEST(HidDescriptorParser, UnitsAreUnsigned) {
  EXPECT_EQ(only_field(in_pen().raw({0x66, 0x11, 0xE1}).input(2).end_collection()).unit, 0xE111U);
}

TEST(HidDescriptorParser, ShortUsagesTakeThePageAtTheMainItem) {
  Items items = in_pen();
  items.usage(0x30).full_usage({0xFF0D, 0x132}).usages(1, 2);
  items.usage_page(0x01).report_count(4).input(test::kVariable).end_collection();
  const auto descriptor = parsed(items);
  const Field& field = descriptor.fields[0];
  EXPECT_EQ(descriptor.element_usage(field, 0), usage::kX);
  EXPECT_EQ(descriptor.element_usage(field, 1), usage::kWacomDistance);
  EXPECT_EQ(descriptor.element_usage(field, 2), usage::kPointer);
  EXPECT_EQ(descriptor.element_usage(field, 3), usage::kMouse);
}

TEST(HidDescriptorParser, RangesTakeThePageOfEitherEnd) {
  Items items = in_pen();
  items.report_count(2);
  items.raw({0x1B, 0x01, 0x00, 0x09, 0x00, 0x29, 0x02}).input(test::kVariable);  // page at minimum
  items.raw({0x19, 0x01, 0x2B, 0x02, 0x00, 0x09, 0x00}).input(test::kVariable);  // page at maximum
  items.raw({0x29, 0x02, 0x19, 0x01}).input(test::kVariable);  // the maximum comes first
  items.end_collection();
  const auto descriptor = parsed(items);
  EXPECT_EQ(descriptor.element_usage(descriptor.fields[0], 1), (Usage{0x09, 2}));
  EXPECT_EQ(descriptor.element_usage(descriptor.fields[1], 1), (Usage{0x09, 2}));
  EXPECT_EQ(descriptor.element_usage(descriptor.fields[2], 1), (Usage{0x0D, 2}));
}

TEST(HidDescriptorParser, TheLastUsageRepeats) {
  Items items = in_pen();
  items.report_count(5).usage(0x44).usages(0x30, 0x31).input(test::kVariable).end_collection();
  const auto descriptor = parsed(items);
  const Field& field = descriptor.fields[0];
  EXPECT_EQ(descriptor.element_usage(field, 0), usage::kBarrelSwitch);
  EXPECT_EQ(descriptor.element_usage(field, 1), usage::kTipPressure);
  for (std::uint32_t i = 2; i < 5; ++i) {
    EXPECT_EQ(descriptor.element_usage(field, i), usage::kBarrelPressure) << i;
  }
  EXPECT_EQ(descriptor.element_usage(field, 5), std::nullopt);
}

TEST(HidDescriptorParser, UsagesPastTheCountNameNothing) {
  Items items = in_pen();
  items.report_count(1).usage(0x42).usage(0x44).input(test::kVariable).end_collection();
  const auto descriptor = parsed(items);
  EXPECT_EQ(descriptor.element_usage(descriptor.fields[0], 0), usage::kTipSwitch);
  EXPECT_EQ(descriptor.element_usage(descriptor.fields[0], 1), std::nullopt);
  EXPECT_EQ(descriptor.declared_usage(descriptor.fields[0], 1), usage::kBarrelSwitch);
}

TEST(HidDescriptorParser, AFieldWithoutUsageIsPadding) {
  const auto descriptor = parsed(in_pen().input(test::kVariable).end_collection());
  EXPECT_EQ(descriptor.element_usage(descriptor.fields[0], 0), std::nullopt);
  EXPECT_THAT(descriptor.usages(descriptor.fields[0]), IsEmpty());
}

TEST(HidDescriptorParser, LocalItemsEndAtEveryMainItem) {
  Items items = in_pen();
  items.usage(0x42).raw({0x19, 0x01}).input(test::kVariable);  // a minimum without maximum
  items.raw({0x29, 0x05}).input(test::kVariable).end_collection();
  const auto descriptor = parsed(items);
  EXPECT_EQ(descriptor.element_usage(descriptor.fields[0], 0), usage::kTipSwitch);
  EXPECT_THAT(descriptor.usages(descriptor.fields[1]), IsEmpty());
  EXPECT_EQ(descriptor.notes.size(), 2U);
}

TEST(HidDescriptorParser, PushAndPopSaveAllGlobals) {
  Items items = in_pen();
  items.report_id(3).logical(0, 7).physical(0, 9).unit(0x11).unit_exponent(0x0E).push();
  items.report_id(4).usage_page(0x01).logical(-1, 1).physical(-5, 5).unit(0x14).unit_exponent(1);
  items.report_size(2).report_count(7).pop();
  items.usage(0x42).input(test::kVariable).end_collection();
  const auto descriptor = parsed(items);
  const Field& field = descriptor.fields[0];
  EXPECT_EQ(field.report_id, 3);
  EXPECT_EQ(field.logical, (Range{0, 7}));
  EXPECT_EQ(field.physical, (Range{0, 9}));
  EXPECT_EQ(field.unit, 0x11U);
  EXPECT_EQ(field.unit_exponent, -2);
  EXPECT_EQ(field.bit_size, 8U);
  EXPECT_EQ(field.count, 1U);
  EXPECT_EQ(descriptor.element_usage(field, 0), usage::kTipSwitch);
  EXPECT_THAT(descriptor.notes, IsEmpty());
}

TEST(HidDescriptorParser, PushesLeftOverAreTolerated) {
  const auto descriptor = parsed(in_pen().push().push().usage(0x42).input(2).end_collection());
  EXPECT_EQ(descriptor.fields.size(), 1U);
  EXPECT_EQ(descriptor.notes.size(), 2U);
}

TEST(HidDescriptorParser, OnlyTheFirstDelimitedSetCounts) {
  Items items = in_pen();
  items.report_count(3);
  items.delimiter(true).usage(0x42).usage(0x44).delimiter(false);
  items.delimiter(true).usage(0x45).usages(0x30, 0x31).delimiter(false);
  items.usage(0x5A).input(test::kVariable);
  items.usage(0x32).input(test::kVariable).end_collection();
  const auto descriptor = parsed(items);
  EXPECT_EQ(descriptor.element_usage(descriptor.fields[0], 0), usage::kTipSwitch);
  EXPECT_EQ(descriptor.element_usage(descriptor.fields[0], 1), usage::kBarrelSwitch);
  EXPECT_EQ(descriptor.element_usage(descriptor.fields[0], 2), usage::kSecondaryBarrelSwitch);
  EXPECT_EQ(descriptor.element_usage(descriptor.fields[1], 0), usage::kInRange);
}

TEST(HidDescriptorParser, ACollectionTakesItsUsageFromTheFirstDelimitedSet) {
  Items items;
  items.usage_page(0x0D).delimiter(true).usage(0x02).delimiter(false);
  items.delimiter(true).usage(0x04).delimiter(false).collection(test::kApplication);
  items.end_collection();
  EXPECT_EQ(parsed(items).collections[0].usage, usage::kPen);
}

TEST(HidDescriptorParser, LongItemsAreSkippedWhole) {
  Items items = in_pen();
  // Data that would be Report Size 1, End Collection and a half item.
  items.raw({0xFE, 0x04, 0x55, 0x75, 0x01, 0xC0, 0x27}).usage(0x42).input(test::kVariable);
  items.raw({0xFE, 0x00, 0x12}).end_collection();
  const auto descriptor = parsed(items);
  ASSERT_EQ(descriptor.fields.size(), 1U);
  EXPECT_EQ(descriptor.fields[0].bit_size, 8U);
}

TEST(HidDescriptorParser, KeepsNineFlagBits) {
  const FieldFlags flags = only_field(in_pen().input(0x1FE).end_collection()).flags;
  EXPECT_TRUE(flags.variable() && flags.relative() && flags.wrap() && flags.nonlinear() &&
              flags.no_preferred() && flags.null_state() && flags.is_volatile() &&
              flags.buffered_bytes());
  EXPECT_FALSE(flags.constant());
  const FieldFlags none = only_field(in_pen().item(0x80, 0, 0).end_collection()).flags;
  EXPECT_TRUE(none.array());
  EXPECT_EQ(none.bits(), 0U);
}

TEST(HidDescriptorParser, AnArrayValueIsAnIndexFromLogicalMinimum) {
  Items items = in_pen();
  items.usage_page(0x09).usages(1, 3).usage(0x0A).logical(5, 9).input(test::kArray);
  items.end_collection();
  const auto descriptor = parsed(items);
  const Field& field = descriptor.fields[0];
  EXPECT_EQ(descriptor.selected_usage(field, 4), std::nullopt);
  EXPECT_EQ(descriptor.selected_usage(field, 5), (Usage{0x09, 1}));
  EXPECT_EQ(descriptor.selected_usage(field, 7), (Usage{0x09, 3}));
  EXPECT_EQ(descriptor.selected_usage(field, 8), (Usage{0x09, 10}));
  EXPECT_EQ(descriptor.selected_usage(field, 9), std::nullopt);   // no such usage
  EXPECT_EQ(descriptor.selected_usage(field, 10), std::nullopt);  // outside the range
  EXPECT_EQ(descriptor.element_usage(field, 0), std::nullopt);    // elements have no fixed usage
}

TEST(HidDescriptorParser, WideFieldsAreReal) {
  for (const std::uint32_t bits : {56U, 63U, 64U, 88U, 104U, 256U}) {
    Items items = in_pen();
    items.report_size(bits).usage(0x5B).input(test::kVariable).end_collection();
    EXPECT_EQ(only_field(items).bit_size, bits);
  }
}

TEST(HidDescriptorParser, ToleratesWithANote) {
  const auto notes = [](Items items) { return parsed(items).notes; };
  EXPECT_THAT(notes(in_pen().logical(5, 4).input(2).end_collection()), testing::SizeIs(1));
  EXPECT_THAT(notes(in_pen().usages(5, 4).input(2).end_collection()), testing::SizeIs(1));
  EXPECT_THAT(notes(in_pen().report_count(0).input(2).end_collection()), testing::SizeIs(1));
  EXPECT_THAT(notes(in_pen().report_size(0).input(2).end_collection()), testing::SizeIs(1));
  EXPECT_THAT(notes(in_pen().end_collection().input(2)), testing::SizeIs(1));
  EXPECT_THAT(notes(Items().raw({0x00, 0xD4, 0xB8, 0x0C})), testing::SizeIs(4));  // unknown items
  EXPECT_THAT(notes(in_pen().input(2).report_id(1).input(2).end_collection()), testing::SizeIs(1));
}

struct Fault {
  const char* name;
  Items items;
  ErrorCode code;
  const char* at;
  const char* what;
};

TEST(HidDescriptorParser, FaultsHaveAPlaceAndARemedy) {
  const Fault faults[] = {
      {"empty", Items(), ErrorCode::kMissing, "byte 0", "empty"},
      {"Report ID 0", in_pen().raw({0x85, 0x00}), ErrorCode::kSyntax, "byte 10", "Report ID 0"},
      {"Report ID above a byte", in_pen().report_id(256), ErrorCode::kSyntax, "byte 10", "256"},
      {"item cut short", in_pen().raw({0x27, 0x01, 0x02}), ErrorCode::kSyntax, "byte 10",
       "4 data bytes but 2 follow"},
      {"item without data", Items().raw({0x05}), ErrorCode::kSyntax, "byte 0", "0 follow"},
      {"long item cut short", Items().raw({0xFE, 0x03, 0x00, 0x01}), ErrorCode::kSyntax, "byte 0",
       "5 further bytes but 3 follow"},
      {"long item without length", Items().raw({0x00, 0xFE}), ErrorCode::kSyntax, "byte 1",
       "0 follow"},
      {"collection left open", in_pen(), ErrorCode::kSyntax, "byte 10", "opened at byte 4"},
      {"End Collection too many", in_pen().end_collection().end_collection(), ErrorCode::kSyntax,
       "byte 11", "End Collection"},
      {"Pop without Push", in_pen().pop(), ErrorCode::kSyntax, "byte 10", "Pop"},
      {"nested delimiters", in_pen().delimiter(true).delimiter(true), ErrorCode::kSyntax, "byte 12",
       "nested"},
      {"delimiter not open", in_pen().delimiter(false), ErrorCode::kSyntax, "byte 10", "not open"},
  };
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.name);
    const auto descriptor = parse_descriptor(fault.items.bytes());
    ASSERT_FALSE(descriptor.has_value());
    EXPECT_EQ(descriptor.error().code, fault.code);
    EXPECT_EQ(descriptor.error().at, fault.at);
    EXPECT_THAT(descriptor.error().what, HasSubstr(fault.what));
    EXPECT_FALSE(descriptor.error().remedy.empty());
  }
}

}  // namespace
}  // namespace limn::hid
