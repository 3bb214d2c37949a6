// Every rule over every real descriptor beside the repository.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>

#include "drivers/hid/describe.hpp"
#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/pen_layout.hpp"
#include "tests/support/recordings.hpp"

namespace limn::hid {
namespace {

/// A line of INDEX.tsv: facts that others counted.
struct Indexed {
  std::string file;
  std::size_t bytes = 0;
  bool digitizer = false;
  bool tip_pressure = false;
  bool tilt = false;
  std::uint32_t max_input_bytes = 0;  // without the report ID
  std::string features;
};

std::vector<Indexed> index() {
  enum Column {
    kSha,
    kBytes,
    kRepository,
    kCopies,
    kDigitizer,
    kWacom,
    kPressure,
    kTilt,
    kLength,
    kFeatures,
    kColumns
  };
  std::vector<Indexed> all;
  std::istringstream lines(
      limn::test::read_file(limn::test::shared_folder() / "traces/descriptors/INDEX.tsv"));
  std::string line;
  std::getline(lines, line);  // the heading
  while (std::getline(lines, line)) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
      if (c == '\t')
        cells.emplace_back();
      else
        cells.back() += c;
    }
    if (cells.size() < kColumns) continue;
    all.push_back({cells[kSha].substr(0, 12) + ".bin", std::stoul(cells[kBytes]),
                   cells[kDigitizer] == "1", cells[kPressure] == "1", cells[kTilt] == "1",
                   static_cast<std::uint32_t>(std::stoul(cells[kLength])), cells[kFeatures]});
  }
  return all;
}

