#include "drivers/devices/wacom_bytes.hpp"
#include "drivers/devices/wacom_decoder.hpp"

namespace limn {

using namespace wacom;  // byte access

// Bamboo Pen and Touch, One by Wacom, Intuos Pen (recordings of Bamboo Pen, Intuos PT S and M,
// Intuos S and M; the kernel driver).
//   d1: 80 a tool is in range, 40 position measured, 20 pressure and switches ready, 08 eraser,
//       04 barrel2, 02 barrel1, 01 tip
//   le16 x 2, y 4, pressure 6; d8: nearness, 0 at the edge of range, beyond the maximum in contact
// Outside the active area the device sends the edge's coordinate without "ready", and whatever
// pressure there is does not draw.
void WacomDecoder::bamboo(Bytes report, Timestamp time, PenOutput& out) noexcept {
  const std::uint8_t flags = report[1];
  if (!has(flags, 0x80)) {
    leave(time, out);
    return;
  }
  const bool measured = has(flags, 0x40);
  if (!measured && !present_) return;  // which end it is, it has not said yet

  PenSample sample;
  sample.time = time;
  sample.tool = measured ? (has(flags, 0x08) ? Tool::kEraser : Tool::kPen) : held_.tool;
  const bool ready = has(flags, 0x20);
  sample.state = state_of(sample.tool, ready && measured && has(flags, 0x01));
  if (measured) set_position(sample, le16(report, 2), le16(report, 4));
  if (ready) {
    set_pressure(sample, le16(report, 6));
    sample.buttons = buttons(has(flags, 0x02), has(flags, 0x04));
  }
  set_distance(sample, spec_->distance_max - report[8]);
  hold(sample, out);
}

}  // namespace limn
