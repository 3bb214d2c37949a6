#include "drivers/devices/usual_step.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace limn {
namespace {

constexpr std::size_t kOutliers = 3;  // of a block

// Longer steps count as so long: sums and products of a block's stay whole numbers of 64 bits.
constexpr std::int64_t kLongest =
    std::numeric_limits<std::int64_t>::max() / (4 * static_cast<std::int64_t>(UsualStep::kBlock));

}  // namespace

std::uint32_t UsualStep::push(std::int64_t step) noexcept {
  if (step <= 0) return 0;  // a clock that stands still, or reports of one instant
  step = std::min(step, kLongest);
  const std::uint32_t missing = known() ? missing_in(step) : 0;
  if (missing == 0) {
    too_long_ = 0;
    block_[filled_++] = step;
    if (filled_ == kBlock) learn();
  } else if (++too_long_ == kBlock / 2) {
    *this = UsualStep();
  }
  return missing;
}

std::uint32_t UsualStep::missing_in(std::int64_t step) const noexcept {
  if (step <= limit_) return 0;
  constexpr std::int64_t kCount = kBlock;
  const std::int64_t fit = (std::min(step, kLongest) * kCount + sum_ / 2) / sum_;
  return static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(fit - 1, 1, std::numeric_limits<std::uint32_t>::max()));
}

void UsualStep::learn() noexcept {
  filled_ = 0;
  std::sort(block_.begin(), block_.end());
  const std::int64_t longest = block_[kBlock - 1 - kOutliers];
  const bool tight = longest - block_.front() <= longest / 8;
  // The outliers count as ordinary ones in the mean.
  sum_ = std::accumulate(block_.begin(), block_.end() - kOutliers,
                         static_cast<std::int64_t>(kOutliers) * longest);
  limit_ = tight ? longest + longest / 2 : 2 * longest + longest / 2;
}

}  // namespace limn
