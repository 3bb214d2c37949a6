#include "firmware_sim/usb/report_field.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

namespace limn::firmware {
namespace {

using testing::ElementsAre;

constexpr FieldSpec switch_at(std::uint16_t bit, Usage usage) {
  return {usage, bit, 1, {0, 1}, kNoPhysical, Unit::kNone, 0};
}

TEST(ReportField, FitsKnowsTheEndsOfEachWidth) {
  EXPECT_TRUE(fits({0, 1}, 1));
  EXPECT_FALSE(fits({0, 2}, 1));
  EXPECT_TRUE(fits({0, 65535}, 16));
  EXPECT_FALSE(fits({0, 65536}, 16));
  EXPECT_TRUE(fits({-128, 127}, 8));
  EXPECT_FALSE(fits({-129, 127}, 8));
  EXPECT_FALSE(fits({-1, 128}, 8));
  EXPECT_TRUE(fits({INT32_MIN, INT32_MAX}, 32));
  EXPECT_FALSE(fits({0, 1}, 0));
  EXPECT_FALSE(fits({0, 1}, 33));
  EXPECT_FALSE(fits({1, 1}, 8)) << "an empty range";
}

TEST(ReportField, ATableIsOrderedDisjointAndInsideItsReport) {
  const std::vector<FieldSpec> good = {switch_at(0, usages::kTipSwitch),
                                       switch_at(1, usages::kInRange)};
  EXPECT_TRUE(is_well_formed(good, 8));
  EXPECT_FALSE(is_well_formed(good, 9)) << "no whole bytes";
  EXPECT_FALSE(is_well_formed(std::vector<FieldSpec>{}, 8));

  auto overlapping = good;
  overlapping[1].bit = 0;
  EXPECT_FALSE(is_well_formed(overlapping, 8));

  auto outside = good;
  outside[1].bit = 8;
  EXPECT_FALSE(is_well_formed(outside, 8));
  EXPECT_TRUE(is_well_formed(outside, 16));

  auto same_usage = good;
  same_usage[1].usage = usages::kTipSwitch;
  EXPECT_FALSE(is_well_formed(same_usage, 8));
}

TEST(ReportField, APhysicalRangeAndAUnitComeTogether) {
  const FieldSpec x = {usages::kX, 0, 16, {0, 42000}, {0, 210}, Unit::kCentimeter, -1};
  EXPECT_TRUE(is_well_formed(std::array{x}, 16));
  FieldSpec without_unit = x;
  without_unit.unit = Unit::kNone;
  EXPECT_FALSE(is_well_formed(std::array{without_unit}, 16));
  FieldSpec without_size = x;
  without_size.physical = kNoPhysical;
  EXPECT_FALSE(is_well_formed(std::array{without_size}, 16));
  FieldSpec reversed = x;
  reversed.physical = {210, 0};
  EXPECT_FALSE(is_well_formed(std::array{reversed}, 16));
}

TEST(ReportField, PutWritesItsBitsAloneLowestFirst) {
  const FieldSpec field = {usages::kX, 4, 12, {0, 4095}, kNoPhysical, Unit::kNone, 0};
  std::array<std::uint8_t, 3> zeros{};
  put_field(zeros, field, 0xABC);
  EXPECT_THAT(zeros, ElementsAre(0xC0, 0xAB, 0x00));
  std::array<std::uint8_t, 3> ones{0xFF, 0xFF, 0xFF};
  put_field(ones, field, 0xABC);
  EXPECT_THAT(ones, ElementsAre(0xCF, 0xAB, 0xFF));
}

TEST(ReportField, PutWritesTwosComplementAndKeepsToTheLogicalRange) {
  const FieldSpec tilt = {usages::kTiltX, 0, 16, {-9000, 9000}, kNoPhysical, Unit::kNone, 0};
  std::array<std::uint8_t, 2> bytes{};
  put_field(bytes, tilt, -1);
  EXPECT_THAT(bytes, ElementsAre(0xFF, 0xFF));
  put_field(bytes, tilt, -100000);
  EXPECT_THAT(bytes, ElementsAre(0xD8, 0xDC));  // -9000
  put_field(bytes, tilt, 100000);
  EXPECT_THAT(bytes, ElementsAre(0x28, 0x23));  // 9000
}

}  // namespace
}  // namespace limn::firmware
