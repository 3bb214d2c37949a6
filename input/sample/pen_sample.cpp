#include "input/sample/pen_sample.hpp"

#include <array>
#include <bit>

namespace limn {

std::string_view name(Tool tool) noexcept {
  constexpr std::array<std::string_view, 3> kNames = {"pen", "eraser", "tablet_mouse"};
  return kNames[static_cast<std::size_t>(tool)];
}

std::string_view name(PenState state) noexcept {
  constexpr std::array<std::string_view, 5> kNames = {"out_of_range", "in_range", "in_contact",
                                                      "in_range_erasing", "erasing"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string_view name(Disturbance disturbance) noexcept {
  constexpr std::array<std::string_view, kDisturbanceCount> kNames = {
      "overrun", "gap", "reset", "repaired", "clock_jump", "damage"};
  return kNames[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(disturbance)))];
}

std::string_view button_name(Tool tool, unsigned index) noexcept {
  constexpr std::array<std::string_view, 8> kBarrel = {"barrel1", "barrel2", "barrel3", "barrel4",
                                                       "barrel5", "barrel6", "barrel7", "barrel8"};
  constexpr std::array<std::string_view, 8> kMouse = {"left",  "right",   "middle",  "side",
                                                      "extra", "button6", "button7", "button8"};
  return (tool == Tool::kTabletMouse ? kMouse : kBarrel)[index & 7U];
}

}  // namespace limn
