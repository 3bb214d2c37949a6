#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/field_reader.hpp"

namespace limn::hid {

/// Where a usage lies in a report.
struct LocatedElement {
  std::uint32_t field = 0;    ///< index in ReportDescriptor::fields
  std::uint32_t element = 0;  ///< of a variable field; in an array, the index of the usage
  FieldReader reader;
};

/// All places of `wanted` among the input report `report_id`'s fields inside `collection`
/// (kNoCollection: anywhere), in report order. Vendor usages count as the standard usages they
/// repeat (standard_usage). Variable elements give their value, array usages a switch (1 while
/// selected). Constant fields do not count. Declared usages past the field's count lie nowhere; a
/// repeated last usage counts once, at its first element.
std::vector<LocatedElement> locate(const ReportDescriptor& descriptor, std::uint8_t report_id,
                                   CollectionIndex collection, Usage wanted);

/// The same within one input field: fields[field_index].
std::vector<LocatedElement> locate_in_field(const ReportDescriptor& descriptor,
                                            std::uint32_t field_index, Usage wanted);

/// The compiled plan for one input report: a flat array of readers, one for each wanted usage.
class ReportLayout {
 public:
  ReportLayout() = default;

  /// Readers for the first place of each usage (see locate); absent readers for usages that are not
  /// there.
  static ReportLayout compile(const ReportDescriptor& descriptor, std::uint8_t report_id,
                              CollectionIndex collection, std::span<const Usage> wanted);

  std::uint8_t report_id() const noexcept { return report_id_; }

  /// Whether `report` is this layout's: by its first byte where reports are numbered, else always.
  bool matches(std::span<const std::uint8_t> report) const noexcept {
    return !numbered_ || (!report.empty() && report[0] == report_id_);
  }

  /// In the order of `wanted`.
  std::span<const FieldReader> readers() const noexcept { return readers_; }

 private:
  std::vector<FieldReader> readers_;
  std::uint8_t report_id_ = 0;
  bool numbered_ = false;
};

}  // namespace limn::hid
