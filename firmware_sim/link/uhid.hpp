#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware_sim/link/file_descriptor.hpp"
#include "firmware_sim/link/in_memory.hpp"
#include "firmware_sim/link/link_error.hpp"
#include "firmware_sim/link/waiter.hpp"
#include "firmware_sim/usb/bus_device.hpp"

struct uhid_event;  // of <linux/uhid.h>

namespace limn::firmware {

struct UhidOptions {
  /// Linux's BUS_*; the device's own unless given, but 5, Bluetooth, for vendors whose drivers in
  /// Linux insist on real USB (hid-uclogic, hid-logitech): as USB devices they would be refused and
  /// left to no driver; so hid-generic takes them. (On bus 6, virtual, hidapi would not list them.)
  std::optional<std::uint16_t> bus;
  /// The simulation's time stands still until a program opens the device, so that it misses
  /// nothing; else it runs from the first moment.
  bool wait_for_reader = true;
};

/// Opens /dev/uhid. Errors say what to load or to run.
LinkResult<FileDescriptor> open_uhid();

/// A simulated device as a HID device of this machine's Linux: hidraw and event nodes that other
/// programs read. It takes the place of Linux's USB side (InMemoryHost), and talks to Linux's HID
/// side by /dev/uhid, one file an interface, in the events of <linux/uhid.h>:
///
///     Linux            here
///                      UHID_CREATE2 when plugged in, UHID_DESTROY when unplugged and at the end
///                      UHID_INPUT2 for each report, at the time at which it is due
///     UHID_OPEN        the simulation's time starts
///     UHID_OUTPUT      interrupt-out, or SET_REPORT where there is no such endpoint
///     UHID_GET_REPORT  GET_REPORT; answered with the bytes of the device, or EIO where it stalls;
///     UHID_SET_REPORT  SET_REPORT; not answered where the device times out, as Linux then does
///
/// Where reports have no ID, Linux may put a zero in its place: such a byte is taken off.
/// Sources: linux/Documentation/hid/uhid.rst, drivers/hid/uhid.c.
class UhidLink {
 public:
  using Opener = std::function<LinkResult<FileDescriptor>()>;

  /// Opens a file for each interface; nothing is created yet. `device` must outlive the link.
  /// Errors: those of `opener`; a report descriptor of more than the 4096 bytes that UHID takes.
  static LinkResult<UhidLink> open(BusDevice& device, UhidOptions options = {},
                                   const Opener& opener = open_uhid);

  /// Creates the device, serves it until `end` of the simulation's time, destroys it. Error: Linux
  /// refused it, or closed the file.
  LinkResult<LinkEnd> run(std::chrono::microseconds end, Waiter& waiter);

  /// Reports given to Linux so far.
  std::uint64_t reports() const noexcept { return reports_; }
  /// Reports that Linux refused, because no driver took the device (its descriptor is bad, say).
  std::uint64_t refused() const noexcept { return refused_; }

 private:
  UhidLink(BusDevice& device, UhidOptions options, std::vector<FileDescriptor> files);

  LinkResult<LinkEnd> serve(std::chrono::microseconds end, Waiter& waiter);
  LinkResult<void> handle(const HostEvent& event);
  LinkResult<void> create(std::uint8_t interface);
  void destroy();
  LinkResult<void> answer(std::uint8_t interface);
  LinkResult<void> answer_get(std::uint8_t interface, const uhid_event& event);
  LinkResult<void> answer_set(std::uint8_t interface, uhid_event& event);

  std::string place_;  // in physical_path(): two devices alike are two, one that returns is itself
  BusDevice* device_;
  UhidOptions options_;
  std::vector<FileDescriptor> files_;  // one an interface
  std::unique_ptr<InMemoryHost> host_;
  SimulationClock clock_;
  bool created_ = false;
  std::uint64_t reports_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace limn::firmware
