#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "input/base/error.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// Who brings a device's reports.
enum class Backend : std::uint8_t {
  kHidraw,  ///< Linux's hidraw nodes: reports as the device sent them
  kUsb,     ///< USB devices, taken from Linux's drivers
};

/// A HID device (one USB interface) that the system has, opened or not.
struct ListedDevice {
  std::string node;           ///< e.g. "/dev/hidraw3"
  TraceDevice device;         ///< report_descriptor is empty where sysfs does not show it
  std::string serial;         ///< the device's own serial number, where it has one
  int interface_number = -1;  ///< of USB; -1 elsewhere
  bool readable = false;      ///< whether this user may read the node
  Backend backend = Backend::kHidraw;
  std::string driver;  ///< Linux's driver of it: "hid-generic", "wacom" ..; empty: none, not known
};

/// The HID devices of the system, by node. Reads sysfs and opens none of them.
/// Error: kIo where the system cannot be asked; kMissing in a build without hidapi.
Expected<std::vector<ListedDevice>> list_hid_devices();

/// Which of the listed devices somebody wants.
using DeviceFilter = std::function<bool(const ListedDevice&)>;

}  // namespace limn
