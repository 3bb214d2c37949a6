#include "firmware_sim/devices/xp_pen.hpp"

#include "firmware_sim/devices/counts.hpp"
#include "firmware_sim/usb/string_answers.hpp"

namespace limn::firmware {
namespace {

constexpr std::uint16_t kUsEnglish = 0x0409;

// clang-format off

// Interface 0: a mouse with pressure (9), a mouse (1), a keyboard (6): for its keys.
constexpr std::uint8_t kKeysDescriptor[] = {
    0x05, 0x01,               // Usage Page (0x1)
    0x09, 0x02,               // Usage (0x2)
    0xA1, 0x01,               // Collection (Application)
    0x85, 0x09,               //   Report ID (9)
    0x09, 0x01,               //   Usage (0x1)
    0xA1, 0x00,               //   Collection (Physical)
    0x05, 0x09,               //     Usage Page (0x9)
    0x19, 0x01,               //     Usage Minimum (0x1)
    0x29, 0x03,               //     Usage Maximum (0x3)
    0x15, 0x00,               //     Logical Minimum (0)
    0x25, 0x01,               //     Logical Maximum (1)
    0x95, 0x03,               //     Report Count (3)
    0x75, 0x01,               //     Report Size (1)
    0x81, 0x02,               //     Input (Data, Variable)
    0x95, 0x05,               //     Report Count (5)
    0x81, 0x01,               //     Input (Constant)
    0x05, 0x01,               //     Usage Page (0x1)
    0x09, 0x30,               //     Usage (0x30)
    0x09, 0x31,               //     Usage (0x31)
    0x26, 0xFF, 0x7F,         //     Logical Maximum (32767)
    0x95, 0x02,               //     Report Count (2)
    0x75, 0x10,               //     Report Size (16)
    0x81, 0x02,               //     Input (Data, Variable)
    0x05, 0x0D,               //     Usage Page (0xd)
    0x09, 0x30,               //     Usage (0x30)
    0x26, 0xFF, 0x07,         //     Logical Maximum (2047)
    0x95, 0x01,               //     Report Count (1)
    0x75, 0x10,               //     Report Size (16)
    0x81, 0x02,               //     Input (Data, Variable)
    0xC0,                     //   End Collection
    0xC0,                     // End Collection
    0x05, 0x01,               // Usage Page (0x1)
    0x09, 0x02,               // Usage (0x2)
    0xA1, 0x01,               // Collection (Application)
    0x09, 0x01,               //   Usage (0x1)
    0xA1, 0x00,               //   Collection (Physical)
    0x85, 0x01,               //     Report ID (1)
    0x05, 0x09,               //     Usage Page (0x9)
    0x19, 0x01,               //     Usage Minimum (0x1)
    0x29, 0x05,               //     Usage Maximum (0x5)
    0x95, 0x05,               //     Report Count (5)
    0x75, 0x01,               //     Report Size (1)
    0x15, 0x00,               //     Logical Minimum (0)
    0x25, 0x01,               //     Logical Maximum (1)
    0x81, 0x02,               //     Input (Data, Variable)
    0x95, 0x03,               //     Report Count (3)
    0x81, 0x01,               //     Input (Constant)
    0x05, 0x01,               //     Usage Page (0x1)
    0x09, 0x30,               //     Usage (0x30)
    0x09, 0x31,               //     Usage (0x31)
    0x95, 0x02,               //     Report Count (2)
    0x75, 0x10,               //     Report Size (16)
    0x16, 0x00, 0x80,         //     Logical Minimum (-32768)
    0x26, 0xFF, 0x7F,         //     Logical Maximum (32767)
    0x81, 0x06,               //     Input (Data, Variable, Relative)
    0x09, 0x38,               //     Usage (0x38)
    0x15, 0x81,               //     Logical Minimum (-127)
    0x25, 0x7F,               //     Logical Maximum (127)
    0x95, 0x01,               //     Report Count (1)
    0x75, 0x08,               //     Report Size (8)
    0x81, 0x06,               //     Input (Data, Variable, Relative)
    0x05, 0x0C,               //     Usage Page (0xc)
    0x0A, 0x38, 0x02,         //     Usage (0x238)
    0x95, 0x01,               //     Report Count (1)
    0x75, 0x08,               //     Report Size (8)
    0x81, 0x06,               //     Input (Data, Variable, Relative)
    0xC0,                     //   End Collection
    0xC0,                     // End Collection
    0x05, 0x01,               // Usage Page (0x1)
    0x09, 0x06,               // Usage (0x6)
    0xA1, 0x01,               // Collection (Application)
    0x85, 0x06,               //   Report ID (6)
    0x05, 0x07,               //   Usage Page (0x7)
    0x19, 0xE0,               //   Usage Minimum (0xe0)
    0x29, 0xE7,               //   Usage Maximum (0xe7)
    0x15, 0x00,               //   Logical Minimum (0)
    0x25, 0x01,               //   Logical Maximum (1)
    0x75, 0x01,               //   Report Size (1)
    0x95, 0x08,               //   Report Count (8)
    0x81, 0x02,               //   Input (Data, Variable)
    0x05, 0x07,               //   Usage Page (0x7)
    0x19, 0x00,               //   Usage Minimum (0x0)
    0x29, 0xFF,               //   Usage Maximum (0xff)
    0x26, 0xFF, 0x00,         //   Logical Maximum (255)
    0x75, 0x08,               //   Report Size (8)
    0x95, 0x06,               //   Report Count (6)
    0x81, 0x00,               //   Input (Data, Array)
    0xC0,                     // End Collection
};

// Interface 1: a pen.
constexpr std::uint8_t kPlainDescriptor[] = {
    0x05, 0x0D,               // Usage Page (0xd)
    0x09, 0x02,               // Usage (0x2)
    0xA1, 0x01,               // Collection (Application)
    0x85, 0x07,               //   Report ID (7)
    0x09, 0x20,               //   Usage (0x20)
    0xA1, 0x00,               //   Collection (Physical)
    0x09, 0x42,               //     Usage (0x42)
    0x09, 0x44,               //     Usage (0x44)
    0x09, 0x45,               //     Usage (0x45)
    0x15, 0x00,               //     Logical Minimum (0)
    0x25, 0x01,               //     Logical Maximum (1)
    0x75, 0x01,               //     Report Size (1)
    0x95, 0x03,               //     Report Count (3)
    0x81, 0x02,               //     Input (Data, Variable)
    0x95, 0x02,               //     Report Count (2)
    0x81, 0x03,               //     Input (Constant, Variable)
    0x09, 0x32,               //     Usage (0x32)
    0x95, 0x01,               //     Report Count (1)
    0x81, 0x02,               //     Input (Data, Variable)
    0x95, 0x02,               //     Report Count (2)
    0x81, 0x03,               //     Input (Constant, Variable)
    0x75, 0x10,               //     Report Size (16)
    0x95, 0x01,               //     Report Count (1)
    0x35, 0x00,               //     Physical Minimum (0)
    0xA4,                     //     Push
    0x05, 0x01,               //     Usage Page (0x1)
    0x09, 0x30,               //     Usage (0x30)
    0x65, 0x13,               //     Unit (0x13)
    0x55, 0x0D,               //     Unit Exponent (13)
    0x46, 0x10, 0x27,         //     Physical Maximum (10000)
    0x26, 0xFF, 0x7F,         //     Logical Maximum (32767)
    0x81, 0x02,               //     Input (Data, Variable)
    0x09, 0x31,               //     Usage (0x31)
    0x46, 0x6A, 0x18,         //     Physical Maximum (6250)
    0x26, 0xFF, 0x7F,         //     Logical Maximum (32767)
    0x81, 0x02,               //     Input (Data, Variable)
    0xB4,                     //     Pop
    0x09, 0x30,               //     Usage (0x30)
    0x45, 0x00,               //     Physical Maximum (0)
    0x26, 0xFF, 0x1F,         //     Logical Maximum (8191)
    0x81, 0x42,               //     Input (Data, Variable, Null State)
    0x09, 0x3D,               //     Usage (0x3d)
    0x15, 0x81,               //     Logical Minimum (-127)
    0x25, 0x7F,               //     Logical Maximum (127)
    0x75, 0x08,               //     Report Size (8)
    0x95, 0x01,               //     Report Count (1)
    0x81, 0x02,               //     Input (Data, Variable)
    0x09, 0x3E,               //     Usage (0x3e)
    0x15, 0x81,               //     Logical Minimum (-127)
    0x25, 0x7F,               //     Logical Maximum (127)
    0x81, 0x02,               //     Input (Data, Variable)
    0xC0,                     //   End Collection
    0xC0,                     // End Collection
};

// Interface 2: bytes.
constexpr std::uint8_t kVendorDescriptor[] = {
    0x06, 0x0A, 0xFF,         // Usage Page (0xff0a)
    0x09, 0x01,               // Usage (0x1)
    0xA1, 0x01,               // Collection (Application)
    0x85, 0x02,               //   Report ID (2)
    0x09, 0x02,               //   Usage (0x2)
    0x75, 0x08,               //   Report Size (8)
    0x95, 0x0B,               //   Report Count (11)
    0x15, 0x00,               //   Logical Minimum (0)
    0x26, 0xFF, 0x00,         //   Logical Maximum (255)
    0x81, 0x02,               //   Input (Data, Variable)
    0x09, 0x03,               //   Usage (0x3)
    0x75, 0x08,               //   Report Size (8)
    0x95, 0x09,               //   Report Count (9)
    0x15, 0x00,               //   Logical Minimum (0)
    0x26, 0xFF, 0x00,         //   Logical Maximum (255)
    0x91, 0x02,               //   Output (Data, Variable)
    0xC0,                     // End Collection
};

constexpr std::uint8_t kParameters[] = {
    0x0C, 0x03, 0x38, 0x63, 0x03, 0x3E, 0x08, 0x00, 0xFF, 0x1F, 0xEC, 0x09};
constexpr std::uint8_t kString101[] = {0x04, 0x03, 0x00, 0x67};
constexpr std::uint8_t kString110[] = {0x09, 0x03, 0x00, 0x10, 0x00, 0x11, 0x08, 0x00, 0x00};
constexpr std::uint8_t kString121[] = {
    0x10, 0x03, ' ', ' ', ' ', ' ', ' ', ' ', ' ', ' ', ' ', ' ', ' ', ' ', ' ', ' '};
constexpr std::uint8_t kString122[] = {0x08, 0x03, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00};
constexpr std::uint8_t kString123[] = {0x0C, 0x03, 'H', 0, 'K', 0, ' ', 0, 'O', 0, 'n', 0};
// clang-format on

constexpr StringAnswer kStrings[] = {{100, kParameters}, {101, kString101}, {110, kString110},
                                     {121, kString121},  {122, kString122}, {123, kString123}};

constexpr EndpointSpec kKeysEndpoints[] = {{0x81, 8, 4}};
constexpr EndpointSpec kPlainEndpoints[] = {{0x82, 64, 3}};
constexpr EndpointSpec kVendorEndpoints[] = {{0x83, 12, 3}, {0x03, 10, 10}};
constexpr InterfaceSpec kInterfaces[] = {{kKeysDescriptor, 1, 2, kKeysEndpoints},
                                         {kPlainDescriptor, 1, 2, kPlainEndpoints},
                                         {kVendorDescriptor, 0, 0, kVendorEndpoints}};

constexpr DeviceSpec kSpec = [] {
  DeviceSpec spec;
  spec.vendor = 0x28BD;
  spec.product = 0x0905;
  spec.version = 0x0000;
  spec.manufacturer = "UGTABLET";
  spec.product_name = "10 inch PenTablet";
  spec.interfaces = kInterfaces;
  spec.usb_version = 0x0110;
  spec.hid_version = 0x0100;
  spec.attributes = kRemoteWakeup;
  return spec;
}();

}  // namespace

const DeviceSpec& XpPen::spec() const noexcept { return kSpec; }

void XpPen::restart() noexcept {
  vendor_mode_ = false;
  present_ = false;
}

int XpPen::string_descriptor(std::uint8_t index, std::uint16_t language,
                             std::span<std::uint8_t> out) noexcept {
  return language == kUsEnglish ? answer_string(kStrings, index, out) : kStall;
}

bool XpPen::set_report(std::uint8_t interface, ReportKind kind, std::uint8_t id,
                       std::span<const std::uint8_t> bytes) noexcept {
  if (interface != 2 || kind != ReportKind::kOutput || id != 0x02 || bytes.size() < 3) return false;
  if (bytes[1] == 0xB0 && bytes[2] == 0x04) {
    vendor_mode_ = true;
    present_ = false;
  }
  return true;
}

std::size_t XpPen::scan(const PenPose& pose, ReportBuffer report) noexcept {
  const bool sees = pose.proximity != Proximity::kAway;
  const bool touches = pose.proximity == Proximity::kTouching;
  if (!sees && !present_) return 0;
  present_ = sees;
  report[0] = vendor_mode_ ? 0x02 : 0x07;
  if (!sees) {
    // Interface 1 declares bit 5 as "in range"; at interface 2 both high bits say that it left.
    report[1] = vendor_mode_ ? 0xC0 : 0x80;
    return vendor_mode_ ? kPenBytes : kPlainBytes;
  }
  constexpr std::int32_t kPlainMost = 32767;
  const double per_mm_x = vendor_mode_ ? kCountsPerMm : kPlainMost / kWidthMm;
  const double per_mm_y = vendor_mode_ ? kCountsPerMm : kPlainMost / kHeightMm;
  const std::int32_t x =
      to_counts(pose.x_mm, per_mm_x, 0, vendor_mode_ ? kWidthCounts : kPlainMost);
  const std::int32_t y =
      to_counts(pose.y_mm, per_mm_y, 0, vendor_mode_ ? kHeightCounts : kPlainMost);
  // Report 7 has the eraser in bit 2, report 2 in bit 3.
  const bool erases = pose.end == PenEnd::kEraser;
  report[1] =
      static_cast<std::uint8_t>(0xA0 | (touches ? 0x01 : 0) | (pose.barrel_switch ? 0x02 : 0));
  if (vendor_mode_) {
    report[1] = static_cast<std::uint8_t>(report[1] | (pose.secondary_barrel_switch ? 0x04 : 0) |
                                          (erases ? 0x08 : 0));
  } else if (erases) {
    report[1] = static_cast<std::uint8_t>(report[1] | 0x04);
  }
  put_le16(report, 2, x);
  put_le16(report, 4, y);
  if (touches) put_le16(report, 6, to_counts(pose.pressure, kPressureMaximum, 1, kPressureMaximum));
  report[8] = byte_of(to_counts(pose.tilt_x_deg, 1, -60, 60));
  report[9] = byte_of(to_counts(pose.tilt_y_deg, 1, -60, 60));
  if (!vendor_mode_) return kPlainBytes;
  report[10] = byte_of(x, 2);
  report[11] = byte_of(y, 2);
  return kPenBytes;
}

}  // namespace limn::firmware
