#include "drivers/devices/generic_pen.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>

#include "input/sample/tilt.hpp"

namespace limn {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr double kPi = std::numbers::pi;

// Most devices lack most members of a layout: asking first keeps their reading free.
bool is_set(const hid::FieldReader& reader, Bytes report) noexcept {
  return reader.present() && reader.is_set(report);
}

/// What the switches of one report say.
struct Switches {
  bool in_range = false;
  bool inverted = false;
  bool tip = false;
  bool eraser = false;
};

Switches read_switches(const hid::PenLayout& layout, Bytes report) noexcept {
  Switches now;
  now.in_range = is_set(layout.in_range, report) || is_set(layout.sense, report) ||
                 (!layout.in_range && !layout.sense);
  if (layout.transducer == hid::Transducer::kPuck) return now;  // it hovers, whatever it presses
  now.inverted = is_set(layout.invert, report);
  now.eraser = is_set(layout.eraser, report);
  if (layout.tip_switch) {
    now.tip = is_set(layout.tip_switch, report);
  } else if (layout.pressure) {
    const auto& range = layout.pressure.reader.logical();
    now.tip = layout.pressure.reader.read(report).value_or(range.minimum) > range.minimum;
  }
  return now;
}

PenState state_of(const Switches& now) noexcept {
  if (!now.in_range) return PenState::kOutOfRange;
  if (now.eraser || (now.inverted && now.tip)) return PenState::kErasing;
  if (now.inverted) return PenState::kInRangeErasing;
  return now.tip ? PenState::kInContact : PenState::kInRange;
}

Tool tool_of(const hid::PenLayout& layout, PenState state) noexcept {
  if (layout.transducer == hid::Transducer::kPuck) return Tool::kTabletMouse;
  const bool erasing = state == PenState::kErasing || state == PenState::kInRangeErasing;
  return erasing ? Tool::kEraser : Tool::kPen;
}

std::int32_t clamp_count(std::int64_t value) noexcept {
  using Limits = std::numeric_limits<std::int32_t>;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(value, Limits::min(), Limits::max()));
}

/// The counts into `value`; false where there are none.
bool get(const hid::FieldReader& reader, Bytes report, std::int64_t& value) noexcept {
  return reader.present() && reader.read(report, value);
}

void set_axis(PenSample& sample, PenAxis axis, double PenSample::*member, double value) noexcept {
  sample.axes.add(axis);
  sample.*member = value;
}

/// The axis in limn's unit, within low..high, where the report has it.
void read_axis(const hid::AxisReader& axis, Bytes report, double low, double high,
               PenSample& sample, PenAxis which, double PenSample::*member) noexcept {
  std::int64_t counts = 0;
  if (!get(axis.reader, report, counts)) return;
  set_axis(sample, which, member, std::clamp(axis.map(counts), low, high));
}

/// A turn into 0 .. 2 pi, whatever range the device counts it in.
void set_twist(const hid::PenLayout& layout, Bytes report, PenSample& sample) noexcept {
  std::int64_t counts = 0;
  if (!get(layout.twist.reader, report, counts)) return;
  const double turn = std::clamp(layout.twist.map(counts), -2 * kPi, 2 * kPi);
  set_axis(sample, PenAxis::kTwist, &PenSample::twist_rad, turn < 0 ? turn + 2 * kPi : turn);
}

void set_position(const hid::PenLayout& layout, Bytes report, PenSample& sample) noexcept {
  // Fields are at most 64 bits of counts; a tablet of 1 km keeps any garbage finite.
  constexpr double kFarthestMm = 1e6;
  if (layout.data_valid && !layout.data_valid.is_set(report)) return;
  std::int64_t x = 0;
  std::int64_t y = 0;
  if (!get(layout.x.reader, report, x) || !get(layout.y.reader, report, y)) return;
  sample.raw.x = clamp_count(x);
  sample.raw.y = clamp_count(y);
  set_axis(sample, PenAxis::kX, &PenSample::x_mm,
           std::clamp(layout.x.map(x), -kFarthestMm, kFarthestMm));
  set_axis(sample, PenAxis::kY, &PenSample::y_mm,
           std::clamp(layout.y.map(y), -kFarthestMm, kFarthestMm));
}

