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
    const timespec until{time.count() / kSecond, time.count() % kSecond};
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
  auto event = reader_->next();
  if (!event) return event;
  if (const auto time = std::visit(TimeOf{}, *event)) wait_for(*time);
  return event;
}

void PacedReader::wait_for(Timestamp recorded) noexcept {
  if (!started_) {
    started_ = clock_.now();
    first_ = recorded;
  }
  // A century: times that a damaged file makes up must not overflow.
  constexpr double kLongest = 3.2e18;
  const double passed = static_cast<double>((recorded - first_).count()) / speed_;
  const Timestamp due =
      *started_ + Timestamp(static_cast<std::int64_t>(std::clamp(passed, 0.0, kLongest)));
  clock_.wait_until(due);
  lateness_ = std::max(Timestamp::zero(), clock_.now() - due);
}

}  // namespace limn
