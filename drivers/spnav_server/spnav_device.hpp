#pragma once

#include <cstdint>
#include <string>

#include "input/sample/report.hpp"

namespace limn {

/// What programs may ask of a 3D mouse.
struct SpnavDevice {
  DeviceIndex index = 0;
  std::string name;
  std::string path;  ///< its node; empty where that is not known
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  unsigned buttons = 2;
};

/// libspnav's number (SPNAV_DEV_..) of the product: 0 for those that it has none for.
std::int32_t spnav_device_type(std::uint16_t vendor, std::uint16_t product) noexcept;

}  // namespace limn
