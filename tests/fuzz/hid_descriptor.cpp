// Any bytes as a report descriptor: a value or an error with a place, and a description of either
// size that stays bounded.

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "drivers/hid/describe.hpp"
#include "drivers/hid/descriptor_parser.hpp"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace limn::hid;
  const auto descriptor = parse_descriptor({data, size});
  if (!descriptor) {
    const limn::Error& error = descriptor.error();
    require(error.at.rfind("byte ", 0) == 0 && !error.what.empty() && !error.remedy.empty());
    return 0;
  }
  require(descriptor->collections.size() <= kMaxCollections);
  require(descriptor->fields.size() <= kMaxFields && descriptor->usage_ranges.size() <= size);
  for (const Field& field : descriptor->fields) {
    const ReportShape* report = descriptor->report(field.kind, field.report_id);
    require(report != nullptr && report->byte_length <= kMaxReportBytes);
    const std::uint64_t end = field.bit_offset + std::uint64_t{field.bit_size} * field.count;
    require(field.count > 0 && field.bit_size > 0 && end <= std::uint64_t{report->byte_length} * 8);
    const bool named = descriptor->element_usage(field, field.count - 1).has_value();
    require(named == (field.flags.variable() && field.usage_range_count > 0));
  }
  const Description description = describe(*descriptor);
  require(description.rows.size() <= kMaxDescriptionRows);
  require(!to_text(description).empty());
  return 0;
}
