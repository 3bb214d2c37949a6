#pragma once

#include <chrono>

#include "firmware_sim/usb/bus_device.hpp"
#include "modeler/app/command.hpp"

namespace limn::app {

/// Gives a device to other programs, by UHID or USB/IP as the arguments say, until `end` of the
/// simulation's time and a second more, or Ctrl-C. The time begins when a program opens the device.
/// Says on standard error what to do next, and what became of it. Precondition: arguments.wanted().
Outcome run_device_link(firmware::BusDevice& device, std::chrono::microseconds end,
                        const LinkArguments& arguments);

}  // namespace limn::app
