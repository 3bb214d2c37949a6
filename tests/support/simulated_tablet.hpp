#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace limn::test {

/// What a pen does at one instant.
struct PenAction {
  bool in_range = false;
  bool tip = false;
  bool barrel = false;
  int x = 0;         ///< 0 to 20000 over 105.3 mm
  int y = 0;         ///< 0 to 10000 over 52.6 mm
  int pressure = 0;  ///< 0 to 1023
  int tilt_x = 0;    ///< degrees, -64 to 63
  int tilt_y = 0;
};

/// One event of Linux's evdev.
struct KernelEvent {
  std::uint16_t type = 0;
  std::uint16_t code = 0;
  std::int32_t value = 0;
};

/// A USB tablet as umockdev can play it on both of Linux's sides: /dev/hidraw0 and, as hid-input
/// would decode it, /dev/input/event300. Its 189.93 counts a mm become evdev's resolution of 190.
class SimulatedTablet {
 public:
  static constexpr const char* kHidraw = "/dev/hidraw0";
  static constexpr const char* kEvent = "/dev/input/event300";

  /// Where the devices lie in sysfs.
  static std::string usb_path() { return "/devices/pci0000:00/0000:00:14.0/usb1/1-1"; }
  static std::string hid_path() { return usb_path() + "/1-1:1.0/0003:1209:0002.0001"; }
  static std::string hidraw_path(int number = 0) {
    return hid_path() + "/hidraw/hidraw" + std::to_string(number);
  }
  static std::string event_path() { return hid_path() + "/input/input5/event300"; }

  /// The devices, as umockdev describes them.
  static std::string usb_and_hid_devices();
  static std::string hidraw_device(int number = 0);
  static std::string event_device();

  /// Answers to ioctls, in umockdev's format. The event node's state is that of `state`.
  static std::string hidraw_ioctls(int number = 0);
  static std::string event_ioctls(const PenAction& state);

  static std::vector<std::uint8_t> report_descriptor();
  static std::vector<std::uint8_t> report(const PenAction& action);

  /// What the kernel tells of a step from one state to the next: changes, then SYN_REPORT.
  static std::vector<KernelEvent> events(const PenAction& before, const PenAction& after);

  /// As a read of the event node gives them.
  static std::vector<std::uint8_t> bytes(const std::vector<KernelEvent>& events);
};

}  // namespace limn::test
