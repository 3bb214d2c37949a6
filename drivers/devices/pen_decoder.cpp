#include "drivers/devices/pen_decoder.hpp"

#include <utility>
#include <vector>

#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/usages.hpp"

namespace limn {
namespace {

ReportClass class_of_application(hid::Usage application) noexcept {
  namespace usage = hid::usage;
  if (hid::is_touch_application(application)) return ReportClass::kTouch;
  if (application == usage::kMouse) return ReportClass::kMouse;
  if (application == usage::kTabletFunctionKeys) return ReportClass::kPad;
  return ReportClass::kOther;
}

std::array<ReportClass, 256> classify(const hid::ReportDescriptor& descriptor) noexcept {
  std::array<ReportClass, 256> classes;
  classes.fill(ReportClass::kUnknownId);
  for (const hid::Field& field : descriptor.fields) {
    if (field.kind != hid::ReportKind::kInput) continue;
    ReportClass& known = classes[field.report_id];
    const hid::CollectionIndex top = descriptor.top_level(field.collection);
    const hid::Usage application =
        top == hid::kNoCollection ? hid::Usage{}
                                  : descriptor.collections[static_cast<std::size_t>(top)].usage;
    const ReportClass of_field = class_of_application(application);
    if (known == ReportClass::kUnknownId || known == ReportClass::kOther) known = of_field;
  }
  return classes;
}

/// Notebook pens explain themselves, sizes included; their rows are for lost descriptors.
bool descriptor_knows_better(const PenSpec& spec, const GenericPen& generic) noexcept {
  return spec.family == PenFamily::kTabletPc && !generic.layouts().empty();
}

}  // namespace

PenDecoder::PenDecoder(const PenSpec* spec) : output_(std::make_unique<PenOutput>()) {
  if (spec != nullptr) wacom_.emplace(*spec);
  classes_.fill(ReportClass::kUnknownId);
}

Expected<PenDecoder> PenDecoder::make(std::uint16_t vendor, std::uint16_t product,
                                      std::span<const std::uint8_t> report_descriptor) {
  const PenSpec* spec = find_pen_spec(vendor, product);
  PenDecoder decoder(spec);
  if (report_descriptor.empty()) {
    if (spec != nullptr) return decoder;
    return fail(ErrorCode::kMissing, "", "the device has no report descriptor",
                "add its descriptor, e.g. --descriptor FILE");
  }
  auto descriptor = hid::parse_descriptor(report_descriptor);
  if (!descriptor) {
    if (spec != nullptr) return decoder;  // the table suffices
    Error error = std::move(descriptor.error());
    error.at = error.at.empty() ? "report descriptor" : "report descriptor, " + error.at;
    return tl::unexpected(std::move(error));
  }
  std::vector<hid::PenLayout> layouts = hid::pen_layouts(*descriptor);
  decoder.numbered_ = descriptor->numbered(hid::ReportKind::kInput);
  decoder.classes_ = classify(*descriptor);
  decoder.generic_ = GenericPen(std::move(layouts));
  if (spec != nullptr && descriptor_knows_better(*spec, decoder.generic_)) decoder.wacom_.reset();
  return decoder;
}

PenDecoder::Decoded PenDecoder::decode(const Report& report) noexcept {
  output_->begin(report.device);
  if (report.bytes.empty()) return {ReportClass::kTooShort, {}};
  ReportClass kind = ReportClass::kUnknownId;
  if (wacom_) kind = wacom_->decode(report.bytes, report.time, *output_);
  if (kind == ReportClass::kUnknownId) {
    kind = generic_.decode(report.bytes, report.time, *output_);
  }
  if (kind == ReportClass::kUnknownId) kind = class_in_descriptor(report.bytes);
  return {kind, output_->samples()};
}

std::span<const PenSample> PenDecoder::disconnect(DeviceIndex device, Timestamp time) noexcept {
  output_->begin(device);
  output_->disconnect(time);
  return output_->samples();
}

ReportClass PenDecoder::class_in_descriptor(std::span<const std::uint8_t> report) const noexcept {
  return classes_[numbered_ ? report[0] : 0];
}

PenRange PenDecoder::range() const noexcept {
  PenRange range;
  if (wacom_) {
    const PenSpec& spec = wacom_->spec();
    range.x_max = spec.x_max;
    range.y_max = spec.y_max;
    range.pressure_max = spec.pressure_max;
    range.width_mm = spec.width_mm();
    range.height_mm = spec.height_mm();
  } else if (!generic_.layouts().empty()) {
    const hid::PenLayout& layout = generic_.layouts().front();
    const hid::Range& x = layout.x.reader.logical();
    const hid::Range& y = layout.y.reader.logical();
    range.x_min = x.minimum;
    range.x_max = x.maximum;
    range.y_min = y.minimum;
    range.y_max = y.maximum;
    range.pressure_max = layout.pressure.reader.logical().maximum;
    range.width_mm = layout.x.map(x.maximum);
    range.height_mm = layout.y.map(y.maximum);
  }
  return range;
}

}  // namespace limn
