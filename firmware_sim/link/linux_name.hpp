#pragma once

#include <cstdint>
#include <string>

#include "firmware_sim/usb/usb_function.hpp"

namespace limn::firmware {

/// What Linux calls a USB device: manufacturer and product, as far as it says them.
std::string linux_name(const DeviceSpec& spec);

/// Where an interface of a simulated device is, in place of "usb-0000:00:14.0-1/input0"; `link`
/// ("/1234.0") where several links show devices at a time.
std::string physical_path(std::uint8_t interface, const std::string& link = {});

}  // namespace limn::firmware
