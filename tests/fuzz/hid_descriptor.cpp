// Any bytes as a report descriptor: a value or an error with a place, and a description of either
// size that stays bounded.

#include <cstddef>
#include <cstdint>

#include "drivers/hid/describe.hpp"
#include "drivers/hid/descriptor_parser.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace limn::hid;
  using limn::fuzz::require;
  const auto descriptor = parse_descriptor({data, size});
  if (!descriptor) {
    const limn::Error& error = descriptor.error();
    require(error.at.rfind("byte ", 0) == 0 && !error.what.empty() && !error.remedy.empty(),
            "an error says where, what is wrong and to do");
    return 0;
  }
  require(descriptor->collections.size() <= kMaxCollections, "collections are limited");
  require(descriptor->fields.size() <= kMaxFields && descriptor->usage_ranges.size() <= size,
          "fields and usages are limited");
  for (const Field& field : descriptor->fields) {
    const ReportShape* report = descriptor->report(field.kind, field.report_id);
    require(report != nullptr && report->byte_length <= kMaxReportBytes,
            "a field has a report of limited length");
    const std::uint64_t end = field.bit_offset + std::uint64_t{field.bit_size} * field.count;
    require(field.count > 0 && field.bit_size > 0 && end <= std::uint64_t{report->byte_length} * 8,
            "a field lies within its report");
    const bool named = descriptor->element_usage(field, field.count - 1).has_value();
    require(named == (field.flags.variable() && field.usage_range_count > 0),
            "elements of variable fields with usages have one");
  }
  const Description description = describe(*descriptor);
  require(description.rows.size() <= kMaxDescriptionRows, "descriptions are limited");
  require(!to_text(description).empty(), "a description is never empty");
  return 0;
}
