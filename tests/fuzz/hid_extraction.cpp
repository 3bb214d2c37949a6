// Any report against the plan of any descriptor. The first two bytes give the length of the
// descriptor that follows them (little-endian), the rest is the report.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <vector>

#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/field_reader.hpp"
#include "drivers/hid/pen_layout.hpp"

namespace {

using namespace limn::hid;
using Report = std::span<const std::uint8_t>;

void require(bool condition) {
  if (!condition) std::abort();
}

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
  require(reader.present() == (field.bit_size <= 64));
  if (!reader) {
    require(!reader.read(report).has_value());
    return;
  }
  const auto expected = plain_bits(report, reader);
  require(reader.read_bits(report) == expected);
  const auto value = reader.read(report);
  if (!expected) {
    require(!value.has_value());
  } else if (value) {
    const std::uint64_t kept = static_cast<std::uint64_t>(*value) ^ *expected;
    require(field.bit_size == 64 ? kept == 0 : kept << (64 - field.bit_size) == 0);
    require(field.is_signed() || field.bit_size == 64 || *value >= 0);
  } else {
    require(field.flags.null_state());
  }
}

void check_layout(const PenLayout& layout, Report report) {
  for (const AxisReader* axis :
       {&layout.x, &layout.y, &layout.pressure, &layout.barrel_pressure, &layout.tilt_x,
        &layout.tilt_y, &layout.azimuth, &layout.altitude, &layout.twist, &layout.distance,
        &layout.scan_time, &layout.wheel}) {
    const auto counts = axis->reader.read(report);
    if (!counts) continue;
    const double value = axis->map(*counts);
    require(value - value == 0);  // finite
  }
  for (const FieldReader* reader : {&layout.tip_switch, &layout.in_range, &layout.barrel_switch,
                                    &layout.eraser, &layout.invert, &layout.sense, &layout.serial,
                                    &layout.serial_high, &layout.tool_type, &layout.buttons[0]}) {
    require(reader->is_set(report) == (reader->read(report).value_or(0) != 0));
    require(!reader->read(report).has_value() || reader->read_bits(report).has_value());
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
      const auto selected = FieldReader::of_selection(field, field.logical.minimum);
      require(selected.read(report).value_or(0) <= 1);
    }
  }
  for (const PenLayout& layout : transducer_layouts(*descriptor)) check_layout(layout, report);
  return 0;
}
