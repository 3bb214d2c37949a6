#include "input/stroke/drag_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "input/base/expect.hpp"

namespace limn {
namespace {

constexpr double kMostDeadZone = 0.9;

Expected<void> outside(std::string_view member, const std::string& range) {
  return fail(ErrorCode::kOutOfRange, std::string(member), "is outside " + range, "give one in it");
}

bool is_zero(const std::array<double, 3>& vector) noexcept {
  return vector[0] == 0 && vector[1] == 0 && vector[2] == 0;
}

}  // namespace

Expected<void> check(const DragOptions& options) {
  constexpr double kMostSpeed = 1e6;
  const auto is_speed = [](double value) { return std::abs(value) <= kMostSpeed; };
  if (!is_speed(options.mm_per_s)) return outside("mm_per_s", "-1e6 to 1e6");
  if (!is_speed(options.rad_per_s)) return outside("rad_per_s", "-1e6 to 1e6");
  if (!(options.dead_zone >= 0 && options.dead_zone <= kMostDeadZone)) {
    return outside("dead_zone", "0 to 0.9");
  }
  if (!(options.curve >= 0 && options.curve <= 1)) return outside("curve", "0 to 1");
  if (!std::all_of(options.sensitivity.begin(), options.sensitivity.end(), is_speed)) {
    return outside("sensitivity", "-1e6 to 1e6");
  }
  if (std::any_of(options.source.begin(), options.source.end(),
                  [](std::size_t axis) { return axis >= kMotionAxes; })) {
    return outside("source", "0 to 5");
  }
  return {};
}

DragVelocity::DragVelocity(const DragOptions& options) : options_(options) {
  LIMN_EXPECT(check(options));
}

Drag DragVelocity::push(const MotionSample& sample) noexcept {
  const Timestamp time = last_ ? std::max(sample.time, *last_) : sample.time;
  last_ = time;
  rest_.push(sample);
  const bool stopped = sample.silence || rest_.is_stuck();
  const Six velocity = stopped ? Six{} : shaped(sample.deflection);
  Drag drag;
  drag.time = sample.time;
  drag.at_rest = rest_.at_rest() || stopped;
  for (std::size_t i = 0; i < 3; ++i) {
    drag.mm_per_s[i] = velocity[i] * options_.mm_per_s;
    drag.rad_per_s[i] = velocity[3 + i] * options_.rad_per_s;
  }
  // A dominant axis of one half stops the other, told or not.
  const auto changes = [this, stopped](const Half& half, const std::array<double, 3>& to) {
    return stopped || (options_.dominant_axis && half.velocity != to);
  };
  const bool moves = sample.translation_told || changes(halves_[0], drag.mm_per_s);
  const bool turns = sample.rotation_told || changes(halves_[1], drag.rad_per_s);
  if (stopped) dominant_.reset();
  advance(halves_[0], drag.mm_per_s, time, moves, drag.mm);
  advance(halves_[1], drag.rad_per_s, time, turns, drag.rad);
  return drag;
}

/// Velocities of the result's axes, 1 at full deflection.
DragVelocity::Six DragVelocity::shaped(const Six& deflection) noexcept {
  Six axes;
  for (std::size_t i = 0; i < kMotionAxes; ++i) {
    const double edge = std::max(options_.dead_zone, rest_.noise(i));
    const double held = deflection[i] - rest_.bias(i);
    const double beyond = std::max(0.0, std::abs(held) - edge) / (1 - edge);
    const double curved = beyond * (1 - options_.curve + options_.curve * beyond * beyond);
    axes[i] = held < 0 ? -curved : curved;
  }
  if (options_.dominant_axis) keep_dominant(axes);
  Six result;
  for (std::size_t i = 0; i < kMotionAxes; ++i) {
    const double value = options_.sensitivity[i] * axes[options_.source[i]];
    result[i] = options_.inverted[i] ? 0 - value : value;  // never -0
  }
  return result;
}

void DragVelocity::keep_dominant(Six& axes) noexcept {
  // An axis that drives nothing stands in nobody's way.
  std::array<bool, kMotionAxes> drives{};
  for (std::size_t i = 0; i < kMotionAxes; ++i) {
    if (options_.sensitivity[i] != 0) drives[options_.source[i]] = true;
  }
  const auto size = [&axes, &drives](std::size_t axis) {
    return drives[axis] ? std::abs(axes[axis]) : 0.0;
  };
  std::size_t most = 0;
  for (std::size_t i = 1; i < kMotionAxes; ++i) {
    if (size(i) > size(most)) most = i;
  }
  if (size(most) == 0) {
    dominant_.reset();
  } else if (!dominant_ || size(most) > kHysteresis * size(*dominant_)) {
    dominant_ = most;
  }
  for (std::size_t i = 0; i < kMotionAxes; ++i) {
    if (i != dominant_) axes[i] = 0;
  }
}

void DragVelocity::advance(Half& half, const std::array<double, 3>& velocity, Timestamp time,
                           bool is_told, std::array<double, 3>& moved) noexcept {
  if (!is_told) return;
  const Timestamp step = half.told ? time - *half.told : Timestamp::zero();
  const bool straight = !is_zero(velocity) && !is_zero(half.velocity) && step <= kLongestStep;
  for (std::size_t i = 0; i < 3; ++i) {
    const double mean = straight ? (half.velocity[i] + velocity[i]) / 2 : half.velocity[i];
    moved[i] = mean * to_seconds(step);
  }
  half.velocity = velocity;
  half.told = time;
}

}  // namespace limn
