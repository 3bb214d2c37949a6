// decode(encode(x)) = x over random descriptors: this file writes descriptors and reports bit by
// bit with its own arithmetic, the plan compiled from the descriptor reads the values back.

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <vector>

#include "drivers/hid/describe.hpp"
#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/pen_layout.hpp"
#include "drivers/hid/report_layout.hpp"
#include "tests/support/for_all.hpp"
#include "tests/unit/drivers/hid_items.hpp"

namespace limn::hid {
namespace {

using limn::test::for_all;
using limn::test::Rng;
using test::Items;
using Bytes = std::vector<std::uint8_t>;

/// A report as single bits, lowest bit of the first byte first.
class BitWriter {
 public:
  void append(std::uint64_t value, std::uint32_t bits) {
    for (std::uint32_t i = 0; i < bits; ++i) bits_.push_back(i < 64 && (value >> i & 1) != 0);
  }
  std::size_t size() const { return bits_.size(); }
  Bytes bytes() const {
    Bytes out((bits_.size() + 7) / 8, 0);
    for (std::size_t i = 0; i < bits_.size(); ++i) {
      if (bits_[i]) out[i / 8] = static_cast<std::uint8_t>(out[i / 8] + (1 << i % 8));
    }
    return out;
  }

 private:
  std::vector<bool> bits_;
};

/// What was written for one element of a variable field.
struct Written {
  std::uint8_t report_id = 0;
  Usage usage;
  std::uint64_t bits = 0;
  std::uint32_t width = 0;
  std::optional<std::int64_t> value;  // nullopt: Null State
  std::size_t end_bit = 0;
};

struct Case {
  Items descriptor;
  std::map<std::uint8_t, BitWriter> reports;
  std::vector<Written> elements;
};

std::uint64_t mask(std::uint32_t bits) {
  return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
}

std::int64_t as_number(std::uint64_t bits, std::uint32_t width, bool is_signed) {
  if (is_signed && width < 64 && (bits >> (width - 1) & 1) != 0) bits |= ~mask(width);
  return static_cast<std::int64_t>(bits);
}

constexpr std::uint16_t kPage = 0xFF42;  // repeats no standard usage

/// Appends one random variable field with usages of its own to the descriptor and random values to
/// the report.
void add_field(Rng& rng, std::uint8_t report_id, std::uint16_t& next_usage, Case& made) {
  const std::uint32_t widths[] = {1, 8, 16, static_cast<std::uint32_t>(rng.integer(1, 64))};
  const std::uint32_t width = widths[rng.integer(0, 3)];
  const auto count = static_cast<std::uint32_t>(rng.integer(1, 5));
  const bool is_signed = rng.chance(0.5);
  const bool has_null = rng.chance(0.3);
  Range logical{0, 1};
  const std::uint32_t declared = std::min(width, 32U);
  logical.maximum = is_signed ? (std::int64_t{1} << (declared - 1)) - 1
                              : static_cast<std::int64_t>(mask(declared));
  if (is_signed) logical.minimum = -(std::int64_t{1} << (declared - 1));
  if (has_null) {  // leave values outside
    logical.maximum -= (logical.maximum - logical.minimum) / 3;
    if (!is_signed) logical.minimum = logical.maximum / 4;
  }

  Items& items = made.descriptor;
  items.report_size(width).report_count(count).logical(logical.minimum, logical.maximum);
  const std::uint16_t first = next_usage;
  next_usage = static_cast<std::uint16_t>(next_usage + count);
  if (rng.chance(0.5)) {
    items.usages(first, first + count - 1);
  } else {
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto id = static_cast<std::uint16_t>(first + i);
      if (rng.chance(0.5))
        items.usage(id);
      else
        items.full_usage({kPage, id});
    }
  }
  items.input(has_null ? test::kNullState : test::kVariable);

