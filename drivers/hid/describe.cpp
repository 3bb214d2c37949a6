#include "drivers/hid/describe.hpp"

#include <algorithm>
#include <numbers>
#include <tuple>
#include <utility>

namespace limn::hid {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
constexpr std::size_t kNamedRanges = 4;  // usage ranges named in the row of an array field

std::string usage_or_none(Usage usage) {
  return usage == Usage{} ? "(no usage)" : usage_name(usage);
}

std::string type_name(CollectionType type) {
  constexpr const char* kNames[] = {"physical",    "application",  "logical",       "report",
                                    "named array", "usage switch", "usage modifier"};
  const auto number = static_cast<std::size_t>(type);
  if (number < std::size(kNames)) return kNames[number];
  return "type " + std::to_string(number);
}

/// Names from the outermost collection inwards.
std::string path_of(const ReportDescriptor& descriptor, CollectionIndex index) {
  constexpr int kShown = 8;  // deeper nesting than any real device's ends in "..."
  std::vector<std::string> names;
  for (; index != kNoCollection;
       index = descriptor.collections[static_cast<std::size_t>(index)].parent) {
    names.push_back(usage_or_none(descriptor.collections[static_cast<std::size_t>(index)].usage));
  }
  std::string path;
  int shown = 0;
  for (auto name = names.rbegin(); name != names.rend(); ++name) {
    if (!path.empty()) path += " > ";
    if (shown++ == kShown) return path + "...";
    path += *name;
  }
  return path;
}

void append(std::string& list, std::string_view word) {
  if (!list.empty()) list += ", ";
  list += word;
}

std::string flags_of(const Field& field) {
  const FieldFlags flags = field.flags;
  std::string text;
  if (flags.array()) append(text, "array");
  if (flags.relative()) append(text, "relative");
  if (flags.wrap()) append(text, "wraps");
  if (flags.nonlinear()) append(text, "nonlinear");
  if (flags.no_preferred()) append(text, "no preferred state");
  if (flags.null_state()) append(text, "null state");
  if (flags.is_volatile()) append(text, "volatile");
  if (flags.buffered_bytes()) append(text, "buffered bytes");
  return text;
}

std::string range_name(UsageRange range) {
  std::string text = usage_name(range.first);
  if (range.last_id != range.first.id) {
    text += " .. " + usage_name({range.first.page, range.last_id});
  }
  return text;
}

/// The columns that all rows of a field share.
FieldRow row_of(const ReportDescriptor& descriptor, const Field& field) {
  FieldRow row;
  row.kind = field.kind;
  row.report_id = field.report_id;
  row.bit_offset = field.bit_offset;
  row.bit_size = field.bit_size;
  row.count = field.count;
  row.collections = path_of(descriptor, field.collection);
  row.flags = flags_of(field);
  row.array = field.flags.array();
  row.logical = field.logical;
  row.physical = physical_range(field);
  row.unit = unit_name(field.unit);
  row.unit_exponent = field.unit_exponent;
  row.quantity = quantity(field.unit);
  row.counts_per_mm = counts_per_mm(field);
  row.offset = field.offset;
  const bool convertible = row.quantity != Quantity::kNone && row.quantity != Quantity::kOther;
  if (const auto map = physical_map(field, row.quantity); map && convertible) {
    const double turn = row.quantity == Quantity::kAngle ? kDegreesPerRadian : 1.0;
    row.minimum = (*map)(field.logical.minimum) * turn;
    row.maximum = (*map)(field.logical.maximum) * turn;
  }
  return row;
}

std::string array_usages(std::span<const UsageRange> ranges) {
  std::string text;
  for (std::size_t i = 0; i < std::min(ranges.size(), kNamedRanges); ++i) {
    append(text, range_name(ranges[i]));
  }
  if (ranges.size() > kNamedRanges) {
    append(text, std::to_string(ranges.size() - kNamedRanges) + " more");
  }
  return text;
}

/// Cuts the elements of a variable field into one row a declared usage range; the last range also
/// takes the elements that repeat its last usage.
void add_variable_rows(std::span<const UsageRange> ranges, FieldRow row,
                       std::vector<FieldRow>& rows) {
  std::uint32_t left = row.count;
  for (std::size_t i = 0; i < ranges.size() && left > 0 && rows.size() < kMaxDescriptionRows;) {
    UsageRange range = ranges[i];
    std::uint32_t declared = range.count();
    // One usage declared again and again is one row.
    std::size_t next = i + 1;
    while (next < ranges.size() && range.count() == 1 && ranges[next].count() == 1 &&
           ranges[next].first == range.first) {
      ++declared;
      ++next;
    }
    row.count = next == ranges.size() ? left : std::min(left, declared);
    if (range.count() > row.count) {
      range.last_id = static_cast<std::uint16_t>(range.first.id + row.count - 1);
    }
    row.usage = range_name(range);
    rows.push_back(row);
    row.bit_offset += row.count * row.bit_size;
    left -= row.count;
    i = next;
  }
}

void add_rows(const ReportDescriptor& descriptor, const Field& field, std::vector<FieldRow>& rows) {
  FieldRow row = row_of(descriptor, field);
  const auto ranges = descriptor.usages(field);
  row.padding = field.flags.constant() || ranges.empty();
  if (row.padding) {
    row.usage = "padding";
    rows.push_back(std::move(row));
  } else if (row.array) {
    row.usage = array_usages(ranges);
    rows.push_back(std::move(row));
  } else {
    add_variable_rows(ranges, std::move(row), rows);
  }
}

std::string axes_of(const PenLayout& layout) {
  const std::pair<const AxisReader&, std::string_view> axes[] = {
      {layout.x, "x"},
      {layout.y, "y"},
      {layout.pressure, "pressure"},
      {layout.barrel_pressure, "barrel pressure"},
      {layout.tilt_x, "tilt x"},
      {layout.tilt_y, "tilt y"},
      {layout.azimuth, "azimuth"},
      {layout.altitude, "altitude"},
      {layout.twist, "twist"},
      {layout.distance, "distance"},
      {layout.wheel, "wheel"},
      {layout.scan_time, "scan time"},
  };
  std::string text;
  for (const auto& [axis, word] : axes) {
    if (axis) append(text, word);
  }
  if (layout.serial) append(text, "serial");
  if (layout.tool_type) append(text, "tool type");
  if (layout.battery) append(text, "battery");
  return text;
}

std::string switches_of(const PenLayout& layout) {
  const std::pair<const FieldReader&, std::string_view> switches[] = {
      {layout.tip_switch, "tip"},
      {layout.in_range, "in range"},
      {layout.sense, "sense"},
      {layout.barrel_switch, "barrel"},
      {layout.secondary_barrel_switch, "second barrel"},
      {layout.barrel_switch3, "third barrel"},
      {layout.eraser, "eraser"},
      {layout.invert, "invert"},
      {layout.data_valid, "data valid"},
      {layout.confidence, "confidence"},
  };
  std::string text;
  for (const auto& [reader, word] : switches) {
    if (reader) append(text, word);
  }
  return text;
}

TransducerRow transducer_row(const ReportDescriptor& descriptor, const PenLayout& layout) {
  constexpr const char* kNames[] = {"pen", "tablet mouse", "finger"};
  return {layout, kNames[static_cast<std::size_t>(layout.transducer)],
          path_of(descriptor, layout.collection), axes_of(layout), switches_of(layout)};
}

std::vector<CollectionRow> collection_rows(const ReportDescriptor& descriptor) {
  std::vector<CollectionRow> rows;
  for (const Collection& collection : descriptor.collections) {
    const std::uint32_t depth = collection.parent == kNoCollection
                                    ? 0
                                    : rows[static_cast<std::size_t>(collection.parent)].depth + 1;
    rows.push_back(
        {depth, type_name(collection.type), usage_or_none(collection.usage), collection.offset});
  }
  return rows;
}

}  // namespace

