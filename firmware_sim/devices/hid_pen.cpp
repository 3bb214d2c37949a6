#include "firmware_sim/devices/hid_pen.hpp"

#include <algorithm>

#include "firmware_sim/devices/counts.hpp"
#include "firmware_sim/usb/descriptor_builder.hpp"

namespace limn::firmware {
namespace {

constexpr ReportId kPenReport{1};
constexpr std::size_t kPayloadBits = 8 * (HidPen::kReportBytes - 1);
constexpr std::int32_t kWidthCounts = 42000;
constexpr std::int32_t kHeightCounts = 29600;
constexpr std::chrono::microseconds kScanTimeTick{100};

// clang-format off
constexpr FieldSpec kFields[] = {
    // usage                        bit  width logical               physical       unit               exponent
    {usages::kTipSwitch,               0,  1, {0, 1},               kNoPhysical,   Unit::kNone,        0},
    {usages::kBarrelSwitch,            1,  1, {0, 1},               kNoPhysical,   Unit::kNone,        0},
    {usages::kSecondaryBarrelSwitch,   2,  1, {0, 1},               kNoPhysical,   Unit::kNone,        0},
    {usages::kInvert,                  3,  1, {0, 1},               kNoPhysical,   Unit::kNone,        0},
    {usages::kEraser,                  4,  1, {0, 1},               kNoPhysical,   Unit::kNone,        0},
    {usages::kInRange,                 5,  1, {0, 1},               kNoPhysical,   Unit::kNone,        0},
    {usages::kX,                       8, 16, {0, kWidthCounts},    {0, 210},      Unit::kCentimeter, -1},
    {usages::kY,                        24, 16, {0, kHeightCounts},   {0, 148},      Unit::kCentimeter, -1},
    {usages::kTipPressure,              40, 16, {0, 8191},            kNoPhysical,   Unit::kNone,        0},
    {usages::kTiltX,                    56, 16, {-9000, 9000},        {-9000, 9000}, Unit::kDegree,     -2},
    {usages::kTiltY,                    72, 16, {-9000, 9000},        {-9000, 9000}, Unit::kDegree,     -2},
    {usages::kScanTime,                 88, 16, {0, 65535},           {0, 65535},    Unit::kSecond,     -4},
    {usages::kTransducerSerial,        104, 32, {0, 0x7FFFFFFF},      kNoPhysical,   Unit::kNone,        0},
};
// clang-format on
static_assert(is_well_formed(kFields, kPayloadBits));
static_assert(kWidthCounts == HidPen::kWidthMm * HidPen::kCountsPerMm);
static_assert(kHeightCounts == HidPen::kHeightMm * HidPen::kCountsPerMm);

constexpr DescriptorBuilder kBuilt = DescriptorBuilder()
                                         .application(usages::kPen)
                                         .report_id(kPenReport)
                                         .collection(CollectionKind::kPhysical, usages::kStylus)
                                         .input_fields(kFields, kPayloadBits)
                                         .end_collection()
                                         .end_collection();
static_assert(kBuilt.is_well_formed());
static_assert(kBuilt.report_bytes(kPenReport) == HidPen::kReportBytes);

constexpr auto kDescriptor = descriptor_bytes<kBuilt.size()>(kBuilt);

template <Usage kUsage>
void put(std::span<std::uint8_t> payload, std::int64_t count) noexcept {
  constexpr std::size_t kIndex = index_of(kFields, kUsage);
  static_assert(kIndex < std::size(kFields), "the report has no field with this usage");
  put_field(payload, kFields[kIndex], count);
}

std::int32_t pressure_counts(const PenPose& pose) noexcept {
  if (pose.proximity != Proximity::kTouching) return 0;
  // A closed tip switch with no pressure would contradict itself.
  return to_counts(pose.pressure, HidPen::kPressureMaximum, 1, HidPen::kPressureMaximum);
}

}  // namespace

std::span<const std::uint8_t> HidPen::report_descriptor() noexcept { return kDescriptor; }

bool HidPen::scan(const PenPose& pose, std::span<std::uint8_t, kReportBytes> report) noexcept {
  const bool sees = pose.proximity != Proximity::kAway;
  if (!sees && !in_range_) return false;
  in_range_ = sees;
  const bool touches = pose.proximity == Proximity::kTouching;
  const bool inverted = pose.end == PenEnd::kEraser;
  if (sees) {
    x_ = to_counts(pose.x_mm, kCountsPerMm, 0, kWidthCounts);
    y_ = to_counts(pose.y_mm, kCountsPerMm, 0, kHeightCounts);
  }

  std::fill(report.begin(), report.end(), std::uint8_t{0});
  report[0] = kPenReport.value();
  const std::span<std::uint8_t> payload = report.subspan<1>();
  put<usages::kInRange>(payload, sees);
  put<usages::kTipSwitch>(payload, touches && !inverted);
  put<usages::kBarrelSwitch>(payload, sees && pose.barrel_switch);
  put<usages::kSecondaryBarrelSwitch>(payload, sees && pose.secondary_barrel_switch);
  put<usages::kInvert>(payload, sees && inverted);
  put<usages::kEraser>(payload, touches && inverted);
  put<usages::kX>(payload, x_);
  put<usages::kY>(payload, y_);
  put<usages::kTipPressure>(payload, pressure_counts(pose));
  put<usages::kTiltX>(payload, sees ? to_counts(pose.tilt_x_deg, kCountsPerDegree) : 0);
  put<usages::kTiltY>(payload, sees ? to_counts(pose.tilt_y_deg, kCountsPerDegree) : 0);
  put<usages::kScanTime>(payload, pose.time / kScanTimeTick % 65536);
  put<usages::kTransducerSerial>(payload, kTransducerSerial);
  return true;
}

}  // namespace limn::firmware
