#include "drivers/devices/evdev_pen_decoder.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/devices/pen_spec.hpp"
#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/pen_layout.hpp"

namespace limn {
namespace {

// <linux/input-event-codes.h>
constexpr std::uint16_t kEvSyn = 0x00;
constexpr std::uint16_t kEvKey = 0x01;
constexpr std::uint16_t kEvAbs = 0x03;
constexpr std::uint16_t kEvMsc = 0x04;
constexpr std::uint16_t kSynDropped = 3;
constexpr std::uint16_t kMscSerial = 0;
constexpr std::int32_t kNoSerial = -1;
constexpr std::uint16_t kAbsX = 0x00;
constexpr std::uint16_t kAbsY = 0x01;
constexpr std::uint16_t kAbsZ = 0x02;
constexpr std::uint16_t kAbsPressure = 0x18;
constexpr std::uint16_t kAbsDistance = 0x19;
constexpr std::uint16_t kAbsTiltX = 0x1A;
constexpr std::uint16_t kAbsTiltY = 0x1B;
constexpr std::uint16_t kAbsMtFirst = 0x2F;
constexpr std::uint16_t kAbsMtLast = 0x3D;
constexpr std::uint16_t kBtnLeft = 0x110;
constexpr std::uint16_t kBtnExtra = 0x114;
constexpr std::uint16_t kBtnToolPen = 0x140;
constexpr std::uint16_t kBtnToolLens = 0x147;
constexpr std::uint16_t kBtnStylus3 = 0x149;
constexpr std::uint16_t kBtnTouch = 0x14A;
constexpr std::uint16_t kBtnStylus = 0x14B;
constexpr std::uint16_t kBtnStylus2 = 0x14C;

// Bits of tools_, by code from BTN_TOOL_PEN: pen, rubber, brush, pencil, airbrush, finger, mouse,
// lens.
constexpr unsigned kRubber = 1U << 1;
constexpr unsigned kFinger = 1U << 5;
constexpr unsigned kMice = 1U << 6 | 1U << 7;
constexpr unsigned kPens = 0xFFU & ~(kRubber | kFinger | kMice);

constexpr std::uint16_t kWacomVendor = 0x056A;
constexpr double kPi = std::numbers::pi;
constexpr double kRadiansPerDegree = kPi / 180;  // the nearest double

double span_of(std::int32_t minimum, std::int32_t maximum) noexcept {
  return static_cast<double>(maximum) - minimum;
}

double unit_interval(double counts, double span) noexcept {
  return span > 0 ? std::clamp(counts / span, 0.0, 1.0) : 0.0;
}

PenButtons with_bit(PenButtons buttons, unsigned bit, bool down) noexcept {
  return static_cast<PenButtons>(down ? buttons | 1U << bit : buttons & ~(1U << bit));
}

/// Tilt counts a radian: as declared, else degrees, tenths or hundredths by what the range allows.
double tilt_counts_per_radian(const EvdevAxis& axis) noexcept {
  if (axis.resolution > 0) return axis.resolution;
  constexpr double kMostDegrees = 127;
  const double reach = span_of(axis.minimum, axis.maximum) / 2;
  double per_degree = 1;
  while (per_degree < 100 && reach / per_degree > kMostDegrees) per_degree *= 10;
  return per_degree / kRadiansPerDegree;
}

std::string id_text(const TraceDevice& device) {
  char text[16];
  std::snprintf(text, sizeof text, "%04x:%04x", unsigned{device.vendor}, unsigned{device.product});
  return text;
}

bool is_dropped(const EvdevEvent& event) noexcept {
  return event.type == kEvSyn && event.code == kSynDropped;
}

bool is_touch_axis(const EvdevAxis& axis) noexcept {
  return axis.code >= kAbsMtFirst && axis.code <= kAbsMtLast;
}

/// The pens that the report descriptor declares; none where it is unknown or broken.
std::vector<hid::PenLayout> declared_pens(const TraceDevice& device) {
  const auto descriptor = hid::parse_descriptor(device.report_descriptor);
  return descriptor ? hid::pen_layouts(*descriptor) : std::vector<hid::PenLayout>();
}

/// Counts per mm or radian of a kernel axis by the HID field behind it: that with its very range
/// and a declared unit. Nothing where no pen has one, or two disagree.
std::optional<double> declared_counts_per_unit(const std::vector<hid::PenLayout>& pens,
                                               const EvdevAxis& axis) {
  std::optional<double> found;
  for (const hid::PenLayout& pen : pens) {
    const hid::AxisReader* field = nullptr;
    if (axis.code == kAbsX) field = &pen.x;
    if (axis.code == kAbsY) field = &pen.y;
    if (axis.code == kAbsTiltX) field = &pen.tilt_x;
    if (axis.code == kAbsTiltY) field = &pen.tilt_y;
    if (field == nullptr || !*field || !field->has_unit || !(field->map.scale > 0)) continue;
    const hid::Range range = field->reader.logical();
    if (range.minimum != axis.minimum || range.maximum != axis.maximum) continue;
    const double counts = 1 / field->map.scale;
    if (found && *found != counts) return std::nullopt;
    found = counts;
  }
  return found;
}

}  // namespace

EvdevPenDecoder::EvdevPenDecoder() : output_(std::make_unique<PenOutput>()) {}

Expected<EvdevPenDecoder> EvdevPenDecoder::make(const TraceDevice& device) {
  EvdevPenDecoder decoder;
  if (auto taken = decoder.take_axes(device); !taken) return tl::unexpected(taken.error());
  return decoder;
}

Expected<void> EvdevPenDecoder::take_axes(const TraceDevice& device) {
  wacom_ = device.vendor == kWacomVendor;
  const std::vector<hid::PenLayout> pens = declared_pens(device);
  const auto take = [&](std::uint16_t code) {
    Axis axis;
    for (const EvdevAxis& declared : device.axes) {
      if (declared.code != code || declared.maximum <= declared.minimum) continue;
      axis = {declared.minimum, declared.maximum, double(declared.resolution),
              double(declared.minimum), true};
      if (code == kAbsTiltX || code == kAbsTiltY) {
        axis.per_unit = tilt_counts_per_radian(declared);
        // Kernels before 3.19 shifted Wacom's -64..63 to 0..127.
        axis.middle = declared.minimum == 0 ? (span_of(0, declared.maximum) + 1) / 2 : 0;
      }
      axis.per_unit = declared_counts_per_unit(pens, declared).value_or(axis.per_unit);
    }
    return axis;
  };
  x_ = take(kAbsX);
  y_ = take(kAbsY);
  pressure_ = take(kAbsPressure);
  distance_ = take(kAbsDistance);
  tilt_x_ = take(kAbsTiltX);
  tilt_y_ = take(kAbsTiltY);
  twist_ = take(kAbsZ);
  const bool fingers = std::any_of(device.axes.begin(), device.axes.end(), is_touch_axis);
  has_pen_ = x_.present && y_.present && pressure_.present && !fingers;
  if (!has_pen_) return {};

  const PenSpec* spec = find_pen_spec(device.vendor, device.product);
  for (const auto& [axis, axis_name] : {std::pair{&x_, "ABS_X"}, std::pair{&y_, "ABS_Y"}}) {
    if (axis->per_unit > 0) continue;
    if (spec == nullptr) {
      return fail(ErrorCode::kMissing, "",
                  std::string(axis_name) + " has no resolution, and no table knows device " +
                      id_text(device) + ", so its size in mm is unknown",
                  "add the resolution (units a mm) as the sixth number of the axis' A: line");
    }
    axis->per_unit = spec->counts_per_mm;
  }
  return {};
}

std::span<const PenSample> EvdevPenDecoder::decode(const EvdevFrame& frame) noexcept {
  output_->begin(frame.device);
  if (!has_pen_) return {};
  if (std::any_of(frame.events.begin(), frame.events.end(), is_dropped)) {
    dropped_ = true;
    return {};
  }
  position_moved_ = false;
  bool told = false;
  for (const EvdevEvent& event : frame.events) told = apply(event) || told;
  if (!told) return {};
  // A pen that was in range has left even if a finger is down.
  const bool finger_alone = tools_ == kFinger;
  if (finger_alone && output_->machine().last().state == PenState::kOutOfRange) return {};
  PenSample sample = current(frame.time);
  const bool nothing_new = sample.state == PenState::kOutOfRange && !position_moved_ &&
                           output_->machine().last().state == PenState::kOutOfRange;
  if (nothing_new) return {};
  if (std::exchange(dropped_, false)) {
    sample.lost = 1;
    sample.lost_estimated = true;
    sample.disturbances.add(Disturbance::kOverrun);
  }
  output_->push(sample);
  return output_->samples();
}

std::span<const PenSample> EvdevPenDecoder::disconnect(DeviceIndex device,
                                                       Timestamp time) noexcept {
  output_->begin(device);
  output_->disconnect(time);
  return output_->samples();
}

bool EvdevPenDecoder::apply(const EvdevEvent& event) noexcept {
  switch (event.type) {
    case kEvKey:
      return apply_key(event.code, event.value != 0);
    case kEvAbs:
      return apply_axis(event.code, event.value);
    case kEvMsc:
      // -1 is the pad's, whose frames say nothing of the pen.
      if (event.code != kMscSerial || event.value == kNoSerial) return false;
      held_.serial = static_cast<std::uint32_t>(event.value);
      if (held_.serial != 0) {
        held_.axes.add(PenAxis::kSerial);
      } else {
        held_.axes.remove(PenAxis::kSerial);
      }
      return true;  // even alone: the pen reported, unmoved
    default:
      return false;
  }
}

bool EvdevPenDecoder::apply_key(std::uint16_t code, bool down) noexcept {
  if (code >= kBtnToolPen && code <= kBtnToolLens) {
    tools_ = with_bit(tools_, code - kBtnToolPen, down);
    tool_key_seen_ = true;
    return true;
  }
  if (code >= kBtnLeft && code <= kBtnExtra) {
    mouse_ = with_bit(mouse_, code - kBtnLeft, down);
    return true;
  }
  switch (code) {
    case kBtnTouch:
      touching_ = down;
      return true;
    case kBtnStylus:
      barrel_ = with_bit(barrel_, 0, down);
      return true;
    case kBtnStylus2:
      barrel_ = with_bit(barrel_, 1, down);
      return true;
    case kBtnStylus3:
      barrel_ = with_bit(barrel_, 2, down);
      return true;
    default:
      return false;
  }
}

bool EvdevPenDecoder::apply_axis(std::uint16_t code, std::int32_t value) noexcept {
  const auto set = [&](const Axis& axis, PenAxis which, double PenSample::*member, double number) {
    if (!axis.present) return false;
    held_.axes.add(which);
    held_.*member = number;
    return true;
  };
  const auto offset = [value](const Axis& axis) { return value - axis.middle; };
  const auto interval = [value](const Axis& axis) {
    return unit_interval(static_cast<double>(value) - axis.minimum,
                         span_of(axis.minimum, axis.maximum));
  };
  const auto tilt = [&](const Axis& axis) {
    return std::clamp(offset(axis) / axis.per_unit, -kPi / 2, kPi / 2);
  };
  switch (code) {
    case kAbsX:
      held_.raw.x = value;
      position_moved_ = true;
      return set(x_, PenAxis::kX, &PenSample::x_mm, offset(x_) / x_.per_unit);
    case kAbsY:
      held_.raw.y = value;
      position_moved_ = true;
      return set(y_, PenAxis::kY, &PenSample::y_mm, offset(y_) / y_.per_unit);
    case kAbsPressure:
      held_.raw.pressure = value;
      return set(pressure_, PenAxis::kPressure, &PenSample::pressure, interval(pressure_));
    case kAbsDistance:
      return set(distance_, PenAxis::kDistance, &PenSample::distance, interval(distance_));
    case kAbsTiltX:
      return set(tilt_x_, PenAxis::kTiltX, &PenSample::tilt_x_rad, tilt(tilt_x_));
    case kAbsTiltY:
      return set(tilt_y_, PenAxis::kTiltY, &PenSample::tilt_y_rad, tilt(tilt_y_));
    case kAbsZ: {
      const double turn = (static_cast<double>(value) - twist_.minimum) /
                          (span_of(twist_.minimum, twist_.maximum) + 1);
      // Wacom: -900 is half a turn before the zero that lies a quarter turn left of upright.
      const double turned = wacom_ ? turn + 0.25 : turn;
      const double within = turned >= 1 ? turned - 1 : turned;
      return set(twist_, PenAxis::kTwist, &PenSample::twist_rad,
                 std::clamp(within, 0.0, 1.0) * 2 * kPi);
    }
    default:
      return false;
  }
}

PenSample EvdevPenDecoder::current(Timestamp time) noexcept {
  PenSample sample = held_;
  sample.time = time;
  const bool in_range = tool_key_seen_ ? (tools_ & ~kFinger) != 0 : touching_;
  if ((tools_ & kRubber) != 0) {
    sample.tool = Tool::kEraser;
  } else if ((tools_ & kMice) != 0 && (tools_ & kPens) == 0) {
    sample.tool = Tool::kTabletMouse;
  } else {
    sample.tool = Tool::kPen;
  }
  if (!in_range) {
    sample.tool = output_->machine().last().tool;
    sample.state = PenState::kOutOfRange;
    // Wacom's driver sets the axes to 0 when a tool leaves: that is no position.
    if (wacom_ && sample.raw.x == 0 && sample.raw.y == 0) {
      PenSample bare;
      bare.time = time;
      bare.tool = sample.tool;
      if (sample.axes.has(PenAxis::kSerial)) bare.axes.add(PenAxis::kSerial);
      bare.serial = sample.serial;
      sample = bare;
    }
    held_.axes.remove(PenAxis::kTwist);  // the next tool may have none
    held_.twist_rad = 0;
    return sample;
  }
  sample.state = state_of(sample.tool, touching_);
  sample.buttons = sample.tool == Tool::kTabletMouse ? mouse_ : barrel_;
  return sample;
}

PenRange EvdevPenDecoder::range() const noexcept {
  PenRange range;
  if (!has_pen_) return range;
  range.x_min = x_.minimum;
  range.x_max = x_.maximum;
  range.y_min = y_.minimum;
  range.y_max = y_.maximum;
  range.pressure_max = pressure_.maximum;
  range.width_mm = span_of(x_.minimum, x_.maximum) / x_.per_unit;
  range.height_mm = span_of(y_.minimum, y_.maximum) / y_.per_unit;
  return range;
}

PenAxes EvdevPenDecoder::axes() const noexcept {
  PenAxes axes;
  if (!has_pen_) return axes;
  const auto add = [&axes](const Axis& axis, PenAxis which) {
    if (axis.present) axes.add(which);
  };
  add(x_, PenAxis::kX);
  add(y_, PenAxis::kY);
  add(pressure_, PenAxis::kPressure);
  add(distance_, PenAxis::kDistance);
  add(tilt_x_, PenAxis::kTiltX);
  add(tilt_y_, PenAxis::kTiltY);
  add(twist_, PenAxis::kTwist);
  return axes;
}

}  // namespace limn