void set_pressure(const hid::PenLayout& layout, Bytes report, PenSample& sample) noexcept {
  std::int64_t counts = 0;
  if (!get(layout.pressure.reader, report, counts)) return;
  sample.raw.pressure = clamp_count(counts);
  set_axis(sample, PenAxis::kPressure, &PenSample::pressure,
           std::clamp(layout.pressure.map(counts), 0.0, 1.0));
}

void set_tilt(const hid::PenLayout& layout, Bytes report, PenSample& sample) noexcept {
  if (layout.tilt_x || layout.tilt_y) {
    read_axis(layout.tilt_x, report, -kPi / 2, kPi / 2, sample, PenAxis::kTiltX,
              &PenSample::tilt_x_rad);
    read_axis(layout.tilt_y, report, -kPi / 2, kPi / 2, sample, PenAxis::kTiltY,
              &PenSample::tilt_y_rad);
    return;
  }
  constexpr double kDegreesPerRadian = 180 / kPi;
  std::int64_t altitude = 0;
  std::int64_t azimuth = 0;
  if (!get(layout.altitude.reader, report, altitude)) return;
  if (!get(layout.azimuth.reader, report, azimuth)) return;
  const auto degrees = [](const hid::AxisReader& axis, std::int64_t counts) {
    return std::clamp(axis.map(counts), -2 * kPi, 2 * kPi) * kDegreesPerRadian;
  };
  const Tilt tilt = tilt_from_altitude_azimuth(degrees(layout.altitude, altitude),
                                               degrees(layout.azimuth, azimuth));
  set_axis(sample, PenAxis::kTiltX, &PenSample::tilt_x_rad, tilt.x_rad);
  set_axis(sample, PenAxis::kTiltY, &PenSample::tilt_y_rad, tilt.y_rad);
}

void set_serial(const hid::PenLayout& layout, Bytes report, PenSample& sample) noexcept {
  if (!layout.serial && !layout.serial_high) return;
  const std::uint64_t low = layout.serial.read_bits(report).value_or(0);
  const std::uint64_t high = layout.serial_high.read_bits(report).value_or(0);
  const std::uint64_t serial = layout.serial_high ? (high << 32 | (low & 0xFFFFFFFFU)) : low;
  if (serial == 0) return;  // not known (yet)
  sample.axes.add(PenAxis::kSerial);
  sample.serial = serial;
}

PenButtons read_buttons(const hid::PenLayout& layout, Bytes report) noexcept {
  unsigned pressed = 0;
  if (layout.transducer == hid::Transducer::kPuck) {
    for (std::size_t i = 0; i < layout.buttons.size(); ++i) {
      if (is_set(layout.buttons[i], report)) pressed |= 1U << i;
    }
    return static_cast<PenButtons>(pressed);
  }
  if (is_set(layout.barrel_switch, report)) pressed |= 1U;
  if (is_set(layout.secondary_barrel_switch, report)) pressed |= 2U;
  if (is_set(layout.barrel_switch3, report)) pressed |= 4U;
  return static_cast<PenButtons>(pressed);
}

bool ends_before_position(const hid::PenLayout& layout, Bytes report) noexcept {
  const auto end = [](const hid::FieldReader& reader) {
    return (std::size_t{reader.bit_offset()} + reader.bit_size() + 7) / 8;
  };
  return report.size() < std::max(end(layout.x.reader), end(layout.y.reader));
}

}  // namespace

