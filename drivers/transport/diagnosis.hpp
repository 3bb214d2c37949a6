#pragma once

#include <string>
#include <vector>

#include "drivers/transport/device_listing.hpp"

namespace limn {

/// Something that was looked at, and what to do about it.
struct Finding {
  enum class State { kGood, kNotice, kTrouble };
  State state = State::kGood;
  std::string subject;  ///< "udev rules", "/dev/hidraw3", ..
  std::string what;     ///< what was found
  std::string remedy;   ///< empty where there is nothing to do
};

/// Looks for what keeps devices from limn: nodes that this user may not read, udev rules that are
/// not installed, programs that have a node open, spacenavd. Reads /proc, /run and the folders of
/// udev below `root` ("" is the system's own; tests have others); opens no device.
std::vector<Finding> diagnose(const std::vector<ListedDevice>& devices,
                              const std::string& root = {});

}  // namespace limn
