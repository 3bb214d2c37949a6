#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drivers/transport/device_listing.hpp"
#include "drivers/transport/transport.hpp"
#include "input/base/error.hpp"

namespace limn {

/// Opens a device that came; nothing where it cannot be had.
using DeviceOpener = std::function<std::unique_ptr<Transport>(const ListedDevice&)>;

/// Which devices to wait for, and what to do with them.
struct DeviceWatch {
  std::string subsystem = "hidraw";  ///< of udev: "hidraw", or "usb" for interfaces of USB devices
  std::function<Expected<std::vector<ListedDevice>>()> list = list_hid_devices;
  DeviceFilter wanted;
  DeviceOpener open;
};

/// Tells of wanted devices that are plugged in later, opened. Listing and opening, which take as
/// long as a device takes to answer, happen in a thread of the watch's own, which calls all three
/// functions; destruction waits for the device that is being opened. Error: kIo where udev cannot
/// be asked or the system refuses a thread; kMissing in a build without libudev.
Expected<std::unique_ptr<Hotplug>> watch_devices(DeviceWatch watch);

}  // namespace limn
