#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "input/base/expect.hpp"
#include "input/sample/pen_sample.hpp"
#include "input/sample/pen_state_machine.hpp"

namespace limn {

/// The state of `tool` in range: a mouse never touches.
constexpr PenState state_of(Tool tool, bool touching) noexcept {
  if (tool == Tool::kEraser) return touching ? PenState::kErasing : PenState::kInRangeErasing;
  return touching && tool == Tool::kPen ? PenState::kInContact : PenState::kInRange;
}

/// Collects the samples of one report behind a state machine, in fixed memory.
class PenOutput {
 public:
  /// Most samples that a decoder pushes for one report: an Intuos Pro 2 bundles seven frames over
  /// Bluetooth, and a tool may have to leave before them.
  static constexpr std::size_t kMaxPushed = 8;
  static constexpr std::size_t kCapacity = kMaxPushed * PenStateMachine::kMaxSamples;

  void begin(DeviceIndex device) noexcept {
    device_ = device;
    count_ = 0;
  }

  /// Precondition: at most kMaxPushed times after begin().
  void push(const PenSample& sample) noexcept {
    LIMN_EXPECT(count_ + PenStateMachine::kMaxSamples <= kCapacity);
    const std::size_t given =
        machine_.push(sample, std::span<PenSample, PenStateMachine::kMaxSamples>(
                                  samples_.data() + count_, PenStateMachine::kMaxSamples));
    for (std::size_t i = 0; i < given; ++i) samples_[count_ + i].device = device_;
    count_ += given;
  }

  /// The device went away: its tool lifts and leaves range, at `time`. Nothing to repair.
  void disconnect(Timestamp time) noexcept {
    PenSample gone = machine_.last();
    if (gone.state == PenState::kOutOfRange) return;
    gone.time = time;
    if (in_contact(gone.state)) {
      gone.state = state_of(gone.tool, false);
      push(gone);
    }
    PenSample out_of_range;
    out_of_range.time = time;
    out_of_range.tool = gone.tool;
    push(out_of_range);
  }

  std::span<const PenSample> samples() const noexcept { return {samples_.data(), count_}; }
  const PenStateMachine& machine() const noexcept { return machine_; }

 private:
  std::array<PenSample, kCapacity> samples_;
  std::size_t count_ = 0;
  DeviceIndex device_ = 0;
  PenStateMachine machine_;
};

}  // namespace limn
