#pragma once

#include <memory>
#include <string>

#include "drivers/transport/transport.hpp"
#include "input/base/error.hpp"

namespace limn {

/// Connects to spacenavd, whose 3D mouse limn can then use without a permission of its own and
/// without reading beside it. What spacenavd sends comes as frames, as an event node would give
/// them, stamped when read:
///
///   - A motion is ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ (0 to 5), all six in every frame:
///     x, y, z, rx, ry, rz in spacenavd's frame (of the device's own x, y, z: x, -z, -y), after its
///     dead zone, sensitivity and axis map. Displacements, not rates; all zero at rest.
///   - Button n is EV_KEY, BTN_0 (0x100) + n, 1 pressed, 0 released; n beyond KEY_MAX is passed
///     over.
///
/// The axes' ranges are not known: spacenavd scales. Ids are those of its first device, where it is
/// recent enough to tell (protocol 1). libspnav keeps one connection a process: one of these at a
/// time.
///
/// `socket`: where spacenavd listens, "" for $SPNAV_SOCKET, /etc/spnavrc's and then the usual place
/// (/var/run/spnav.sock). Not thread-safe.
///
/// Errors: kIo: spacenavd does not run or refuses, or a connection is open already; kMissing in a
/// build without libspnav.
Expected<std::unique_ptr<Transport>> open_spnav(const std::string& socket = {});

}  // namespace limn
