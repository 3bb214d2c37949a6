#pragma once

#include <chrono>
#include <vector>

#include "firmware_sim/devices/drawings.hpp"
#include "firmware_sim/devices/minimum_jerk.hpp"
#include "firmware_sim/devices/pen_pose.hpp"

namespace limn::firmware {

/// The hand that draws: it comes down from above, makes each stroke with minimum jerk, rests at
/// corners, carries the pen over to the next stroke (high enough to leave range where it turns the
/// pen round), and goes away. Pressure rises after the touch, is greater in strokes towards the
/// user and falls before the lift; the tilt wanders smoothly, as a wrist does.
/// A pure function of the drawing and the time, the same on every machine; not firmware (it uses
/// the heap). Immutable, so any number of threads may use one.
class Hand {
 public:
  /// Precondition: at least one stroke; see PenStroke.
  explicit Hand(const Drawing& drawing);

  /// When the pen has gone for good. It is away at 0 as well.
  std::chrono::microseconds duration() const noexcept { return duration_; }

  /// Where the pen is, without any sensor's noise.
  PenPose pose(std::chrono::microseconds time) const noexcept;

 private:
  /// A part of the session: a piece of a stroke, a rest in it, or a way through the air.
  struct Leg {
    MinimumJerk path;
    PenEnd end = PenEnd::kTip;
    double begin = 0;  // seconds
    bool touches = false;
    // Touching: of the whole contact.
    double pressure = 0;
    double touch_begin = 0;
    double touch_end = 0;
    // In the air: from one height to another over an arch between them.
    double begin_mm = 0;
    double end_mm = 0;
    double arch_mm = 0;
  };

  void add_flight(PlanePoint to, PenEnd end, double begin_mm, double end_mm);
  void add_contact(const PenStroke& stroke);
  double end_of_legs() const noexcept;

  static double height_mm(const Leg& leg, double t) noexcept;
  static double pressure(const Leg& leg, double t) noexcept;

  PlanePoint pen_;  // where the legs so far end
  std::vector<Leg> legs_;
  std::chrono::microseconds duration_{};
};

}  // namespace limn::firmware
