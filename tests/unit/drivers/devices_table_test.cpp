// Every rule runs over every row of the tables, so that a new row inherits them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "drivers/devices/pen_spec.hpp"
#include "tests/support/recordings.hpp"
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

TEST(EveryPenSpec, IsFoundByItsIdsAndConditions) {
  for_every_spec([](const PenSpec& spec) {
    const PenForms forms = find_pen_forms(test::identity_of(spec));
    EXPECT_EQ(std::count(forms.rows.begin(), forms.rows.begin() + forms.count, &spec), 1);
    if (!spec.unconditional()) return;
    const PenSpec* found = find_pen_spec(spec.vendor, spec.product);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->vendor, spec.vendor);
    EXPECT_EQ(found->product, spec.product);
    EXPECT_TRUE(found->unconditional());
  });
}

TEST(EveryPenSpec, HasAPlausibleSize) {
  for_every_spec([](const PenSpec& spec) {
    // From the smallest (PenStation2, 65 x 46 mm) to the largest (Cintiq 27QHD, 601 x 340 mm).
    EXPECT_GE(spec.width_mm(), 60);
    EXPECT_LE(spec.width_mm(), 610);
    EXPECT_GE(spec.height_mm(), 40);
    EXPECT_LE(spec.height_mm(), 350);
    // Between square and 16 : 9 (a little more where displays count beyond their picture), some
    // 12 x 12 tablets a little taller than wide.
    const double aspect = spec.width_mm() / spec.height_mm();
    EXPECT_GE(aspect, 0.95);
    EXPECT_LE(aspect, 1.83);
  });
}

TEST(EveryPenSpec, HasARangeThatItsReportsCanReach) {
  for_every_spec([](const PenSpec& spec) {
    EXPECT_GT(spec.x_max, 2000);
    EXPECT_LE(spec.x_max, 131071);  // 17 bits, the widest coordinate
    EXPECT_LE(spec.y_max, 131071);
    EXPECT_GE(spec.counts_per_mm, 20);  // 508 lpi
    EXPECT_LE(spec.counts_per_mm, 5120 / 25.4);
    EXPECT_GE(spec.y_counts_per_mm(), 20);
    // 5120 lpi; before its initialisation a tablet stretches its shorter side over the range of the
    // longer one.
    EXPECT_LE(spec.y_counts_per_mm(), spec.report_id != 0 ? 260 : 5120 / 25.4);
    const std::set<int> full_scales = {255, 511, 1023, 2047, 4095, 8191, 16383};
    if (spec.family == PenFamily::kKyeMouse) return;  // no pressure
    EXPECT_EQ(full_scales.count(spec.pressure_max), 1U) << spec.pressure_max;
    const std::set<int> distances = {0, 31, 32, 63};
    EXPECT_EQ(distances.count(spec.distance_max), 1U) << spec.distance_max;
  });
}

TEST(EveryPenSpec, HasANameOfItsVendor) {
  const std::map<int, std::set<std::string_view>> brands = {
      {test::kWacom, {"Wacom"}},
      {0x17EF, {"Lenovo"}},
      {0x0458, {"Genius"}},
      {0x256C, {"Huion"}},
      {0x28BD, {"XP-Pen", "UGEE", "Parblo"}},
      {0x2FEB, {"VEIKK"}},
      {0x5543, {"UC-Logic", "XP-Pen", "UGEE"}}};
  for_every_spec([&brands](const PenSpec& spec) {
    ASSERT_EQ(brands.count(spec.vendor), 1U);
    EXPECT_EQ(brands.at(spec.vendor).count(spec.name.substr(0, spec.name.find(' '))), 1U);
    EXPECT_FALSE(name(spec.family).empty());
  });
}

TEST(EveryPenSpec, SaysWhatItRestsOn) {
  for_every_spec([](const PenSpec& spec) {
    EXPECT_EQ(spec.evidence.empty(), spec.family <= kLastWacomFamily) << "Wacom's: one comment";
  });
}

