#include "drivers/hid/report_layout.hpp"

#include <array>
#include <optional>

namespace limn::hid {
namespace {

/// The declared usages that count as `wanted`: itself, and the vendor usages that repeat it.
std::array<Usage, 4> spellings(Usage wanted) noexcept {
  std::array<Usage, 4> all = {wanted, wanted, wanted, wanted};
  const Usage candidates[] = {
      {page::kWacomG9, wanted.id},
      {page::kWacomG11, wanted.id},
      {page::kWacom,
       static_cast<std::uint16_t>(wanted.page == page::kDigitizer ? wanted.id
                                                                  : wanted.page << 8 | wanted.id)},
  };
  for (std::size_t i = 0; i < std::size(candidates); ++i) {
    if (standard_usage(candidates[i]) == wanted) all[i + 1] = candidates[i];
  }
  return all;
}

/// Index of the first usage in `range` that one of `spelled` names.
std::optional<std::uint32_t> index_in(const UsageRange& range,
                                      const std::array<Usage, 4>& spelled) noexcept {
  std::optional<std::uint32_t> first;
  for (const Usage usage : spelled) {
    if (usage.page != range.first.page || usage.id < range.first.id || usage.id > range.last_id) {
      continue;
    }
    const auto index = static_cast<std::uint32_t>(usage.id - range.first.id);
    if (!first || index < *first) first = index;
  }
  return first;
}

FieldReader reader_of_usage(const Field& field, std::uint32_t index) noexcept {
  if (field.flags.variable()) return FieldReader::of_element(field, index);
  return FieldReader::of_selection(field, field.logical.minimum + index);
}

}  // namespace

std::vector<LocatedElement> locate_in_field(const ReportDescriptor& descriptor,
                                            std::uint32_t field_index, Usage wanted) {
  const Field& field = descriptor.fields[field_index];
  std::vector<LocatedElement> found;
  if (field.flags.constant()) return found;
  const auto spelled = spellings(wanted);
  std::uint32_t before = 0;
  for (const UsageRange& range : descriptor.usages(field)) {
    if (field.flags.variable() && before >= field.count) break;
    if (const auto index = index_in(range, spelled)) {
      const std::uint32_t element = before + *index;
      const FieldReader reader = reader_of_usage(field, element);
      if (reader) found.push_back({field_index, element, reader});
    }
    before += range.count();
  }
  return found;
}

std::vector<LocatedElement> locate(const ReportDescriptor& descriptor, std::uint8_t report_id,
                                   CollectionIndex collection, Usage wanted) {
  std::vector<LocatedElement> found;
  for (std::uint32_t i = 0; i < descriptor.fields.size(); ++i) {
    const Field& field = descriptor.fields[i];
    if (field.kind != ReportKind::kInput || field.report_id != report_id ||
        !descriptor.inside(field.collection, collection)) {
      continue;
    }
    const auto here = locate_in_field(descriptor, i, wanted);
    found.insert(found.end(), here.begin(), here.end());
  }
  return found;
}

}  // namespace limn::hid
