#include <algorithm>

#include "drivers/devices/wacom_bytes.hpp"
#include "drivers/devices/wacom_decoder.hpp"

namespace limn {

using namespace wacom;  // byte access

// Over Bluetooth several packets share one report, whose time is the last packet's. The others lie
// before it, evenly since the last report, but no further apart than a pen's slowest rate: after a
// silence the packets of a report are still only as old as the device's own pace. The first report
// of a stream has nothing before it, so all its packets have its time.
Timestamp WacomDecoder::bundle_period(Timestamp time, int frames) noexcept {
  constexpr Timestamp kSlowest = std::chrono::milliseconds(10);  // 100 Hz
  Timestamp period{0};
  if (has_bundle_time_ && time > bundle_time_ && frames > 0) {
    const Timestamp since = time - bundle_time_;
    period = std::min(since / frames, kSlowest);
  }
  bundle_time_ = time;
  has_bundle_time_ = true;
  return period;
}

// Intuos4 Wireless (source: kernel driver): report 3 holds two Intuos packets of ten bytes, report
// 4 three, then the battery. The pad's packets have their own ID in their first byte.
void WacomDecoder::intuos4_bundle(Bytes report, Timestamp time, PenOutput& out) noexcept {
  constexpr std::size_t kPacket = 10;
  const int packets = report[0] == 4 ? 3 : 2;
  const Timestamp period = bundle_period(time, packets);
  for (int i = 0; i < packets; ++i) {
    const Bytes packet = report.subspan(1 + kPacket * static_cast<std::size_t>(i), kPacket);
    const bool pen = packet[0] == 2 || packet[0] == 0x10;
    if (pen) intuos(packet, time - period * (packets - 1 - i), out);
  }
}

// Intuos Pro (2017) and Intuos BT (source: kernel driver), report 0x80 or 0x81.
//   frames of 14 (Intuos BT: 8) bytes from byte 1, 7 (4) of them
//   serial le64 at 99 (33), tool id le16 at 107 (41)
// A frame: d0: 80 valid, 40 in proximity, 20 in range, 10 eraser, 09 tip, 02 and 04 barrel;
//   le16 x 1, y 3, pressure 5; Pro: s8 tilt x 7, y 8, s16 rotation 9 (0.2 degrees), distance d13;
//   Intuos BT: distance d7
namespace {

struct BundleForm {
  std::size_t frame_bytes;
  int frames;
  std::size_t serial_at;
  std::size_t tool_at;
};
constexpr BundleForm kProForm{14, 7, 99, 107};
constexpr BundleForm kSmallForm{8, 4, 33, 41};

std::uint64_t le64(Bytes b, std::size_t at) noexcept {
  std::uint64_t value = 0;
  for (std::size_t i = 8; i-- > 0;) value = value << 8 | b[at + i];
  return value;
}

}  // namespace

void WacomDecoder::frame_bundle(Bytes report, Timestamp time, PenOutput& out) noexcept {
  constexpr unsigned kValid = 0x80;
  const BundleForm& form = spec_->family == PenFamily::kIntuosPro2Bluetooth ? kProForm : kSmallForm;
  const std::uint64_t serial = le64(report, form.serial_at);
  auto tool_id = static_cast<std::uint32_t>(le16(report, form.tool_at));
  if (serial >> 52 == 1) {  // pens other than USI carry the upper bits of their id here
    tool_id |= static_cast<std::uint32_t>(serial >> 32) & 0xFFFFFU;
  }
  int valid = 0;
  for (int i = 0; i < form.frames; ++i) {
    valid += has(report[1 + form.frame_bytes * static_cast<std::size_t>(i)], kValid) ? 1 : 0;
  }
  const Timestamp period = bundle_period(time, valid);
  int seen = 0;
  for (int i = 0; i < form.frames; ++i) {
    const Bytes bytes =
        report.subspan(1 + form.frame_bytes * static_cast<std::size_t>(i), form.frame_bytes);
    if (!has(bytes[0], kValid)) continue;
    ++seen;
    if (!present_) {
      held_ = PenSample{};  // a tool that only came near left its serial here
      if (serial != 0) held_.axes.add(PenAxis::kSerial);
      held_.serial = serial;
    }
    frame(bytes, tool_id, time - period * (valid - seen), out);
  }
}

void WacomDecoder::frame(Bytes bytes, std::uint32_t tool_id, Timestamp time,
                         PenOutput& out) noexcept {
  const std::uint8_t flags = bytes[0];
  if (!has(flags, 0x40)) {
    leave(time, out);
    return;
  }
  const bool in_range = has(flags, 0x20);
  if (!in_range && !present_) return;

  PenSample sample;
  sample.time = time;
  sample.tool = present_ ? held_.tool : (has(flags, 0x10) ? Tool::kEraser : wacom_tool(tool_id));
  if (held_.axes.has(PenAxis::kSerial)) {
    sample.axes.add(PenAxis::kSerial);
    sample.serial = held_.serial;
  }
  sample.state = state_of(sample.tool, in_range && has(flags, 0x09));
  sample.buttons = buttons(has(flags, 0x02), has(flags, 0x04));
  set_pressure(sample, le16(bytes, 5));
  const bool pro = spec_->family == PenFamily::kIntuosPro2Bluetooth;
  set_distance(sample, in_range ? bytes[pro ? 13 : 7] : spec_->distance_max);
  if (in_range) {
    set_position(sample, le16(bytes, 1), le16(bytes, 3));
    if (pro) {
      sample.axes.add(PenAxis::kTiltX);
      sample.axes.add(PenAxis::kTiltY);
      sample.tilt_x_rad = std::clamp(signed8(bytes[7]), -90, 90) * kRadiansPerDegree;
      sample.tilt_y_rad = std::clamp(signed8(bytes[8]), -90, 90) * kRadiansPerDegree;
    }
    if (pro && is_wacom_art_pen(tool_id)) {
      sample.axes.add(PenAxis::kTwist);
      const std::int32_t turn = le16(bytes, 9);
      sample.twist_rad = twist_of_fifths(turn < 0x8000 ? turn : turn - 0x10000);
    }
  }
  hold(sample, out);
}

}  // namespace limn
