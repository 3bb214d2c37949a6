#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "input/sample/motion_sample.hpp"

namespace limn::test {

inline constexpr double kFullCounts = 350;
using Counts = std::array<int, kMotionAxes>;

/// What a device of 350 counts says of all six axes at once.
inline MotionSample motion_of(Timestamp time, const Counts& counts, bool rests_exactly = true) {
  MotionSample sample;
  sample.time = time;
  sample.translation_told = sample.rotation_told = true;
  sample.rests_exactly = rests_exactly;
  for (std::size_t i = 0; i < kMotionAxes; ++i) {
    sample.raw[i] = counts[i];
    sample.deflection[i] = counts[i] / kFullCounts;
  }
  return sample;
}

/// The same, of an axis alone.
inline MotionSample pushed(Timestamp time, int counts, bool rests_exactly = true) {
  return motion_of(time, {counts, 0, 0, 0, 0, 0}, rests_exactly);
}

}  // namespace limn::test
