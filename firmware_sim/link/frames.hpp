#pragma once

#include <algorithm>
#include <chrono>

namespace limn::firmware {

inline constexpr std::chrono::microseconds kFrame{1000};  // of full speed

/// Links look again after this, whatever a device says: it may be pulled by another thread.
inline constexpr std::chrono::microseconds kLongestSilence{100'000};

/// The first of the times `next` + k * kFrame, k >= 0, that is not before `silent_until`.
/// Precondition: `next` is later than `now`.
constexpr std::chrono::microseconds after_silence(std::chrono::microseconds next,
                                                  std::chrono::microseconds now,
                                                  std::chrono::microseconds silent_until) noexcept {
  const auto until = std::min(silent_until, now + kLongestSilence);
  if (until <= next) return next;
  return next + (until - next + kFrame - std::chrono::microseconds(1)) / kFrame * kFrame;
}

}  // namespace limn::firmware
