#include "firmware_sim/devices/huion.hpp"

#include "firmware_sim/devices/counts.hpp"

namespace limn::firmware {
namespace {

constexpr std::uint8_t kParameters = 200;
constexpr std::uint16_t kUsEnglish = 0x0409;

// Interface 0: report 8, of seven bytes as it says. It sends eleven.
constexpr std::uint8_t kPenDescriptor[] = {
    0x06, 0x00, 0xFF,  // Usage Page (Vendor)
    0x09, 0x01,        // Usage (1)
    0xA1, 0x01,        // Collection (Application)
    0x85, 0x08,        //   Report ID (8)
    0x75, 0x38,        //   Report Size (56)
    0x95, 0x01,        //   Report Count (1)
    0x09, 0x01,        //   Usage (1)
    0x81, 0x02,        //   Input (Data, Variable, Absolute)
    0xC0,              // End Collection
};

// Interface 1: a pen with the unit "inch" of the wrong system (33) and usages that repeat.
constexpr std::uint8_t kMouseDescriptor[] = {
    0x05, 0x0D,                          // Usage Page (Digitizer)
    0x09, 0x02,                          // Usage (Pen)
    0xA1, 0x01,                          // Collection (Application)
    0x85, 0x0A,                          //   Report ID (10)
    0x09, 0x20,                          //   Usage (Stylus)
    0xA1, 0x00,                          //   Collection (Physical)
    0x09, 0x42, 0x09, 0x44, 0x09, 0x45,  //     Usage (Tip Switch, Barrel Switch, Eraser)
    0x09, 0x3C, 0x09, 0x43, 0x09, 0x44,  //     Usage (Invert, Secondary Tip, Barrel Switch)
    0x15, 0x00, 0x25, 0x01,              //     Logical 0..1
    0x75, 0x01, 0x95, 0x06, 0x81, 0x02,  //     Input, 6 fields of 1 bit
    0x09, 0x32,                          //     Usage (In Range)
    0x75, 0x01, 0x95, 0x01, 0x81, 0x02,  //     Input, 1 bit
    0x81, 0x03,                          //     Input (Constant)
    0x05, 0x01,                          //     Usage Page (Generic Desktop)
    0x09, 0x30, 0x09, 0x31,              //     Usage (X, Y)
    0x55, 0x0D, 0x65, 0x33,              //     Unit, with exponent -3
    0x26, 0xFF, 0x7F,                    //     Logical Maximum (32767)
    0x35, 0x00, 0x46, 0x00, 0x08,        //     Physical 0..2048
    0x75, 0x10, 0x95, 0x02, 0x81, 0x02,  //     Input, 2 fields of 16 bits
    0x05, 0x0D,                          //     Usage Page (Digitizer)
    0x09, 0x30,                          //     Usage (Tip Pressure)
    0x26, 0xFF, 0x07,                    //     Logical Maximum (2047)
    0x75, 0x10, 0x95, 0x01, 0x81, 0x02,  //     Input, 16 bits
    0xC0,                                //   End Collection
    0xC0,                                // End Collection
};

constexpr EndpointSpec kPenEndpoint[] = {{0x81, 16, 2}};
constexpr EndpointSpec kMouseEndpoint[] = {{0x82, 16, 2}};
constexpr InterfaceSpec kInterfaces[] = {{kPenDescriptor, 1, 2, kPenEndpoint},
                                         {kMouseDescriptor, 1, 2, kMouseEndpoint}};

constexpr DeviceSpec spec_of(std::uint16_t product, std::string_view name) noexcept {
  DeviceSpec spec;
  spec.vendor = 0x256C;
  spec.product = product;
  spec.version = 0x3000;
  spec.manufacturer = "HUION";
  spec.product_name = name;
  spec.interfaces = kInterfaces;
  spec.usb_version = 0x0100;
  spec.attributes = kRemoteWakeup;
  spec.power_ma = 480;
  spec.manufacturer_index = 5;
  spec.product_index = 6;
  return spec;
}

// clang-format off
constexpr std::uint8_t kParameters1060[] = {
    0x12, 0x03, 0x70, 0xC6, 0x00, 0x06, 0x7C, 0x00, 0xFF, 0x1F, 0xD8, 0x13, 0x03, 0x0C, 0x10, 0x00, 0x01, 0x00};
constexpr std::uint8_t kFirmware1060[] = {
    0x24, 0x03, 'H', 0, 'U', 0, 'I', 0, 'O', 0, 'N', 0, '_', 0, 'T', 0, '1', 0, '7', 0, '4', 0, '_', 0,
    '1', 0, '7', 0, '0', 0, '5', 0, '1', 0, '9', 0};
constexpr std::uint8_t kFirmware191[] = {
    0x24, 0x03, 'H', 0, 'U', 0, 'I', 0, 'O', 0, 'N', 0, '_', 0, 'T', 0, '1', 0, '9', 0, '1', 0, '_', 0,
    '1', 0, '9', 0, '0', 0, '6', 0, '1', 0, '9', 0};
constexpr std::uint8_t kCompany[] = {
    0x46, 0x03, 'H', 0, 'U', 0, 'I', 0, 'O', 0, 'N', 0, ' ', 0, 'A', 0, 'n', 0, 'i', 0, 'm', 0, 'a', 0,
    't', 0, 'i', 0, 'o', 0, 'n', 0, ' ', 0, 'T', 0, 'e', 0, 'c', 0, 'h', 0, 'n', 0, 'o', 0, 'l', 0,
    'o', 0, 'g', 0, 'y', 0, ' ', 0, 'C', 0, 'o', 0, '.', 0, ',', 0, 'l', 0, 't', 0, 'd', 0};
constexpr std::uint8_t kOldParameters[] = {
    0x0E, 0x03, 0x40, 0x9C, 0xA8, 0x61, 0x03, 0x00, 0xFF, 0x1F, 0xA0, 0x0F, 0x08, 0x00};
constexpr std::uint8_t kString101[] = {0x04, 0x03, 0x20, 0xA0};
constexpr std::uint8_t kString110[] = {0x04, 0x03, 0x00, 0x30};
constexpr std::uint8_t kOldFirmware[] = {
    0x14, 0x03, 'H', 0, 'A', 0, '6', 0, '0', 0, '-', 0, 'F', 0, '4', 0, '0', 0, '0', 0};
constexpr std::uint8_t kString122[] = {0x08, 0x03, 0x01, 0x0C, 0x00, 0x00, 0x00, 0x00};
constexpr std::uint8_t kButtonsOn[] = {0x0C, 0x03, 'H', 0, 'K', 0, ' ', 0, 'O', 0, 'n', 0};
// clang-format on

constexpr StringAnswer kStrings1060[] = {
    {100, kOldParameters},  {101, kString101},    {110, kString110},
    {121, kOldFirmware},    {122, kString122},    {123, kButtonsOn},
    {200, kParameters1060}, {201, kFirmware1060}, {202, kCompany}};
// The same range, as the later tablets of this size have it.
constexpr StringAnswer kStrings191[] = {
    {200, kParameters1060}, {201, kFirmware191}, {202, kCompany}};

constexpr HuionModel kInspiroy{
    spec_of(0x006D, "Huion Tablet"), kStrings191, 50800, 31750, 8191, true};
constexpr HuionModel kNew1060Plus{
    spec_of(0x006E, "HUION New 1060 Plus"), kStrings1060, 50800, 31750, 8191, false};

}  // namespace

const HuionModel& Huion::inspiroy() noexcept { return kInspiroy; }
const HuionModel& Huion::new_1060_plus() noexcept { return kNew1060Plus; }

void Huion::restart() noexcept { is_mouse_ = true; }

int Huion::string_descriptor(std::uint8_t index, std::uint16_t language,
                             std::span<std::uint8_t> out) noexcept {
  if (language != kUsEnglish) return kStall;
  if (index == kParameters) is_mouse_ = false;
  return answer_string(model_.strings, index, out);
}

std::size_t Huion::scan(const PenPose& pose, ReportBuffer report) noexcept {
  if (pose.proximity == Proximity::kAway) return 0;
  if (is_mouse_) return mouse_report(pose, report);
  const bool touches = pose.proximity == Proximity::kTouching;
  const std::int32_t x = to_counts(pose.x_mm, kCountsPerMm, 0, model_.width_counts);
  const std::int32_t y = to_counts(pose.y_mm, kCountsPerMm, 0, model_.height_counts);
  report[0] = 8;
  report[1] = static_cast<std::uint8_t>(0x80 | (pose.secondary_barrel_switch ? 0x04 : 0) |
                                        (pose.barrel_switch ? 0x02 : 0) | (touches ? 0x01 : 0));
  put_le16(report, 2, x);
  put_le16(report, 4, y);
  if (touches) {
    put_le16(report, 6,
             to_counts(pose.pressure, model_.pressure_maximum, 1, model_.pressure_maximum));
  }
  report[8] = byte_of(x, 2);
  report[9] = byte_of(y, 2);
  if (model_.has_tilt) {
    report[10] = byte_of(to_counts(pose.tilt_x_deg, 1, -60, 60));
    report[11] = byte_of(-to_counts(pose.tilt_y_deg, 1, -60, 60));
  }
  return kPenBytes;
}

std::size_t Huion::mouse_report(const PenPose& pose, ReportBuffer report) const noexcept {
  constexpr std::int32_t kMost = 32767;
  constexpr std::int32_t kMostPressure = 2047;
  const bool touches = pose.proximity == Proximity::kTouching;
  const double width_mm = static_cast<double>(model_.width_counts) / kCountsPerMm;
  const double height_mm = static_cast<double>(model_.height_counts) / kCountsPerMm;
  report[0] = 10;
  report[1] =
      static_cast<std::uint8_t>(0x40 | (pose.barrel_switch ? 0x02 : 0) | (touches ? 0x01 : 0));
  put_le16(report, 2, to_counts(pose.x_mm, kMost / width_mm, 0, kMost));
  put_le16(report, 4, to_counts(pose.y_mm, kMost / height_mm, 0, kMost));
  if (touches) put_le16(report, 6, to_counts(pose.pressure, kMostPressure, 1, kMostPressure));
  return kMouseBytes;
}

}  // namespace limn::firmware
