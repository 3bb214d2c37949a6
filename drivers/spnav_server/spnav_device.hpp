#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "input/sample/report.hpp"

namespace limn {

/// What spacenavd tells at full deflection of a device whose axes are absolute. Relative ones it
/// tells as the device counts them.
inline constexpr double kSpnavFull = 500;

/// What programs may ask of a 3D mouse.
struct SpnavDevice {
  DeviceIndex index = 0;
  std::string name;
  std::string path;  ///< its node; empty where that is not known
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  unsigned buttons = 2;
  double full_deflection = kSpnavFull;  ///< what spacenavd tells there
};

/// libspnav's number (SPNAV_DEV_..) of the product: 0 for those that it has none for.
std::int32_t spnav_device_type(std::uint16_t vendor, std::uint16_t product) noexcept;

/// spacenavd's number, from 0 on, of the product's button `number` (MotionButtons): one less, but
/// for the SpaceMouse Pro and the Enterprise, whose gaps it closes. Nothing: it tells no such
/// button.
std::optional<unsigned> spnav_button(std::uint16_t vendor, std::uint16_t product,
                                     unsigned number) noexcept;

}  // namespace limn
