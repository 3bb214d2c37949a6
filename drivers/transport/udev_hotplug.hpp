#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "drivers/transport/device_listing.hpp"
#include "drivers/transport/transport.hpp"
#include "input/base/error.hpp"

namespace limn {

/// Opens a device that came; nothing where it cannot be had.
using DeviceOpener = std::function<std::unique_ptr<Transport>(const ListedDevice&)>;

/// udev's news of devices, kept until a watch takes them: whoever listens before listing and
/// opening misses nothing that comes meanwhile.
class DeviceNews;

/// Error: kIo where udev cannot be asked; kMissing in a build without libudev.
Expected<std::shared_ptr<DeviceNews>> listen_for_devices();

/// Which devices to wait for, and what to do with them.
struct DeviceWatch {
  std::vector<Backend> backends = {Backend::kHidraw};  ///< whose rows; of spacenavd nobody tells
  DeviceFilter wanted;
  DeviceOpener open;
};

/// Tells of wanted devices that are plugged in later, opened. Listing and opening, which take as
/// long as a device takes to answer, happen in a thread of the watch's own, which calls both
/// functions; destruction waits for the device that is being opened. At most kMaxTraceDevices wait
/// to be taken; what comes beyond is left alone. `heard`: what listen_for_devices() gave before;
/// nothing: news from now on. Error: kIo where udev cannot be asked or the system refuses a thread;
/// kMissing in a build without libudev.
Expected<std::unique_ptr<Hotplug>> watch_devices(DeviceWatch watch,
                                                 std::shared_ptr<DeviceNews> heard = nullptr);

}  // namespace limn