Expected<ReportDescriptor> parse_file(const std::string& file) {
  const std::string bytes =
      limn::test::read_file(limn::test::shared_folder() / "traces/descriptors" / file);
  return parse_descriptor({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

TEST(HidRealDescriptors, AllParseWithTheKnownReportLengths) {
  LIMN_NEEDS_RECORDINGS();
  std::size_t parsed = 0;
  for (const Indexed& known : index()) {
    SCOPED_TRACE(known.file);
    const auto descriptor = parse_file(known.file);
    ASSERT_TRUE(descriptor.has_value()) << descriptor.error().at << ": " << descriptor.error().what;
    ++parsed;
    EXPECT_EQ(descriptor->byte_length, known.bytes);
    std::uint32_t longest = 0;
    for (const ReportShape& report : descriptor->reports) {
      if (report.kind != ReportKind::kInput) continue;
      const std::uint32_t id_bytes = descriptor->numbered(report.kind) ? 1 : 0;
      longest = std::max(longest, report.byte_length - id_bytes);
    }
    EXPECT_EQ(longest, known.max_input_bytes);
    for (const Field& field : descriptor->fields) {
      EXPECT_LE(field.logical.minimum, field.logical.maximum) << field.offset;
      EXPECT_NE(field.collection, kNoCollection) << field.offset;
    }
  }
  EXPECT_GE(parsed, 413U);
}

TEST(HidRealDescriptors, TheCountedFeaturesAreFound) {
  LIMN_NEEDS_RECORDINGS();
  std::map<std::string, std::size_t> seen;
  for (const Indexed& known : index()) {
    SCOPED_TRACE(known.file);
    const auto descriptor = parse_file(known.file);
    ASSERT_TRUE(descriptor.has_value());
    const auto& fields = descriptor->fields;
    const auto any = [&fields](auto&& test) {
      return std::any_of(fields.begin(), fields.end(), test);
    };
    const auto has = [&known](const std::string& feature) {
      return (',' + known.features + ',').find(',' + feature + ',') != std::string::npos;
    };
    // Features whose definition leaves no choice.
    const std::pair<std::string, bool> found[] = {
        {"relative", any([](const Field& f) { return f.flags.relative(); })},
        {"bufferedbytes", any([](const Field& f) { return f.flags.buffered_bytes(); })},
        {"null", any([](const Field& f) { return f.flags.null_state(); })},
        {"nopreferred", any([](const Field& f) { return f.flags.no_preferred(); })},
        {"volatile", any([](const Field& f) { return f.flags.is_volatile(); })},
        {"size>32:64", any([](const Field& f) { return f.bit_size == 64; })},
        {"size>32:63", any([](const Field& f) { return f.bit_size == 63; })},
        {"size>32:56", any([](const Field& f) { return f.bit_size == 56; })},
        {"push-left-over",
         std::any_of(descriptor->notes.begin(), descriptor->notes.end(),
                     [](const DescriptorNote& note) { return note.what == "Push without a Pop"; })},
    };
    for (const auto& [feature, is_there] : found) {
      if (has(feature)) {
        ++seen[feature];
        EXPECT_TRUE(is_there) << feature;
      }
    }
  }
  EXPECT_EQ(seen.size(), 9U);
}

/// Whether a layout of `kind` (any, for nullopt) has X, Y and pressure.
bool has_pressure_layout(const std::vector<PenLayout>& layouts, std::optional<Transducer> kind) {
  return std::any_of(layouts.begin(), layouts.end(), [kind](const PenLayout& layout) {
    return layout.x && layout.y && layout.pressure && (!kind || layout.transducer == *kind);
  });
}

TEST(HidRealDescriptors, EveryTipPressureGivesALayout) {
  LIMN_NEEDS_RECORDINGS();
  std::size_t with_pressure = 0;
  std::size_t pens = 0;
  std::vector<std::string> fingers_only;
  for (const Indexed& known : index()) {
    SCOPED_TRACE(known.file);
    const auto descriptor = parse_file(known.file);
    ASSERT_TRUE(descriptor.has_value());
    const auto layouts = transducer_layouts(*descriptor);
    EXPECT_EQ(has_pressure_layout(layouts, std::nullopt), known.tip_pressure);
    if (!known.tip_pressure) continue;
    ++with_pressure;
    if (has_pressure_layout(pen_layouts(*descriptor), Transducer::kStylus)) {
      ++pens;
    } else {
      fingers_only.push_back(known.file);
    }
  }
  EXPECT_GE(with_pressure, 214U);
  EXPECT_GE(pens, 210U);
  // The rest are fingers that report a force: three touch screens (Ideacom 6650 and 6651, Asus
  // 0486:0185) and the touch pad of a Surface Laptop. None of them has a Stylus or Pen collection.
  for (const std::string& file : fingers_only) {
    const auto descriptor = parse_file(file);
    for (const Collection& collection : descriptor->collections) {
      EXPECT_NE(standard_usage(collection.usage), usage::kStylus) << file;
      EXPECT_NE(standard_usage(collection.usage), usage::kPen) << file;
    }
    for (const PenLayout& layout : transducer_layouts(*descriptor)) {
      EXPECT_TRUE(layout.application == usage::kTouchScreen ||
                  layout.application == usage::kTouchPad)
          << file;
    }
  }
}

TEST(HidRealDescriptors, PenRangesArePlausible) {
  LIMN_NEEDS_RECORDINGS();
  // Wide enough for two descriptors that declare a wrong size (13 mm and 3.07 m); a wrong unit or
  // exponent is off by 2.54 or 10 and more.
  constexpr double kSmallestMm = 10;
  constexpr double kLargestMm = 3500;
  constexpr double kRightAngle = 1.5707963267948966;
  constexpr double kWidestTilt = kRightAngle * 127 / 90;  // +-127 without unit
  std::size_t measured = 0;
  std::size_t tilted = 0;
  for (const Indexed& known : index()) {
    SCOPED_TRACE(known.file);
    const auto descriptor = parse_file(known.file);
    ASSERT_TRUE(descriptor.has_value());
    for (const PenLayout& pen : pen_layouts(*descriptor)) {
      EXPECT_LE((pen.y.reader.bit_offset() + pen.y.reader.bit_size() + 7) / 8, pen.byte_length);
      const auto top = [](const AxisReader& axis) {
        return axis.map(axis.reader.logical().maximum);
      };
      if (pen.x.has_unit && pen.y.has_unit && pen.pressure) {
        ++measured;
        EXPECT_GT(top(pen.x), kSmallestMm);
        EXPECT_LT(top(pen.x), kLargestMm);
        EXPECT_GT(top(pen.y), kSmallestMm);
        EXPECT_LT(top(pen.y), kLargestMm);
      }
      if (pen.tilt_x) {
        ++tilted;
        EXPECT_GT(top(pen.tilt_x), 0.5);  // 30 degrees at least
        EXPECT_LE(top(pen.tilt_x), kWidestTilt + 1e-9);
        if (pen.tilt_x.reader.logical().minimum < 0) {
          EXPECT_EQ(pen.tilt_x.map(0), 0.0);
        }
      }
    }
  }
  EXPECT_GE(measured, 200U);
  EXPECT_GE(tilted, 120U);
}

TEST(HidRealDescriptors, AllAreDescribed) {
  LIMN_NEEDS_RECORDINGS();
  for (const Indexed& known : index()) {
    SCOPED_TRACE(known.file);
    const auto descriptor = parse_file(known.file);
    ASSERT_TRUE(descriptor.has_value());
    const Description description = describe(*descriptor);
    EXPECT_TRUE(description.complete);
    // The rows cover every declared bit.
    std::uint64_t bits = 0;
    for (const FieldRow& row : description.rows) bits += std::uint64_t{row.bit_size} * row.count;
    std::uint64_t declared = 0;
    for (const Field& field : descriptor->fields) {
      declared += std::uint64_t{field.bit_size} * field.count;
    }
    EXPECT_EQ(bits, declared);
    EXPECT_GT(to_text(description).size(), known.bytes);
  }
}

}  // namespace
}  // namespace limn::hid
