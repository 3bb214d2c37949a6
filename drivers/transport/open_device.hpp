#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "drivers/transport/device_listing.hpp"
#include "drivers/transport/transport.hpp"
#include "input/base/error.hpp"

namespace limn {

/// What `backend` has: list_hid_devices() or list_usb_devices(). Errors as theirs.
Expected<std::vector<ListedDevice>> list_devices_of(Backend backend);

struct OpenedDevice {
  std::unique_ptr<Transport> transport;
  /// Why a device that needs an initialisation has not got (all of) it. It is read as it is.
  std::optional<Error> trouble;
};

/// Opens a listed device by its backend. With `initialize`, one that a driver must set up before it
/// reports as the tables say (drivers/devices/pen_initialization.hpp) is set up first, in bounded
/// time (pen_setup.hpp), and what it answers becomes notes of the stream. On hidraw that is left to
/// Linux's driver where it has one for the device. Errors: open_hidraw()'s,
/// UsbInterface::claim()'s.
Expected<OpenedDevice> open_device(const ListedDevice& listed, bool initialize = true);

}  // namespace limn
