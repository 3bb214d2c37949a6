// Any report against the plan of any descriptor. The first two bytes give the length of the
// descriptor that follows them (little-endian), the rest is the report.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/field_reader.hpp"
#include "drivers/hid/pen_layout.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using namespace limn::hid;
using limn::fuzz::require;
using Report = std::span<const std::uint8_t>;

bool bit_of(Report report, std::size_t bit) { return (report[bit / 8] >> bit % 8 & 1) != 0; }

/// The value bit by bit, as slowly and plainly as can be.
std::optional<std::uint64_t> plain_bits(Report report, const FieldReader& reader) {
  if ((std::size_t{reader.bit_offset()} + reader.bit_size() + 7) / 8 > report.size()) return {};
  std::uint64_t value = 0;
  for (std::uint32_t i = reader.bit_size(); i-- > 0;) {
    value = value << 1 | (bit_of(report, reader.bit_offset() + i) ? 1U : 0U);
  }
  return value;
}

void check_element(const Field& field, std::uint32_t element, Report report) {
  const FieldReader reader = FieldReader::of_element(field, element);
  require(reader.present() == (field.bit_size <= 64), "up to 64 bits are read");
  if (!reader) {
    require(!reader.read(report).has_value(), "an absent reader reads nothing");
    return;
  }
  const auto expected = plain_bits(report, reader);
  require(reader.read_bits(report) == expected, "bits are read as they lie");
  const auto value = reader.read(report);
  const bool has_nonzero_bits = expected.value_or(0) != 0;
  require(reader.is_set(report) == (has_nonzero_bits && value.has_value()), "a switch is its bits");
  if (!expected) {
    require(!value.has_value(), "nothing is read past the end");
  } else if (value) {
    const std::uint64_t kept = static_cast<std::uint64_t>(*value) ^ *expected;
    require(field.bit_size == 64 ? kept == 0 : kept << (64 - field.bit_size) == 0,
            "a value keeps its bits");
    require(field.is_signed() || field.bit_size == 64 || *value >= 0,
            "unsigned fields are not negative");
  } else {
    require(field.flags.null_state(), "only null states have bits and no value");
  }
}

/// Whether an element of the array field holds `wanted`; nothing where the report ends before that
/// is known.
std::optional<bool> plainly_selected(Report report, const Field& field, std::int64_t wanted) {
  for (std::uint32_t i = 0; i < field.count; ++i) {
    const auto bits = plain_bits(report, FieldReader::of_element(field, i));
    if (!bits) return std::nullopt;
    const bool negative = field.is_signed() && (*bits >> (field.bit_size - 1)) != 0;
    const std::uint64_t above =
        negative && field.bit_size < 64 ? ~std::uint64_t{0} << field.bit_size : 0;
    if (static_cast<std::int64_t>(*bits | above) == wanted) return true;
  }
  return false;
}

void check_selection(const Field& field, std::int64_t wanted, Report report) {
  const FieldReader reader = FieldReader::of_selection(field, wanted);
  require(reader.present() == (field.bit_size <= 64), "up to 64 bits are searched");
  if (!reader) return;
  const auto expected = plainly_selected(report, field, wanted);
  require(reader.read(report) == expected, "a selection is an element with its index");
  require(reader.is_set(report) == expected.value_or(false), "a selection is a switch");
}

void check_layout(const PenLayout& layout, Report report) {
  for (const AxisReader* axis :
       {&layout.x, &layout.y, &layout.pressure, &layout.barrel_pressure, &layout.tilt_x,
        &layout.tilt_y, &layout.azimuth, &layout.altitude, &layout.twist, &layout.distance,
        &layout.scan_time, &layout.wheel}) {
    const auto counts = axis->reader.read(report);
    if (!counts) continue;
    const double value = axis->map(*counts);
    require(std::isfinite(value), "converted values are finite");
  }
  for (const FieldReader* reader : {&layout.tip_switch, &layout.in_range, &layout.barrel_switch,
                                    &layout.eraser, &layout.invert, &layout.sense, &layout.serial,
                                    &layout.serial_high, &layout.tool_type, &layout.buttons[0]}) {
    require(!reader->read(report).has_value() || reader->read_bits(report).has_value(),
            "a value has bits");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::size_t length = std::min(data[0] + std::size_t{256} * data[1], size - 2);
  const auto descriptor = parse_descriptor({data + 2, length});
  if (!descriptor) return 0;
  // A copy of its own, so that AddressSanitizer watches its end.
  const std::vector<std::uint8_t> report(data + 2 + length, data + size);
  for (const Field& field : descriptor->fields) {
    if (field.kind != ReportKind::kInput) continue;
    check_element(field, 0, report);
    check_element(field, field.count / 2, report);
    check_element(field, field.count - 1, report);
    if (field.flags.array()) {
      check_selection(field, field.logical.minimum, report);
      const auto first = FieldReader::of_element(field, 0).read(report);
      if (first) check_selection(field, *first, report);
    }
  }
  for (const PenLayout& layout : transducer_layouts(*descriptor)) check_layout(layout, report);
  return 0;
}
