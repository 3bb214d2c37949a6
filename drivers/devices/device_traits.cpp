#include "drivers/devices/device_traits.hpp"

#include <algorithm>

#include "drivers/devices/evdev_pen_decoder.hpp"
#include "drivers/devices/motion_decoder.hpp"
#include "drivers/devices/motion_spec.hpp"
#include "drivers/hid/report_layout.hpp"
#include "drivers/hid/usages.hpp"

namespace limn {
namespace {

// <linux/input-event-codes.h>
constexpr std::uint16_t kAbsX = 0x00;
constexpr std::uint16_t kAbsRz = 0x05;

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

bool is_3d_mouse(const TraceDevice& device) {
  if (device.physical_path == kSpacenavdPath) return true;
  const bool by_ids = find_motion_spec(device.vendor, device.product) != nullptr;
  const bool is_mouse = device.report_descriptor.empty()
                            ? by_ids
                            : is_multi_axis_controller(device.report_descriptor);
  return is_mouse && (device.axes.empty() || has_six_axes(device.axes));
}

std::optional<double> relative_full_counts(const TraceDevice& device) {
  if (!device.relative_axes.empty()) return kUsualFullCounts;
  if (device.is_kernel_decoded() || !is_3d_mouse(device)) return std::nullopt;
  const auto descriptor = hid::parse_descriptor(device.report_descriptor);
  if (!descriptor) return std::nullopt;
  for (std::uint32_t i = 0; i < descriptor->fields.size(); ++i) {
    const hid::Field& field = descriptor->fields[i];
    if (field.kind != hid::ReportKind::kInput || !field.flags.relative()) continue;
    if (hid::locate_in_field(*descriptor, i, hid::usage::kX).empty()) continue;
    return full_counts(field.logical.minimum, field.logical.maximum);
  }
  return std::nullopt;
}

DeviceTraits traits_of(const TraceDevice& device) {
  if (is_3d_mouse(device)) return {DeviceKind::k3dMouse, "3D mouse", {}, {}};
  if (device.is_kernel_decoded()) return kernel_pen(device);
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
