#pragma once

#include <cstdint>
#include <string_view>

#include "input/base/time.hpp"
#include "input/sample/report.hpp"

namespace limn {

/// Which end of which transducer reports.
enum class Tool : std::uint8_t { kPen, kEraser, kTabletMouse };

/// The five states of a digitizer pen (the names are those of the HID usage tables and of the
/// Windows pen guidelines). kOutOfRange is also the state before the first report.
enum class PenState : std::uint8_t {
  kOutOfRange,
  kInRange,
  kInContact,
  kInRangeErasing,
  kErasing,
};

/// An axis that a device may or may not give. Absence is a cleared bit, never a magic value.
enum class PenAxis : std::uint16_t {
  kX = 1 << 0,
  kY = 1 << 1,
  kPressure = 1 << 2,
  kTiltX = 1 << 3,
  kTiltY = 1 << 4,
  kTwist = 1 << 5,
  kDistance = 1 << 6,
  kSerial = 1 << 7,
};

/// A set of axes.
class PenAxes {
 public:
  constexpr PenAxes() = default;
  constexpr bool has(PenAxis axis) const noexcept {
    return (bits_ & static_cast<std::uint16_t>(axis)) != 0;
  }
  constexpr bool has_position() const noexcept { return has(PenAxis::kX) && has(PenAxis::kY); }
  constexpr void add(PenAxis axis) noexcept {
    bits_ = static_cast<std::uint16_t>(bits_ | static_cast<std::uint16_t>(axis));
  }
  constexpr void remove(PenAxis axis) noexcept {
    bits_ = static_cast<std::uint16_t>(bits_ & ~static_cast<std::uint16_t>(axis));
  }
  constexpr bool empty() const noexcept { return bits_ == 0; }
  constexpr std::uint16_t bits() const noexcept { return bits_; }
  friend constexpr bool operator==(PenAxes, PenAxes) = default;

 private:
  std::uint16_t bits_ = 0;
};

/// Pressed switches of the transducer: bit i is button i+1 of its kind. For a pen and an eraser
/// that is barrel1 (the one nearer the tip), barrel2, barrel3; for a tablet mouse left, right,
/// middle, side, extra, in the order of the Linux button codes.
using PenButtons = std::uint8_t;

/// What happened to a device's stream of reports between its sample before and this one.
enum class Disturbance : std::uint8_t {
  kOverrun = 1 << 0,    ///< a queue ran full: the device's, the kernel's or limn's dropped reports
  kGap = 1 << 1,        ///< the device's own counter or clock, or its pace, shows reports missing
  kReset = 1 << 2,      ///< the device went away or was described anew
  kRepaired = 1 << 3,   ///< the pen made an illegal transition, of which this is the repair
  kClockJump = 1 << 4,  ///< time went back, or the device's clock and the reports' times disagree
  kDamage = 1 << 5,     ///< a part of the recording that cannot be read was skipped
};
inline constexpr unsigned kDisturbanceCount = 6;

/// A set of them; disturbance i is bit i.
class Disturbances {
 public:
  constexpr Disturbances() = default;
  constexpr Disturbances(Disturbance one) noexcept : bits_(static_cast<std::uint8_t>(one)) {}
  constexpr bool has(Disturbance one) const noexcept {
    return (bits_ & static_cast<std::uint8_t>(one)) != 0;
  }
  constexpr void add(Disturbances others) noexcept {
    bits_ = static_cast<std::uint8_t>(bits_ | others.bits_);
  }
  constexpr void remove(Disturbance one) noexcept {
    bits_ = static_cast<std::uint8_t>(bits_ & ~static_cast<std::uint8_t>(one));
  }
  constexpr bool empty() const noexcept { return bits_ == 0; }
  constexpr std::uint8_t bits() const noexcept { return bits_; }
  friend constexpr bool operator==(Disturbances, Disturbances) = default;

 private:
  std::uint8_t bits_ = 0;
};

/// Device counts before any conversion, as the device sent them.
struct RawCounts {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t pressure = 0;
  friend constexpr bool operator==(const RawCounts&, const RawCounts&) = default;
};

/// What a pen said at one instant, in the HID frame: x to the right, y towards the user, (0, 0) at
/// the Logical Minimum of both axes. A member whose axis is not in `axes` is zero and means
/// nothing.
struct PenSample {
  Timestamp time{};
  DeviceIndex device = 0;
  Tool tool = Tool::kPen;
  PenState state = PenState::kOutOfRange;
  PenButtons buttons = 0;
  PenAxes axes;
  double x_mm = 0;
  double y_mm = 0;
  double pressure = 0;    ///< 0 (none) to 1 (the device's maximum)
  double tilt_x_rad = 0;  ///< -pi/2 to pi/2, positive when the pen's upper end leans to the right
  double tilt_y_rad = 0;  ///< -pi/2 to pi/2, positive when it leans towards the user
  double twist_rad = 0;   ///< 0 to 2 pi about the pen's own axis, clockwise seen from above
  double distance = 0;    ///< 0 (touching) to 1 (the edge of range)
  std::uint64_t serial = 0;
  std::uint32_t lost = 0;  ///< reports that are missing just before this sample, as counted
  /// Nobody counted (all of) `lost`: at least so many are missing. 0 after an overrun only: a queue
  /// was full and perhaps dropped none.
  bool lost_estimated = false;
  Disturbances disturbances;
  RawCounts raw;
};

constexpr bool in_contact(PenState state) noexcept {
  return state == PenState::kInContact || state == PenState::kErasing;
}

/// The names of the JSON and CSV contracts ("pen", "in_range_erasing", ..).
std::string_view name(Tool tool) noexcept;
std::string_view name(PenState state) noexcept;
/// "overrun", "gap", "reset", "repaired", "clock_jump", "damage".
std::string_view name(Disturbance disturbance) noexcept;
/// Name of button `index` (0 to 7): "barrel1", .. for pens and erasers, "left", .. for mice.
std::string_view button_name(Tool tool, unsigned index) noexcept;

}  // namespace limn
