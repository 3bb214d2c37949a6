// Hostile descriptors: each limit is an error with its place, and what lies just below it parses.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "drivers/hid/describe.hpp"
#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/pen_layout.hpp"
#include "tests/unit/drivers/hid_items.hpp"

namespace limn::hid {
namespace {

using test::Items;
using testing::HasSubstr;

void expect_limit(const Items& items, const std::string& at, const std::string& what) {
  const auto descriptor = parse_descriptor(items.bytes());
  ASSERT_FALSE(descriptor.has_value());
  EXPECT_EQ(descriptor.error().code, ErrorCode::kLimit);
  EXPECT_EQ(descriptor.error().at, at);
  EXPECT_THAT(descriptor.error().what, HasSubstr(what));
  EXPECT_FALSE(descriptor.error().remedy.empty());
}

TEST(HidLimits, AMillionCollections) {
  const std::vector<std::uint8_t> open(2'000'000, 0xA1);
  const auto descriptor = parse_descriptor(open);
  ASSERT_FALSE(descriptor.has_value());
  EXPECT_EQ(descriptor.error().code, ErrorCode::kLimit);
  EXPECT_EQ(descriptor.error().at, "byte 65535");
}

TEST(HidLimits, Collections) {
  Items items;
  for (std::size_t i = 0; i < kMaxCollections; ++i) items.collection(0).end_collection();
  ASSERT_TRUE(parse_descriptor(items.bytes()).has_value());
  expect_limit(items.collection(0).end_collection(), "byte 12288", "4096 collections");
}

TEST(HidLimits, Depth) {
  const auto nested = [](std::size_t depth) {
    Items items;
    for (std::size_t i = 0; i < depth; ++i) items.collection(0);
    for (std::size_t i = 0; i < depth; ++i) items.end_collection();
    return items;
  };
  EXPECT_TRUE(parse_descriptor(nested(kMaxCollectionDepth).bytes()).has_value());
  expect_limit(nested(kMaxCollectionDepth + 1), "byte 128", "deeper than 64");
}

TEST(HidLimits, Pushes) {
  Items items;
  for (std::size_t i = 0; i < kMaxPushDepth; ++i) items.push();
  EXPECT_TRUE(parse_descriptor(items.bytes()).has_value());
  expect_limit(items.push(), "byte 64", "pushes");
}

TEST(HidLimits, ReportSize) {
  EXPECT_TRUE(parse_descriptor(Items().report_size(256).bytes()).has_value());
  expect_limit(Items().report_size(257), "byte 0", "257");
  expect_limit(Items().report_size(0xFFFFFFFF), "byte 0", "4294967295");
}

TEST(HidLimits, SizeTimesCountDoesNotOverflow) {
  // 256 x 2^24 bits is 0 in 32 bits.
  expect_limit(Items().report_size(256).report_count(1U << 24).input(test::kVariable), "byte 8",
               "16384 bytes");
  expect_limit(Items().report_size(32).report_count(0xFFFFFFFF).feature(test::kVariable), "byte 7",
               "16384 bytes");
}

TEST(HidLimits, ReportLengthIncludesTheId) {
  const auto report = [](std::uint32_t bytes) {
    return Items().report_id(1).report_size(8).report_count(bytes).input(test::kConstant);
  };
  const auto largest = parse_descriptor(report(kMaxReportBytes - 1).bytes());
  ASSERT_TRUE(largest.has_value());
  EXPECT_EQ(largest->report(ReportKind::kInput, 1)->byte_length, kMaxReportBytes);
  expect_limit(report(kMaxReportBytes), "byte 7", "16384 bytes");
  // Also where many fields add up.
  Items two = report(kMaxReportBytes - 1);
  expect_limit(two.report_count(1).input(test::kConstant), "byte 11", "16384 bytes");
}

TEST(HidLimits, Fields) {
  Items items;
  items.report_size(1).report_count(1);
  for (std::size_t i = 0; i < kMaxFields; ++i) items.input(test::kVariable);
  EXPECT_TRUE(parse_descriptor(items.bytes()).has_value());
  expect_limit(items.input(test::kVariable), "byte 16388", "8192 fields");
}

TEST(HidLimits, BigCountsStayOneField) {
  Items items;
  items.usage_page(0x0D).usage(0x02).collection(test::kApplication);
  items.report_size(1).report_count(kMaxReportBytes * 8).usages(0, 0xFFFF).input(test::kVariable);
  items.end_collection();
  const auto descriptor = parse_descriptor(items.bytes());
  ASSERT_TRUE(descriptor.has_value());
  EXPECT_EQ(descriptor->fields.size(), 1U);
  EXPECT_EQ(descriptor->usage_ranges.size(), 1U);
  EXPECT_EQ(descriptor->element_usage(descriptor->fields[0], 0x42), usage::kTipSwitch);
  EXPECT_EQ(descriptor->element_usage(descriptor->fields[0], 0x1FFFF), (Usage{0x0D, 0xFFFF}));
  EXPECT_EQ(describe(*descriptor).rows.size(), 1U);
}

TEST(HidLimits, NotesAreBounded) {
  const std::vector<std::uint8_t> unknown(kMaxDescriptorBytes, 0x00);
  const auto descriptor = parse_descriptor(unknown);
  ASSERT_TRUE(descriptor.has_value());
  EXPECT_EQ(descriptor->notes.size(), kMaxNotes);
}

TEST(HidLimits, TransducersAreBounded) {
  Items items;
  items.usage_page(0x0D).usage(0x04).collection(test::kApplication);
  items.report_size(8).report_count(1);
  for (int i = 0; i < 300; ++i) {
    items.usage_page(0x0D).usage(0x22).collection(test::kLogical);
    items.usage(0x42).input(test::kVariable);
    items.usage_page(0x01).usage(0x30).input(test::kVariable).usage(0x31).input(test::kVariable);
    items.end_collection();
  }
  items.end_collection();
  const auto descriptor = parse_descriptor(items.bytes());
  ASSERT_TRUE(descriptor.has_value());
  EXPECT_EQ(transducer_layouts(*descriptor).size(), kMaxTransducers);
}

TEST(HidLimits, DescriptionRowsAreBounded) {
  Items items;
  items.usage_page(0x0D).usage(0x02).collection(test::kApplication);
  items.report_size(1).report_count(20000);
  for (std::uint32_t i = 0; i < 20000; ++i) items.usage(0x30 + i % 2);
  items.input(test::kVariable).end_collection();
  const auto descriptor = parse_descriptor(items.bytes());
  ASSERT_TRUE(descriptor.has_value());
  const Description description = describe(*descriptor);
  EXPECT_EQ(description.rows.size(), kMaxDescriptionRows);
  EXPECT_FALSE(description.complete);
  EXPECT_THAT(to_text(description), HasSubstr("only the first 10000 rows"));
}

}  // namespace
}  // namespace limn::hid
