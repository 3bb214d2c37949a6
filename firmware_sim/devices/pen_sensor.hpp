#pragma once

#include <chrono>

#include "firmware_sim/devices/pen_pose.hpp"

namespace limn::firmware {

/// What a tablet's coils measure: the pen's pose, with the sensor's noise. Asked with times that
/// grow, once a report period.
class PenSensor {
 public:
  virtual PenPose measure(std::chrono::microseconds time) noexcept = 0;

 protected:
  PenSensor() = default;
  PenSensor(const PenSensor&) = default;
  PenSensor& operator=(const PenSensor&) = default;
  ~PenSensor() = default;  // owned by its own type: no heap, so nothing is deleted through this
};

}  // namespace limn::firmware
