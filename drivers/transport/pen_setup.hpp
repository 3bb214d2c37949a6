#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/devices/pen_initialization.hpp"
#include "drivers/transport/device_control.hpp"

namespace limn {

/// How an initialisation went.
struct PenSetup {
  PenInitializer initializer;      ///< what was learnt: parameters, firmware
  std::vector<std::string> notes;  ///< the same for a recording: "string" notes (noted_string.hpp)
  std::optional<Error> trouble;    ///< the request that could not be made; the later ones were not
};

/// Does to the device what the sequence says. `sequence` must outlive the result. Takes no longer
/// than its requests, and begins none after kLongestSetup.
PenSetup set_up_pen(const PenInitialization& sequence, DeviceControl& control);

inline constexpr std::chrono::seconds kLongestSetup{3};

}  // namespace limn
