#pragma once

#include <memory>

#include "drivers/transport/live_reader.hpp"
#include "modeler/app/command.hpp"

namespace limn::app {

/// Opens the devices that DEVICE names (see limn(1)), all of a kind where it is empty, and watches
/// for them where they may come later. Says on standard error where it uses another backend than
/// hidraw unasked, where another program uses the device, too, and where a device that should be
/// set up cannot be. Failure: there is none and none may be waited for, or none that may be read.
tl::expected<std::unique_ptr<LiveReader>, Failure> open_live_input(const LiveArguments& live);

}  // namespace limn::app
