#include "firmware_sim/devices/wacom_intuos.hpp"

#include "firmware_sim/devices/counts.hpp"
#include "firmware_sim/usb/descriptor_builder.hpp"

namespace limn::firmware {
namespace {

constexpr ReportId kMouseReport{1};
constexpr ReportId kPenReport{2};  // the mode's feature report has the same ID
constexpr std::size_t kPenBytes = 10;
constexpr std::size_t kMouseBytes = 5;

// As Wacom's: a mouse that explains itself, a digitizer that does not.
constexpr DescriptorBuilder kBuilt = DescriptorBuilder()
                                         .application(usages::kMouse)
                                         .report_id(kMouseReport)
                                         .collection(CollectionKind::kPhysical, usages::kPointer)
                                         .usage_range(usages::button(1), 3)
                                         .logical({0, 1})
                                         .report_size(1, 3)
                                         .input(InputFlags::kVariable)
                                         .padding(5)
                                         .usage(usages::kX)
                                         .usage(usages::kY)
                                         .usage(usages::kWheel)
                                         .logical({-127, 127})
                                         .report_size(8, 3)
                                         .input(InputFlags::kRelative)
                                         .end_collection()
                                         .end_collection()
                                         .application(usages::kDigitizer)
                                         .report_id(kPenReport)
                                         .collection(CollectionKind::kPhysical, usages::kStylus)
                                         .usage(usages::kVendor1)
                                         .logical({0, 255})
                                         .report_size(8, kPenBytes - 1)
                                         .input(InputFlags::kVariable)
                                         .end_collection()
                                         .usage(usages::kVendor1)
                                         .report_size(8, 1)
                                         .feature(InputFlags::kVariable)
                                         .end_collection();
static_assert(kBuilt.is_well_formed());
static_assert(kBuilt.report_bytes(kMouseReport) == kMouseBytes);
static_assert(kBuilt.report_bytes(kPenReport) == kPenBytes);
constexpr auto kDescriptor = descriptor_bytes<kBuilt.size()>(kBuilt);

constexpr EndpointSpec kEndpoints[] = {{0x81, 16, 4}};
constexpr InterfaceSpec kInterfaces[] = {{kDescriptor, 1, 2, kEndpoints}};

constexpr DeviceSpec kSpec = [] {
  DeviceSpec spec;
  spec.vendor = 0x056A;
  spec.product = 0x002A;
  spec.version = 0x0107;
  spec.manufacturer = "Wacom Co.,Ltd.";
  spec.product_name = "Intuos5 M";
  spec.interfaces = kInterfaces;
  return spec;
}();

/// The tool's switches, as bits 1 and 2.
constexpr std::uint8_t barrel_bits(const PenPose& pose) noexcept {
  return static_cast<std::uint8_t>((pose.barrel_switch ? 0x02 : 0) |
                                   (pose.secondary_barrel_switch ? 0x04 : 0));
}

void put_entering(std::span<std::uint8_t> report, std::uint32_t tool) noexcept {
  constexpr std::uint32_t kSerial = WacomIntuos::kSerial;
  report[1] = 0xC2;
  report[2] = static_cast<std::uint8_t>(tool >> 4 & 0xFFU);
  report[3] = static_cast<std::uint8_t>((tool & 0xFU) << 4 | kSerial >> 28);
  report[4] = static_cast<std::uint8_t>(kSerial >> 20 & 0xFFU);
  report[5] = static_cast<std::uint8_t>(kSerial >> 12 & 0xFFU);
  report[6] = static_cast<std::uint8_t>(kSerial >> 4 & 0xFFU);
  report[7] = static_cast<std::uint8_t>(kSerial << 4 & 0xF0U);
}

void put_position(std::span<std::uint8_t> report, const PenPose& pose) noexcept {
  constexpr double kCountsPerMm = WacomIntuos::kCountsPerMm;
  constexpr std::int32_t kLeastTouch = 11;     // up to 10 the tip does not touch
  constexpr std::int32_t kHoverDistance = 30;  // of 63
  constexpr std::int32_t kTouchDistance = 12;
  const bool touches = pose.proximity == Proximity::kTouching;
  const std::int32_t x = to_counts(pose.x_mm, kCountsPerMm, 0, WacomIntuos::kWidthCounts);
  const std::int32_t y = to_counts(pose.y_mm, kCountsPerMm, 0, WacomIntuos::kHeightCounts);
  const std::int32_t pressure = touches ? to_counts(pose.pressure, WacomIntuos::kPressureMaximum,
                                                    kLeastTouch, WacomIntuos::kPressureMaximum)
                                        : 0;
  const std::int32_t tilt_x = to_counts(pose.tilt_x_deg, 1, -64, 63) + 64;
  const std::int32_t tilt_y = to_counts(pose.tilt_y_deg, 1, -64, 63) + 64;
  const std::int32_t distance = touches ? kTouchDistance : kHoverDistance;
  report[1] = static_cast<std::uint8_t>(0xE0U | barrel_bits(pose) | (byte_of(pressure) & 1U));
  report[2] = byte_of(x >> 1, 1);
  report[3] = byte_of(x >> 1, 0);
  report[4] = byte_of(y >> 1, 1);
  report[5] = byte_of(y >> 1, 0);
  report[6] = byte_of(pressure >> 3);
  report[7] = byte_of((pressure >> 1 & 3) << 6 | tilt_x >> 1);
  report[8] = byte_of((tilt_x & 1) << 7 | tilt_y);
  report[9] = byte_of(distance << 2 | (x & 1) << 1 | (y & 1));
}

}  // namespace

const DeviceSpec& WacomIntuos::spec() const noexcept { return kSpec; }

void WacomIntuos::restart() noexcept {
  mode_ = kMouseMode;
  present_ = false;
  last_ = PenPose();
}

int WacomIntuos::get_report(std::uint8_t, ReportKind kind, std::uint8_t id,
                            std::span<std::uint8_t> out) noexcept {
  if (kind != ReportKind::kFeature || id != kPenReport.value() || out.size() < 2) return kStall;
  out[0] = kPenReport.value();
  out[1] = mode_;
  return 2;
}

bool WacomIntuos::set_report(std::uint8_t, ReportKind kind, std::uint8_t id,
                             std::span<const std::uint8_t> bytes) noexcept {
  if (kind != ReportKind::kFeature || id != kPenReport.value() || bytes.size() < 2) return false;
  if (bytes[1] != kMouseMode && bytes[1] != kPenMode) return false;
  if (bytes[1] == mode_) return true;
  mode_ = bytes[1];
  present_ = false;
  last_ = PenPose();
  return true;
}

std::size_t WacomIntuos::scan(const PenPose& pose, ReportBuffer report) noexcept {
  if (mode_ == kMouseMode) return mouse_report(pose, report);
  const bool sees = pose.proximity != Proximity::kAway;
  report[0] = kPenReport.value();
  if (present_ && (!sees || pose.end != end_)) {
    present_ = false;
    report[1] = 0x80;
    return kPenBytes;
  }
  if (!sees) return 0;
  if (!present_) {
    present_ = true;
    end_ = pose.end;
    put_entering(report, end_ == PenEnd::kTip ? kGripPen : kGripPenEraser);
    return kPenBytes;
  }
  put_position(report, pose);
  return kPenBytes;
}

/// Movements from the place where the pen came near, and what it presses.
std::size_t WacomIntuos::mouse_report(const PenPose& pose, ReportBuffer report) noexcept {
  constexpr double kStepsPerMm = 10;
  const bool was_there = last_.proximity != Proximity::kAway;
  if (pose.proximity == Proximity::kAway && !was_there) return 0;
  report[0] = kMouseReport.value();
  const bool touches = pose.proximity == Proximity::kTouching;
  report[1] = static_cast<std::uint8_t>(barrel_bits(pose) | (touches ? 1U : 0U));
  if (pose.proximity != Proximity::kAway && was_there) {
    report[2] = byte_of(to_counts(pose.x_mm - last_.x_mm, kStepsPerMm, -127, 127));
    report[3] = byte_of(to_counts(pose.y_mm - last_.y_mm, kStepsPerMm, -127, 127));
  }
  last_ = pose;
  return kMouseBytes;
}

}  // namespace limn::firmware
