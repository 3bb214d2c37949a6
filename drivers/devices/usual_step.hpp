#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace limn {

/// Learns how long the steps of a stream are, and tells those that are too long. A pure function of
/// the steps; whole numbers in any unit.
///
/// It learns in blocks. The usual step is the mean of a block, its longest ordinary one the fourth
/// largest, so that three losses in a block do not pass for ordinary. Where all but those three are
/// within an eighth (a device's clock), a step above 1.5 ordinary ones is too long; else, where
/// steps jitter by up to twice their length, one above 2.5. Steps that are too long are not learned
/// from, unless half a block of them follow each other: then the pace has changed.
class UsualStep {
 public:
  static constexpr std::size_t kBlock = 16;

  bool known() const noexcept { return limit_ > 0; }

  /// Steps longer than this are too long; 0 as long as nothing is known.
  std::int64_t limit() const noexcept { return limit_; }

  /// Takes in a step and returns how many usual ones it lacks in between: 0 for an ordinary one.
  std::uint32_t push(std::int64_t step) noexcept;

  /// How many steps a step lacks, without learning from it. Precondition: known().
  std::uint32_t missing_in(std::int64_t step) const noexcept;

 private:
  std::array<std::int64_t, kBlock> block_{};
  std::size_t filled_ = 0;
  std::size_t too_long_ = 0;  // one after the other
  std::int64_t sum_ = 0;      // of the last whole block
  std::int64_t limit_ = 0;

  void learn() noexcept;
};

}  // namespace limn
