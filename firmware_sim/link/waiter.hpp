#pragma once

#include <chrono>
#include <optional>
#include <span>

#include "firmware_sim/link/file_descriptor.hpp"
#include "firmware_sim/link/link_error.hpp"

namespace limn::firmware {

/// The simulation's time by the wall: zero until start(), then counted by CLOCK_MONOTONIC from its
/// last whole millisecond. All devices of a machine have their frames at the same moments, as those
/// on one bus have: one timer wakes them all.
class SimulationClock {
 public:
  using Point = std::chrono::steady_clock::time_point;

  void start() noexcept {
    start_ = std::chrono::floor<std::chrono::milliseconds>(std::chrono::steady_clock::now());
  }
  bool runs() const noexcept { return start_.has_value(); }
  std::chrono::microseconds now() const noexcept {
    if (!start_) return std::chrono::microseconds(0);
    return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() -
                                                                 *start_);
  }
  /// Precondition: runs().
  Point at(std::chrono::microseconds time) const noexcept { return *start_ + time; }

 private:
  std::optional<Point> start_;
};

/// A file to be waited for.
struct Watched {
  int file = -1;
  bool read = true;
  bool write = false;
  bool ready = false;  ///< out: either of what was asked, or it has failed
};

/// Sleeps until a file is ready or an absolute time has come: a timer descriptor, so without the
/// slack that Linux gives to timeouts.
class Waiter {
 public:
  static LinkResult<Waiter> make();

  /// Ends what runs with this waiter, for good. From any thread or signal handler.
  void stop() noexcept;
  bool stopped() const noexcept;

  /// Returns when one of `files` is ready, at `deadline`, or where stopped; sets `ready` of each.
  void wait(std::span<Watched> files, std::optional<SimulationClock::Point> deadline);

 private:
  Waiter(FileDescriptor timer, FileDescriptor stop)
      : timer_(std::move(timer)), stop_(std::move(stop)) {}

  FileDescriptor timer_;
  FileDescriptor stop_;  // an event descriptor; readable once stopped
};

}  // namespace limn::firmware
