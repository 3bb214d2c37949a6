#include "drivers/devices/vendor_pen_decoder.hpp"

#include <algorithm>
#include <bit>

#include "drivers/devices/pen_bytes.hpp"
#include "input/base/expect.hpp"

namespace limn {

using namespace pen_bytes;  // byte access

namespace {

using F = PenFamily;

// KYE gives each of its tools a report ID beside the pen's.
constexpr std::uint8_t kKyeMouseId = 0x11;
constexpr std::uint8_t kKyePadId = 0x12;

constexpr bool speaks(const PenSpec& form, std::uint8_t own_id, std::uint8_t id) noexcept {
  if (id == own_id) return true;
  switch (form.family) {
    case F::kUcLogicV1:
      // Read or written to, these switch to the same form under the ID of another interface.
      return id == 0x02;
    case F::kKye:
      return id == kKyeMouseId || id == kKyePadId;
    default:
      return false;
  }
}

/// The bytes that a family's decoder always reads.
constexpr std::size_t needed_bytes(PenFamily family) noexcept {
  switch (family) {
    case F::kUcLogicV2:
      return 12;
    case F::kUgee:
    case F::kUcLogicV1:
    case F::kKye:
    case F::kPenAsMouse:
      return 8;
    case F::kUgeeGen2:
      return 14;
    case F::kVeikk:
      return 9;
    case F::kKyeMouse:
      return 6;
    default:
      return 0;
  }
}

}  // namespace

VendorPenDecoder::VendorPenDecoder(std::span<const PenSpec> forms) noexcept {
  LIMN_EXPECT(!forms.empty() && forms.size() <= kMaxPenForms);
  std::copy(forms.begin(), forms.end(), forms_.begin());
  count_ = forms.size();
}

ReportClass VendorPenDecoder::decode(Bytes report, Timestamp time, PenOutput& out) noexcept {
  if (report.empty()) return ReportClass::kTooShort;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!speaks(forms_[i], form_report_id(forms_[i]), report[0])) continue;
    if (report.size() < needed_bytes(forms_[i].family)) return ReportClass::kTooShort;
    const std::size_t before = active_;
    active_ = i;
    const ReportClass kind = decode_form(report, time, out);
    if (kind == ReportClass::kPen) {
      last_time_ = time;
    } else {
      active_ = before;
    }
    return kind;
  }
  return ReportClass::kUnknownId;
}

ReportClass VendorPenDecoder::decode_form(Bytes report, Timestamp time, PenOutput& out) noexcept {
  switch (spec().family) {
    case F::kUcLogicV1:
      return uclogic_v1(report, time, out);
    case F::kUcLogicV2:
      return uclogic_v2(report, time, out);
    case F::kUgee:
    case F::kUgeeGen2:
      return ugee(report, time, out);
    case F::kVeikk:
      return veikk(report, time, out);
    case F::kKye:
      return kye(report, time, out);
    case F::kKyeMouse:
      return kye_mouse(report, time, out);
    case F::kPenAsMouse:
      return pen_as_mouse(report, time, out);
    default:
      return ReportClass::kUnknownId;
  }
}

std::optional<Timestamp> VendorPenDecoder::due() const noexcept {
  if (!present_ || !spec().leaves_silently) return std::nullopt;
  return std::min(last_time_, Timestamp::max() - kLeavingTimeout) + kLeavingTimeout;
}

void VendorPenDecoder::leave(Timestamp time, PenOutput& out) noexcept {
  present_ = false;
  out.disconnect(time);
}

// Report 7: le16 x 2, y 4, pressure 6. d1: C0 out of range, E0 the frame's keys; bits 0 tip, 1 and
// 2 barrel switches. Before its initialisation a tablet means the reverse by bit 6, in range, and
// shows it by sending it with one of the switches. Sources: kernel driver hid-uclogic; recordings
// of Huion K26.
ReportClass VendorPenDecoder::uclogic_v1(Bytes report, Timestamp time, PenOutput& out) noexcept {
  const std::uint8_t flags = report[1];
  if ((flags & 0x60U) == 0x60U) return ReportClass::kPad;
  bit6_in_range_ = bit6_in_range_ || (has(flags, 0x40) && has(flags, 0x07));
  if (has(flags, 0x40) != bit6_in_range_) return out_of_range(time, out);
  return plain_pen(report, time, out);
}

