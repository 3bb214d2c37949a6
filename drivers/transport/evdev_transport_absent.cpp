// For builds without libevdev.

#include "drivers/transport/evdev_transport.hpp"

namespace limn {

Expected<std::unique_ptr<Transport>> open_evdev(const std::string& node) {
  return fail(ErrorCode::kMissing, node, "this build has no libevdev, which reads event nodes",
              "build limn where libevdev-dev is installed");
}

}  // namespace limn
