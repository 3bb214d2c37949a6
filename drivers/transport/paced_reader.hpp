#pragma once

#include <memory>
#include <optional>
#include <string>

#include "input/trace/trace.hpp"

namespace limn {

/// A clock that can be waited on; tests have their own.
class WaitingClock {
 public:
  virtual ~WaitingClock() = default;
  virtual Timestamp now() noexcept = 0;
  /// Returns at `time` or as soon after it as the system lets it; at once where that is past.
  virtual void wait_until(Timestamp time) noexcept = 0;
};

/// CLOCK_MONOTONIC. Waits without the 50 us of slack that Linux gives ordinary timers.
WaitingClock& monotonic_clock() noexcept;

/// A recording at the pace at which it was made: every report, frame or sample is held back until
/// as much time has passed since the first one as the recording says, divided by `speed`. Gaps are
/// kept, however long. What lies before the first one (a second device, counted from its own start)
/// comes at once. Events are those of the inner reader, borrowed from it.
///
/// Silence is that of the recording: next_until() waits for its deadline, divided by `speed` too,
/// whenever the next event is a later one or the end, however late the caller is. Where the times
/// of events once went back, the devices do not share a clock, and nothing tells silence any more.
class PacedReader final : public TraceReader {
 public:
  /// Precondition: 0 < speed < infinity. `clock` must outlive the reader.
  PacedReader(std::unique_ptr<TraceReader> reader, double speed, WaitingClock& clock);

  TraceFormat format() const noexcept override { return reader_->format(); }
  Expected<TraceEvent> next() override;
  Expected<std::optional<TraceEvent>> next_until(Timestamp deadline) override;
  std::string place() const override { return reader_->place(); }

  /// How much later than its time the last event came out.
  Timestamp lateness() const noexcept { return lateness_; }

 private:
  Timestamp due(Timestamp recorded) const noexcept;
  void wait_for(Timestamp recorded) noexcept;

  std::unique_ptr<TraceReader> reader_;
  std::optional<TraceEvent> ahead_;  // read, but later than the caller's deadline
  double speed_;
  WaitingClock& clock_;
  std::optional<Timestamp> started_;  // of the clock, at the first event
  Timestamp first_{};                 // its time in the recording
  Timestamp latest_ = Timestamp::min();
  bool shares_clock_ = true;
  Timestamp lateness_{};
};

}  // namespace limn
