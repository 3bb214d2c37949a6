#include "drivers/devices/wacom_bytes.hpp"
#include "drivers/devices/wacom_decoder.hpp"

namespace limn {

using namespace wacom;  // byte access

// PL displays, DTF, DTU-710, DTU-1931 (source: kernel driver). Coordinates of 16 bits in 2 + 7 + 7:
//   x: d1 & 3, d2, d3; y: d4 & 3, d5, d6; d1: 40 in range
//   d4: 08 tip, 10 barrel1, 20 barrel2, or the eraser when it enters so; 04 and 40 pressure bits
//   pressure: d7 as upper, signed bits
void WacomDecoder::pl(Bytes report, Timestamp time, PenOutput& out) noexcept {
  constexpr std::int32_t kEightBits = 255;
  const std::int32_t x = report[3] | report[2] << 7 | (report[1] & 0x03) << 14;
  const std::int32_t y = report[6] | report[5] << 7 | (report[4] & 0x03) << 14;
  if (!has(report[1], 0x40)) {
    leave_at(held_.tool, x, y, time, out);
    return;
  }
  const bool second_switch = has(report[4], 0x20);
  // The eraser's bit is barrel2's: it decides when a tool enters. An eraser always sets it, so one
  // without was a pen all along.
  Tool tool = present_ ? held_.tool : (second_switch ? Tool::kEraser : Tool::kPen);
  if (!second_switch) tool = Tool::kPen;
  if (present_ && held_.tool != tool) leave(time, out);

  PenSample sample;
  sample.time = time;
  sample.tool = tool;
  sample.state = state_of(tool, has(report[4], 0x08));
  sample.buttons = buttons(has(report[4], 0x10), tool == Tool::kPen && second_switch);
  set_position(sample, x, y);
  std::int32_t pressure =
      signed8(static_cast<std::uint8_t>(report[7] << 1 | ((report[4] >> 2) & 1)));
  if (spec_->pressure_max > kEightBits) pressure = pressure * 2 + ((report[4] >> 6) & 1);
  set_pressure(sample, pressure + (spec_->pressure_max + 1) / 2);
  hold(sample, out);
}

// Cintiq Partner (source: kernel driver).
//   d1: 20 in range, 04 eraser, 01 tip, 08 eraser's tip, 02 and 10 barrel
//   le16 x 2, y 4, pressure 6
void WacomDecoder::ptu(Bytes report, Timestamp time, PenOutput& out) noexcept {
  if (!has(report[1], 0x20)) {
    leave_at(held_.tool, le16(report, 2), le16(report, 4), time, out);
    return;
  }
  PenSample sample;
  sample.time = time;
  sample.tool = has(report[1], 0x04) ? Tool::kEraser : Tool::kPen;
  sample.state = state_of(sample.tool, has(report[1], has(report[1], 0x04) ? 0x08 : 0x01));
  sample.buttons = buttons(has(report[1], 0x02), has(report[1], 0x10));
  set_position(sample, le16(report, 2), le16(report, 4));
  set_pressure(sample, le16(report, 6));
  hold(sample, out);
}

// DTU-1631, DTU-2231 (recording of the latter; the kernel driver).
//   d1: 20 in range, 0C eraser, 05 tip, 02 and 10 barrel
//   le16 x 2, y 4; pressure d6 | (d7 & 1) << 8
void WacomDecoder::dtu(Bytes report, Timestamp time, PenOutput& out) noexcept {
  if (!has(report[1], 0x20)) {
    leave_at(held_.tool, le16(report, 2), le16(report, 4), time, out);
    return;
  }
  PenSample sample;
  sample.time = time;
  sample.tool = has(report[1], 0x0C) ? Tool::kEraser : Tool::kPen;
  sample.state = state_of(sample.tool, has(report[1], 0x05));
  sample.buttons = buttons(has(report[1], 0x02), has(report[1], 0x10));
  set_position(sample, le16(report, 2), le16(report, 4));
  set_pressure(sample, report[6] | (report[7] & 0x01) << 8);
  hold(sample, out);
}

// DTU-1031, DTU-1141, DTK-1651 (recording of the first; the kernel driver). Report 0x11.
//   d1: 80 in range, 18 tool (08 eraser, 10 pen, 00 as before: seen while it hovers), 20 and 40
//       barrel, 03 pressure 9, 8; d2 pressure 7..0, be16 x 3, y 5
void WacomDecoder::dtus(Bytes report, Timestamp time, PenOutput& out) noexcept {
  const std::int32_t x = be16(report, 3);
  const std::int32_t y = be16(report, 5);
  if (!has(report[1], 0x80)) {
    leave_at(held_.tool, x, y, time, out);
    return;
  }
  const unsigned tool_bits = (report[1] >> 3) & 3U;
  const std::int32_t pressure = report[2] | (report[1] & 0x03) << 8;
  PenSample sample;
  sample.time = time;
  sample.tool = tool_bits == 1 ? Tool::kEraser : tool_bits == 2 ? Tool::kPen : held_.tool;
  sample.state = state_of(sample.tool, pressure > kTouchPressure);
  sample.buttons = buttons(has(report[1], 0x20), has(report[1], 0x40));
  set_position(sample, x, y);
  set_pressure(sample, pressure);
  hold(sample, out);
}

// Pens of notebook displays (source: kernel driver). Used only where the descriptor does not say
// the same and more.
//   d1: 20 in range, 0C eraser when it enters, 05 tip, 02 and 10 barrel
//   le16 x 2, y 4; pressure d6 | (d7 & 7) << 8
void WacomDecoder::tablet_pc(Bytes report, Timestamp time, PenOutput& out) noexcept {
  if (!has(report[1], 0x20)) {
    leave_at(held_.tool, le16(report, 2), le16(report, 4), time, out);
    return;
  }
  PenSample sample;
  sample.time = time;
  sample.tool = present_ ? held_.tool : (has(report[1], 0x0C) ? Tool::kEraser : Tool::kPen);
  sample.state = state_of(sample.tool, has(report[1], 0x05));
  sample.buttons = buttons(has(report[1], 0x02), has(report[1], 0x10));
  set_position(sample, le16(report, 2), le16(report, 4));
  set_pressure(sample, report[6] | (report[7] & 0x07) << 8);
  hold(sample, out);
}

}  // namespace limn
