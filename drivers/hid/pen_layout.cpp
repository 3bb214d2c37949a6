#include "drivers/hid/pen_layout.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "drivers/hid/report_layout.hpp"

namespace limn::hid {
namespace {

enum class AxisMap : std::uint8_t { kPosition, kInterval, kHeight, kAngle, kFullTurn, kTime };

struct AxisSlot {
  Usage usage;
  AxisReader PenLayout::*member;
  AxisMap map;
};

// In order of preference where two usages share a member.
constexpr AxisSlot kAxes[] = {
    {usage::kX, &PenLayout::x, AxisMap::kPosition},
    {usage::kY, &PenLayout::y, AxisMap::kPosition},
    {usage::kTipPressure, &PenLayout::pressure, AxisMap::kInterval},
    {usage::kBarrelPressure, &PenLayout::barrel_pressure, AxisMap::kInterval},
    {usage::kXTilt, &PenLayout::tilt_x, AxisMap::kAngle},
    {usage::kYTilt, &PenLayout::tilt_y, AxisMap::kAngle},
    {usage::kAzimuth, &PenLayout::azimuth, AxisMap::kFullTurn},
    {usage::kAltitude, &PenLayout::altitude, AxisMap::kAngle},
    {usage::kTwist, &PenLayout::twist, AxisMap::kFullTurn},
    {usage::kWacomDistance, &PenLayout::distance, AxisMap::kInterval},
    {usage::kZ, &PenLayout::distance, AxisMap::kHeight},
    {usage::kScanTime, &PenLayout::scan_time, AxisMap::kTime},
    {usage::kWacomFingerWheel, &PenLayout::wheel, AxisMap::kInterval},
};

struct FieldSlot {
  Usage usage;
  FieldReader PenLayout::*member;
};

constexpr FieldSlot kFields[] = {
    {usage::kTipSwitch, &PenLayout::tip_switch},
    {usage::kInRange, &PenLayout::in_range},
    {usage::kBarrelSwitch, &PenLayout::barrel_switch},
    {usage::kSecondaryBarrelSwitch, &PenLayout::secondary_barrel_switch},
    {usage::kWacomBarrelSwitch3, &PenLayout::barrel_switch3},
    {usage::kEraser, &PenLayout::eraser},
    {usage::kInvert, &PenLayout::invert},
    {usage::kWacomSense, &PenLayout::sense},
    {usage::kDataValid, &PenLayout::data_valid},
    {usage::kConfidence, &PenLayout::confidence},
    {usage::kContactCount, &PenLayout::contact_count},
    {usage::kBatteryStrength, &PenLayout::battery},
    {usage::kTransducerSerial, &PenLayout::serial},
    {usage::kWacomSerialHigh, &PenLayout::serial_high},
    {usage::kTransducerSerialPart2, &PenLayout::serial_high},
    {usage::kWacomToolType, &PenLayout::tool_type},
    {usage::kWacomSequenceNumber, &PenLayout::sequence},
};

/// The map and whether it rests on a declared unit.
std::pair<LinearMap, bool> axis_map(const Field& field, AxisMap kind) noexcept {
  const Quantity unit = quantity(field.unit);
  switch (kind) {
    case AxisMap::kPosition: {
      const auto mm = position_map(field);
      const LinearMap counts{static_cast<double>(field.logical.minimum), 1, 0};
      return {mm.value_or(counts), mm.has_value()};
    }
    case AxisMap::kInterval:
      return {unit_interval_map(field), false};
    case AxisMap::kHeight: {
      // Z grows from far to near (HID Usage Tables), a distance the other way.
      const LinearMap up = unit_interval_map(field);
      return {{static_cast<double>(field.logical.maximum), -up.scale, 0}, false};
    }
    case AxisMap::kAngle:
    case AxisMap::kFullTurn: {
      const LinearMap map = angle_map(field, kind == AxisMap::kFullTurn);
      const auto declared = physical_map(field, Quantity::kAngle);
      return {map, declared && *declared == map};
    }
    case AxisMap::kTime:
      return {time_map(field), unit == Quantity::kTime};
  }
  return {};
}

/// Fills the absent members of `layout` from one field.
void take_field(const ReportDescriptor& descriptor, std::uint32_t index, PenLayout& layout) {
  const Field& field = descriptor.fields[index];
  const auto first = [&](Usage usage) {
    const auto found = locate_in_field(descriptor, index, usage);
    return found.empty() ? FieldReader{} : found.front().reader;
  };
  if (field.flags.variable() && !field.flags.relative()) {
    for (const AxisSlot& slot : kAxes) {
      AxisReader& axis = layout.*slot.member;
      if (axis) continue;
      axis.reader = first(slot.usage);
      if (axis) std::tie(axis.map, axis.has_unit) = axis_map(field, slot.map);
    }
  }
  for (const FieldSlot& slot : kFields) {
    FieldReader& reader = layout.*slot.member;
    if (!reader) reader = first(slot.usage);
  }
  for (std::size_t i = 0; i < layout.buttons.size(); ++i) {
    const Usage button{page::kButton, static_cast<std::uint16_t>(i + 1)};
    if (!layout.buttons[i]) layout.buttons[i] = first(button);
  }
}

/// Fills the absent members of `layout` from `shared`.
void inherit(const PenLayout& shared, PenLayout& layout) {
  for (const AxisSlot& slot : kAxes) {
    if (!(layout.*slot.member)) layout.*slot.member = shared.*slot.member;
  }
  for (const FieldSlot& slot : kFields) {
    if (!(layout.*slot.member)) layout.*slot.member = shared.*slot.member;
  }
  for (std::size_t i = 0; i < layout.buttons.size(); ++i) {
    if (!layout.buttons[i]) layout.buttons[i] = shared.buttons[i];
  }
}

std::optional<Transducer> transducer_of(Usage collection) noexcept {
  const Usage standard = standard_usage(collection);
  if (standard == usage::kStylus || standard == usage::kPen) return Transducer::kStylus;
  if (standard == usage::kPuck) return Transducer::kPuck;
  if (standard == usage::kFinger) return Transducer::kFinger;
  return std::nullopt;
}

/// For each collection the transducer collection that its fields belong to: the innermost one
/// around them, else the top-level one.
std::vector<CollectionIndex> transducer_collections(const ReportDescriptor& descriptor) {
  std::vector<CollectionIndex> owner(descriptor.collections.size());
  for (std::size_t i = 0; i < owner.size(); ++i) {
    const Collection& collection = descriptor.collections[i];
    const bool own = collection.parent == kNoCollection || transducer_of(collection.usage);
    owner[i] =
        own ? static_cast<CollectionIndex>(i) : owner[static_cast<std::size_t>(collection.parent)];
  }
  return owner;
}

/// A report and a transducer collection in it; sorts by report, then place.
using Place = std::pair<std::uint8_t, CollectionIndex>;

std::map<Place, PenLayout> collect(const ReportDescriptor& descriptor) {
  const auto owner = transducer_collections(descriptor);
  std::map<Place, PenLayout> layouts;
  for (std::uint32_t i = 0; i < descriptor.fields.size(); ++i) {
    const Field& field = descriptor.fields[i];
    if (field.kind != ReportKind::kInput || field.collection == kNoCollection) continue;
    const Place place{field.report_id, owner[static_cast<std::size_t>(field.collection)]};
    take_field(descriptor, i, layouts[place]);
  }
  return layouts;
}

bool has_pen_evidence(const PenLayout& layout, bool own_collection) noexcept {
  if (layout.pressure) return true;
  const bool digitizer =
      own_collection || standard_usage(layout.application).page == page::kDigitizer;
  return digitizer && (layout.tip_switch || layout.in_range);
}

/// What the collection `own` and its surroundings make of a layout. In touch screens a Stylus
/// collection with nothing but a contact is a single-touch finger.
Transducer kind_of(std::optional<Transducer> own, const PenLayout& layout) noexcept {
  const bool touch = is_touch_application(layout.application);
  const bool pen_only = layout.pressure || layout.eraser || layout.invert || layout.barrel_switch;
  if (touch && own == Transducer::kStylus && !pen_only) return Transducer::kFinger;
  return own.value_or(touch ? Transducer::kFinger : Transducer::kStylus);
}

void use_buttons_as_switches(PenLayout& layout) noexcept {
  if (layout.tip_switch || layout.transducer != Transducer::kStylus) return;
  layout.tip_switch = layout.buttons[0];
  if (!layout.barrel_switch) layout.barrel_switch = layout.buttons[1];
  if (!layout.secondary_barrel_switch) layout.secondary_barrel_switch = layout.buttons[2];
}

/// Lower comes first.
int preference(const PenLayout& layout) noexcept {
  if (layout.application.page == page::kDigitizer) return 0;
  return layout.application == usage::kMouse ? 2 : 1;
}

}  // namespace

std::vector<PenLayout> transducer_layouts(const ReportDescriptor& descriptor) {
  const auto collected = collect(descriptor);
  const bool numbered = descriptor.numbered(ReportKind::kInput);
  std::vector<PenLayout> layouts;
  for (const auto& [place, found] : collected) {
    if (layouts.size() == kMaxTransducers) break;
    const auto [report_id, collection] = place;
    const CollectionIndex top = descriptor.top_level(collection);
    PenLayout layout = found;
    if (const auto shared = collected.find({report_id, top});
        collection != top && shared != collected.end()) {
      inherit(shared->second, layout);
    }
    if (!layout.x || !layout.y) continue;
    const auto own =
        transducer_of(descriptor.collections[static_cast<std::size_t>(collection)].usage);
    layout.application = descriptor.collections[static_cast<std::size_t>(top)].usage;
    layout.transducer = kind_of(own, layout);
    if (!has_pen_evidence(layout, own.has_value())) continue;
    layout.report_id = report_id;
    layout.numbered = numbered;
    layout.byte_length = descriptor.report(ReportKind::kInput, report_id)->byte_length;
    layout.collection = collection;
    use_buttons_as_switches(layout);
    layouts.push_back(layout);
  }
  return layouts;
}

std::vector<PenLayout> pen_layouts(const ReportDescriptor& descriptor) {
  std::vector<PenLayout> pens = transducer_layouts(descriptor);
  std::erase_if(pens,
                [](const PenLayout& layout) { return layout.transducer == Transducer::kFinger; });
  std::stable_sort(pens.begin(), pens.end(), [](const PenLayout& a, const PenLayout& b) {
    return preference(a) < preference(b);
  });
  return pens;
}

}  // namespace limn::hid
