#pragma once

#include <optional>
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

/// The physical path of what spacenavd gives, whichever device is behind it.
inline constexpr std::string_view kSpacenavdPath = "spacenavd";

/// Tells a HID device by its ids, its name and its descriptor, and what the kernel decodes (a
/// device with `axes`) by its axes: of a tablet's several event nodes only the pen's is one. 3D
/// mice are known by their descriptor (Generic Desktop, Multi-axis Controller), without one by
/// their ids (motion_spec.hpp).
DeviceTraits traits_of(const TraceDevice& device);

/// Whether that kind is k3dMouse.
bool is_3d_mouse(const TraceDevice& device);

/// The counts of full deflection of a 3D mouse whose axes are called relative, as 3Dconnexion's
/// older ones do wrongly, by its event node or its descriptor; nothing where they are absolute, or
/// neither says.
std::optional<double> relative_full_counts(const TraceDevice& device);

}  // namespace limn
