#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "drivers/devices/pen_initialization.hpp"
#include "drivers/transport/device_control.hpp"
#include "drivers/transport/paced_reader.hpp"

namespace limn {

/// How an initialisation went.
struct PenSetup {
  PenInitializer initializer;      ///< what was learnt: parameters, firmware
  std::vector<std::string> notes;  ///< the same for a recording: "string" notes (noted_string.hpp)
  std::optional<Error> trouble;    ///< the request that could not be made; the later ones were not
};

/// No request of an initialisation begins later than so long after the first.
inline constexpr std::chrono::seconds kLongestSetup{3};

/// Does to the device what the sequence says. `sequence` must outlive the result.
PenSetup set_up_pen(const PenInitialization& sequence, DeviceControl& control,
                    WaitingClock& clock = monotonic_clock());

}  // namespace limn