  BitWriter& report = made.reports[report_id];
  for (std::uint32_t i = 0; i < count; ++i) {
    Written written;
    written.report_id = report_id;
    written.usage = {kPage, static_cast<std::uint16_t>(first + i)};
    written.bits = rng() & mask(width);
    written.width = width;
    written.value = as_number(written.bits, width, is_signed);
    if (has_null && (*written.value < logical.minimum || *written.value > logical.maximum)) {
      written.value.reset();
    }
    report.append(written.bits, width);
    written.end_bit = report.size();
    made.elements.push_back(written);
  }
}

void add_padding(Rng& rng, std::uint8_t report_id, Case& made) {
  const auto bits = static_cast<std::uint32_t>(rng.integer(1, 100));
  if (rng.chance(0.5)) made.descriptor.usage(1);  // constant fields name nothing
  made.descriptor.report_size(bits).report_count(1).input(test::kConstant | test::kVariable);
  for (std::uint32_t i = 0; i < bits; ++i) made.reports[report_id].append(rng() & 1, 1);
}

/// What belongs to other reports or to nobody and must not disturb.
void add_noise(Rng& rng, Case& made) {
  Items& items = made.descriptor;
  switch (rng.integer(0, 3)) {
    case 0:
      items.push().usage_page(1).report_size(3).logical(-5, 5).unit(0x11).pop();
      break;
    case 1:
      items.report_size(7).report_count(3).usage(2).feature(test::kVariable);
      break;
    case 2:
      items.raw({0xFE, 0x02, 0x99, 0x81, 0x02});
      break;
    default:
      items.report_size(8).report_count(1).usage(3).output(test::kVariable);
      break;
  }
}

Case any_case(Rng& rng) {
  Case made;
  const bool numbered = rng.chance(0.7);
  std::uint16_t next_usage = 10;
  made.descriptor.usage_page(kPage).usage(1).collection(test::kApplication);
  std::uint8_t id = 0;
  for (std::int64_t i = rng.integer(1, 20); i > 0; --i) {
    if (numbered && (id == 0 || rng.chance(0.3))) {  // reports interleave
      id = static_cast<std::uint8_t>(rng.integer(1, 4) * 60);
      made.descriptor.report_id(id);
      if (made.reports[id].size() == 0) made.reports[id].append(id, 8);
    }
    if (rng.chance(0.2)) add_noise(rng, made);
    if (rng.chance(0.25))
      add_padding(rng, id, made);
    else
      add_field(rng, id, next_usage, made);
  }
  made.descriptor.end_collection();
  return made;
}

TEST(HidRoundTripProperty, ThePlanReadsWhatWasWritten) {
  for_all(2000, [](Rng& rng) {
    const Case made = any_case(rng);
    const auto descriptor = parse_descriptor(made.descriptor.bytes());
    ASSERT_TRUE(descriptor.has_value()) << descriptor.error().what;
    for (const auto& [id, writer] : made.reports) {
      const ReportShape* shape = descriptor->report(ReportKind::kInput, id);
      if (shape == nullptr) continue;  // a Report ID without fields
      EXPECT_EQ(shape->byte_length, writer.bytes().size());
    }
    for (const Written& written : made.elements) {
      const auto found = locate(*descriptor, written.report_id, 0, written.usage);
      ASSERT_EQ(found.size(), 1U);
      const FieldReader& reader = found[0].reader;
      const Bytes report = made.reports.at(written.report_id).bytes();
      EXPECT_EQ(reader.read(report), written.value);
      EXPECT_EQ(reader.read_bits(report), written.bits);
      EXPECT_EQ(reader.bit_size(), written.width);
    }
  });
}

TEST(HidRoundTripProperty, EachElementNeedsItsOwnBytesAlone) {
  for_all(300, [](Rng& rng) {
    const Case made = any_case(rng);
    const auto descriptor = parse_descriptor(made.descriptor.bytes());
    ASSERT_TRUE(descriptor.has_value()) << descriptor.error().what;
    for (const Written& written : made.elements) {
      const FieldReader reader =
          locate(*descriptor, written.report_id, 0, written.usage).at(0).reader;
      const Bytes report = made.reports.at(written.report_id).bytes();
      const std::size_t needed = (written.end_bit + 7) / 8;
      // Copies of their own, so that AddressSanitizer watches the end.
      const Bytes enough(report.begin(), report.begin() + static_cast<std::ptrdiff_t>(needed));
      const Bytes cut(enough.begin(), enough.end() - 1);
      EXPECT_EQ(reader.read_bits(enough), written.bits);
      EXPECT_FALSE(reader.read_bits(cut).has_value());
      EXPECT_FALSE(reader.read(cut).has_value());
    }
  });
}

TEST(HidRoundTripProperty, ArraysSelectByIndex) {
  for_all(500, [](Rng& rng) {
    const auto width = static_cast<std::uint32_t>(rng.integer(3, 20));
    const auto count = static_cast<std::uint32_t>(rng.integer(1, 6));
    const auto controls = static_cast<std::uint32_t>(rng.integer(1, 6));
    const std::int64_t minimum = rng.chance(0.5) ? rng.integer(0, 1) : -rng.integer(1, 4);
    const auto lead = static_cast<std::uint32_t>(rng.integer(1, 9));
    Items items;
    items.usage_page(0x09).usage(1).collection(test::kApplication);
    items.report_size(lead).report_count(1).input(test::kConstant);
    items.report_size(width).report_count(count).usages(1, controls);
    items.logical(minimum, minimum + controls - 1).input(test::kArray).end_collection();
    const auto descriptor = parse_descriptor(items.bytes());
    ASSERT_TRUE(descriptor.has_value()) << descriptor.error().what;

    BitWriter report;
    report.append(rng(), lead);
    std::vector<bool> pressed(controls, false);
    for (std::uint32_t i = 0; i < count; ++i) {
      const bool is_signed = minimum < 0;
      const std::int64_t low = is_signed ? -4 : 0;
      const std::int64_t sent = rng.integer(low, low + 7);
      const auto bits = static_cast<std::uint64_t>(sent) & mask(width);
      report.append(bits, width);
      const std::int64_t index = as_number(bits, width, is_signed) - minimum;
      if (index >= 0 && index < controls) pressed[static_cast<std::size_t>(index)] = true;
    }
    for (std::uint16_t i = 0; i < controls; ++i) {
      const auto found =
          locate(*descriptor, 0, kNoCollection, Usage{0x09, static_cast<std::uint16_t>(i + 1)});
      ASSERT_EQ(found.size(), 1U);
      EXPECT_EQ(found[0].reader.read(report.bytes()), pressed[i] ? 1 : 0);
    }
  });
}

/// A descriptor of random items in random order: mostly nonsense that still parses far.
Bytes any_items(Rng& rng) {
  Items items;
  items.usage_page(0x0D);
  for (std::int64_t i = rng.integer(1, 60); i > 0; --i) {
    const auto prefix = static_cast<std::uint8_t>(rng.integer(0, 63) * 4);
    const unsigned sizes[] = {0, 1, 1, 1, 2, 4};
    const auto value = static_cast<std::uint32_t>(rng.chance(0.8) ? rng.integer(0, 66)
                                                                  : rng.integer(0, 0xFFFFFFFF));
    items.item(prefix == 0xFC ? 0x04 : prefix, value, sizes[rng.integer(0, 5)]);
    if (rng.chance(0.2)) items.collection(test::kPhysical).end_collection();
    if (rng.chance(0.2)) items.input(static_cast<std::uint32_t>(rng.integer(0, 0x1FF)));
  }
  return {items.bytes().begin(), items.bytes().end()};
}

TEST(HidRoundTripProperty, AnyItemsGiveADescriptorOrAnError) {
  int parsed = 0;
  for_all(3000, [&parsed](Rng& rng) {
    const auto descriptor = parse_descriptor(any_items(rng));
    if (!descriptor) {
      EXPECT_EQ(descriptor.error().at.rfind("byte ", 0), 0U);
      EXPECT_FALSE(descriptor.error().what.empty());
      EXPECT_FALSE(descriptor.error().remedy.empty());
      return;
    }
    ++parsed;
    for (const Field& field : descriptor->fields) {
      const ReportShape* shape = descriptor->report(field.kind, field.report_id);
      ASSERT_NE(shape, nullptr);
      EXPECT_LE(field.bit_offset + std::uint64_t{field.bit_size} * field.count,
                std::uint64_t{shape->byte_length} * 8);
    }
    EXPECT_FALSE(to_text(describe(*descriptor)).empty());
  });
  if (limn::test::requested_seed()) return;
  EXPECT_GT(parsed, 100);  // the generator must not only err
}

}  // namespace
}  // namespace limn::hid
