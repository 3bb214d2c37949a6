#include "drivers/devices/loss_tracker.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace limn {
namespace {

std::uint32_t saturated_sum(std::uint32_t a, std::uint32_t b) noexcept {
  return a + std::min(b, std::numeric_limits<std::uint32_t>::max() - a);
}

}  // namespace

void StreamLosses::add(const StreamLosses& other) noexcept {
  lost += other.lost;
  lost_estimated |= other.lost_estimated;
  overruns += other.overruns;
  gaps += other.gaps;
  resets += other.resets;
  clock_jumps += other.clock_jumps;
}

void LossTracker::overrun(std::uint32_t count, bool estimated) noexcept {
  if (count == 0 && !estimated) return;
  ++losses_.overruns;
  tell(count, estimated, Disturbance::kOverrun);
}

void LossTracker::damage(std::uint32_t count, bool time_went_back) noexcept {
  tell(count, false, Disturbance::kDamage);
  if (!time_went_back) return;
  ++losses_.clock_jumps;
  disturbances_.add(Disturbance::kClockJump);
}

void LossTracker::tell(std::uint32_t count, bool estimated, Disturbance what) noexcept {
  losses_.lost += count;
  losses_.lost_estimated |= estimated;
  lost_ = saturated_sum(lost_, count);
  estimated_ |= estimated;
  disturbances_.add(what);
}

void LossTracker::gone() noexcept {
  if (!away_) reset();
  away_ = true;
}

void LossTracker::described() noexcept {
  if (known_ && !away_) reset();
  known_ = true;
  away_ = false;
}

void LossTracker::reset() noexcept {
  ++losses_.resets;
  disturbances_.add(Disturbance::kReset);
}

void LossTracker::complete(PenSample& sample, bool paced) noexcept {
  tell_what_was(sample);
  if (paced) estimate(sample);
  last_ = sample;
}

void LossTracker::complete(MotionSample& sample) noexcept { tell_what_was(sample); }

template <class Sample>
void LossTracker::tell_what_was(Sample& sample) noexcept {
  const std::uint32_t told = std::exchange(lost_, 0);
  const bool told_estimated = std::exchange(estimated_, false);
  if (sample.disturbances.has(Disturbance::kGap) && sample.lost <= told) {
    sample.disturbances.remove(Disturbance::kGap);  // it is what was told of already
  }
  if (sample.disturbances.has(Disturbance::kOverrun)) ++losses_.overruns;
  if (sample.disturbances.has(Disturbance::kGap)) ++losses_.gaps;
  if (sample.disturbances.has(Disturbance::kClockJump)) ++losses_.clock_jumps;
  // What the device counts holds what was told of it.
  const std::uint32_t counted = sample.lost;
  sample.lost = std::max(counted, told);
  losses_.lost += sample.lost - told;
  losses_.lost_estimated |= sample.lost_estimated;
  sample.lost_estimated |= told_estimated && told >= counted;
  sample.disturbances.add(std::exchange(disturbances_, {}));
  if (last_time_ && sample.time < *last_time_ &&
      !sample.disturbances.has(Disturbance::kClockJump)) {
    ++losses_.clock_jumps;
    sample.disturbances.add(Disturbance::kClockJump);
  }
  last_time_ = sample.time;
}

void LossTracker::estimate(PenSample& sample) noexcept {
  if (!last_ || !in_contact(sample.state) || last_->state != sample.state) return;
  if (!sample.axes.has_position() || !last_->axes.has_position()) return;
  // What is told already is no usual step either.
  Disturbances told = sample.disturbances;
  if (!told.empty()) return;
  const double dx = sample.x_mm - last_->x_mm;
  const double dy = sample.y_mm - last_->y_mm;
  const Step step{(sample.time - last_->time).count(), dx * dx + dy * dy};

  constexpr std::int64_t kTooLong = 5;
  constexpr double kTooFar = 4;
  constexpr double kLeastMm = 1;
  Step most = before_.most;
  most.ns = std::max({most.ns, now_.most.ns, std::int64_t{1}});
  most.mm2 = std::max(most.mm2, now_.most.mm2);
  const bool gap = before_.steps == kPaceSteps && step.ns / kTooLong >= most.ns &&
                   step.mm2 >= kTooFar * kTooFar * most.mm2 && step.mm2 > kLeastMm * kLeastMm;
  if (gap) {
    sample.lost = static_cast<std::uint32_t>(
        std::min<std::int64_t>(step.ns / most.ns - 1, std::numeric_limits<std::uint32_t>::max()));
    sample.lost_estimated = true;
    sample.disturbances.add(Disturbance::kGap);
    ++losses_.gaps;
    losses_.lost += sample.lost;
    losses_.lost_estimated = true;
    constexpr std::size_t kMostRefused = 4;  // by then the pace has changed
    if (++refused_ == kMostRefused) before_ = now_ = {};
    return;
  }
  refused_ = 0;
  now_.add(step);
  if (now_.steps == kPaceSteps) before_ = std::exchange(now_, {});
}

void LossTracker::Pace::add(const Step& step) noexcept {
  most.ns = std::max(most.ns, step.ns);
  most.mm2 = std::max(most.mm2, step.mm2);
  ++steps;
}

}  // namespace limn
