#include "input/stroke/rest_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr std::size_t kLeastSamples = 32;  // to learn from
constexpr double kExcursions = 3;
constexpr double kLeastNoise = 1.5 / 350;  // a count and a half
constexpr double kMostNoise = 0.1;
constexpr double kFollowSeconds = 10;

template <class Test>
bool all_told(const MotionSample& sample, const Test& test) {
  for (std::size_t axis = 0; axis < kMotionAxes; ++axis) {
    const bool told = axis < kMotionAxes / 2 ? sample.translation_told : sample.rotation_told;
    if (told && !test(axis)) return false;
  }
  return true;
}

}  // namespace

double RestTracker::noise(std::size_t axis) const noexcept {
  switch (kind_) {
    case Kind::kExact:
      return 0;
    case Kind::kUnknown:
      return kSmall;
    case Kind::kNoisy:
      break;
  }
  return noise_[axis];
}

bool RestTracker::is_quiet(const MotionSample& sample) const noexcept {
  for (std::size_t axis = 0; axis < kMotionAxes; ++axis) {
    if (std::abs(sample.deflection[axis] - bias_[axis]) > noise(axis)) return false;
  }
  return true;
}

void RestTracker::push(const MotionSample& sample) noexcept {
  if (!started_ && sample.rests_exactly) kind_ = Kind::kExact;
  started_ = true;
  watch(sample);
  if (sample.silence) {
    at_rest_ = true;
    window_.reset();
    zero_reports_ = quiet_reports_ = 0;
    return;
  }
  if (!sample.translation_told && !sample.rotation_told) return;
  const Timestamp step = last_ ? std::max(sample.time - *last_, Timestamp::zero()) : Timestamp{};
  last_ = sample.time;
  if (step >= kPause) {
    // Of devices that tell the halves in turn, the one that rested already may be first.
    if (zero_reports_ == kZeroReports || zero_reports_ == kZeroReports + 1) {
      shown_exact_ = true;
      kind_ = Kind::kExact;
      bias_ = {};
    }
    window_.reset();
  }
  if (sample.is_zero() && kind_ == Kind::kNoisy && !is_quiet(sample)) forget(sample);
  const auto zero = [&sample](std::size_t axis) { return sample.deflection[axis] == 0; };
  zero_reports_ = all_told(sample, zero) ? zero_reports_ + 1 : 0;
  if (!shown_exact_) {
    look(sample);
    judge(sample.time);
  }
  const auto quiet = [this, &sample](std::size_t axis) {
    return std::abs(sample.deflection[axis] - bias_[axis]) <= noise(axis);
  };
  quiet_reports_ = all_told(sample, quiet) ? quiet_reports_ + 1 : 0;
  const bool is_quiet_now = is_quiet(sample);
  at_rest_ = is_quiet_now && quiet_reports_ >= (sample.changes_only ? 1 : kZeroReports);
  if (kind_ != Kind::kNoisy || !is_quiet_now) return;
  const double weight = std::min(to_seconds(step), to_seconds(kPause)) / kFollowSeconds;
  for (std::size_t axis = 0; axis < kMotionAxes; ++axis) {
    bias_[axis] += (sample.deflection[axis] - bias_[axis]) * weight;
  }
}

/// What was learned was a deflection, not rest.
void RestTracker::forget(const MotionSample& sample) noexcept {
  kind_ = sample.rests_exactly ? Kind::kExact : Kind::kUnknown;
  bias_ = {};
  window_.reset();
}

void RestTracker::watch(const MotionSample& sample) noexcept {
  if (sample.silence || sample.raw != same_) {
    same_ = sample.raw;
    same_since_ = sample.time;
  }
  const bool near_full = std::any_of(sample.deflection.begin(), sample.deflection.end(),
                                     [](double value) { return std::abs(value) >= kNearFull; });
  stuck_ = near_full && sample.time - same_since_ >= kStuckAfter;
}

void RestTracker::look(const MotionSample& sample) noexcept {
  const bool small = std::all_of(sample.deflection.begin(), sample.deflection.end(),
                                 [](double value) { return std::abs(value) <= kSmall; });
  if (!small) {
    window_.reset();
    return;
  }
  if (!window_) window_ = Window{sample.time, 0, {}, sample.deflection, sample.deflection};
  ++window_->samples;
  for (std::size_t axis = 0; axis < kMotionAxes; ++axis) {
    const double value = sample.deflection[axis];
    window_->sum[axis] += value;
    window_->low[axis] = std::min(window_->low[axis], value);
    window_->high[axis] = std::max(window_->high[axis], value);
  }
}

void RestTracker::judge(Timestamp time) noexcept {
  if (!window_ || window_->samples < kLeastSamples) return;
  const Timestamp length = time - window_->begin;
  switch (kind_) {
    case Kind::kExact:
      if (length < kWornAfter) break;
      if (is_within(kWornSpread)) {
        learn();
      } else {
        window_.reset();
      }
      break;
    case Kind::kUnknown:
      if (length >= kFirstLook) learn();
      break;
    case Kind::kNoisy:
      if (length < kNextLook) break;
      if (is_within(2 * *std::max_element(noise_.begin(), noise_.end()))) {
        learn();
      } else {
        window_.reset();
      }
      break;
  }
}

/// Whether no axis wandered farther in the window.
bool RestTracker::is_within(double spread) const noexcept {
  for (std::size_t axis = 0; axis < kMotionAxes; ++axis) {
    if (window_->high[axis] - window_->low[axis] > spread) return false;
  }
  return true;
}

void RestTracker::learn() noexcept {
  kind_ = Kind::kNoisy;
  for (std::size_t axis = 0; axis < kMotionAxes; ++axis) {
    const double mean = window_->sum[axis] / static_cast<double>(window_->samples);
    const double most = std::max(window_->high[axis] - mean, mean - window_->low[axis]);
    bias_[axis] = mean;
    noise_[axis] = std::min(kMostNoise, kExcursions * most + kLeastNoise);
  }
  window_.reset();
}

}  // namespace limn
