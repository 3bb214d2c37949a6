#include "drivers/transport/paced_reader.hpp"

#include <sys/prctl.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <utility>
#include <variant>

namespace limn {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

class MonotonicClock final : public WaitingClock {
 public:
  Timestamp now() noexcept override {
    timespec t{};
    ::clock_gettime(CLOCK_MONOTONIC, &t);
    return Timestamp(t.tv_sec * kSecond + t.tv_nsec);
  }

  void wait_until(Timestamp time) noexcept override {
    if (time <= now()) return;
    ::prctl(PR_SET_TIMERSLACK, 1UL);
    const timespec until{static_cast<time_t>(time.count() / kSecond),  // 32 bits on some
                         static_cast<long>(time.count() % kSecond)};
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
    ::prctl(PR_SET_TIMERSLACK, 0UL);  // back to the thread's default
  }
};

/// When an event happened; nothing for what only describes or comments.
struct TimeOf {
  std::optional<Timestamp> operator()(const Report& report) const { return report.time; }
  std::optional<Timestamp> operator()(const EvdevFrame& frame) const { return frame.time; }
  std::optional<Timestamp> operator()(const PenSample& sample) const { return sample.time; }
  template <class Other>
  std::optional<Timestamp> operator()(const Other&) const {
    return std::nullopt;
  }
};

}  // namespace

WaitingClock& monotonic_clock() noexcept {
  static MonotonicClock clock;
  return clock;
}

PacedReader::PacedReader(std::unique_ptr<TraceReader> reader, double speed, WaitingClock& clock)
    : reader_(std::move(reader)), speed_(speed), clock_(clock) {}

Expected<TraceEvent> PacedReader::next() {
  auto event = next_until(Timestamp::max());
  if (!event) return tl::unexpected(std::move(event.error()));
  return **std::move(event);
}

Expected<std::optional<TraceEvent>> PacedReader::next_until(Timestamp deadline) {
  if (!ahead_) {
    auto event = reader_->next();
    if (!event) return tl::unexpected(std::move(event.error()));
    ahead_ = *std::move(event);
  }
  const auto time = std::visit(TimeOf{}, *ahead_);
  if (time) {
    shares_clock_ = shares_clock_ && latest_ <= *time;
    latest_ = std::max(latest_, *time);
  }
  const bool silent = std::holds_alternative<TraceEnd>(*ahead_)
                          ? deadline != Timestamp::max()
                          : time && *time > deadline && shares_clock_;
  if (silent && started_) {
    clock_.wait_until(due(deadline));
    return std::nullopt;
  }
  if (time) wait_for(*time);
  return std::exchange(ahead_, std::nullopt);
}

Timestamp PacedReader::due(Timestamp recorded) const noexcept {
  // A century: times that a damaged file makes up must not overflow.
  constexpr double kLongest = 3.2e18;
  const double passed = static_cast<double>((recorded - first_).count()) / speed_;
  return *started_ + Timestamp(static_cast<std::int64_t>(std::clamp(passed, 0.0, kLongest)));
}

void PacedReader::wait_for(Timestamp recorded) noexcept {
  if (!started_) {
    started_ = clock_.now();
    first_ = recorded;
  }
  const Timestamp time = due(recorded);
  clock_.wait_until(time);
  lateness_ = std::max(Timestamp::zero(), clock_.now() - time);
}

}  // namespace limn
