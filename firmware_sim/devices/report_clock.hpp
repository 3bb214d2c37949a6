#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

namespace limn::firmware {

/// When a device measures: at the multiples of its report period, from when the host first asks.
/// Measurements wait for a host that is late; the oldest of more than kMostWaiting are lost.
class ReportClock {
 public:
  static constexpr int kMostWaiting = 256;

  constexpr explicit ReportClock(std::chrono::microseconds period) noexcept : period_(period) {}

  /// As if switched on: begins anew when the host next asks.
  constexpr void restart() noexcept { next_.reset(); }

  /// The time of a measurement that is due at `now` and was not made yet, the oldest first.
  constexpr std::optional<std::chrono::microseconds> take(std::chrono::microseconds now) noexcept {
    const std::chrono::microseconds last = now - now % period_;
    const std::chrono::microseconds oldest = last - (kMostWaiting - 1) * period_;
    if (!next_) next_ = last;
    if (*next_ < oldest) next_ = oldest;
    if (*next_ > now) return std::nullopt;
    const std::chrono::microseconds time = *next_;
    *next_ += period_;
    return time;
  }

  /// When the next measurement is due, which may be now.
  constexpr std::chrono::microseconds due(std::chrono::microseconds now) const noexcept {
    return next_ && *next_ > now ? *next_ : now;
  }

 private:
  std::chrono::microseconds period_;
  std::optional<std::chrono::microseconds> next_;
};

}  // namespace limn::firmware
