#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/devices/motion_spec.hpp"
#include "input/sample/motion_sample.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// Kernel-decoded frames of a 3D mouse, and what spacenavd gives -> MotionSamples.
///
///     ABS_X .. ABS_RZ   deflections; the kernel tells changes only, so others are held, though
///                       none for longer than kLongestHold: then its release is lost
///     REL_X .. REL_RZ   deflections as well: old devices call their axes relative. The kernel
///                       never tells a zero: of a half that it tells, the others are zero, and
///                       what it has not told for kRelativeSilence is released
///     BTN_0 ..          button 1 ..
///     SYN_DROPPED       the kernel lost events: this frame's are void, and the next sample has
///                       an overrun, `lost` at least 1
///
/// Full deflection is that of the axis' range (full_counts); of spacenavd, whose axes point
/// elsewhere, 500. Allocates nothing but when it is made. Not thread-safe.
class EvdevMotionDecoder {
 public:
  /// Two and a half periods of a SpaceNavigator's half.
  static constexpr std::chrono::milliseconds kRelativeSilence{40};
  static constexpr std::chrono::seconds kLongestHold{60};

  /// For a device that traits_of() calls a 3D mouse.
  explicit EvdevMotionDecoder(const TraceDevice& device);

  /// What one frame says: at most two samples, the first of them what silence before it meant.
  /// Valid until the next call.
  std::span<const MotionSample> decode(const EvdevFrame& frame) noexcept;

  /// The silence that is due by `now`, if it is.
  std::span<const MotionSample> advance(Timestamp now) noexcept;
  std::optional<Timestamp> due() const noexcept;

  /// The device went away: a motion ends and buttons are released, at `time`.
  std::span<const MotionSample> disconnect(DeviceIndex device, Timestamp time) noexcept;

 private:
  using Half = std::size_t;

  void set(std::size_t axis, std::int32_t count) noexcept;
  void release(Half half) noexcept;
  void stop(Timestamp time) noexcept;
  void push(Timestamp time) noexcept;
  std::span<const MotionSample> pushed() const noexcept { return {out_.data(), count_}; }

  MotionFrame frame_ = MotionFrame::kDown;
  std::array<double, kMotionAxes> full_counts_{};
  std::array<double, kMotionAxes> axes_{};  // in the device's frame
  MotionSample state_;
  std::array<std::optional<Timestamp>, 2> relative_;  // when it told each half last
  std::optional<Timestamp> moved_;                    // its last frame of axes
  bool dropped_ = false;
  std::array<MotionSample, 2> out_;
  std::size_t count_ = 0;
};

}  // namespace limn
