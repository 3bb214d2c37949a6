#pragma once

#include <memory>
#include <string>

#include "drivers/transport/transport.hpp"
#include "input/base/error.hpp"

namespace limn {

/// Opens a node of Linux's hidraw (/dev/hidraw3): reports as the device sent them, stamped when
/// read. Others may read the same device; nothing is grabbed.
///
/// hidraw keeps 63 reports for a reader that does not come, drops those that come then, and tells
/// nobody: a drain that finds that many says that some may be lost.
///
/// hidapi is not used for reading: it hides the descriptor that poll needs, so each device would
/// need a thread of its own.
///
/// Errors: kIo: no such node, no permission, not a hidraw node; kLimit: a report descriptor above
/// 4 KiB, which Linux does not take either.
Expected<std::unique_ptr<Transport>> open_hidraw(const std::string& node);

/// The same over a descriptor that keeps messages apart (a SOCK_SEQPACKET socket), whose other end
/// is then the device: for tests and simulations. Takes the descriptor over. `queue`: how many the
/// other end keeps before it drops some; 0: it waits.
std::unique_ptr<Transport> open_messages(int descriptor, TraceDevice device, int queue = 0);

}  // namespace limn
