#include <algorithm>
#include <array>

#include "drivers/devices/wacom_bytes.hpp"
#include "drivers/devices/wacom_decoder.hpp"

namespace limn {

using namespace wacom;  // byte access

// Intuos to Intuos Pro, Cintiq (recordings of Intuos3, 4, 4 Wireless, 5, Pro, PT and of eight
// Cintiqs and DTKs; the kernel driver). Packets of 10 bytes, by d1:
//
//   110000xx  a tool enters: serial (d3 & F) << 28 | d4 << 20 | d5 << 12 | d6 << 4 | d7 >> 4,
//             id d2 << 4 | d3 >> 4 | (d7 & F) << 16 | (d8 & F0) << 8
//   1000000x  it leaves
//   xx1ttttx  position; t: 0-3 pen, 4, 6, 8 mice, 5 rotation (pen or mouse), A airbrush wheel.
//             80: full data; else only position, distance and rotation: the tool is too far for
//             the rest, or has not been identified yet. 40 clear: outside the active area.
//
//   x = be16(2) << 1 | (d9 >> 1 & 1), y = be16(4) << 1 | (d9 & 1), distance d9 >> 2; on the first
//   two Intuos without the lowest bit, and bit 0 of d1 tells two tools apart.
//   t = 0..3: pressure d6 << 3 | (d7 & C0) >> 5 | (d1 & 1), half of it where the maximum is 1023;
//             tilt x ((d7 << 1 & 7E) | d8 >> 7) - 64, tilt y (d8 & 7F) - 64; d1: 02 and 04 barrel
//
// Recordings show (Intuos5 and Pro) that packets without 80 have a true position, which the kernel
// drops: it is kept here.
namespace {

// Packet types.
constexpr unsigned kLastPen = 3;
constexpr unsigned kMouse4d = 4;
constexpr unsigned kRotation = 5;
constexpr unsigned kMouseIntuos4 = 6;
constexpr unsigned kMouse2d = 8;
constexpr unsigned kAirbrushWheel = 10;

bool has_half_resolution(PenFamily family) noexcept { return family == PenFamily::kIntuos; }

/// Art pen: the low bit is the direction, the rest half steps of 0.2 degrees.
double art_pen_twist(Bytes packet) noexcept {
  const std::int32_t turn = packet[6] << 3 | packet[7] >> 5;
  return twist_of_fifths(has(packet[7], 0x20) ? (turn - 1) / 2 : -(turn / 2));
}

PenButtons mouse_buttons(unsigned type, Bytes p, bool lens, bool side_buttons) noexcept {
  switch (type) {
    case kMouse4d:
      return buttons(has(p[8], 0x01), has(p[8], 0x04), has(p[8], 0x02), has(p[8], 0x20),
                     has(p[8], 0x10));
    case kMouseIntuos4:
      return buttons(has(p[6], 0x01), has(p[6], 0x04), has(p[6], 0x02), has(p[6], 0x08),
                     has(p[6], 0x10));
    default:  // kMouse2d: 2D mouse and lens cursor
      if (lens) {
        return buttons(has(p[8], 0x01), has(p[8], 0x04), has(p[8], 0x02), has(p[8], 0x10),
                       has(p[8], 0x08));
      }
      return buttons(has(p[8], 0x04), has(p[8], 0x10), has(p[8], 0x08),
                     side_buttons && has(p[8], 0x40), side_buttons && has(p[8], 0x20));
  }
}

bool is_lens_cursor(std::uint32_t id) noexcept { return id == 0x096 || id == 0x097 || id == 0x006; }

}  // namespace

Tool wacom_tool(std::uint32_t id) noexcept {
  constexpr std::array<std::uint32_t, 5> kMice = {0x007, 0x017, 0x094, 0x09C, 0x806};
  if (is_lens_cursor(id) || std::find(kMice.begin(), kMice.end(), id) != kMice.end()) {
    return Tool::kTabletMouse;
  }
  return (id & 0x008U) != 0 ? Tool::kEraser : Tool::kPen;
}

bool is_wacom_art_pen(std::uint32_t id) noexcept {
  return id == 0x885 || id == 0x804 || id == 0x10804 || id == 0x204;
}

void WacomDecoder::intuos(Bytes packet, Timestamp time, PenOutput& out) noexcept {
  const std::uint8_t flags = packet[1];
  const std::uint8_t slot =
      spec_->family == PenFamily::kIntuos ? static_cast<std::uint8_t>(flags & 1U) : 0;
  if ((flags & 0xFCU) == 0xC0) {
    intuos_enter(packet, slot, time, out);
  } else if ((flags & 0xFEU) == 0x80) {
    intuos_leave(slot, time, out);
  } else if (has(flags, 0x20)) {
    intuos_general(packet, slot, time, out);
  }
}

void WacomDecoder::intuos_enter(Bytes p, std::uint8_t slot, Timestamp time,
                                PenOutput& out) noexcept {
  ToolSlot entering;
  entering.known = true;
  entering.serial = static_cast<std::uint64_t>(p[3] & 0x0F) << 28 |
                    static_cast<std::uint64_t>(p[4]) << 20 | static_cast<unsigned>(p[5]) << 12 |
                    static_cast<unsigned>(p[6]) << 4 | static_cast<unsigned>(p[7]) >> 4;
  entering.id = static_cast<unsigned>(p[2]) << 4 | static_cast<unsigned>(p[3]) >> 4 |
                (p[7] & 0x0FU) << 16 | (p[8] & 0xF0U) << 8;
  entering.tool = wacom_tool(entering.id);
  slots_[slot] = entering;
  if (!present_ || active_slot_ != slot) return;
  const bool same =
      held_.tool == entering.tool && (!identified_ || held_.serial == entering.serial);
  if (!same) leave(time, out);
}

void WacomDecoder::intuos_leave(std::uint8_t slot, Timestamp time, PenOutput& out) noexcept {
  slots_[slot] = ToolSlot{};
  if (active_slot_ == slot) leave(time, out);
}

bool WacomDecoder::intuos_take_tool(std::uint8_t slot, unsigned packet_type, Timestamp time,
                                    PenOutput& out) noexcept {
  const ToolSlot& tool = slots_[slot];
  const bool continues = present_ && active_slot_ == slot;
  Tool kind = tool.tool;
  if (packet_type == kMouse4d || packet_type == kMouseIntuos4 || packet_type == kMouse2d) {
    kind = Tool::kTabletMouse;
  } else if (continues && (packet_type == kRotation || packet_type == kAirbrushWheel)) {
    kind = held_.tool;  // the second half of what the tool's main packet began
  }
  if (present_ && !continues) {
    // Two tools at once: one stream has one, and the pen counts more than the mouse beside it.
    const bool pen_over_mouse = held_.tool == Tool::kTabletMouse && kind != Tool::kTabletMouse;
    if (!pen_over_mouse) return false;
    leave(time, out);
  } else if (continues && held_.tool != kind) {
    leave(time, out);
  }
  active_slot_ = slot;
  held_.tool = kind;
  identified_ = tool.known;
  if (tool.known && tool.serial != 0) {
    held_.axes.add(PenAxis::kSerial);
    held_.serial = tool.serial;
  }
  return true;
}

void WacomDecoder::intuos_general(Bytes p, std::uint8_t slot, Timestamp time,
                                  PenOutput& out) noexcept {
  const bool full = has(p[1], 0x80);
  if (!full && !present_ && !slots_[slot].known) return;
  const unsigned type = (p[1] >> 1) & 0x0FU;
  if (!intuos_take_tool(slot, type, time, out)) return;

  PenSample sample = held_;
  sample.time = time;
  std::int32_t x = be16(p, 2) << 1 | ((p[9] >> 1) & 1);
  std::int32_t y = be16(p, 4) << 1 | (p[9] & 1);
  std::int32_t distance = p[9] >> 2;
  if (has_half_resolution(spec_->family)) {
    x >>= 1;
    y >>= 1;
    distance >>= 1;
  }
  if (spec_->family == PenFamily::kIntuosArt) distance = spec_->distance_max - distance;
  set_position(sample, x, y);
  set_distance(sample, distance);

  if (!full) {
    for (const PenAxis axis : {PenAxis::kPressure, PenAxis::kTiltX, PenAxis::kTiltY}) {
      sample.axes.remove(axis);
    }
    sample.pressure = sample.tilt_x_rad = sample.tilt_y_rad = 0;
    sample.raw.pressure = 0;
    sample.buttons = 0;
  }
  if (sample.tool == Tool::kTabletMouse) {
    sample.state = PenState::kInRange;
    if (full && type != kRotation) {
      const bool side_buttons = spec_->family == PenFamily::kIntuos3;
      sample.buttons = mouse_buttons(type, p, is_lens_cursor(slots_[slot].id), side_buttons);
    }
  } else {
    if (!full || !in_contact(sample.state)) sample.state = state_of(sample.tool, false);
    if (full && type <= kLastPen) intuos_pen_axes(p, sample);
    if (type == kRotation) {
      sample.axes.add(PenAxis::kTwist);
      sample.twist_rad = art_pen_twist(p);
    }
  }
  hold(sample, out);
}

void WacomDecoder::intuos_pen_axes(Bytes p, PenSample& sample) const noexcept {
  constexpr std::int32_t kElevenBits = 2047;
  std::int32_t pressure = p[6] << 3 | (p[7] & 0xC0) >> 5 | (p[1] & 1);
  if (spec_->pressure_max < kElevenBits) pressure >>= 1;
  set_pressure(sample, pressure);
  sample.state = state_of(sample.tool, pressure > kTouchPressure);
  sample.buttons = buttons(has(p[1], 0x02), has(p[1], 0x04));
  if (spec_->family == PenFamily::kIntuosArt) return;  // its pen knows no tilt
  sample.axes.add(PenAxis::kTiltX);
  sample.axes.add(PenAxis::kTiltY);
  sample.tilt_x_rad = (((p[7] << 1 & 0x7E) | p[8] >> 7) - 64) * kRadiansPerDegree;
  sample.tilt_y_rad = ((p[8] & 0x7F) - 64) * kRadiansPerDegree;
}

}  // namespace limn
