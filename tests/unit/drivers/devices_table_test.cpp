// Every rule runs over every row of the tables, so that a new row inherits them.

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "drivers/devices/pen_spec.hpp"
#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

/// Runs a rule over every row; a failure names the device.
template <class Rule>
void for_every_spec(Rule&& rule) {
  for (const PenSpec& spec : pen_specs()) {
    SCOPED_TRACE(spec.name);
    rule(spec);
  }
}

TEST(EveryPenSpec, IsFoundByItsIds) {
  for_every_spec([](const PenSpec& spec) {
    const PenSpec* found = find_pen_spec(spec.vendor, spec.product);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->name, spec.name);
  });
}

TEST(EveryPenSpec, HasAPlausibleSize) {
  for_every_spec([](const PenSpec& spec) {
    // From the smallest (PenStation2, 65 x 46 mm) to the largest (Cintiq 27QHD, 601 x 340 mm).
    EXPECT_GE(spec.width_mm(), 60);
    EXPECT_LE(spec.width_mm(), 610);
    EXPECT_GE(spec.height_mm(), 40);
    EXPECT_LE(spec.height_mm(), 350);
    // Between square and 2 : 1, some 12 x 12 tablets a little taller than wide.
    const double aspect = spec.width_mm() / spec.height_mm();
    EXPECT_GE(aspect, 0.95);
    EXPECT_LE(aspect, 1.8);
  });
}

TEST(EveryPenSpec, HasARangeThatItsReportsCanReach) {
  for_every_spec([](const PenSpec& spec) {
    EXPECT_GT(spec.x_max, 2000);
    EXPECT_LE(spec.x_max, 131071);  // 17 bits, the widest coordinate
    EXPECT_LE(spec.y_max, 131071);
    EXPECT_GE(spec.counts_per_mm, 20);   // 508 lpi
    EXPECT_LE(spec.counts_per_mm, 200);  // 5080 lpi
    const std::set<int> full_scales = {255, 511, 1023, 2047, 4095, 8191};
    EXPECT_EQ(full_scales.count(spec.pressure_max), 1U) << spec.pressure_max;
    const std::set<int> distances = {0, 31, 32, 63};
    EXPECT_EQ(distances.count(spec.distance_max), 1U) << spec.distance_max;
  });
}

TEST(EveryPenSpec, HasANameOfItsVendor) {
  for_every_spec([](const PenSpec& spec) {
    const std::string_view brand = spec.vendor == test::kWacom ? "Wacom " : "Lenovo ";
    EXPECT_EQ(spec.name.substr(0, brand.size()), brand);
    EXPECT_FALSE(name(spec.family).empty());
  });
}

TEST(EveryPenSpec, GivesADecoderWithItsRangeWithoutADescriptor) {
  for_every_spec([](const PenSpec& spec) {
    auto decoder = PenDecoder::make(spec.vendor, spec.product, {});
    ASSERT_TRUE(decoder);
    EXPECT_TRUE(decoder->has_pen());
    EXPECT_EQ(decoder->range().x_max, spec.x_max);
    EXPECT_EQ(decoder->range().width_mm, spec.width_mm());
  });
}

/// A long report of the family's pen with every bit set or clear in turn: whatever it means, what
/// comes out is legal and within its ranges.
TEST(EveryPenSpec, KeepsItsRangesForExtremeReports) {
  for_every_spec([](const PenSpec& spec) {
    test::DecodedDevice device(spec.vendor, spec.product);
    std::vector<PenSample> all;
    std::size_t of_the_pen = 0;
    for (const std::uint8_t id : {1, 2, 3, 4, 0x10, 0x11, 0x80}) {
      for (const std::uint8_t fill : {0xFF, 0xE0, 0xC2, 0xE1, 0x00}) {
        for (const std::size_t size : {10U, 31U, 109U}) {
          test::ReportBytes bytes(size, fill);
          bytes[0] = id;
          for (const bool bundled : {false, true}) {
            // Where Bluetooth bundles packets, each has its own ID.
            if (bundled) bytes[1] = 2;
            for (const PenSample& sample : device(bytes)) all.push_back(sample);
            of_the_pen += device.kind() == ReportClass::kPen ? 1 : 0;
          }
        }
      }
    }
    EXPECT_GT(of_the_pen, 0U);
    EXPECT_FALSE(all.empty());
    test::expect_legal_transitions(all);
    for (const PenSample& sample : all) {
      EXPECT_GE(sample.pressure, 0);
      EXPECT_LE(sample.pressure, 1);
      EXPECT_GE(sample.distance, 0);
      EXPECT_LE(sample.distance, 1);
      EXPECT_LE(std::abs(sample.tilt_x_rad), 1.571);
      EXPECT_LE(std::abs(sample.tilt_y_rad), 1.571);
      EXPECT_GE(sample.twist_rad, 0);
      EXPECT_LE(sample.twist_rad, 6.2832);
      EXPECT_EQ(sample.x_mm, sample.axes.has_position() ? sample.raw.x / spec.counts_per_mm : 0);
    }
  });
}

TEST(PenTable, IdsAreUniqueAndSorted) {
  std::set<std::pair<int, int>> ids;
  std::pair<int, int> before{-1, -1};
  for (const PenSpec& spec : pen_specs()) {
    const std::pair<int, int> id{spec.vendor, spec.product};
    EXPECT_TRUE(ids.insert(id).second) << spec.name;
    EXPECT_LT(before, id);
    before = id;
  }
  EXPECT_EQ(ids.size(), 147U);
}

TEST(PenTable, EveryFamilyHasADevice) {
  std::set<PenFamily> families;
  std::set<std::string_view> names;
  for (const PenSpec& spec : pen_specs()) families.insert(spec.family);
  EXPECT_EQ(families.size(), static_cast<std::size_t>(kPenFamilyCount));
  for (const PenFamily family : families) names.insert(name(family));
  EXPECT_EQ(names.size(), families.size());
}

TEST(PenTable, UnknownIdsHaveNoRow) {
  EXPECT_EQ(find_pen_spec(0, 0), nullptr);
  EXPECT_EQ(find_pen_spec(test::kWacom, 0xFFFF), nullptr);
  EXPECT_EQ(find_pen_spec(0xFFFF, 0x0013), nullptr);
  EXPECT_EQ(find_pen_spec(test::kWacom, 0x0001), nullptr);
}

}  // namespace
}  // namespace limn
