#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "drivers/devices/usual_step.hpp"
#include "input/base/time.hpp"

namespace limn {

/// What a report's Scan Time shows: the clock that a pen stamps its reports with (HID usage
/// 0x0D/0x56; mostly 16 bits of 100 us). A pure function of the reports.
///
/// A pen with such a clock reports without a pause while it is in range, as Windows wants it: a
/// step that is too long for it (UsualStep) lacks reports. Hovering and touching pens may have a
/// pace each. A clock that steps by far more or less than the reports' times, wraps aside, has
/// jumped, or they have: then nothing can be counted.
class ScanTime {
 public:
  /// One reading of the field.
  struct Reading {
    std::int64_t ticks = 0;    ///< from 0 on
    std::int64_t modulus = 0;  ///< it wraps there
    double tick_s = 0;
    Timestamp time{};  ///< of the report
    bool touching = false;
  };

  struct Step {
    std::uint32_t lost = 0;  ///< reports missing before this one
    bool jumped = false;
  };

  /// The step from the reading before. Allocates nothing.
  Step push(const Reading& reading) noexcept;

  /// The pen left: the next reading follows no other.
  void leave() noexcept { last_.reset(); }

  /// Disagreement of a step that is no delay of a transport or a recorder any more.
  static constexpr double kJumpSeconds = 1;

 private:
  std::optional<Reading> last_;
  std::array<UsualStep, 2> usual_;  // hovering, touching
};

}  // namespace limn
