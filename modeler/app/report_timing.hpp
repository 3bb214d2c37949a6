#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "input/base/time.hpp"

namespace limn::app {

/// Durations as people want to see them: how many, mean, spread, longest, and a histogram whose
/// bins double: bin 0 holds what is below kFirstBin, bin k up to kFirstBin 2^k, the last the rest.
class DurationStatistics {
 public:
  static constexpr Timestamp kFirstBin{62'500};  // 1/16 ms
  static constexpr std::size_t kBins = 12;       // the last begins at 64 ms

  void add(Timestamp duration) noexcept;

  std::uint64_t count() const noexcept { return count_; }
  double mean_ms() const noexcept { return count_ > 0 ? mean_ms_ : 0; }
  /// Standard deviation; 0 below two durations. By Welford's update, which does not cancel.
  double deviation_ms() const noexcept;
  Timestamp longest() const noexcept { return longest_; }
  const std::array<std::uint64_t, kBins>& bins() const noexcept { return bins_; }

 private:
  std::uint64_t count_ = 0;
  double mean_ms_ = 0;
  double squares_ms2_ = 0;  // sum of squared distances from the mean
  Timestamp longest_{};
  std::array<std::uint64_t, kBins> bins_{};
};

/// When a device's reports came.
class ReportTiming {
 public:
  /// An interval longer than this is a pause between strokes, not the device's pace.
  static constexpr Timestamp kPause{100'000'000};

  void report(Timestamp time) noexcept;

  std::uint64_t reports() const noexcept { return reports_; }
  const DurationStatistics& intervals() const noexcept { return intervals_; }
  /// Reports a second while it reports; 0 before the third.
  double rate() const noexcept;

 private:
  std::uint64_t reports_ = 0;
  Timestamp last_{};
  DurationStatistics intervals_;
};

}  // namespace limn::app
