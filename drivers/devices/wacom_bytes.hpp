#pragma once

#include <cstdint>

#include "drivers/devices/pen_bytes.hpp"

namespace limn::wacom {

using namespace pen_bytes;

/// Counts of pressure up to which a tip that has no switch of its own does not touch: noise.
constexpr std::int32_t kTouchPressure = 10;

/// A turn in steps of 0.2 degrees, -900 to 899 (or any other), to 0 .. 2 pi.
constexpr double twist_of_fifths(std::int32_t fifths) noexcept {
  constexpr std::int32_t kTurn = 1800;
  const std::int32_t within = ((fifths % kTurn) + kTurn) % kTurn;
  return within * 0.2 * kRadiansPerDegree;
}

}  // namespace limn::wacom
