#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/transport/device_listing.hpp"
#include "drivers/transport/transport.hpp"
#include "input/base/error.hpp"

namespace limn {

/// What one backend has: list_hid_devices(), list_usb_devices(), list_evdev_devices(), or
/// spacenavd. Errors as theirs.
Expected<std::vector<ListedDevice>> list_devices_of(Backend backend);

/// The backend of a node, by what its path leads to: an event node is evdev's, a socket
/// spacenavd's, a node of a USB device libusb's, all else hidraw's.
Backend backend_of_node(const std::string& node);

/// Whether both name one node, perhaps by a link.
bool is_same_node(const std::string& one, const std::string& other);

struct OpenedDevice {
  std::unique_ptr<Transport> transport;
  /// Why a device that needs an initialisation has not got (all of) it. It is read as it is.
  std::optional<Error> trouble;
};

/// Opens a listed device by its backend. With `initialize`, one that a driver must set up before it
/// reports as the tables say (drivers/devices/pen_initialization.hpp) is set up first, in bounded
/// time (pen_setup.hpp), and what it answers becomes notes of the stream. On hidraw that is left to
/// Linux's driver where it has one for the device; what evdev and spacenavd give is set up already.
/// Errors: those of open_hidraw(), UsbInterface::claim(), open_evdev(), open_spnav(); kIo also
/// where the device has gone since it was listed.
Expected<OpenedDevice> open_device(const ListedDevice& listed, bool initialize = true);

/// Rows to open, and what to tell the user about the choice, a line each.
struct DeviceChoice {
  std::vector<ListedDevice> rows;
  std::vector<std::string> notes;
};

/// One row a device, of those that somebody wants: hidraw where it may be read. Where it may not:
/// spacenavd where it runs (`spacenavd`, given for 3D mice only: it grabs their event nodes, which
/// then stay silent for others); else the event nodes of the same device that may be read; else
/// hidraw all the same, whose error says why. Event nodes whose hidraw row nobody wants are taken;
/// devices on USB alone are not. Error: kMissing where that leaves nothing: what look_at() finds of
/// the first one.
Expected<DeviceChoice> choose_rows(const std::vector<ListedDevice>& wanted,
                                   const ListedDevice* spacenavd = nullptr);

}  // namespace limn
