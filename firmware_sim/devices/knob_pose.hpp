#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace limn::firmware {

/// Axes of a 3D mouse's knob: moved to the right, towards the user, down; turned about these three,
/// right-handed. These are the axes X, Y, Z, Rx, Ry, Rz of its reports.
inline constexpr std::size_t kKnobAxes = 6;

/// How a 3D mouse's knob is held at one instant, before any sensor.
struct KnobPose {
  std::chrono::microseconds time{};            ///< since the session began
  std::array<double, kKnobAxes> deflection{};  ///< -1 to 1, of what the spring allows; 0 at rest
  std::uint16_t buttons = 0;                   ///< bit i is button i + 1
};

/// What a 3D mouse's optics measure. Asked with times that grow, once a report period.
class KnobSensor {
 public:
  virtual KnobPose measure(std::chrono::microseconds time) noexcept = 0;

 protected:
  KnobSensor() = default;
  KnobSensor(const KnobSensor&) = default;
  KnobSensor& operator=(const KnobSensor&) = default;
  ~KnobSensor() = default;  // as PenSensor's
};

}  // namespace limn::firmware
