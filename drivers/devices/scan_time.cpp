#include "drivers/devices/scan_time.hpp"

#include <algorithm>
#include <utility>

namespace limn {
namespace {

constexpr double kNanosecond = 1e-9;

/// Whether a step of the device's clock fits that of the reports' times, but for whole turns.
bool agree(std::int64_t ticks, std::int64_t elapsed_ns, const ScanTime::Reading& clock) noexcept {
  const double turn_s = static_cast<double>(clock.modulus) * clock.tick_s;
  if (turn_s < 4 * ScanTime::kJumpSeconds) return true;  // it turns too fast to tell
  const double apart_s =
      static_cast<double>(elapsed_ns) * kNanosecond - static_cast<double>(ticks) * clock.tick_s;
  constexpr double kMostTurns = 1e9;  // beyond, drift is longer than a turn
  const double turns = apart_s / turn_s;
  if (!(turns > -kMostTurns && turns < kMostTurns)) return true;
  const double nearest =
      static_cast<double>(static_cast<std::int64_t>(turns < 0 ? turns - 0.5 : turns + 0.5));
  const double rest_s = apart_s - nearest * turn_s;
  return rest_s < ScanTime::kJumpSeconds && rest_s > -ScanTime::kJumpSeconds;
}

}  // namespace

ScanTime::Step ScanTime::push(const Reading& reading) noexcept {
  const auto before = std::exchange(last_, reading);
  if (!before || before->modulus != reading.modulus || reading.modulus <= 1) return {};
  const std::int64_t ticks = (reading.ticks - before->ticks + reading.modulus) % reading.modulus;
  UsualStep& usual = usual_[reading.touching ? 1 : 0];
  // A field that always has the same value is no clock.
  if (usual.known() && !agree(ticks, (reading.time - before->time).count(), reading)) {
    return {0, true};
  }
  if (before->touching == reading.touching) return {usual.push(ticks), false};
  const UsualStep& other = usual_[reading.touching ? 0 : 1];
  if (!usual.known() || !other.known()) return {};
  return {std::min(usual.missing_in(ticks), other.missing_in(ticks)), false};
}

}  // namespace limn