Description describe(const ReportDescriptor& descriptor) {
  Description description;
  description.byte_length = descriptor.byte_length;
  description.collections = collection_rows(descriptor);
  description.reports = descriptor.reports;
  description.notes = descriptor.notes;
  for (const Field& field : descriptor.fields) {
    if (description.rows.size() >= kMaxDescriptionRows) break;
    add_rows(descriptor, field, description.rows);
  }
  description.complete = description.rows.size() < kMaxDescriptionRows;
  std::stable_sort(description.rows.begin(), description.rows.end(),
                   [](const FieldRow& a, const FieldRow& b) {
                     return std::tuple(a.kind, a.report_id, a.bit_offset) <
                            std::tuple(b.kind, b.report_id, b.bit_offset);
                   });
  for (const PenLayout& layout : transducer_layouts(descriptor)) {
    description.transducers.push_back(transducer_row(descriptor, layout));
  }
  return description;
}

std::string_view unit_of(Quantity quantity) noexcept {
  switch (quantity) {
    case Quantity::kLength:
      return "mm";
    case Quantity::kAngle:
      return "deg";
    case Quantity::kTime:
      return "s";
    case Quantity::kForce:
      return "N";
    case Quantity::kNone:
    case Quantity::kOther:
      break;
  }
  return {};
}

std::string_view name(ReportKind kind) noexcept {
  switch (kind) {
    case ReportKind::kInput:
      return "input";
    case ReportKind::kOutput:
      return "output";
    case ReportKind::kFeature:
      break;
  }
  return "feature";
}

}  // namespace limn::hid
