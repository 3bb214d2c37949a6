#include <algorithm>

#include "drivers/hid/descriptor_parser.hpp"
#include "input/base/expect.hpp"

namespace limn::hid {

bool ReportDescriptor::numbered(ReportKind kind) const noexcept {
  return std::any_of(reports.begin(), reports.end(), [kind](const ReportShape& report) {
    return report.kind == kind && report.id != 0;
  });
}

const ReportShape* ReportDescriptor::report(ReportKind kind, std::uint8_t id) const noexcept {
  const auto found = std::find_if(
      reports.begin(), reports.end(),
      [kind, id](const ReportShape& report) { return report.kind == kind && report.id == id; });
  return found == reports.end() ? nullptr : &*found;
}

std::span<const UsageRange> ReportDescriptor::usages(const Field& field) const noexcept {
  LIMN_EXPECT(field.first_usage_range + field.usage_range_count <= usage_ranges.size());
  return std::span(usage_ranges).subspan(field.first_usage_range, field.usage_range_count);
}

std::optional<Usage> ReportDescriptor::declared_usage(const Field& field,
                                                      std::uint32_t index) const noexcept {
  for (const UsageRange& range : usages(field)) {
    if (index < range.count()) {
      return Usage{range.first.page, static_cast<std::uint16_t>(range.first.id + index)};
    }
    index -= range.count();
  }
  return std::nullopt;
}

std::optional<Usage> ReportDescriptor::element_usage(const Field& field,
                                                     std::uint32_t element) const noexcept {
  const auto ranges = usages(field);
  if (field.flags.array() || ranges.empty() || element >= field.count) return std::nullopt;
  if (const auto usage = declared_usage(field, element)) return usage;
  return Usage{ranges.back().first.page, ranges.back().last_id};
}

std::optional<Usage> ReportDescriptor::selected_usage(const Field& field,
                                                      std::int64_t value) const noexcept {
  if (field.flags.variable() || !field.logical.contains(value)) return std::nullopt;
  return declared_usage(field, static_cast<std::uint32_t>(value - field.logical.minimum));
}

bool ReportDescriptor::inside(CollectionIndex collection, CollectionIndex ancestor) const noexcept {
  if (ancestor == kNoCollection) return true;
  while (collection != kNoCollection && collection != ancestor) {
    collection = collections[static_cast<std::size_t>(collection)].parent;
  }
  return collection == ancestor;
}

CollectionIndex ReportDescriptor::top_level(CollectionIndex collection) const noexcept {
  while (collection != kNoCollection) {
    const CollectionIndex parent = collections[static_cast<std::size_t>(collection)].parent;
    if (parent == kNoCollection) break;
    collection = parent;
  }
  return collection;
}

}  // namespace limn::hid
