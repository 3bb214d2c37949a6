#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "input/base/time.hpp"
#include "input/sample/pen_sample.hpp"
#include "input/sample/report.hpp"

namespace limn {

/// Of a 3D mouse: three translations and three rotations, in this order wherever there are six.
inline constexpr std::size_t kMotionAxes = 6;

/// Pressed buttons of a 3D mouse, by their number: that of the HID usage, from 1 on, which is one
/// more than the position in the device's bitmap and than spacenavd's and libspnav's number.
class MotionButtons {
 public:
  /// A SpaceMouse Enterprise has numbers up to 176.
  static constexpr unsigned kMost = 255;

  constexpr bool has(unsigned number) const noexcept {
    return number >= 1 && number <= kMost && (words_[number / 64] >> number % 64 & 1U) != 0;
  }
  /// Numbers out of range stand for no button.
  constexpr void set(unsigned number, bool pressed) noexcept {
    if (number < 1 || number > kMost) return;
    const std::uint64_t bit = std::uint64_t{1} << number % 64;
    words_[number / 64] = pressed ? words_[number / 64] | bit : words_[number / 64] & ~bit;
  }
  constexpr bool empty() const noexcept { return *this == MotionButtons(); }
  constexpr const std::array<std::uint64_t, 4>& words() const noexcept { return words_; }

  /// Calls `each(number)` for those that are pressed, in their order.
  template <class Each>
  constexpr void for_each(Each&& each) const {
    for (unsigned number = 1; number <= kMost; ++number) {
      if (has(number)) each(number);
    }
  }

  friend constexpr bool operator==(const MotionButtons&, const MotionButtons&) = default;

 private:
  std::array<std::uint64_t, 4> words_{};
};

/// What a 3D mouse said at one instant: how far its cap is held from rest.
///
/// Frame: x to the right, y away from the user, z up; rotations about these, right-handed.
struct MotionSample {
  Timestamp time{};
  DeviceIndex device = 0;
  /// 1 is the full deflection that the device declares; worn and old devices go beyond.
  std::array<double, kMotionAxes> deflection{};
  /// Counts as the device sent them, its own axes in its own order (X, Y, Z, Rx, Ry, Rz).
  std::array<std::int32_t, kMotionAxes> raw{};
  /// Which half this report tells anew; the other is held. Both are false where only buttons
  /// changed. Many devices tell the halves in turn.
  bool translation_told = false;
  bool rotation_told = false;
  /// Its rest is exact zeros: such devices are known by their tables.
  bool rests_exactly = false;
  /// Its stream tells changes only: what it does not tell goes on. So do Linux's event nodes.
  bool changes_only = false;
  /// No report: the device fell silent in mid-motion, or was unplugged, and the motion ends.
  bool silence = false;
  MotionButtons buttons;
  std::optional<std::uint8_t> battery_percent;  ///< where this report tells it
  std::uint32_t lost = 0;                       ///< as PenSample's
  bool lost_estimated = false;
  Disturbances disturbances;

  /// Whether no axis is deflected at all.
  constexpr bool is_zero() const noexcept {
    for (const double axis : deflection) {
      if (axis != 0) return false;
    }
    return true;
  }
};

}  // namespace limn
