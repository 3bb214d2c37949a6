#pragma once

#include <cstdint>
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

}  // namespace limn::hid
