#include <algorithm>
#include <array>

#include "drivers/devices/wacom_bytes.hpp"
#include "drivers/devices/wacom_decoder.hpp"

namespace limn {

using namespace wacom;  // byte access

// PenPartner (source: kernel driver, which reads no position out of range).
//   report 1: le16 x 1, le16 y 3, d5: 80 in range, 40 barrel, 20 eraser; s8 pressure at 6 from -127
//   report 2: always in range, touching above -80 unless d5 & 20
void WacomDecoder::penpartner(Bytes report, Timestamp time, PenOutput& out) noexcept {
  constexpr std::int32_t kRestPressure = -127;
  constexpr std::int32_t kSecondFormTouch = -80;
  const std::int32_t pressure = signed8(report[6]);
  const bool first_form = report[0] == 1;
  if (first_form && !has(report[5], 0x80)) {
    leave(time, out);
    return;
  }
  PenSample sample;
  sample.time = time;
  sample.tool = first_form && has(report[5], 0x20) ? Tool::kEraser : Tool::kPen;
  const bool touching =
      first_form ? pressure > kRestPressure : pressure > kSecondFormTouch && !has(report[5], 0x20);
  sample.state = state_of(sample.tool, touching);
  sample.buttons = buttons(has(report[5], 0x40), false);
  set_position(sample, le16(report, 1), le16(report, 3));
  set_pressure(sample, std::max(pressure - kRestPressure, 0));
  hold(sample, out);
}

// Graphire, Volito, Bamboo One, first Bamboo (recordings of Graphire3, Graphire Wireless, Bamboo
// and Bamboo Fun; the kernel driver).
//   d1: 80 in range, 60 tool (0 pen, 20 eraser, 40 wheel mouse, 60 mouse), 10 position measured,
//       07 tip or left, barrel1 or right, barrel2 or middle; Bluetooth: 08 pressure bit 8
//   le16 x 2, le16 y 4, pressure d6 | (d7 & 3) << 8 (Bluetooth: d7 has battery and keys instead)
// A tool that leaves sends its last positions; a report with nothing at all is the pad's.
void WacomDecoder::graphire(Bytes report, Timestamp time, PenOutput& out) noexcept {
  constexpr unsigned kInRange = 0x80;
  constexpr unsigned kMeasured = 0x10;
  constexpr std::array<Tool, 4> kTools = {Tool::kPen, Tool::kEraser, Tool::kTabletMouse,
                                          Tool::kTabletMouse};
  const Tool tool = kTools[(report[1] >> 5) & 3U];
  if (!has(report[1], kInRange)) {
    if (has(report[1], kMeasured)) {
      leave_at(tool, le16(report, 2), le16(report, 4), time, out);
    } else {
      leave(time, out);
    }
    return;
  }
  PenSample sample;
  sample.time = time;
  sample.tool = tool;
  set_position(sample, le16(report, 2), le16(report, 4));
  if (sample.tool == Tool::kTabletMouse) {
    graphire_mouse(report, sample);
  } else {
    graphire_tool(report, sample);
  }
  hold(sample, out);
}

void WacomDecoder::graphire_tool(Bytes report, PenSample& sample) const noexcept {
  const bool bluetooth = spec_->family == PenFamily::kGraphireBluetooth;
  const int upper = bluetooth ? (report[1] & 0x08) << 5 : (report[7] & 0x03) << 8;
  set_pressure(sample, report[6] | upper);
  sample.state = state_of(sample.tool, has(report[1], 0x01));
  sample.buttons = buttons(has(report[1], 0x02), has(report[1], 0x04));
}

void WacomDecoder::graphire_mouse(Bytes report, PenSample& sample) const noexcept {
  sample.state = PenState::kInRange;
  const bool wheel_mouse = ((report[1] >> 5) & 3U) == 2;
  sample.buttons =
      buttons(has(report[1], 0x01), has(report[1], 0x02), wheel_mouse && has(report[1], 0x04));
  switch (spec_->family) {
    case PenFamily::kGraphireBluetooth:
      set_distance(sample, std::clamp(44 - (report[6] >> 2), 0, 31));
      break;
    case PenFamily::kGraphirePad:
      set_distance(sample, report[6] & 0x3F);
      break;
    default:
      set_distance(sample, report[7] & 0x3F);
      break;
  }
}

}  // namespace limn
