#include "drivers/devices/device_traits.hpp"

#include <algorithm>
#include <array>

#include "drivers/devices/evdev_pen_decoder.hpp"
#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/usages.hpp"

namespace limn {
namespace {

// <linux/input-event-codes.h>
constexpr std::uint16_t kAbsX = 0x00;
constexpr std::uint16_t kAbsRz = 0x05;

bool is_multi_axis_controller(std::span<const std::uint8_t> report_descriptor) {
  const auto descriptor = hid::parse_descriptor(report_descriptor);
  return descriptor && std::any_of(descriptor->collections.begin(), descriptor->collections.end(),
                                   [](const hid::Collection& collection) {
                                     return collection.parent == hid::kNoCollection &&
                                            collection.usage == hid::usage::kMultiAxisController;
                                   });
}

bool has_six_axes(const std::vector<EvdevAxis>& axes) {
  return std::count_if(axes.begin(), axes.end(), [](const EvdevAxis& axis) {
           return axis.code >= kAbsX && axis.code <= kAbsRz;
         }) == kAbsRz - kAbsX + 1;
}

DeviceTraits kernel_pen(const TraceDevice& device) {
  // Nodes that may not be read have axes without ranges: any will do to see which there are.
  TraceDevice ranged = device;
  const bool unknown = std::all_of(device.axes.begin(), device.axes.end(), [](const auto& axis) {
    return axis.minimum == 0 && axis.maximum == 0;
  });
  if (unknown) {
    for (EvdevAxis& axis : ranged.axes) axis.maximum = axis.resolution = 1;
  }
  const auto decoder = EvdevPenDecoder::make(ranged);
  if (!decoder || !decoder->has_pen()) return {};
  return {DeviceKind::kPen, "kernel pen", decoder->axes(), unknown ? PenRange{} : decoder->range()};
}

}  // namespace

bool is_3d_mouse_id(std::uint16_t vendor, std::uint16_t product) noexcept {
  struct Id {
    std::uint16_t vendor;
    std::uint16_t product;
  };
  constexpr auto kIds = std::to_array<Id>({
      {0x046D, 0xC603},  // SpaceMouse Plus XT
      {0x046D, 0xC605},  // CadMan
      {0x046D, 0xC606},  // SpaceMouse Classic
      {0x046D, 0xC621},  // SpaceBall 5000
      {0x046D, 0xC623},  // SpaceTraveler
      {0x046D, 0xC625},  // SpacePilot
      {0x046D, 0xC626},  // SpaceNavigator
      {0x046D, 0xC627},  // SpaceExplorer
      {0x046D, 0xC628},  // SpaceNavigator for Notebooks
      {0x046D, 0xC629},  // SpacePilot Pro
      {0x046D, 0xC62B},  // SpaceMouse Pro
      {0x046D, 0xC640},  // NuLOOQ
      {0x256F, 0xC62E},  // SpaceMouse Wireless, by its cable
      {0x256F, 0xC62F},  // SpaceMouse Wireless, receiver
      {0x256F, 0xC631},  // SpaceMouse Pro Wireless, by its cable
      {0x256F, 0xC632},  // SpaceMouse Pro Wireless, receiver
      {0x256F, 0xC633},  // SpaceMouse Enterprise
      {0x256F, 0xC635},  // SpaceMouse Compact
      {0x256F, 0xC636},  // SpaceMouse Module
      {0x256F, 0xC638},  // SpaceMouse Pro Wireless Bluetooth, by its cable
      {0x256F, 0xC63A},  // SpaceMouse Wireless Bluetooth
  });
  return std::any_of(kIds.begin(), kIds.end(), [vendor, product](const Id& id) {
    return id.vendor == vendor && id.product == product;
  });
}

DeviceTraits traits_of(const TraceDevice& device) {
  const DeviceTraits mouse{DeviceKind::k3dMouse, "3D mouse", {}, {}};
  const bool is_mouse = device.report_descriptor.empty()
                            ? is_3d_mouse_id(device.vendor, device.product)
                            : is_multi_axis_controller(device.report_descriptor);
  if (!device.axes.empty()) {
    if (!is_mouse) return kernel_pen(device);
    return has_six_axes(device.axes) ? mouse : DeviceTraits{};
  }
  if (is_mouse) return mouse;
  PenIdentity identity;
  identity.vendor = device.vendor;
  identity.product = device.product;
  identity.product_name = device.name;
  const auto decoder = PenDecoder::make(identity, device.report_descriptor);
  if (!decoder || !decoder->has_pen()) return {};
  const PenSpec* row = decoder->spec();
  return {DeviceKind::kPen, row != nullptr ? name(row->family) : std::string_view("HID pen"),
          decoder->axes(), decoder->range()};
}

}  // namespace limn
