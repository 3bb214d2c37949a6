#pragma once

#include <cmath>
#include <span>

#include "input/sample/pen_sample.hpp"
#include "input/sample/pen_state_machine.hpp"
#include "tests/fuzz/require.hpp"

namespace limn::fuzz {

/// What holds for the samples of any device, whatever bytes it sends.
class PenLaws {
 public:
  void check(std::span<const PenSample> samples) {
    for (const PenSample& sample : samples) {
      require(is_legal_transition(last_, sample.state), "only legal transitions");
      last_ = sample.state;
      check_values(sample);
    }
  }

 private:
  PenState last_ = PenState::kOutOfRange;

  static void check_values(const PenSample& s) {
    constexpr double kHalfPi = 1.5707963267948968;  // one bit above
    const bool erasing = s.state == PenState::kErasing || s.state == PenState::kInRangeErasing;
    require(!erasing || s.tool == Tool::kEraser, "erasing is the eraser's");
    require(!in_contact(s.state) || s.tool != Tool::kTabletMouse, "mice never touch");
    require(std::isfinite(s.x_mm) && std::isfinite(s.y_mm), "finite positions");
    require(s.pressure >= 0 && s.pressure <= 1, "pressure 0 to 1");
    require(s.distance >= 0 && s.distance <= 1, "distance 0 to 1");
    require(std::abs(s.tilt_x_rad) <= kHalfPi, "tilt x within a quarter turn");
    require(std::abs(s.tilt_y_rad) <= kHalfPi, "tilt y within a quarter turn");
    require(s.twist_rad >= 0 && s.twist_rad <= 4 * kHalfPi, "twist within a turn");
    require(s.axes.has(PenAxis::kX) || s.x_mm == 0, "an absent x is zero");
    require(s.axes.has(PenAxis::kY) || s.y_mm == 0, "an absent y is zero");
    require(s.axes.has(PenAxis::kPressure) || s.pressure == 0, "an absent pressure is zero");
    require(s.axes.has(PenAxis::kTiltX) || s.tilt_x_rad == 0, "an absent tilt x is zero");
    require(s.axes.has(PenAxis::kTiltY) || s.tilt_y_rad == 0, "an absent tilt y is zero");
    require(s.axes.has(PenAxis::kTwist) || s.twist_rad == 0, "an absent twist is zero");
    require(s.axes.has(PenAxis::kDistance) || s.distance == 0, "an absent distance is zero");
    require(s.axes.has(PenAxis::kSerial) || s.serial == 0, "an absent serial is zero");
  }
};

}  // namespace limn::fuzz
