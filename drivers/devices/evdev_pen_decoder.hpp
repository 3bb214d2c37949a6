#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "drivers/devices/pen_decoder.hpp"
#include "drivers/devices/pen_output.hpp"
#include "input/base/error.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// Kernel-decoded frames (evemu) -> PenSamples, one decoder a device. The kernel sends changes
/// only, so the decoder holds every axis; a frame that changes nothing of the pen gives no sample.
///
///     ABS_X, ABS_Y                        position, 0 at the axis' minimum; raw as the kernel sent
///     ABS_PRESSURE, ABS_DISTANCE          over minimum .. maximum of the axis
///     ABS_TILT_X, ABS_TILT_Y              by the resolution (units a radian), else degrees; from 0
///                                         on (older kernels): upright in the middle of the range
///     ABS_Z                               twist of an art pen; Wacom's kernel driver turns it by a
///                                         quarter, which is undone
///     BTN_TOOL_PEN .. BTN_TOOL_LENS       tool and range; without any of them: BTN_TOUCH
///     BTN_TOUCH, BTN_STYLUS, 2, 3         contact and barrel switches; mouse buttons for mice
///     MSC_SERIAL                          serial; alone it tells that the pen reported, unmoved;
///                                         -1 is the pad's
///     SYN_DROPPED                         the kernel lost events: this frame's are void, and the
///                                         next sample has an overrun, `lost` at least 1
///
/// Axes come with their first event: until then the kernel's value is unknown.
class EvdevPenDecoder {
 public:
  /// Counts per mm (per radian of tilt) come from the device's report descriptor, where one is
  /// known and a pen in it has an axis of the kernel's very range with a unit; else from the
  /// kernel's resolution, which is that rounded to a whole number (of 2,486 pen axes 32 % are off
  /// by more than 0.5 %, the worst by 4.7 %); else from the table's row of the device. Error:
  /// kMissing naming the axis whose size nothing tells.
  static Expected<EvdevPenDecoder> make(const TraceDevice& device);

  /// The samples of one frame, valid until the next call. Allocates nothing.
  std::span<const PenSample> decode(const EvdevFrame& frame) noexcept;

  /// The device went away: what is in range leaves, at `time`.
  std::span<const PenSample> disconnect(DeviceIndex device, Timestamp time) noexcept;

  /// False for keyboards, pads and touch devices: decode gives nothing.
  bool has_pen() const noexcept { return has_pen_; }
  PenRange range() const noexcept;
  /// What the kernel's axes can give. Not kSerial, which is no axis of the kernel's.
  PenAxes axes() const noexcept;
  std::uint64_t repaired_transitions() const noexcept { return output_->machine().repaired(); }

 private:
  struct Axis {
    std::int32_t minimum = 0;
    std::int32_t maximum = 0;
    double per_unit = 1;  ///< counts per mm or radian
    double middle = 0;    ///< counts at 0 mm or 0 rad
    bool present = false;
  };

  bool has_pen_ = false;
  bool wacom_ = false;
  Axis x_;
  Axis y_;
  Axis pressure_;
  Axis distance_;
  Axis tilt_x_;
  Axis tilt_y_;
  Axis twist_;

  // The kernel's state, as its events set it.
  PenSample held_;
  bool position_moved_ = false;  ///< in this frame
  std::uint8_t tools_ = 0;       ///< bit i: the tool of code BTN_TOOL_PEN + i is down
  bool tool_key_seen_ = false;
  bool touching_ = false;
  PenButtons barrel_ = 0;
  PenButtons mouse_ = 0;
  bool dropped_ = false;
  std::unique_ptr<PenOutput> output_;

  EvdevPenDecoder();
  Expected<void> take_axes(const TraceDevice& device);
  bool apply(const EvdevEvent& event) noexcept;
  bool apply_key(std::uint16_t code, bool down) noexcept;
  bool apply_axis(std::uint16_t code, std::int32_t value) noexcept;
  PenSample current(Timestamp time) noexcept;
};

}  // namespace limn
