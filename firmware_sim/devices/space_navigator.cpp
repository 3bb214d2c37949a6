#include "firmware_sim/devices/space_navigator.hpp"

#include <algorithm>

#include "firmware_sim/devices/counts.hpp"

namespace limn::firmware {
namespace {

// clang-format off
constexpr std::uint8_t kDescriptor[] = {
    0x05, 0x01,               // Usage Page (0x1)
    0x09, 0x08,               // Usage (0x8)
    0xA1, 0x01,               // Collection (Application)
    0xA1, 0x00,               //   Collection (Physical)
    0x85, 0x01,               //     Report ID (1)
    0x16, 0xA2, 0xFE,         //     Logical Minimum (-350)
    0x26, 0x5E, 0x01,         //     Logical Maximum (350)
    0x36, 0x88, 0xFA,         //     Physical Minimum (-1400)
    0x46, 0x78, 0x05,         //     Physical Maximum (1400)
    0x55, 0x0C,               //     Unit Exponent (12)
    0x65, 0x11,               //     Unit (0x11)
    0x09, 0x30,               //     Usage (0x30)
    0x09, 0x31,               //     Usage (0x31)
    0x09, 0x32,               //     Usage (0x32)
    0x75, 0x10,               //     Report Size (16)
    0x95, 0x03,               //     Report Count (3)
    0x81, 0x06,               //     Input (Data, Variable, Relative)
    0xC0,                     //   End Collection
    0xA1, 0x00,               //   Collection (Physical)
    0x85, 0x02,               //     Report ID (2)
    0x09, 0x33,               //     Usage (0x33)
    0x09, 0x34,               //     Usage (0x34)
    0x09, 0x35,               //     Usage (0x35)
    0x75, 0x10,               //     Report Size (16)
    0x95, 0x03,               //     Report Count (3)
    0x81, 0x06,               //     Input (Data, Variable, Relative)
    0xC0,                     //   End Collection
    0xA1, 0x02,               //   Collection (Logical)
    0x85, 0x03,               //     Report ID (3)
    0x05, 0x01,               //     Usage Page (0x1)
    0x05, 0x09,               //     Usage Page (0x9)
    0x19, 0x01,               //     Usage Minimum (0x1)
    0x29, 0x02,               //     Usage Maximum (0x2)
    0x15, 0x00,               //     Logical Minimum (0)
    0x25, 0x01,               //     Logical Maximum (1)
    0x35, 0x00,               //     Physical Minimum (0)
    0x45, 0x01,               //     Physical Maximum (1)
    0x75, 0x01,               //     Report Size (1)
    0x95, 0x02,               //     Report Count (2)
    0x81, 0x02,               //     Input (Data, Variable)
    0x95, 0x0E,               //     Report Count (14)
    0x81, 0x03,               //     Input (Constant, Variable)
    0xC0,                     //   End Collection
    0xA1, 0x02,               //   Collection (Logical)
    0x85, 0x04,               //     Report ID (4)
    0x05, 0x08,               //     Usage Page (0x8)
    0x09, 0x4B,               //     Usage (0x4b)
    0x15, 0x00,               //     Logical Minimum (0)
    0x25, 0x01,               //     Logical Maximum (1)
    0x95, 0x01,               //     Report Count (1)
    0x75, 0x01,               //     Report Size (1)
    0x91, 0x02,               //     Output (Data, Variable)
    0x95, 0x01,               //     Report Count (1)
    0x75, 0x07,               //     Report Size (7)
    0x91, 0x03,               //     Output (Constant, Variable)
    0xC0,                     //   End Collection
    0x06, 0x00, 0xFF,         //   Usage Page (0xff00)
    0x09, 0x01,               //   Usage (0x1)
    0xA1, 0x02,               //   Collection (Logical)
    0x15, 0x80,               //     Logical Minimum (-128)
    0x25, 0x7F,               //     Logical Maximum (127)
    0x75, 0x08,               //     Report Size (8)
    0x09, 0x3A,               //     Usage (0x3a)
    0xA1, 0x02,               //     Collection (Logical)
    0x85, 0x05,               //       Report ID (5)
    0x09, 0x20,               //       Usage (0x20)
    0x95, 0x01,               //       Report Count (1)
    0xB1, 0x02,               //       Feature (Data, Variable)
    0xC0,                     //     End Collection
    0xA1, 0x02,               //     Collection (Logical)
    0x85, 0x06,               //       Report ID (6)
    0x09, 0x21,               //       Usage (0x21)
    0x95, 0x01,               //       Report Count (1)
    0xB1, 0x02,               //       Feature (Data, Variable)
    0xC0,                     //     End Collection
    0xA1, 0x02,               //     Collection (Logical)
    0x85, 0x07,               //       Report ID (7)
    0x09, 0x22,               //       Usage (0x22)
    0x95, 0x01,               //       Report Count (1)
    0xB1, 0x02,               //       Feature (Data, Variable)
    0xC0,                     //     End Collection
    0xA1, 0x02,               //     Collection (Logical)
    0x85, 0x08,               //       Report ID (8)
    0x09, 0x23,               //       Usage (0x23)
    0x95, 0x07,               //       Report Count (7)
    0xB1, 0x02,               //       Feature (Data, Variable)
    0xC0,                     //     End Collection
    0xA1, 0x02,               //     Collection (Logical)
    0x85, 0x09,               //       Report ID (9)
    0x09, 0x24,               //       Usage (0x24)
    0x95, 0x07,               //       Report Count (7)
    0xB1, 0x02,               //       Feature (Data, Variable)
    0xC0,                     //     End Collection
    0xA1, 0x02,               //     Collection (Logical)
    0x85, 0x0A,               //       Report ID (10)
    0x09, 0x25,               //       Usage (0x25)
    0x95, 0x07,               //       Report Count (7)
    0xB1, 0x02,               //       Feature (Data, Variable)
    0xC0,                     //     End Collection
    0xA1, 0x02,               //     Collection (Logical)
    0x85, 0x0B,               //       Report ID (11)
    0x09, 0x26,               //       Usage (0x26)
    0x95, 0x01,               //       Report Count (1)
    0xB1, 0x02,               //       Feature (Data, Variable)
    0xC0,                     //     End Collection
    0xA1, 0x02,               //     Collection (Logical)
    0x85, 0x13,               //       Report ID (19)
    0x09, 0x2E,               //       Usage (0x2e)
    0x95, 0x01,               //       Report Count (1)
    0xB1, 0x02,               //       Feature (Data, Variable)
    0xC0,                     //     End Collection
    0xC0,                     //   End Collection
    0xC0,                     // End Collection
};
// clang-format on

constexpr EndpointSpec kEndpoints[] = {{0x81, 8, 10}, {0x02, 8, 10}};
constexpr InterfaceSpec kInterfaces[] = {{kDescriptor, 0, 0, kEndpoints}};

constexpr DeviceSpec kSpec = [] {
  DeviceSpec spec;
  spec.vendor = 0x046D;
  spec.product = 0xC626;
  spec.version = 0x0435;
  spec.manufacturer = "3Dconnexion";
  spec.product_name = "SpaceNavigator";
  spec.interfaces = kInterfaces;
  spec.most_control_bytes = 8;
  return spec;
}();

/// The feature reports that the descriptor declares, with the ID's byte.
struct Feature {
  std::uint8_t id;
  std::size_t bytes;
};
constexpr Feature kFeatureReports[] = {{5, 2}, {6, 2},  {7, 2},  {8, 8},
                                       {9, 8}, {10, 8}, {11, 2}, {19, 2}};

/// Its place in the table; past the end where there is none.
std::size_t index_of_feature(std::uint8_t id) noexcept {
  const auto* const found = std::find_if(std::begin(kFeatureReports), std::end(kFeatureReports),
                                         [id](const Feature& feature) { return feature.id == id; });
  return static_cast<std::size_t>(found - std::begin(kFeatureReports));
}

}  // namespace

const DeviceSpec& SpaceNavigator::spec() const noexcept { return kSpec; }

void SpaceNavigator::restart() noexcept {
  turned_ = false;
  for (auto& feature : features_) feature.fill(0);
}

int SpaceNavigator::get_report(std::uint8_t, ReportKind kind, std::uint8_t id,
                               std::span<std::uint8_t> out) noexcept {
  static_assert(std::size(kFeatureReports) == kFeatures);
  const std::size_t index = index_of_feature(id);
  if (kind != ReportKind::kFeature || index == kFeatures) return kStall;
  const std::size_t bytes = std::min(kFeatureReports[index].bytes, out.size());
  std::copy_n(features_[index].begin(), bytes, out.begin());
  if (bytes > 0) out[0] = id;
  return static_cast<int>(bytes);
}

bool SpaceNavigator::set_feature(std::uint8_t id, std::span<const std::uint8_t> bytes) noexcept {
  const std::size_t index = index_of_feature(id);
  if (index == kFeatures || bytes.size() > kFeatureReports[index].bytes) return false;
  std::copy(bytes.begin(), bytes.end(), features_[index].begin());
  return true;
}

std::size_t SpaceNavigator::axis_report(const Counts& counts, ReportBuffer report) noexcept {
  const std::size_t first = turned_ ? 3 : 0;
  report[0] = turned_ ? 2 : 1;
  for (std::size_t axis = 0; axis < 3; ++axis) put_le16(report, 1 + 2 * axis, counts[first + axis]);
  turned_ = !turned_;
  return 7;
}

}  // namespace limn::firmware
