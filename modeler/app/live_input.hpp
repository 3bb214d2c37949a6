#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/transport/device_listing.hpp"
#include "drivers/transport/live_reader.hpp"
#include "modeler/app/command.hpp"

namespace limn::app {

/// What a listed device is to limn: the family of its table row or of what its initialisation makes
/// of it, "HID pen", or "" where it is no pen.
std::string pen_kind(const ListedDevice& listed);

/// Opens the devices that DEVICE names (see limn(1)), all pens where it is empty, and watches for
/// them where they may come later. A device that should be set up and cannot be gives a line on
/// standard error. Failure: there is none, or none that may be read.
tl::expected<std::unique_ptr<LiveReader>, Failure> open_live_input(const LiveArguments& live);

/// Lets SIGINT and SIGTERM stop the reader while this lives; a second one ends the program. For one
/// reader at a time.
class StopOnSignal {
 public:
  explicit StopOnSignal(LiveReader& reader);
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;
};

}  // namespace limn::app
