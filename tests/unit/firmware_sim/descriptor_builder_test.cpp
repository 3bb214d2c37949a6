#include "firmware_sim/usb/descriptor_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

namespace limn::firmware {
namespace {

using testing::ElementsAre;

std::vector<std::uint8_t> bytes(const DescriptorBuilder& built) {
  return {built.bytes().begin(), built.bytes().end()};
}

constexpr Usage kVendorControl{UsagePage{0xFF00}, 0x0123};

TEST(DescriptorBuilder, RangesTakeTheShortestSignedForm) {
  // The first Logical Minimum is told even though it is 0; then only what changes.
  EXPECT_THAT(bytes(DescriptorBuilder().logical({0, 127})), ElementsAre(0x15, 0x00, 0x25, 0x7F));
  EXPECT_THAT(bytes(DescriptorBuilder().logical({-128, 128})),
              ElementsAre(0x15, 0x80, 0x26, 0x80, 0x00));
  EXPECT_THAT(bytes(DescriptorBuilder().logical({-129, 32767})),
              ElementsAre(0x16, 0x7F, 0xFF, 0x26, 0xFF, 0x7F));
  EXPECT_THAT(bytes(DescriptorBuilder().logical({-32769, 32768})),
              ElementsAre(0x17, 0xFF, 0x7F, 0xFF, 0xFF, 0x27, 0x00, 0x80, 0x00, 0x00));
  EXPECT_THAT(bytes(DescriptorBuilder().physical({-1, 1})), ElementsAre(0x35, 0xFF, 0x45, 0x01));
}

TEST(DescriptorBuilder, UnsignedItemsUseAllBitsOfAByte) {
  EXPECT_THAT(bytes(DescriptorBuilder().report_id(ReportId{255})), ElementsAre(0x85, 0xFF));
  EXPECT_THAT(bytes(DescriptorBuilder().report_size(8, 200)), ElementsAre(0x75, 8, 0x95, 200));
  EXPECT_THAT(bytes(DescriptorBuilder().report_size(1, 256)),
              ElementsAre(0x75, 1, 0x96, 0x00, 0x01));
  EXPECT_THAT(bytes(DescriptorBuilder().usage(kVendorControl)),
              ElementsAre(0x06, 0x00, 0xFF, 0x0A, 0x23, 0x01));
}

TEST(DescriptorBuilder, AUnitExponentIsANibble) {
  EXPECT_THAT(bytes(DescriptorBuilder().unit(Unit::kCentimeter, -1)),
              ElementsAre(0x65, 0x11, 0x55, 0x0F));
  EXPECT_THAT(bytes(DescriptorBuilder().unit(Unit::kSecond, -4)),
              ElementsAre(0x66, 0x01, 0x10, 0x55, 0x0C));
  EXPECT_THAT(bytes(DescriptorBuilder().unit(Unit::kDegree, 7)),
              ElementsAre(0x65, 0x14, 0x55, 0x07));
}

TEST(DescriptorBuilder, GlobalItemsAreWrittenWhereTheyChangeOnly) {
  DescriptorBuilder built;
  built.logical({0, 1}).report_size(1, 2).unit(Unit::kNone).physical(kNoPhysical);
  const std::size_t size = built.size();
  built.logical({0, 1}).report_size(1, 2).unit(Unit::kNone).physical(kNoPhysical);
  EXPECT_EQ(built.size(), size);
  built.logical({0, 3});
  EXPECT_THAT(bytes(built).back(), 3);
  EXPECT_EQ(built.size(), size + 2);
}

TEST(DescriptorBuilder, AUsageOfAnotherPageInOneMainItemCarriesItsPage) {
  // Short usages take the page in force at the main item, so a second Usage Page would move X.
  EXPECT_THAT(bytes(DescriptorBuilder().usage(usages::kX).usage(usages::kTipSwitch)),
              ElementsAre(0x05, 0x01, 0x09, 0x30, 0x0B, 0x42, 0x00, 0x0D, 0x00));
}

TEST(DescriptorBuilder, OutputAndFeatureReportsAreCountedByThemselves) {
  DescriptorBuilder built;
  constexpr ReportId kIndicators{4};  // clang 14 crashes on the same expression as an argument
  built.report_id(kIndicators).usage(usages::kGenericIndicator).logical({0, 1}).report_size(1);
  const std::size_t before = built.size();
  built.output(InputFlags::kVariable).report_size(7).output(InputFlags::kConstant);
  EXPECT_THAT(bytes(built).at(before), 0x91);
  EXPECT_THAT(std::vector<std::uint8_t>(built.bytes().begin() + before, built.bytes().end()),
              ElementsAre(0x91, 0x02, 0x75, 0x07, 0x91, 0x03));
  built.usage(usages::kVendor1).report_size(8, 2).feature(InputFlags::kVariable);
  EXPECT_THAT(bytes(built)[built.size() - 2], 0xB1);
  EXPECT_TRUE(built.is_well_formed());
  EXPECT_EQ(built.report_bytes(kIndicators), 1U) << "no input";
  built.usage(usages::kVendor1).report_size(3, 1).feature(InputFlags::kVariable);
  EXPECT_FALSE(built.is_well_formed()) << "a feature report of no whole bytes";
}

TEST(DescriptorBuilder, ARangeOfUsagesAndAnArrayOfThem) {
  DescriptorBuilder buttons;
  buttons.usage_range(usages::button(1), 3).logical({0, 1}).report_size(1, 3);
  EXPECT_THAT(bytes(buttons), ElementsAre(0x05, 0x09, 0x19, 0x01, 0x29, 0x03, 0x15, 0x00, 0x25,
                                          0x01, 0x75, 0x01, 0x95, 0x03));
  EXPECT_TRUE(buttons.input(InputFlags::kVariable).padding(5).is_well_formed());

  DescriptorBuilder keys;
  keys.usage_range(usages::button(1), 200).logical({0, 200}).report_size(8, 6);
  EXPECT_TRUE(DescriptorBuilder(keys).input(InputFlags::kArray).is_well_formed());
  EXPECT_FALSE(DescriptorBuilder(keys).input(InputFlags::kVariable).is_well_formed())
      << "more usages than fields";
  EXPECT_FALSE(DescriptorBuilder().usage_range(usages::button(2), 1).is_well_formed());
}

TEST(DescriptorBuilder, ARelativeFieldSaysSo) {
  DescriptorBuilder built;
  built.usage(usages::kX).logical({-127, 127}).report_size(8).input(InputFlags::kRelative);
  EXPECT_TRUE(built.is_well_formed());
  EXPECT_THAT(bytes(built).back(), 0x06);
}

TEST(DescriptorBuilder, ATableSharesMainItemsAndFillsGaps) {
  constexpr FieldSpec kTwoSwitchesAndX[] = {
      {usages::kTipSwitch, 0, 1, {0, 1}, kNoPhysical, Unit::kNone, 0},
      {usages::kInRange, 1, 1, {0, 1}, kNoPhysical, Unit::kNone, 0},
      {usages::kX, 8, 8, {0, 100}, {0, 1}, Unit::kInch, 0},
  };
  const auto built = DescriptorBuilder().input_fields(kTwoSwitchesAndX, 24);
  EXPECT_TRUE(built.is_well_formed());
  EXPECT_THAT(bytes(built), ElementsAre(0x05, 0x0D, 0x09, 0x42, 0x09, 0x32,  // two usages
                                        0x15, 0x00, 0x25, 0x01,              // 0..1
                                        0x75, 0x01, 0x95, 0x02, 0x81, 0x02,  // in one main item
                                        0x75, 0x06, 0x95, 0x01, 0x81, 0x03,  // six bits of padding
                                        0x05, 0x01, 0x09, 0x30, 0x25, 0x64,  // X, 0..100
                                        0x45, 0x01, 0x65, 0x13,              // 0..1 inch
                                        0x75, 0x08, 0x81, 0x02,              //
                                        0x81, 0x03));                        // a byte of padding
}

DescriptorBuilder one_byte() {
  DescriptorBuilder built;
  built.application(usages::kPen).report_id(ReportId{7});
  built.usage(usages::kTipPressure).logical({0, 255}).report_size(8);
  return built;
}

TEST(DescriptorBuilder, AWholeDescriptorIsWellFormedAndKnowsItsReport) {
  auto built = one_byte();
  built.input(InputFlags::kVariable);
  EXPECT_FALSE(built.is_well_formed()) << "the collection is still open";
  built.end_collection();
  EXPECT_TRUE(built.is_well_formed());
  EXPECT_EQ(built.report_bytes(ReportId{7}), 2U);
}

TEST(DescriptorBuilder, IllFormedDescriptorsAreSeen) {
  const auto well_formed_with = [](auto&& change) {
    auto built = one_byte();
    change(built);
    return built.end_collection().is_well_formed();
  };
  EXPECT_TRUE(well_formed_with([](auto& b) { b.input(InputFlags::kVariable); }));
  EXPECT_FALSE(well_formed_with([](auto& b) { b.input(InputFlags::kConstant); }))
      << "a constant with a usage";
  EXPECT_FALSE(well_formed_with([](auto& b) {
    b.input(InputFlags::kVariable).input(InputFlags::kVariable);
  })) << "a variable without a usage";
  EXPECT_FALSE(well_formed_with([](auto& b) {
    b.logical({0, 256}).input(InputFlags::kVariable);
  })) << "counts that do not fit";
  EXPECT_FALSE(well_formed_with([](auto& b) { b.logical({1, 1}).input(InputFlags::kVariable); }));
  EXPECT_FALSE(well_formed_with([](auto& b) {
    b.usage(usages::kTiltX).input(InputFlags::kVariable);
  })) << "more usages than fields";
  EXPECT_FALSE(well_formed_with([](auto& b) { b.report_size(33).input(InputFlags::kVariable); }));
  EXPECT_FALSE(well_formed_with([](auto& b) { b.input(InputFlags::kVariable).padding(3); }))
      << "no whole bytes";
  EXPECT_FALSE(well_formed_with([](auto& b) {
    b.input(InputFlags::kVariable).report_id(ReportId{7});
  })) << "an ID used twice";
  EXPECT_FALSE(well_formed_with([](auto& b) { b.input(InputFlags::kVariable).end_collection(); }))
      << "a collection closed twice";
  EXPECT_FALSE(well_formed_with([](auto& b) { b.input(InputFlags::kVariable).usage(usages::kX); }))
      << "a usage left over";
  EXPECT_FALSE(DescriptorBuilder().padding(8).report_id(ReportId{1}).padding(8).is_well_formed())
      << "fields before the first ID";
}

TEST(DescriptorBuilder, MoreItemsThanItHoldsAreSeenAndNotWritten) {
  DescriptorBuilder built;
  for (std::size_t i = 0; i < DescriptorBuilder::kCapacity; ++i) built.padding(8);
  EXPECT_FALSE(built.is_well_formed());
  EXPECT_EQ(built.size(), DescriptorBuilder::kCapacity);
}

}  // namespace
}  // namespace limn::firmware
