#include "tests/support/spacenavd_rule.hpp"

#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace limn::test {
namespace {

constexpr std::size_t kHalf = 3;
constexpr int kDeadZone = 2;

/// C's integer division throughout, as spacenavd's.
int scaled(int count, SpacenavdView view) {
  const int told = view.relative ? count : (count + 350) * 1000 / 700 - 500;
  return view.by_event_node && std::abs(told) < kDeadZone ? 0 : told;
}

void tell_buttons(unsigned now, unsigned& before, std::vector<SpnavTold>& told) {
  for (int i = 0; i < 16; ++i) {
    const bool pressed = (now >> i & 1) != 0;
    if (pressed != ((before >> i & 1) != 0)) told.push_back({pressed ? 'p' : 'r', {i}, 0});
  }
  before = now;
}

}  // namespace

std::vector<SpnavTold> by_spacenavd(std::span<const MouseReport> reports, SpacenavdView view) {
  std::vector<SpnavTold> told;
  std::array<int, 6> counts{};  // as Linux knows them
  std::array<int, 6> axes{};    // in the device's order, its frame and scale spacenavd's
  unsigned buttons = 0;
  bool moves = false;
  double last = -1;
  for (const MouseReport& report : reports) {
    const auto le16 = [&report](std::size_t at) {
      return static_cast<std::int16_t>(report.bytes.at(at) | report.bytes.at(at + 1) << 8);
    };
    const int id = report.bytes.at(0);
    if (id == 3) {
      tell_buttons(static_cast<std::uint16_t>(le16(1)), buttons, told);
      continue;
    }
    if (id != 1 && id != 2) continue;
    bool comes = !view.by_event_node;
    std::size_t axis = id == 1 ? 0 : kHalf;
    for (std::size_t at = 1; at + 1 < report.bytes.size() && axis < axes.size(); at += 2, ++axis) {
      const int count = le16(at);
      if (view.by_event_node && (view.relative ? count == 0 : count == counts[axis])) continue;
      counts[axis] = count;
      axes[axis] = scaled(count, view);
      comes = true;
    }
    const SpnavTold motion = {
        'm',
        {axes[0], -axes[2], -axes[1], axes[3], -axes[5], -axes[4]},
        last < 0 ? 0 : static_cast<int>(std::floor((report.seconds - last) * 1e3 + 1e-6))};
    const bool rests = motion.axes == std::array<int, 6>{};
    if (!view.by_event_node && rests && !moves) comes = false;
    if (!comes) continue;
    moves = !rests;
    told.push_back(motion);
    last = report.seconds;
  }
  return told;
}

}  // namespace limn::test
