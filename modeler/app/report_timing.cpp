#include "modeler/app/report_timing.hpp"

#include <algorithm>
#include <cmath>

namespace limn::app {

void DurationStatistics::add(Timestamp duration) noexcept {
  constexpr double kMs = 1e-6;
  const double ms = static_cast<double>(duration.count()) * kMs;
  ++count_;
  const double before = ms - mean_ms_;
  mean_ms_ += before / static_cast<double>(count_);
  squares_ms2_ += before * (ms - mean_ms_);
  longest_ = std::max(longest_, duration);
  std::size_t bin = 0;
  for (Timestamp end = kFirstBin; bin + 1 < kBins && duration >= end; end *= 2) ++bin;
  ++bins_[bin];
}

double DurationStatistics::deviation_ms() const noexcept {
  return count_ > 1 ? std::sqrt(squares_ms2_ / static_cast<double>(count_ - 1)) : 0.0;
}

void ReportTiming::report(Timestamp time) noexcept {
  if (reports_ > 0 && time - last_ <= kPause) intervals_.add(time - last_);
  last_ = time;
  ++reports_;
}

double ReportTiming::rate() const noexcept {
  constexpr double kMsPerSecond = 1000;
  return intervals_.count() > 1 && intervals_.mean_ms() > 0 ? kMsPerSecond / intervals_.mean_ms()
                                                            : 0.0;
}

}  // namespace limn::app