// Report 8: le16 x 2, y 4, pressure 6, their third bytes at 8 and 9, tilt s8 10 (right) and 11
// (away from the user). d1: E0, E3 keys, F0 strip or ring, F1 dial; bit 7 in range, bits 0 tip,
// 1 to 3 barrel switches. The New 1060 Plus sends a d1 of 0 with the last position, but only when
// the pen is back. Sources: kernel driver hid-uclogic, recordings.
ReportClass VendorPenDecoder::uclogic_v2(Bytes report, Timestamp time, PenOutput& out) noexcept {
  const std::uint8_t flags = report[1];
  if ((flags & 0xE0U) == 0xE0U) return ReportClass::kPad;
  if (!has(flags, 0x80)) return out_of_range(time, out);
  PenSample sample = start(time, Tool::kPen, has(flags, 0x01),
                           buttons(has(flags, 0x02), has(flags, 0x04), has(flags, 0x08)));
  set_position(sample, le16(report, 2) | report[8] << 16, le16(report, 4) | report[9] << 16);
  set_pressure(sample, le16(report, 6));
  set_tilt(sample, signed8(report[10]), -signed8(report[11]));
  return in_range(sample, out);
}

// Report 2: le16 x 2, y 4, pressure 6; from 10 bytes on tilt s8 8, 9; from 12 bytes on the third
// bytes of x, y at 10, 11. d1: C0 out of range, bit 4 not the pen (F0 keys, F2 battery, F8 radio
// link); bits 0 tip, 1 and 2 barrel switches, 3 eraser. Bits of the pressure above its range mean
// something else. The second generation sends 14 bytes and the pressure's bit 13 in d13.
// Sources: kernel driver hid-uclogic, OpenTabletDriver.
ReportClass VendorPenDecoder::ugee(Bytes report, Timestamp time, PenOutput& out) noexcept {
  const std::uint8_t flags = report[1];
  if (has(flags, 0x10)) {
    return flags == 0xF2 || flags == 0xF8 ? ReportClass::kStatus : ReportClass::kPad;
  }
  if (!has(flags, 0x80) || has(flags, 0x40)) return out_of_range(time, out);
  PenSample sample = start(time, has(flags, 0x08) ? Tool::kEraser : Tool::kPen, has(flags, 0x01),
                           buttons(has(flags, 0x02), has(flags, 0x04)));
  const bool wide = report.size() >= 12;
  set_position(sample, le16(report, 2) | (wide ? report[10] << 16 : 0),
               le16(report, 4) | (wide ? report[11] << 16 : 0));
  std::int32_t pressure = le16(report, 6);
  if (spec().family == F::kUgeeGen2) pressure = (pressure & 0xBFFF) | (report[13] & 1) << 13;
  const auto levels = static_cast<std::uint32_t>(spec().pressure_max) + 1;
  set_pressure(sample, pressure & static_cast<std::int32_t>(std::bit_ceil(levels) - 1));
  if (report.size() >= 10) set_tilt(sample, signed8(report[8]), signed8(report[9]));
  return in_range(sample, out);
}

// Report 9, d1: 41 pen, 42 keys, 43 touch pad. A pen's d2: C0 out of range, else bit 5; bits 0 tip,
// 1 and 2 barrel switches. Up to 12 bytes: le16 x 3, y 5, pressure 7. From 13 bytes on: le24 x 3,
// y 6, le16 pressure 9, tilt s8 11, 12. Sources: OpenTabletDriver; the keys and the touch pad also
// a recording of the A30.
ReportClass VendorPenDecoder::veikk(Bytes report, Timestamp time, PenOutput& out) noexcept {
  if (report[1] == 0x43) return ReportClass::kTouch;
  const std::uint8_t flags = report[2];
  if (report[1] != 0x41 || (!has(flags, 0x20) && flags != 0xC0)) return ReportClass::kPad;
  if (has(flags, 0x40)) return out_of_range(time, out);
  PenSample sample =
      start(time, Tool::kPen, has(flags, 0x01), buttons(has(flags, 0x02), has(flags, 0x04)));
  if (report.size() < 13) {
    set_position(sample, le16(report, 3), le16(report, 5));
    set_pressure(sample, le16(report, 7));
    return in_range(sample, out);
  }
  set_position(sample, le16(report, 3) | report[5] << 16, le16(report, 6) | report[8] << 16);
  set_pressure(sample, le16(report, 9));
  set_tilt(sample, signed8(report[11]), signed8(report[12]));
  return in_range(sample, out);
}

// Reports 10 (pen) and 11 (tablet mouse): le16 x 2, y 4, the pen's pressure 6. d1: bit 7 in range;
// bits 0 tip, 1 and 2 barrel switches, or the mouse's three buttons. The first MousePen i608X does
// not say when its mouse is in range, so that gives nothing. Source: kernel driver hid-kye.
ReportClass VendorPenDecoder::kye(Bytes report, Timestamp time, PenOutput& out) noexcept {
  if (report[0] == kKyePadId) return ReportClass::kPad;
  const std::uint8_t flags = report[1];
  if (!has(flags, 0x80)) return out_of_range(time, out);
  if (report[0] == kKyeMouseId) {
    PenSample mouse = start(time, Tool::kTabletMouse, false,
                            buttons(has(flags, 0x01), has(flags, 0x02), has(flags, 0x04)));
    set_position(mouse, le16(report, 2), le16(report, 4));
    return in_range(mouse, out);
  }
  return plain_pen(report, time, out);
}

