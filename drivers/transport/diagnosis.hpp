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

/// Whether a line of 70-limn.rules is about the device's node.
bool is_in_rules(const ListedDevice& listed) noexcept;

/// What keeps limn from one listed device: nothing (kGood, with its name), a permission (also one
/// that setting it up needs), no driver, a program that holds it.
Finding look_at(const ListedDevice& listed);

/// Looks for what keeps devices from limn, or makes their values look wrong:
///
///     each device             whether this user may read it, and which driver of Linux has it
///     udev rules              whether they are installed
///     processes               that have a node open, and drivers of tablets in user space that set
///                             devices up or take them over, by name
///     spacenavd               its socket and its process
///     queues                  what can be known of reports that the kernel dropped. Queues are one
///                             a reader, so nothing of what others lost can be seen, and hidraw
///                             tells its own reader nothing either: this finding says where limn
///                             shows it, and measures nothing
///
/// Reads /proc, /run and the folders of udev below `root` ("" is the system's own; tests have
/// others). Opens no device, and never asks for one exclusively: whether an event node is grabbed
/// by somebody could be found out only by grabbing it.
std::vector<Finding> diagnose(const std::vector<ListedDevice>& devices,
                              const std::string& root = {});

}  // namespace limn