GenericPen::GenericPen(std::vector<hid::PenLayout> layouts) : layouts_(std::move(layouts)) {
  const auto end = std::stable_partition(
      layouts_.begin(), layouts_.end(),
      [](const hid::PenLayout& layout) { return layout.x.has_unit && layout.y.has_unit; });
  sized_ = static_cast<std::size_t>(end - layouts_.begin());
}

const hid::PenLayout* GenericPen::layout_for(Bytes report) const noexcept {
  // Where one report has room for several pens, the first in range speaks.
  if (sized_ == 1) return layouts_.front().matches(report) ? &layouts_.front() : nullptr;
  const hid::PenLayout* first = nullptr;
  for (const hid::PenLayout& layout : layouts()) {
    if (!layout.matches(report)) continue;
    if (first == nullptr) first = &layout;
    if (read_switches(layout, report).in_range) return &layout;
  }
  return first;
}

std::uint32_t GenericPen::count_lost(const hid::PenLayout& layout, Bytes report) noexcept {
  if (!layout.sequence) return 0;
  const auto number = layout.sequence.read(report);
  if (!number) return 0;
  const auto previous = std::exchange(last_sequence_, number);
  const auto& range = layout.sequence.logical();
  const std::int64_t numbers = range.maximum - range.minimum + 1;
  if (!previous || numbers <= 1 || !range.contains(*number) || !range.contains(*previous)) return 0;
  const std::int64_t step = (*number - *previous + numbers) % numbers;
  return step == 0 ? 0 : static_cast<std::uint32_t>(step - 1);
}

void GenericPen::read_scan_time(const hid::PenLayout& layout, Bytes report,
                                PenSample& sample) noexcept {
  if (!layout.scan_time) return;
  std::int64_t ticks = 0;
  const hid::Range& range = layout.scan_time.reader.logical();
  if (sample.state == PenState::kOutOfRange || !get(layout.scan_time.reader, report, ticks) ||
      !range.contains(ticks)) {
    scan_time_.leave();
    return;
  }
  ScanTime::Reading reading;
  reading.ticks = ticks - range.minimum;
  reading.modulus = range.maximum - range.minimum + 1;
  reading.tick_s = layout.scan_time.map.scale;
  reading.time = sample.time;
  reading.touching = in_contact(sample.state);
  const ScanTime::Step step = scan_time_.push(reading);
  if (step.jumped) sample.disturbances.add(Disturbance::kClockJump);
  if (step.lost == 0 || layout.sequence) return;
  sample.lost = step.lost;
  sample.disturbances.add(Disturbance::kGap);
}

ReportClass GenericPen::decode(Bytes report, Timestamp time, PenOutput& out) noexcept {
  const hid::PenLayout* layout = layout_for(report);
  if (layout == nullptr) {
    const bool sizeless = std::any_of(
        layouts_.begin() + static_cast<std::ptrdiff_t>(sized_), layouts_.end(),
        [report](const hid::PenLayout& candidate) { return candidate.matches(report); });
    return sizeless ? ReportClass::kNoSize : ReportClass::kUnknownId;
  }
  if (ends_before_position(*layout, report)) return ReportClass::kTooShort;
  PenSample sample;
  sample.time = time;
  sample.state = state_of(read_switches(*layout, report));
  sample.tool = tool_of(*layout, sample.state);
  if (sample.state == PenState::kOutOfRange) sample.tool = out.machine().last().tool;
  sample.buttons = read_buttons(*layout, report);
  sample.lost = count_lost(*layout, report);
  if (sample.lost > 0) sample.disturbances.add(Disturbance::kGap);
  read_scan_time(*layout, report, sample);
  set_position(*layout, report, sample);
  set_pressure(*layout, report, sample);
  set_tilt(*layout, report, sample);
  set_twist(*layout, report, sample);
  read_axis(layout->distance, report, 0, 1, sample, PenAxis::kDistance, &PenSample::distance);
  set_serial(*layout, report, sample);
  out.push(sample);
  return ReportClass::kPen;
}

}  // namespace limn
