#include "drivers/devices/pen_decoder.hpp"

#include <algorithm>
#include <initializer_list>
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

bool is_wacom(const PenSpec& spec) noexcept { return spec.family <= kLastWacomFamily; }

bool is_ugee(PenFamily family) noexcept {
  return family == PenFamily::kUgee || family == PenFamily::kUgeeGen2;
}

/// UC-Logic tablets look the same before and after their initialisation and after the Linux
/// kernel's driver has touched their reports: only the descriptor knows. Of a tablet that was not
/// initialised it explains the report, sizes included, wherever it can.
bool gives_way_to_descriptor(const PenSpec& spec, const GenericPen& generic) noexcept {
  const bool uninitialised = spec.report_id != 0 && spec.unconditional();
  if (spec.family != PenFamily::kUcLogicV1 && spec.family != PenFamily::kUcLogicV2 &&
      !uninitialised) {
    return false;
  }
  const auto layouts = generic.layouts();
  return std::any_of(layouts.begin(), layouts.end(), [&spec](const hid::PenLayout& layout) {
    return layout.report_id == form_report_id(spec);
  });
}

/// The descriptors of these vendors call their second barrel switch an eraser: seen in the
/// recordings of Huion K26 and UGEE M708 v2, whose pens have two switches and no eraser.
void correct_second_switch(std::uint16_t vendor, std::vector<hid::PenLayout>& layouts) {
  constexpr std::array<std::uint16_t, 4> kVendors = {0x256C, 0x28BD, 0x2FEB, 0x5543};
  if (std::find(kVendors.begin(), kVendors.end(), vendor) == kVendors.end()) return;
  for (hid::PenLayout& layout : layouts) {
    if (!layout.eraser || layout.secondary_barrel_switch) continue;
    layout.secondary_barrel_switch = layout.eraser;
    layout.eraser = hid::FieldReader();
  }
}

/// The row that `parameters` make, of what the tables know of the device otherwise.
PenSpec row_of(const PenParameters& parameters, const PenIdentity& identity,
               const PenForms& forms) noexcept {
  PenSpec row;
  row.vendor = identity.vendor;
  row.product = identity.product;
  row.name = "initialised tablet";
  row.family = parameters.family;
  for (std::size_t i = 0; i < forms.count; ++i) {
    const PenSpec& form = *forms.rows[i];
    if (form.report_id != 0) continue;  // as it reports uninitialised
    if (form.family == parameters.family || (is_ugee(form.family) && is_ugee(parameters.family))) {
      row = form;
      break;
    }
  }
  // String 100 has 16 bits for a range, to which a display's need not fit.
  if (is_ugee(parameters.family) && row.x_max > 0xFFFF) return row;
  row.x_max = parameters.x_max;
  row.y_max = parameters.y_max;
  row.pressure_max = parameters.pressure_max;
  row.counts_per_mm = parameters.counts_per_mm;
  row.counts_per_mm_y = 0;
  row.leaves_silently = parameters.family == PenFamily::kUcLogicV2;
  return row;
}

}  // namespace

PenDecoder::PenDecoder() : output_(std::make_unique<PenOutput>()) {
  classes_.fill(ReportClass::kUnknownId);
}

Expected<PenDecoder> PenDecoder::make(std::uint16_t vendor, std::uint16_t product,
                                      std::span<const std::uint8_t> report_descriptor) {
  PenIdentity identity;
  identity.vendor = vendor;
  identity.product = product;
  return make(identity, report_descriptor);
}

Expected<PenDecoder> PenDecoder::make(const PenIdentity& identity,
                                      std::span<const std::uint8_t> report_descriptor,
                                      const PenParameters* parameters) {
  PenIdentity known = identity;
  if (known.descriptor_bytes == 0) known.descriptor_bytes = report_descriptor.size();
  PenDecoder decoder;
  if (report_descriptor.empty()) {
    decoder.choose_rows(known, parameters, false);
    if (decoder.spec() != nullptr) return decoder;
    return fail(ErrorCode::kMissing, "", "the device has no report descriptor",
                "add its descriptor, e.g. --descriptor FILE");
  }
  auto descriptor = hid::parse_descriptor(report_descriptor);
  if (!descriptor) {
    decoder.choose_rows(known, parameters, false);
    if (decoder.spec() != nullptr) return decoder;  // the table suffices
    Error error = std::move(descriptor.error());
    error.at = error.at.empty() ? "report descriptor" : "report descriptor, " + error.at;
    return tl::unexpected(std::move(error));
  }
  std::vector<hid::PenLayout> layouts = hid::pen_layouts(*descriptor);
  correct_second_switch(known.vendor, layouts);
  decoder.numbered_ = descriptor->numbered(hid::ReportKind::kInput);
  decoder.classes_ = classify(*descriptor);
  decoder.generic_ = GenericPen(std::move(layouts));
  decoder.choose_rows(known, parameters, true);
  return decoder;
}

