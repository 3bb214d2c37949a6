#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <span>

#include "input/sample/pen_sample.hpp"
#include "input/sample/pen_state_machine.hpp"

namespace limn::fuzz {

/// Stops the fuzzer at a broken law.
inline void demand(bool holds, const char* law) {
  if (holds) return;
  std::fprintf(stderr, "broken law: %s\n", law);
  std::abort();
}

/// What holds for the samples of any device, whatever bytes it sends.
class PenLaws {
 public:
  void check(std::span<const PenSample> samples) {
    for (const PenSample& sample : samples) {
      demand(is_legal_transition(last_, sample.state), "only legal transitions");
      last_ = sample.state;
      check_values(sample);
    }
  }

 private:
  PenState last_ = PenState::kOutOfRange;

  static void check_values(const PenSample& s) {
    constexpr double kHalfPi = 1.5707963267948968;  // one bit above
    const bool erasing = s.state == PenState::kErasing || s.state == PenState::kInRangeErasing;
    demand(!erasing || s.tool == Tool::kEraser, "erasing is the eraser's");
    demand(!in_contact(s.state) || s.tool != Tool::kTabletMouse, "mice never touch");
    demand(std::isfinite(s.x_mm) && std::isfinite(s.y_mm), "finite positions");
    demand(s.pressure >= 0 && s.pressure <= 1, "pressure 0 to 1");
    demand(s.distance >= 0 && s.distance <= 1, "distance 0 to 1");
    demand(std::abs(s.tilt_x_rad) <= kHalfPi, "tilt x within a quarter turn");
    demand(std::abs(s.tilt_y_rad) <= kHalfPi, "tilt y within a quarter turn");
    demand(s.twist_rad >= 0 && s.twist_rad <= 4 * kHalfPi, "twist within a turn");
    demand(s.axes.has(PenAxis::kX) || s.x_mm == 0, "an absent axis is zero");
    demand(s.axes.has(PenAxis::kPressure) || s.pressure == 0, "an absent pressure is zero");
    demand(s.axes.has(PenAxis::kSerial) || s.serial == 0, "an absent serial is zero");
  }
};

}  // namespace limn::fuzz
