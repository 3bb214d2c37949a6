#include "firmware_sim/devices/knob_hand.hpp"

#include <algorithm>
#include <cmath>

#include "firmware_sim/devices/sensor_noise.hpp"

namespace limn::firmware {
namespace {

MinimumJerk path_of(const MotionPiece& piece, std::size_t axis) {
  const auto at = [axis](const Deflection& point) {
    return PlanePoint{point[axis], point[axis + 1]};
  };
  if (piece.points.size() == 1) return MinimumJerk::rest(at(piece.points[0]), piece.seconds);
  std::vector<PlanePoint> points;
  for (const Deflection& point : piece.points) points.push_back(at(point));
  const std::vector<double> durations(points.size() - 1, piece.seconds);
  return {points, durations};
}

}  // namespace

KnobHand::KnobHand(const Motion& motion, std::uint64_t seed) : seed_(seed) {
  double end = 0;
  for (const MotionPiece& piece : motion.pieces) {
    legs_.push_back(
        {{path_of(piece, 0), path_of(piece, 2), path_of(piece, 4)}, end, piece.buttons});
    end += legs_.back().paths[0].duration();
  }
  duration_ = std::chrono::microseconds(static_cast<std::int64_t>(end * 1e6) + 1);
}

KnobPose KnobHand::pose(std::chrono::microseconds time) const noexcept {
  KnobPose pose;
  pose.time = time;
  const double t = static_cast<double>(time.count()) * 1e-6;
  const auto after =
      std::find_if(legs_.begin(), legs_.end(), [t](const Leg& leg) { return leg.begin > t; });
  if (after == legs_.begin() || time >= duration_) return pose;
  const Leg& leg = *(after - 1);
  for (std::size_t pair = 0; pair < leg.paths.size(); ++pair) {
    const PlanePoint at = leg.paths[pair].position(t - leg.begin);
    pose.deflection[2 * pair] = at.x;
    pose.deflection[2 * pair + 1] = at.y;
  }
  pose.buttons = leg.buttons;
  return pose;
}

KnobPose KnobHand::measure(std::chrono::microseconds time) noexcept {
  // So little is nothing: a knob that comes back to rest stands still.
  constexpr double kStill = 0.004;
  KnobPose held = pose(time);
  SensorNoise noise(noise_seed(seed_, static_cast<std::uint64_t>(time.count())));
  for (double& axis : held.deflection) {
    const double tremor = kTremor * noise.next();
    axis = std::abs(axis) < kStill ? 0 : axis + tremor;
  }
  return held;
}

}  // namespace limn::firmware