void PenDecoder::choose_rows(const PenIdentity& identity, const PenParameters* parameters,
                             bool has_descriptor) {
  const PenForms forms = find_pen_forms(identity);
  if (forms.count > 0 && is_wacom(*forms.rows[0])) {
    const PenSpec& spec = *forms.rows[0];
    if (!descriptor_knows_better(spec, generic_)) wacom_.emplace(spec);
    return;
  }
  std::array<PenSpec, kMaxPenForms> chosen;
  std::size_t count = 0;
  if (parameters != nullptr) chosen[count++] = row_of(*parameters, identity, forms);
  for (std::size_t i = 0; i < forms.count && count < kMaxPenForms; ++i) {
    const PenSpec& form = *forms.rows[i];
    if (count > 0 && form_report_id(chosen[0]) == form_report_id(form)) continue;
    if (gives_way_to_descriptor(form, generic_)) continue;
    chosen[count++] = form;
  }
  if (count == 0) return;
  vendor_.emplace(std::span<const PenSpec>(chosen.data(), count));
  speaks_for_itself_ =
      has_descriptor && parameters == nullptr &&
      std::none_of(chosen.begin(), chosen.begin() + count,
                   [this](const auto& form) { return declares(form_report_id(form)); });
}

bool PenDecoder::declares(std::uint8_t report_id) const noexcept {
  return numbered_ && classes_[report_id] != ReportClass::kUnknownId;
}

PenDecoder::Decoded PenDecoder::decode(const Report& report) noexcept {
  output_->begin(report.device);
  push_due(report.time);
  if (report.bytes.empty()) return {ReportClass::kTooShort, output_->samples()};
  ReportClass kind = ReportClass::kUnknownId;
  if (wacom_) kind = wacom_->decode(report.bytes, report.time, *output_);
  if (vendor_) {
    kind = vendor_->decode(report.bytes, report.time, *output_);
    if (kind == ReportClass::kPen) speaks_for_itself_ = false;
  }
  if (kind == ReportClass::kUnknownId) {
    kind = generic_.decode(report.bytes, report.time, *output_);
    if (vendor_ && kind == ReportClass::kPen) vendor_->overtaken();
  }
  if (kind == ReportClass::kUnknownId) kind = class_in_descriptor(report.bytes);
  return {kind, output_->samples()};
}

void PenDecoder::push_due(Timestamp now) noexcept {
  if (!vendor_) return;  // of most devices: due() would cost as much as a field
  if (const auto leaves = vendor_->due(); leaves && *leaves <= now) {
    vendor_->leave(*leaves, *output_);
  }
}

std::span<const PenSample> PenDecoder::advance(DeviceIndex device, Timestamp now) noexcept {
  output_->begin(device);
  push_due(now);
  return output_->samples();
}

std::span<const PenSample> PenDecoder::disconnect(DeviceIndex device, Timestamp time) noexcept {
  output_->begin(device);
  push_due(time);
  if (vendor_) {
    vendor_->leave(time, *output_);
  } else {
    output_->disconnect(time);
  }
  return output_->samples();
}

ReportClass PenDecoder::class_in_descriptor(std::span<const std::uint8_t> report) const noexcept {
  return classes_[numbered_ ? report[0] : 0];
}

PenRange PenDecoder::range() const noexcept {
  PenRange range;
  if (const PenSpec* row = spec()) {
    range.x_max = row->x_max;
    range.y_max = row->y_max;
    range.pressure_max = row->pressure_max;
    range.width_mm = row->width_mm();
    range.height_mm = row->height_mm();
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

PenAxes PenDecoder::axes() const noexcept {
  PenAxes axes;
  const auto add = [&axes](bool given, std::initializer_list<PenAxis> which) {
    if (!given) return;
    for (const PenAxis axis : which) axes.add(axis);
  };
  const PenSpec* row = spec();
  if (row == nullptr && generic_.layouts().empty()) return axes;
  add(true, {PenAxis::kX, PenAxis::kY});
  if (row != nullptr) {
    const FamilyAxes given = family_axes(row->family);
    add(row->pressure_max > 0, {PenAxis::kPressure});
    add(row->distance_max > 0, {PenAxis::kDistance});
    add(row->tilt || given.tilt, {PenAxis::kTiltX, PenAxis::kTiltY});
    add(given.twist, {PenAxis::kTwist});
    add(given.serial, {PenAxis::kSerial});
    return axes;
  }
  const hid::PenLayout& pen = generic_.layouts().front();
  const bool direction = pen.azimuth && pen.altitude;
  add(static_cast<bool>(pen.pressure), {PenAxis::kPressure});
  add(pen.tilt_x || direction, {PenAxis::kTiltX});
  add(pen.tilt_y || direction, {PenAxis::kTiltY});
  add(static_cast<bool>(pen.twist), {PenAxis::kTwist});
  add(static_cast<bool>(pen.distance), {PenAxis::kDistance});
  add(static_cast<bool>(pen.serial), {PenAxis::kSerial});
  return axes;
}

}  // namespace limn
