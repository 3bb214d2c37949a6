#include "drivers/devices/motion_spec.hpp"

#include <algorithm>
#include <limits>

namespace limn {
namespace {

constexpr std::string_view kSpacenavd = "spacenavd, dev.c and dev_usb_linux.c";
constexpr std::string_view kSpaceMouseNode = "spacemouse-node, products.ts";
constexpr std::string_view kCapture = "USB capture of one, firmware 4.35";
constexpr std::string_view kDescriptor = "its report descriptor, and a USB capture";

constexpr std::uint16_t kLogitech = 0x046D;
constexpr std::uint16_t k3dconnexion = 0x256F;
constexpr auto kUp = MotionFrame::kUp;
constexpr auto kDown = MotionFrame::kDown;

constexpr auto kSpecs = std::to_array<MotionSpec>({
    {kLogitech, 0xC603, "SpaceMouse Plus XT", 0, kUp, kSpacenavd},
    {kLogitech, 0xC605, "CadMan", 0, kDown, kSpacenavd},
    {kLogitech, 0xC606, "SpaceMouse Classic", 0, kUp, kSpacenavd},
    {kLogitech, 0xC621, "SpaceBall 5000", 12, kDown, kSpacenavd},
    {kLogitech, 0xC623, "SpaceTraveler", 8, kDown, kSpacenavd},
    {kLogitech, 0xC625, "SpacePilot", 21, kDown, kSpacenavd},
    {kLogitech, 0xC626, "SpaceNavigator", 2, kDown, kCapture},
    {kLogitech, 0xC627, "SpaceExplorer", 15, kDown, kSpacenavd},
    {kLogitech, 0xC628, "SpaceNavigator for Notebooks", 2, kDown, kSpacenavd},
    {kLogitech, 0xC629, "SpacePilot Pro", 31, kDown, kSpacenavd},
    {kLogitech, 0xC62B, "SpaceMouse Pro", 15, kDown, kSpacenavd},
    {kLogitech, 0xC640, "NuLOOQ", 0, kUp, kSpacenavd},
    {k3dconnexion, 0xC62C, "LIPARI", 0, kDown, kSpaceMouseNode},
    {k3dconnexion, 0xC62E, "SpaceMouse Wireless, by its cable", 2, kDown, kDescriptor},
    {k3dconnexion, 0xC62F, "SpaceMouse Wireless, receiver", 2, kDown, kSpacenavd},
    {k3dconnexion, 0xC631, "SpaceMouse Pro Wireless, by its cable", 15, kDown, kSpacenavd},
    {k3dconnexion, 0xC632, "SpaceMouse Pro Wireless, receiver", 15, kDown, kSpacenavd},
    {k3dconnexion, 0xC633, "SpaceMouse Enterprise", 31, kDown, kSpacenavd},
    {k3dconnexion, 0xC635, "SpaceMouse Compact", 2, kDown, kSpacenavd},
    {k3dconnexion, 0xC636, "SpaceMouse Module", 0, kDown, kSpacenavd},
    {k3dconnexion, 0xC638, "SpaceMouse Pro Wireless Bluetooth, by its cable", 15, kDown,
     kSpacenavd},
    {k3dconnexion, 0xC63A, "SpaceMouse Wireless Bluetooth", 2, kDown, kSpacenavd},
    {k3dconnexion, 0xC652, "Universal Receiver", 0, kDown, kSpaceMouseNode},
    {k3dconnexion, 0xC65A, "Universal Receiver 2", 0, kDown, kSpaceMouseNode},
    {k3dconnexion, 0xC65C, "Universal Receiver 2", 0, kDown, kSpaceMouseNode},
});

}  // namespace

std::array<double, kMotionAxes> in_motion_frame(const std::array<double, kMotionAxes>& axes,
                                                MotionFrame frame) noexcept {
  const auto& [x, y, z, rx, ry, rz] = axes;
  if (frame == MotionFrame::kUp) return {x, z, y, rx, rz, ry};
  return {x, 0 - y, 0 - z, rx, 0 - ry, 0 - rz};  // never -0
}

double full_counts(std::int64_t minimum, std::int64_t maximum) noexcept {
  const std::int64_t most = std::max(maximum, -minimum);
  constexpr std::int64_t kWholeField = std::numeric_limits<std::int16_t>::max();
  if (minimum > maximum || most <= 0 || most >= kWholeField) return kUsualFullCounts;
  return static_cast<double>(most);
}

std::span<const MotionSpec> motion_specs() noexcept { return kSpecs; }

const MotionSpec* find_motion_spec(std::uint16_t vendor, std::uint16_t product) noexcept {
  const auto* const found =
      std::find_if(kSpecs.begin(), kSpecs.end(), [vendor, product](const MotionSpec& spec) {
        return spec.vendor == vendor && spec.product == product;
      });
  return found == kSpecs.end() ? nullptr : found;
}

}  // namespace limn
