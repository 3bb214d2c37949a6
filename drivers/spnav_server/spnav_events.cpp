#include "drivers/spnav_server/spnav_events.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace limn {
namespace {

/// Axis of a sample for each of spacenavd's.
constexpr std::array<std::size_t, kMotionAxes> kSource = {0, 2, 1, 3, 5, 4};

/// Ten times what the most worn device says, far below what overflows.
constexpr double kMost = 1e6;

std::int32_t rounded(double count) {
  return std::isnan(count)
             ? 0
             : static_cast<std::int32_t>(std::lround(std::clamp(count, -kMost, kMost)));
}

}  // namespace

void SpnavEvents::describe(const SpnavDevice& device) { devices_[device.index] = device; }

void SpnavEvents::push(const MotionSample& sample, const Six& velocity) {
  const SpnavDevice& device = devices_[sample.device];
  Mouse& mouse = mice_[sample.device];
  for (std::size_t i = 0; i < kMotionAxes; ++i) {
    mouse.velocity[i] = device.full_deflection * velocity[i];
  }
  mouse.buttons = {};
  sample.buttons.for_each([&](unsigned number) {
    const auto button = spnav_button(device.vendor, device.product, number);
    if (button) mouse.buttons.set(*button + 1, true);
  });
  if (sample.translation_told || sample.rotation_told || sample.silence) tell_motion(sample.time);
  tell_buttons();
}

void SpnavEvents::end() {
  mice_.clear();
  if (last_motion_) tell_motion(*last_motion_);
  tell_buttons();
}

void SpnavEvents::tell_motion(Timestamp time) {
  SpnavMotion motion;
  for (std::size_t i = 0; i < kMotionAxes; ++i) {
    double sum = 0;
    for (const auto& [index, mouse] : mice_) sum += mouse.velocity[kSource[i]];
    motion.axes[i] = rounded(sum);
  }
  const bool moves = !motion.is_rest();
  if (!moves && !moves_) return;
  if (last_motion_) {
    const auto since = std::chrono::duration_cast<std::chrono::milliseconds>(time - *last_motion_);
    motion.period_ms = static_cast<std::uint32_t>(
        std::clamp<std::int64_t>(since.count(), 0, std::int64_t{INT32_MAX}));
  }
  last_motion_ = time;
  moves_ = moves;
  sink_.motion(motion);
}

void SpnavEvents::tell_buttons() {
  MotionButtons now;
  for (const auto& [index, mouse] : mice_) {
    mouse.buttons.for_each([&now](unsigned number) { now.set(number, true); });
  }
  if (now == told_) return;
  for (unsigned number = 1; number <= MotionButtons::kMost; ++number) {
    if (now.has(number) != told_.has(number)) sink_.button(number - 1, now.has(number));
  }
  told_ = now;
}

}  // namespace limn
