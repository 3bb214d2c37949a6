#include "firmware_sim/devices/hand_sensor.hpp"

#include <algorithm>

#include "firmware_sim/devices/hid_pen.hpp"
#include "firmware_sim/devices/sensor_noise.hpp"

namespace limn::firmware {

// Drawings are made for a sheet of the size of HidPen.
HandSensor::HandSensor(const Drawing& drawing, PlanePoint size_mm, std::uint64_t seed,
                       double jitter_mm)
    : hand_(drawing),
      size_mm_(size_mm),
      scale_(std::min({1.0, size_mm.x / HidPen::kWidthMm, size_mm.y / HidPen::kHeightMm})),
      seed_(seed),
      jitter_mm_(jitter_mm) {}

PenPose HandSensor::pose(std::chrono::microseconds time) const noexcept {
  PenPose pose = hand_.pose(time);
  pose.x_mm *= scale_;
  pose.y_mm *= scale_;
  return pose;
}

PenPose HandSensor::measure(std::chrono::microseconds time) noexcept {
  PenPose measured = pose(time);
  const double to_edge_mm = std::min(
      {measured.x_mm, size_mm_.x - measured.x_mm, measured.y_mm, size_mm_.y - measured.y_mm});
  const double closeness = 1 - std::clamp(to_edge_mm / kEdgeMm, 0.0, 1.0);
  const double deviation_mm = jitter_mm_ * (1 + kEdgeGrowth * closeness * closeness);
  SensorNoise noise(noise_seed(seed_, static_cast<std::uint64_t>(time.count())));
  measured.x_mm += deviation_mm * noise.next();
  measured.y_mm += deviation_mm * noise.next();
  return measured;
}

}  // namespace limn::firmware
