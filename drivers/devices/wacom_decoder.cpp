#include "drivers/devices/wacom_decoder.hpp"

#include <algorithm>

#include "drivers/devices/wacom_bytes.hpp"

namespace limn {
namespace {

using F = PenFamily;

/// The bytes that a family's decoder reads.
constexpr std::size_t needed_bytes(PenFamily family, std::uint8_t report_id) noexcept {
  switch (family) {
    case F::kPenPartner:
    case F::kDtus:
    case F::kGraphireBluetooth:
      return 7;
    case F::kGraphire:
    case F::kGraphirePad:
    case F::kPl:
    case F::kPtu:
    case F::kDtu:
    case F::kTabletPc:
      return 8;
    case F::kBamboo:
      return 9;
    case F::kIntuos:
    case F::kIntuos3:
    case F::kIntuos4:
    case F::kIntuos5:
    case F::kIntuosPro:
    case F::kCintiq:
    case F::kIntuosArt:
      return 10;
    case F::kIntuos4Bluetooth:
      return report_id == 4 ? 31 : 21;
    case F::kIntuosPro2Bluetooth:
      return 109;
    case F::kIntuosSmallBluetooth:
      return 43;
    default:
      return 0;  // not Wacom's
  }
}

/// Whether the family's pen speaks in report `id`.
constexpr bool is_pen_report(PenFamily family, std::uint8_t id) noexcept {
  switch (family) {
    case F::kPenPartner:
      return id == 1 || id == 2;
    case F::kGraphireBluetooth:
      return id == 3;
    case F::kDtus:
      return id == 0x11;
    case F::kIntuos4Bluetooth:
      return id == 3 || id == 4;
    case F::kIntuosPro2Bluetooth:
    case F::kIntuosSmallBluetooth:
      return id == 0x80 || id == 0x81;
    case F::kIntuos:
    case F::kIntuos3:
    case F::kIntuos4:
    case F::kIntuos5:
    case F::kIntuosPro:
    case F::kCintiq:
    case F::kIntuosArt:
      return id == 2 || id == 0x10;
    default:
      return id == 2;
  }
}

/// Touch tablets reuse the pen's report ID for fingers, in packets of 20 and 64 bytes.
constexpr bool shares_id_with_touch(PenFamily family) noexcept {
  return family == F::kBamboo || family == F::kIntuosArt || family == F::kIntuos5 ||
         family == F::kIntuosPro;
}
constexpr std::size_t kShortestTouchPacket = 20;

/// The other reports that the kernel's driver knows, by family where they differ.
constexpr ReportClass class_of_other(PenFamily family, std::uint8_t id) noexcept {
  switch (id) {
    case 0x01:
      return ReportClass::kMouse;
    case 0x03:
      if (family == F::kIntuos5 || family == F::kIntuosPro) return ReportClass::kPad;
      return family == F::kTabletPc ? ReportClass::kTouch : ReportClass::kUnknownId;
    case 0x05:
    case 0x06:
      return family == F::kTabletPc ? ReportClass::kTouch : ReportClass::kStatus;
    case 0x0C:
    case 0x11:
      return ReportClass::kPad;
    case 0x0D:
    case 0x0F:
    case 0x10:
    case 0x12:
      return family == F::kTabletPc ? ReportClass::kTouch : ReportClass::kUnknownId;
    case 0x15:
      return family == F::kDtus ? ReportClass::kPad : ReportClass::kUnknownId;
    case 0xC0:
      return ReportClass::kStatus;
    default:
      return ReportClass::kUnknownId;
  }
}

}  // namespace

ReportClass WacomDecoder::decode(Bytes report, Timestamp time, PenOutput& out) noexcept {
  if (report.empty()) return ReportClass::kTooShort;
  const std::uint8_t id = report[0];
  const PenFamily family = spec_->family;
  if (!is_pen_report(family, id)) return class_of_other(family, id);
  if (shares_id_with_touch(family) && report.size() >= kShortestTouchPacket) {
    return ReportClass::kTouch;
  }
  if (report.size() < needed_bytes(family, id)) return ReportClass::kTooShort;
  return decode_pen(report, time, out);
}

ReportClass WacomDecoder::decode_pen(Bytes report, Timestamp time, PenOutput& out) noexcept {
  switch (spec_->family) {
    case F::kPenPartner:
      penpartner(report, time, out);
      break;
    case F::kGraphire:
    case F::kGraphirePad:
    case F::kGraphireBluetooth:
      graphire(report, time, out);
      break;
    case F::kPl:
      pl(report, time, out);
      break;
    case F::kPtu:
      ptu(report, time, out);
      break;
    case F::kDtu:
      dtu(report, time, out);
      break;
    case F::kDtus:
      dtus(report, time, out);
      break;
    case F::kIntuos:
    case F::kIntuos3:
    case F::kIntuos4:
    case F::kIntuos5:
    case F::kIntuosPro:
    case F::kCintiq:
    case F::kIntuosArt:
      intuos(report, time, out);
      break;
    case F::kIntuos4Bluetooth:
      intuos4_bundle(report, time, out);
      break;
    case F::kBamboo:
      bamboo(report, time, out);
      break;
    case F::kIntuosPro2Bluetooth:
    case F::kIntuosSmallBluetooth:
      frame_bundle(report, time, out);
      break;
    case F::kTabletPc:
      tablet_pc(report, time, out);
      break;
    default:
      break;  // not Wacom's
  }
  return ReportClass::kPen;
}

void WacomDecoder::set_position(PenSample& sample, std::int32_t x, std::int32_t y) const noexcept {
  sample.axes.add(PenAxis::kX);
  sample.axes.add(PenAxis::kY);
  sample.raw.x = x;
  sample.raw.y = y;
  sample.x_mm = x / spec_->counts_per_mm;
  sample.y_mm = y / spec_->counts_per_mm;
}

void WacomDecoder::set_pressure(PenSample& sample, std::int32_t counts) const noexcept {
  sample.axes.add(PenAxis::kPressure);
  sample.raw.pressure = counts;
  const std::int32_t within = std::clamp(counts, 0, spec_->pressure_max);
  sample.pressure = static_cast<double>(within) / spec_->pressure_max;
}

void WacomDecoder::set_distance(PenSample& sample, std::int32_t counts) const noexcept {
  if (spec_->distance_max == 0) return;
  sample.axes.add(PenAxis::kDistance);
  const std::int32_t within = std::clamp(counts, 0, spec_->distance_max);
  sample.distance = static_cast<double>(within) / spec_->distance_max;
}

void WacomDecoder::hold(const PenSample& sample, PenOutput& out) noexcept {
  held_ = sample;
  present_ = true;
  out.push(sample);
}

void WacomDecoder::leave(Timestamp time, PenOutput& out) noexcept {
  if (!present_) return;
  PenSample gone;
  gone.time = time;
  gone.tool = held_.tool;
  if (held_.axes.has(PenAxis::kSerial)) {
    gone.axes.add(PenAxis::kSerial);
    gone.serial = held_.serial;
  }
  present_ = false;
  identified_ = false;
  held_ = PenSample{};
  out.push(gone);
}

void WacomDecoder::leave_at(Tool tool, std::int32_t x, std::int32_t y, Timestamp time,
                            PenOutput& out) noexcept {
  if (x == 0 && y == 0) {  // nothing measured: the far left corner itself is out of reach
    leave(time, out);
    return;
  }
  PenSample gone;
  gone.time = time;
  gone.tool = tool;
  set_position(gone, x, y);
  present_ = false;
  held_ = PenSample{};
  out.push(gone);
}

}  // namespace limn
