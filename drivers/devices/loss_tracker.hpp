#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "input/base/time.hpp"
#include "input/sample/motion_sample.hpp"
#include "input/sample/pen_sample.hpp"

namespace limn {

/// How often a device's stream was disturbed so far.
struct StreamLosses {
  std::uint64_t lost = 0;       ///< reports that are missing, as counted
  bool lost_estimated = false;  ///< `lost` are at least so many
  std::uint64_t overruns = 0;
  std::uint64_t gaps = 0;
  std::uint64_t resets = 0;
  std::uint64_t clock_jumps = 0;

  void add(const StreamLosses& other) noexcept;
};

/// Tells with each sample of one device what happened to the stream before it, and counts: what the
/// stream says between the samples (notes, damage, replugs), what their decoder found, times that
/// go back, and a gap that nothing counts but the pace of the samples.
///
/// Such a gap is claimed only where nothing else explains it. The pen touches before and after,
/// the step is five times as long as any of the last kPaceSteps to 2 * kPaceSteps, and the pen
/// moved four times as far in it as in any of these, and more than 1 mm. So no pause is taken for a
/// gap, of a pen that rests and is not reported, nor of a radio that delivers late: a pen does not
/// travel in them. The number lost is at least what the longest of those steps leaves room for.
///
/// A pure function of what it is told. Allocates nothing. Not thread-safe.
class LossTracker {
 public:
  static constexpr std::size_t kPaceSteps = 32;

  /// A queue dropped `count` reports, or at least so many.
  void overrun(std::uint32_t count, bool estimated) noexcept;

  /// The recording is damaged here; with `time_went_back` a report in it was earlier than the one
  /// before.
  void damage(std::uint32_t count, bool time_went_back) noexcept;

  /// The device went away. described() is then its coming back, and no second reset.
  void gone() noexcept;

  /// The device was described; but for its first time, that is a replug.
  void described() noexcept;

  /// Completes the next sample. `paced`: it is a report's, not a row that somebody wrote.
  void complete(PenSample& sample, bool paced) noexcept;

  /// The same for a 3D mouse, whose decoder itself tells of silence in mid-motion.
  void complete(MotionSample& sample) noexcept;

  const StreamLosses& losses() const noexcept { return losses_; }

 private:
  struct Step {
    std::int64_t ns = 0;
    double mm2 = 0;  ///< squared
  };

  /// The longest and the farthest step of a block of kPaceSteps.
  struct Pace {
    Step most;
    std::size_t steps = 0;
    void add(const Step& step) noexcept;
  };

  template <class Sample>
  void tell_what_was(Sample& sample) noexcept;
  void reset() noexcept;
  void tell(std::uint32_t count, bool estimated, Disturbance what) noexcept;
  void estimate(PenSample& sample) noexcept;

  StreamLosses losses_;
  std::uint32_t lost_ = 0;  // to be told
  bool estimated_ = false;
  Disturbances disturbances_;
  bool known_ = false;  // described once
  bool away_ = false;
  std::optional<Timestamp> last_time_;
  std::optional<PenSample> last_;
  Pace before_;  // a whole block, once it has kPaceSteps
  Pace now_;
  std::size_t refused_ = 0;  // steps, one after the other
};

}  // namespace limn
