#include "firmware_sim/devices/wacom_bluetooth.hpp"

#include <algorithm>

#include "firmware_sim/devices/counts.hpp"
#include "firmware_sim/usb/descriptor_builder.hpp"

namespace limn::firmware {
namespace {

constexpr ReportId kBundle{0x80};
static_assert(WacomBluetooth::kReportBytes <= PenFunction::kMostReportBytes);

constexpr DescriptorBuilder kBuilt = DescriptorBuilder()
                                         .application(usages::kDigitizer)
                                         .report_id(kBundle)
                                         .collection(CollectionKind::kPhysical, usages::kStylus)
                                         .usage(usages::kVendor1)
                                         .logical({0, 255})
                                         .report_size(8, WacomBluetooth::kReportBytes - 1)
                                         .input(InputFlags::kVariable)
                                         .end_collection()
                                         .end_collection();
static_assert(kBuilt.is_well_formed());
static_assert(kBuilt.report_bytes(kBundle) == WacomBluetooth::kReportBytes);
constexpr auto kDescriptor = descriptor_bytes<kBuilt.size()>(kBuilt);

constexpr EndpointSpec kEndpoints[] = {{0x81, 64, 1}};
constexpr InterfaceSpec kInterfaces[] = {{kDescriptor, 0, 0, kEndpoints}};

constexpr DeviceSpec kSpec = [] {
  DeviceSpec spec;
  spec.vendor = 0x056A;
  spec.product = 0x0360;
  spec.version = 0x0100;
  spec.manufacturer = "Wacom Co.,Ltd.";
  spec.product_name = "Intuos Pro M";
  spec.interfaces = kInterfaces;
  spec.bus = Bus::kBluetooth;
  return spec;
}();

}  // namespace

const DeviceSpec& WacomBluetooth::spec() const noexcept { return kSpec; }

void WacomBluetooth::restart() noexcept {
  filled_ = 0;
  present_ = false;
}

std::size_t WacomBluetooth::scan(const PenPose& pose, ReportBuffer report) noexcept {
  constexpr std::uint8_t kValid = 0x80;
  constexpr std::uint8_t kNear = 0x40;
  constexpr std::uint8_t kInRange = 0x20;
  constexpr std::uint8_t kInverted = 0x10;
  constexpr std::uint8_t kHoverDistance = 30;  // of 63
  const bool sees = pose.proximity != Proximity::kAway;
  if (!sees && !present_) return 0;
  const std::span<std::uint8_t> frame =
      std::span(frames_).subspan(filled_ * kFrameBytes, kFrameBytes);
  ++filled_;
  std::fill(frame.begin(), frame.end(), std::uint8_t{0});
  frame[0] = kValid;
  // A pen that is turned round leaves first: a report tells one tool.
  if (!sees || (present_ && pose.end != end_)) {
    present_ = false;
    return send(report);
  }
  present_ = true;
  end_ = pose.end;
  const bool touches = pose.proximity == Proximity::kTouching;
  frame[0] = static_cast<std::uint8_t>(kValid | kNear | kInRange |
                                       (end_ == PenEnd::kEraser ? kInverted : 0) |
                                       (pose.secondary_barrel_switch ? 0x04 : 0) |
                                       (pose.barrel_switch ? 0x02 : 0) | (touches ? 0x01 : 0));
  put_le16(frame, 1, to_counts(pose.x_mm, kCountsPerMm, 0, kWidthCounts));
  put_le16(frame, 3, to_counts(pose.y_mm, kCountsPerMm, 0, kHeightCounts));
  if (touches) {
    put_le16(frame, 5, to_counts(pose.pressure, kPressureMaximum, 1, kPressureMaximum));
  }
  frame[7] = byte_of(to_counts(pose.tilt_x_deg, 1, -64, 63));
  frame[8] = byte_of(to_counts(pose.tilt_y_deg, 1, -64, 63));
  frame[13] = touches ? std::uint8_t{0} : kHoverDistance;
  return filled_ == kFrames ? send(report) : 0;
}

std::size_t WacomBluetooth::send(ReportBuffer report) noexcept {
  constexpr std::size_t kSerialAt = 99;
  constexpr std::size_t kToolAt = 107;
  constexpr std::size_t kBatteryAt = 284;
  report[0] = kBundle.value();
  std::copy_n(frames_.begin(), filled_ * kFrameBytes, report.begin() + 1);
  put_le16(report, kSerialAt, kSerial & 0xFFFF);
  put_le16(report, kSerialAt + 2, kSerial >> 16);
  put_le16(report, kToolAt, end_ == PenEnd::kTip ? kProPen2 : kProPen2Eraser);
  report[kBatteryAt] = 100;
  filled_ = 0;
  return kReportBytes;
}

}  // namespace limn::firmware
