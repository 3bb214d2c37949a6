#pragma once

#include <cstdint>

#include "drivers/devices/pen_spec.hpp"

namespace limn {

/// What a tablet said of itself while it was initialised (PenInitializer). It speaks for the very
/// device, so it beats the tables, and makes a pen of a product that no table knows.
struct PenParameters {
  PenFamily family = PenFamily::kUcLogicV1;  ///< how its pen reports now: kUcLogicV1, V2 or kUgee
  std::int32_t x_max = 0;                    ///< counts, above 0
  std::int32_t y_max = 0;
  std::int32_t pressure_max = 0;
  double counts_per_mm = 0;    ///< above 0
  bool frame_buttons = false;  ///< its keys report as keys, not as a keyboard
};

}  // namespace limn
