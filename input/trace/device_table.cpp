#include "input/trace/device_table.hpp"

namespace limn {

TrackedDevice* DeviceTable::find_or_add(DeviceIndex index) {
  for (const auto& device : devices_) {
    if (device->description.index == index) return device.get();
  }
  if (devices_.size() == kMaxTraceDevices) return nullptr;
  devices_.push_back(std::make_unique<TrackedDevice>());
  devices_.back()->description.index = index;
  return devices_.back().get();
}

DeviceDescribed DeviceTable::announce(TrackedDevice& device) const {
  TraceDevice& description = device.description;
  if (description.report_descriptor.empty()) {
    description.report_descriptor = supplied_.report_descriptor;
  }
  if (description.vendor == 0 && description.product == 0) {
    description.vendor = supplied_.vendor;
    description.product = supplied_.product;
  }
  device.announced = true;
  return {&description};
}

}  // namespace limn
