#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "drivers/transport/device_control.hpp"
#include "input/base/error.hpp"

namespace limn {

/// What is asked of the device behind a hidraw node, while its stream is read by whoever likes.
/// Reports go through the node. Strings are asked of the USB device above it, which takes nothing
/// from Linux's driver; its node is opened with the first of them.
/// Errors: kIo: no such node, no permission to write. Of read_string() also kMissing: it is no USB
/// device, or the build has no libusb.
Expected<std::unique_ptr<DeviceControl>> open_hidraw_control(const std::string& node);

/// The node of the USB device above a hidraw node, "/dev/bus/usb/001/004"; nothing where it is
/// none.
std::optional<std::string> usb_node_above(const std::string& hidraw_node);

}  // namespace limn
