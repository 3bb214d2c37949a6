#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "input/sample/pen_sample.hpp"

namespace limn {

/// Whether a pen may report `to` right after `from`:
///
///     out_of_range <-> in_range         <-> in_contact
///     out_of_range <-> in_range_erasing <-> erasing
///
/// and any state after itself.
bool is_legal_transition(PenState from, PenState to) noexcept;

/// Lets only legal transitions pass, by inserting the samples that the device left out:
///
///     into contact       a copy of the new sample, in range
///     out of contact     a copy of the last sample, in range
///     to another tool    through out_of_range, without position (pen, eraser and tablet mouse are
///                        three tools, even where two are ends of one stylus)
///
/// all at the new sample's time. Copies keep what was measured, pressure and raw counts included.
/// What the new sample says of losses and disturbances moves to the first sample given for it,
/// which also tells of the repair. One machine a device; not thread-safe.
class PenStateMachine {
 public:
  /// Most samples given for one: lift, leave, enter, contact.
  static constexpr std::size_t kMaxSamples = 4;

  /// Writes the samples that stand for `sample`, itself the last, to the front of `out` and returns
  /// their number.
  std::size_t push(const PenSample& sample, std::span<PenSample, kMaxSamples> out) noexcept;

  /// The last sample given, without its losses and disturbances; kOutOfRange before the first.
  const PenSample& last() const noexcept { return last_; }

  /// Illegal transitions that were repaired so far.
  std::uint64_t repaired() const noexcept { return repaired_; }

  /// Forgets the last sample, as after a replug; keeps the count.
  void reset() noexcept { last_ = PenSample{}; }

 private:
  PenSample last_;
  std::uint64_t repaired_ = 0;
};

}  // namespace limn
