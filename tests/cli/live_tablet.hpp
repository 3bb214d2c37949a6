#pragma once

#include <cstdio>
#include <functional>
#include <string>

#include "tests/cli/run_limn.hpp"
#include "tests/support/simulated_tablet.hpp"
#include "tests/support/temp_folder.hpp"

namespace limn::test {

/// A tablet on both sides of Linux, whose event node tells a stroke: a step every 20 ms, 100 counts
/// to the right, and one more at which the pen leaves.
class LiveTablet {
 public:
  /// `edit` changes what umockdev is told of the devices.
  explicit LiveTablet(const std::function<void(std::string&)>& edit = {}, int steps = kSteps) {
    std::string text = SimulatedTablet::usb_and_hid_devices() + SimulatedTablet::hidraw_device() +
                       SimulatedTablet::event_device();
    if (edit) edit(text);
    device_ = folder_.write("tablet.umockdev", text).string();
    hidraw_ = folder_.write("hidraw.ioctl", SimulatedTablet::hidraw_ioctls()).string();
    event_ = folder_.write("event.ioctl", SimulatedTablet::event_ioctls({})).string();
    // umockdev plays the first event at once, so that is none that counts.
    std::string events = "E: 0.000000 0000 0000 0\n";
    PenAction before;
    for (int i = 0; i <= steps; ++i) {
      const bool down = i > 1 && i < steps - 1;
      const PenAction action{i < steps, down, false, 1000 + 100 * i, 2000, down ? 500 : 0};
      for (const KernelEvent& event : SimulatedTablet::events(before, action)) {
        char line[64];
        std::snprintf(line, sizeof line, "E: %.6f %04x %04x %d\n", 0.2 + 0.02 * i, event.type,
                      event.code, event.value);
        events += line;
      }
      before = action;
    }
    events_ = folder_.write("events", events).string();
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  /// Runs limn on it; `before` may hold a command that runs it in turn.
  CommandRun limn(const std::string& words, const std::string& before = {}) const {
    return run_umockdev("-d " + device_ + " -i " + SimulatedTablet::kHidraw + "=" + hidraw_ +
                        " -i " + SimulatedTablet::kEvent + "=" + event_ + " -e " +
                        SimulatedTablet::kEvent + "=" + events_ + " -- " + before + " \"$0\" " +
                        words);
  }

  static constexpr int kSteps = 10;

 private:
  TempFolder folder_;
  std::string device_;
  std::string hidraw_;
  std::string event_;
  std::string events_;
};

}  // namespace limn::test