// Report 9: le16 x 2, y 4. d1: bit 7 in range, 81 tip, 83 and 85 barrel switches (the tip's bit
// accompanies them above the surface too, so a tip under a pressed switch cannot be told).
// Source: recordings of the PenSketch M912.
ReportClass VendorPenDecoder::kye_mouse(Bytes report, Timestamp time, PenOutput& out) noexcept {
  const std::uint8_t flags = report[1];
  if (!has(flags, 0x80)) return out_of_range(time, out);
  PenSample sample = start(time, Tool::kPen, (flags & 0x07U) == 0x01U,
                           buttons(has(flags, 0x02), has(flags, 0x04)));
  set_position(sample, le16(report, 2), le16(report, 4));
  return in_range(sample, out);
}

// Le16 x 2, y 4, pressure 6. d1: bits 0 tip, 1 and 2 barrel switches; where bit 7 is set, bit 6
// says in range (always, in the recordings of the W58). Source: recordings of Huion W58, VEIKK A30,
// XP-Pen Star 06.
ReportClass VendorPenDecoder::pen_as_mouse(Bytes report, Timestamp time, PenOutput& out) noexcept {
  const std::uint8_t flags = report[1];
  if ((flags & 0xC0U) == 0x80U) return out_of_range(time, out);
  return plain_pen(report, time, out);
}

// What the simplest forms share: d1 bits 0 tip, 1 and 2 barrel switches, le16 x 2, y 4, pressure 6.
ReportClass VendorPenDecoder::plain_pen(Bytes report, Timestamp time, PenOutput& out) noexcept {
  const std::uint8_t flags = report[1];
  PenSample sample =
      start(time, Tool::kPen, has(flags, 0x01), buttons(has(flags, 0x02), has(flags, 0x04)));
  set_position(sample, le16(report, 2), le16(report, 4));
  set_pressure(sample, le16(report, 6));
  return in_range(sample, out);
}

PenSample VendorPenDecoder::start(Timestamp time, Tool tool, bool tip,
                                  PenButtons pressed) const noexcept {
  PenSample sample;
  sample.time = time;
  sample.tool = tool;
  sample.state = state_of(tool, tip);
  sample.buttons = pressed;
  return sample;
}

void VendorPenDecoder::set_position(PenSample& sample, std::int32_t x,
                                    std::int32_t y) const noexcept {
  sample.axes.add(PenAxis::kX);
  sample.axes.add(PenAxis::kY);
  sample.raw.x = x;
  sample.raw.y = y;
  sample.x_mm = x / spec().counts_per_mm;
  sample.y_mm = y / spec().y_counts_per_mm();
}

void VendorPenDecoder::set_pressure(PenSample& sample, std::int32_t counts) const noexcept {
  if (spec().pressure_max == 0) return;
  sample.axes.add(PenAxis::kPressure);
  sample.raw.pressure = counts;
  const std::int32_t within = std::clamp(counts, 0, spec().pressure_max);
  sample.pressure = static_cast<double>(within) / spec().pressure_max;
}

void VendorPenDecoder::set_tilt(PenSample& sample, std::int32_t x_degrees,
                                std::int32_t y_degrees) noexcept {
  tilt_seen_ = tilt_seen_ || x_degrees != 0 || y_degrees != 0;
  if (!spec().tilt && !tilt_seen_) return;
  sample.axes.add(PenAxis::kTiltX);
  sample.axes.add(PenAxis::kTiltY);
  sample.tilt_x_rad = std::clamp(x_degrees, -90, 90) * kRadiansPerDegree;
  sample.tilt_y_rad = std::clamp(y_degrees, -90, 90) * kRadiansPerDegree;
}

ReportClass VendorPenDecoder::in_range(const PenSample& sample, PenOutput& out) noexcept {
  present_ = true;
  out.push(sample);
  return ReportClass::kPen;
}

ReportClass VendorPenDecoder::out_of_range(Timestamp time, PenOutput& out) noexcept {
  present_ = false;
  const PenSample& last = out.machine().last();  // another decoder's, perhaps
  if (last.state == PenState::kOutOfRange) return ReportClass::kPen;
  PenSample gone;
  gone.time = time;
  gone.tool = last.tool;
  out.push(gone);
  return ReportClass::kPen;
}

}  // namespace limn
