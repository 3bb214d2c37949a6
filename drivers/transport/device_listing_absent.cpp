// For builds without hidapi or libudev: hidraw nodes are not found, and nobody tells of new
// devices.

#include "drivers/transport/device_listing.hpp"
#include "drivers/transport/udev_hotplug.hpp"

namespace limn {
namespace {

tl::unexpected<Error> absent() {
  return fail(ErrorCode::kMissing, "", "this build has no hidapi, which finds devices",
              "build limn where libhidapi-dev and libudev-dev are installed");
}

}  // namespace

Expected<std::vector<ListedDevice>> list_hid_devices(const std::string&) { return absent(); }

Expected<std::shared_ptr<DeviceNews>> listen_for_devices() { return absent(); }

Expected<std::unique_ptr<Hotplug>> watch_devices(DeviceWatch, std::shared_ptr<DeviceNews>) {
  return absent();
}

}  // namespace limn
