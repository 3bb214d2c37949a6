#pragma once

#include <map>

#include "input/stroke/drag_velocity.hpp"

namespace limn {

/// DragVelocity for any number of 3D mice: each has a state of its own, and a new one after it was
/// unplugged (Disturbance::kReset). Allocates with the first sample of a device only.
class DragSampler {
 public:
  /// Precondition: check(options).
  explicit DragSampler(const DragOptions& options = {}) : options_(options) {}

  Drag push(const MotionSample& sample) {
    const auto [device, is_new] = devices_.try_emplace(sample.device, options_);
    if (!is_new && sample.disturbances.has(Disturbance::kReset)) {
      device->second = DragVelocity(options_);
    }
    return device->second.push(sample);
  }

 private:
  DragOptions options_;
  std::map<DeviceIndex, DragVelocity> devices_;
};

}  // namespace limn
