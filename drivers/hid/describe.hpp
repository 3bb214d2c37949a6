#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/pen_layout.hpp"
#include "drivers/hid/units.hpp"

namespace limn::hid {

/// One line of a described report: neighbouring elements of a variable field with one usage or one
/// declared range of usages, or a whole array field, or padding.
struct FieldRow {
  ReportKind kind = ReportKind::kInput;
  std::uint8_t report_id = 0;
  std::uint32_t bit_offset = 0;  ///< of the first element, report ID byte included
  std::uint32_t bit_size = 0;    ///< of one element
  std::uint32_t count = 0;       ///< elements
  std::string collections;       ///< from the outermost, e.g. "Pen > Stylus"
  std::string usage;             ///< e.g. "Tip Pressure", "Button 1 .. Button 8", "padding"
  std::string flags;  ///< what differs from a plain absolute value, e.g. "relative, null state"
  bool array = false;
  bool padding = false;  ///< constant, or without a usage
  Range logical;
  Range physical;    ///< in `unit`, exponent not applied; the logical range where 0..0
  std::string unit;  ///< as declared: "cm", "inch", "deg" ..; empty where none is
  std::int8_t unit_exponent = 0;
  Quantity quantity = Quantity::kNone;
  std::optional<double> minimum;  ///< physical range in mm, degrees, s or N (unit_of)
  std::optional<double> maximum;
  std::optional<double> counts_per_mm;  ///< lengths only; times 25.4: lines per inch
  std::uint32_t offset = 0;             ///< of the Main item in the descriptor, bytes
};

/// One collection of the tree, in descriptor order.
struct CollectionRow {
  std::uint32_t depth = 0;  ///< 0 for top-level ones
  std::string type;         ///< "application", "physical", ..
  std::string usage;
  std::uint32_t offset = 0;  ///< bytes
};

/// A transducer as limn will read it: its layout and the axes and switches that are there.
struct TransducerRow {
  PenLayout layout;
  std::string name;         ///< "pen", "tablet mouse", "finger"
  std::string collections;  ///< e.g. "Pen > Stylus"
  std::string axes;         ///< "x, y, pressure, tilt x, tilt y"
  std::string switches;     ///< "tip, in range, barrel"
};

/// A report descriptor explained.
struct Description {
  std::uint32_t byte_length = 0;
  std::vector<CollectionRow> collections;
  std::vector<ReportShape> reports;
  std::vector<FieldRow> rows;  ///< by report (kind, ID), then offset; kMaxDescriptionRows at most
  std::vector<TransducerRow> transducers;  ///< see transducer_layouts
  std::vector<DescriptorNote> notes;
  bool complete = true;  ///< false where kMaxDescriptionRows left rows out
};

/// Bounds the size of any Description; real ones have up to 139 rows.
inline constexpr std::size_t kMaxDescriptionRows = 10000;

/// Explains `descriptor`.
Description describe(const ReportDescriptor& descriptor);

/// The description as aligned text for a person, lines ended by '\n'.
std::string to_text(const Description& description);

/// "mm", "deg", "s", "N": the unit of FieldRow::minimum and maximum; empty without one.
std::string_view unit_of(Quantity quantity) noexcept;

/// "input", "output", "feature".
std::string_view name(ReportKind kind) noexcept;

}  // namespace limn::hid
