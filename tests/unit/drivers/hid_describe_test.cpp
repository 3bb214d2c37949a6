#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/hid/describe.hpp"
#include "tests/unit/drivers/hid_items.hpp"

namespace limn::hid {
namespace {

using test::Items;
using testing::HasSubstr;
using testing::SizeIs;

Description described(const Items& items) {
  const auto descriptor = parse_descriptor(items.bytes());
  EXPECT_TRUE(descriptor.has_value()) << descriptor.error().at << ": " << descriptor.error().what;
  return descriptor ? describe(*descriptor) : Description{};
}

Items example() {
  Items items;
  items.usage_page(0x0D).usage(0x02).collection(test::kApplication).report_id(2);
  items.usage(0x20).collection(test::kPhysical).logical(0, 1).report_size(1).report_count(2);
  items.usage(0x42).usage(0x32).input(test::kVariable);
  items.usage_page(0x09).usages(1, 3).report_count(3).input(test::kVariable);
  items.usage_page(0x0D).report_count(3).input(test::kConstant);
  items.push().usage_page(0x01).logical(0, 20000).physical(0, 100).unit(0x11).unit_exponent(0x0F);
  items.report_size(16).report_count(1).usage(0x30).input(test::kNullState);
  items.usage(0x31).input(test::kVariable).pop();
  items.report_size(8).report_count(1).logical(-90, 90).physical(-90, 90).unit(0x14).usage(0x3D);
  items.input(test::kVariable);
  items.unit(0).physical(0, 0).usage_page(0xFF00).usage(1).report_count(4).input(test::kVariable);
  items.usage_page(0x07).usages(4, 10).logical(0, 6).input(test::kArray);
  return items.push().end_collection().end_collection();
}

TEST(HidDescribe, OneRowAUsage) {
  const Description description = described(example());
  ASSERT_THAT(description.rows, SizeIs(9));
  const FieldRow& tip = description.rows[0];
  EXPECT_EQ(tip.usage, "Tip Switch");
  EXPECT_EQ(tip.collections, "Pen > Stylus");
  EXPECT_EQ(tip.count, 1U);
  EXPECT_EQ(description.rows[1].usage, "In Range");
  EXPECT_EQ(description.rows[1].bit_offset, 9U);
  EXPECT_EQ(description.rows[2].usage, "Button 1 .. Button 3");
  EXPECT_EQ(description.rows[2].count, 3U);
  EXPECT_TRUE(description.rows[3].padding);
  EXPECT_EQ(description.rows[7].usage, "0xFF00:0001");
  EXPECT_EQ(description.rows[7].count, 4U);
  EXPECT_TRUE(description.rows[8].array);
  EXPECT_EQ(description.rows[8].usage, "0x0007:0004 .. 0x0007:000A");
}

TEST(HidDescribe, PhysicalRangesInPlainUnits) {
  const Description description = described(example());
  const FieldRow& x = description.rows[4];
  EXPECT_EQ(x.usage, "X");
  EXPECT_EQ(x.unit, "cm");
  EXPECT_EQ(x.flags, "null state");
  EXPECT_EQ(x.minimum, 0.0);
  EXPECT_EQ(x.maximum, 100.0);
  EXPECT_EQ(x.counts_per_mm, 200.0);
  const FieldRow& tilt = description.rows[6];
  EXPECT_EQ(unit_of(tilt.quantity), "deg");
  EXPECT_NEAR(tilt.minimum.value(), -90.0, 1e-12);
  EXPECT_FALSE(tilt.counts_per_mm.has_value());
  EXPECT_FALSE(description.rows[0].minimum.has_value());
}

TEST(HidDescribe, CollectionsReportsAndTransducers) {
  const Description description = described(example());
  ASSERT_THAT(description.collections, SizeIs(2));
  EXPECT_EQ(description.collections[1].depth, 1U);
  EXPECT_EQ(description.collections[1].type, "physical");
  ASSERT_THAT(description.reports, SizeIs(1));
  EXPECT_EQ(description.reports[0].byte_length, 15U);
  ASSERT_THAT(description.transducers, SizeIs(1));
  EXPECT_EQ(description.transducers[0].name, "pen");
  EXPECT_EQ(description.transducers[0].axes, "x, y, tilt x");
  EXPECT_EQ(description.transducers[0].switches, "tip, in range");
  EXPECT_THAT(description.notes, SizeIs(1));
}

TEST(HidDescribe, RepeatedUsagesShareARow) {
  Items items;
  items.usage_page(0x0D).usage(0x02).collection(test::kApplication).report_size(1).report_count(9);
  items.usage(0x42).usage(0x44).usage(0x44).usage(0x45).usage(0x45).usage(0x3C);
  items.input(test::kVariable).end_collection();
  const Description description = described(items);
  ASSERT_THAT(description.rows, SizeIs(4));
  EXPECT_EQ(description.rows[1].count, 2U);
  EXPECT_EQ(description.rows[2].bit_offset, 3U);
  EXPECT_EQ(description.rows[3].count, 4U);  // the last usage repeats
}

TEST(HidDescribe, TextIsAlignedAndComplete) {
  const std::string text = to_text(described(example()));
  EXPECT_THAT(text, HasSubstr("input report 2, 15 bytes\n"));
  EXPECT_THAT(text, HasSubstr("0 .. 100 mm"));
  EXPECT_THAT(text, HasSubstr("200/mm (5080 lpi)"));
  EXPECT_THAT(text, HasSubstr("Push without a Pop"));
  EXPECT_THAT(text, testing::Not(HasSubstr(" \n")));
  // The columns of X and Y start where their heading does.
  const auto column_of = [&text](const std::string& line_start, const std::string& word) {
    const std::size_t line = text.find(line_start);
    return text.find(word, line) - (line == 0 ? 0 : text.rfind('\n', line) + 1);
  };
  const std::size_t usage = column_of("  byte.bit", "usage");
  EXPECT_EQ(column_of("  2.0 ", "X"), usage);
  EXPECT_EQ(column_of("  4.0 ", "Y"), usage);
  EXPECT_EQ(column_of("  2.0 ", "200/mm"), column_of("  byte.bit", "resolution"));
}

TEST(HidDescribe, AnEmptyDescriptionStillSpeaks) {
  EXPECT_EQ(to_text(described(Items().usage_page(1))), "2 bytes\n");
}

}  // namespace
}  // namespace limn::hid