TEST(EveryPenSpec, RestsOnARecordingThatExists) {
  LIMN_NEEDS_RECORDINGS();
  std::size_t recorded = 0;
  for_every_spec([&recorded](const PenSpec& spec) {
    const auto space = spec.evidence.find(' ');
    const std::string_view kind = spec.evidence.substr(0, space);
    if (kind != "recording" && kind != "probe") return;
    const std::filesystem::path folder = test::shared_folder() / "traces/pens-usbhid-dump" /
                                         std::string(spec.evidence.substr(space + 1));
    EXPECT_TRUE(std::filesystem::exists(folder)) << folder;
    ++recorded;
  });
  EXPECT_GE(recorded, 8U);
}

TEST(EveryPenSpec, GivesADecoderWithItsRangeWithoutADescriptor) {
  for_every_spec([](const PenSpec& spec) {
    const PenIdentity identity = test::identity_of(spec);
    auto decoder = PenDecoder::make(identity, {});
    ASSERT_TRUE(decoder);
    EXPECT_TRUE(decoder->has_pen());
    if (find_pen_forms(identity).rows[0] != &spec) return;  // until such a report comes
    EXPECT_EQ(decoder->range().x_max, spec.x_max);
    EXPECT_EQ(decoder->range().width_mm, spec.width_mm());
    EXPECT_EQ(decoder->range().height_mm, spec.height_mm());
  });
}

/// A long report of the family's pen with every bit set or clear in turn: whatever it means, what
/// comes out is legal and within its ranges.
TEST(EveryPenSpec, KeepsItsRangesForExtremeReports) {
  for_every_spec([](const PenSpec& spec) {
    test::DecodedDevice device(test::identity_of(spec));
    std::vector<PenSample> all;
    std::size_t of_the_pen = 0;
    for (const std::uint8_t id : {1, 2, 3, 4, 7, 8, 9, 0x0A, 0x10, 0x11, 0x80}) {
      for (const std::uint8_t fill : {0xFF, 0xE0, 0xC2, 0xE1, 0xA9, 0x00}) {
        for (const std::size_t size : {10U, 31U, 109U}) {
          test::ReportBytes bytes(size, fill);
          bytes[0] = id;
          // Where Bluetooth bundles packets, each has its own ID; VEIKK's second byte names the
          // tool.
          for (const std::uint8_t second : {fill, std::uint8_t{0x02}, std::uint8_t{0x41}}) {
            bytes[1] = second;
            for (const PenSample& sample : device(bytes)) {
              all.push_back(sample);
              if (!sample.axes.has_position()) continue;
              const PenSpec& spoke = *device.decoder().spec();
              EXPECT_EQ(sample.x_mm, sample.raw.x / spoke.counts_per_mm);
              EXPECT_EQ(sample.y_mm, sample.raw.y / spoke.y_counts_per_mm());
            }
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
    }
  });
}

TEST(PenTable, RowsAreUniqueAndSorted) {
  using Key = std::tuple<int, int, int, std::string_view, std::string_view, int>;
  std::set<Key> keys;
  std::tuple<int, int, bool> before{-1, -1, false};
  for (const PenSpec& spec : pen_specs()) {
    const Key key{spec.vendor,   spec.product,      form_report_id(spec),
                  spec.firmware, spec.product_name, spec.descriptor_bytes};
    EXPECT_TRUE(keys.insert(key).second) << spec.name;
    const std::tuple<int, int, bool> place{spec.vendor, spec.product, !spec.unconditional()};
    EXPECT_LE(before, place);
    before = place;
  }
  EXPECT_EQ(keys.size(), 339U);
}

TEST(PenTable, NoDeviceHasMoreFormsThanThereIsRoomFor) {
  for_every_spec([](const PenSpec& spec) {
    EXPECT_LT(find_pen_forms(test::identity_of(spec)).count, kMaxPenForms) << "one is kept free";
  });
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
