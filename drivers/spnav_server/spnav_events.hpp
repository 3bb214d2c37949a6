#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "drivers/spnav_server/spnav_device.hpp"
#include "input/base/time.hpp"
#include "input/sample/motion_sample.hpp"

namespace limn {

/// A motion as spacenavd tells it: x to the right, y up, z away from the user, then the rotations
/// about these, right-handed though the axes are not. Displacements of the cap, not rates.
struct SpnavMotion {
  std::array<std::int32_t, kMotionAxes> axes{};
  std::uint32_t period_ms = 0;  ///< since the motion before

  bool is_rest() const noexcept { return axes == decltype(axes){}; }
};

/// Who is told of motions and buttons.
class SpnavSink {
 public:
  virtual ~SpnavSink() = default;
  virtual void motion(const SpnavMotion& motion) = 0;
  /// `number` counts from 0.
  virtual void button(unsigned number, bool pressed) = 0;
};

/// Samples of any number of 3D mice -> one mouse's events, as spacenavd's clients expect them.
///
///     x, y, z, rx, ry, rz  =  full (x, z, y, rx, rz, ry) of the samples' frame
///
/// rounded, full deflection being 1, and `full` SpnavDevice::full_deflection: x, -z, -y of the
/// device's own axes, as spacenavd has them. Two mice moved at once add up; a button that both have
/// is pressed while either holds it.
///
/// What spacenavd does otherwise, reading an event node of Linux: it rounds down, which makes one
/// way half a count stronger than the other; takes a count or less for none; tells nothing while
/// nothing changes, so that programs, which move by so much an event, stop under a hand that holds
/// still; and knows of no zero of axes that are called relative, so that one stays where it was
/// told last. Here every report that tells a motion gives an event, and rest is told once, by
/// zeros.
class SpnavEvents {
 public:
  using Six = std::array<double, kMotionAxes>;

  /// `sink` must outlive this.
  explicit SpnavEvents(SpnavSink& sink) noexcept : sink_(sink) {}

  /// What is to be known of a mouse before its samples; unless told, it is a SpnavDevice of no
  /// ids.
  void describe(const SpnavDevice& device);

  /// The next sample, and its velocity in parts of that at full deflection, in the sample's frame.
  void push(const MotionSample& sample, const Six& velocity);

  /// No sample comes any more: all rest, and their buttons are up.
  void end();

 private:
  struct Mouse {
    Six velocity{};
    MotionButtons buttons;  // by spacenavd's numbers, from 1 on
  };

  void tell_motion(Timestamp time);
  void tell_buttons();

  SpnavSink& sink_;
  std::map<DeviceIndex, SpnavDevice> devices_;
  std::map<DeviceIndex, Mouse> mice_;
  MotionButtons told_;
  bool moves_ = false;
  std::optional<Timestamp> last_motion_;
};

}  // namespace limn
