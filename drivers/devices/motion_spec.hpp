#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "input/sample/motion_sample.hpp"

namespace limn {

/// Which way a 3D mouse's own axes point. Both are right-handed about themselves; X is to the
/// right.
enum class MotionFrame : std::uint8_t {
  kDown,  ///< Y towards the user, Z down: 3Dconnexion's USB devices, and what HID asks for
  kUp,    ///< Y up, Z away from the user: Logitech's first ones, and what spacenavd gives
};

/// The six axes of a device's frame in that of MotionSample.
std::array<double, kMotionAxes> in_motion_frame(const std::array<double, kMotionAxes>& axes,
                                                MotionFrame frame) noexcept;

inline constexpr double kUsualFullCounts = 350;

/// The counts of full deflection of an axis with this range: 350 where there is none, or only what
/// fits into 16 bits, which firmware that imitates other devices declares.
double full_counts(std::int64_t minimum, std::int64_t maximum) noexcept;

/// What its reports do not say of a 3D mouse. All of these rest by exact zeros.
struct MotionSpec {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string_view name = {};
  std::uint8_t buttons = 0;  ///< keys on it; 0: not known, or those of what is paired with it
  MotionFrame frame = MotionFrame::kDown;
  std::string_view evidence = {};
};

/// What is told to a device of 3Dconnexion, as reports with their ID first. `light_report` is an
/// output report (DeviceControl::set_output), `zero_report` a feature report
/// (DeviceControl::set_feature): the device takes its cap as it is held for its rest.
constexpr std::array<std::uint8_t, 2> light_report(bool on) noexcept {
  return {4, static_cast<std::uint8_t>(on ? 1 : 0)};
}
constexpr std::array<std::uint8_t, 2> zero_report() noexcept { return {7, 0}; }

/// All rows; no two have the same ids.
std::span<const MotionSpec> motion_specs() noexcept;

/// The row of these USB ids, or nullptr. 3Dconnexion's vendor id alone says too little: it makes
/// ordinary mice and keyboards, too.
const MotionSpec* find_motion_spec(std::uint16_t vendor, std::uint16_t product) noexcept;

}  // namespace limn
