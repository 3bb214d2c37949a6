#include "input/sample/pen_state_machine.hpp"

namespace limn {
namespace {

// Row: from. Column: to. Order of PenState.
// clang-format off
constexpr bool kLegal[5][5] = {
    //                 out    in_r   contact in_r_er erasing
    /* out_of_range */ {true,  true,  false,  true,   false},
    /* in_range     */ {true,  true,  true,   false,  false},
    /* in_contact   */ {false, true,  true,   false,  false},
    /* in_r_erasing */ {true,  false, false,  true,   true},
    /* erasing      */ {false, false, false,  true,   true},
};
// clang-format on

constexpr std::size_t index(PenState state) noexcept { return static_cast<std::size_t>(state); }

constexpr bool out_of_range(PenState state) noexcept { return state == PenState::kOutOfRange; }

/// The state in which the same tool hovers.
constexpr PenState hovering(PenState state) noexcept {
  return state == PenState::kErasing || state == PenState::kInRangeErasing
             ? PenState::kInRangeErasing
             : PenState::kInRange;
}

PenSample undisturbed_copy(const PenSample& sample) noexcept {
  PenSample copy = sample;
  copy.lost = 0;
  copy.lost_estimated = false;
  copy.disturbances = {};
  return copy;
}

PenSample hovering_copy(const PenSample& sample) noexcept {
  PenSample copy = undisturbed_copy(sample);
  copy.state = hovering(sample.state);
  return copy;
}

PenSample left_range(const PenSample& sample) noexcept {
  PenSample gone;
  gone.device = sample.device;
  gone.tool = sample.tool;
  gone.state = PenState::kOutOfRange;
  if (sample.axes.has(PenAxis::kSerial)) {
    gone.axes.add(PenAxis::kSerial);
    gone.serial = sample.serial;
  }
  return gone;
}

/// Whether another tool may only follow after the present one has left: true between two tools in
/// range. (Out of range there is no tool to leave.)
bool changes_tool(const PenSample& from, const PenSample& to) noexcept {
  return from.tool != to.tool && !out_of_range(from.state) && !out_of_range(to.state);
}

}  // namespace

bool is_legal_transition(PenState from, PenState to) noexcept {
  return kLegal[index(from)][index(to)];
}

std::size_t PenStateMachine::push(const PenSample& sample,
                                  std::span<PenSample, kMaxSamples> out) noexcept {
  std::size_t count = 0;
  const auto give = [&](const PenSample& inserted) {
    out[count] = inserted;
    out[count].time = sample.time;
    ++count;
  };
  Disturbances disturbances = sample.disturbances;
  const bool other_tool = changes_tool(last_, sample);
  if (other_tool || !is_legal_transition(last_.state, sample.state)) {
    ++repaired_;
    disturbances.add(Disturbance::kRepaired);
    const bool leaves =
        other_tool || out_of_range(sample.state) || hovering(last_.state) != hovering(sample.state);
    if (leaves && in_contact(last_.state)) give(hovering_copy(last_));
    if (leaves && !out_of_range(last_.state) && !out_of_range(sample.state)) {
      give(left_range(last_));
    }
    if (in_contact(sample.state)) give(hovering_copy(sample));
  }
  last_ = undisturbed_copy(sample);
  give(last_);
  out[0].lost = sample.lost;
  out[0].lost_estimated = sample.lost_estimated;
  out[0].disturbances = disturbances;
  return count;
}

}  // namespace limn
