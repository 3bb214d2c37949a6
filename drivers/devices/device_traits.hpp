#pragma once

#include <string_view>

#include "drivers/devices/pen_decoder.hpp"
#include "input/trace/trace.hpp"

namespace limn {

enum class DeviceKind : std::uint8_t { kOther, kPen, k3dMouse };

/// What a device is to limn, before it has sent anything.
struct DeviceTraits {
  DeviceKind kind = DeviceKind::kOther;
  /// Of a pen: the family of its table's row, "HID pen", or "kernel pen" where the kernel decodes
  /// it; of a 3D mouse "3D mouse"; else empty.
  std::string_view name;
  PenAxes axes;    ///< of a pen: what its samples can have (PenDecoder, EvdevPenDecoder)
  PenRange range;  ///< of a pen: zero where its axes' ranges are not known
};

/// Tells a HID device by its ids, its name and its descriptor, and what the kernel decodes (a
/// device with `axes`) by its axes: of a tablet's several event nodes only the pen's is one. 3D
/// mice are known by their descriptor (Generic Desktop, Multi-axis Controller), without one by
/// their ids. limn lists and records them and watches their reports.
DeviceTraits traits_of(const TraceDevice& device);

/// Whether these are the USB ids of a 3D mouse. 3Dconnexion's vendor id alone says too little: it
/// makes ordinary mice and keyboards, too. Source: spacenavd, dev.c.
bool is_3d_mouse_id(std::uint16_t vendor, std::uint16_t product) noexcept;

}  // namespace limn
