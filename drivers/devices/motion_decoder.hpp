#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/devices/motion_spec.hpp"
#include "drivers/devices/report_class.hpp"
#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/field_reader.hpp"
#include "input/base/error.hpp"
#include "input/sample/motion_sample.hpp"
#include "input/sample/report.hpp"

namespace limn {

/// Whether a descriptor declares a 3D mouse: a Multi-axis Controller (Generic Desktop).
bool is_multi_axis_controller(std::span<const std::uint8_t> report_descriptor);

/// Report -> MotionSample, one decoder a device. Axes, buttons and battery lie where the descriptor
/// says. Of 3Dconnexion's devices also what it does not say: without a descriptor, and beyond it:
///
///     1     X, Y, Z as le16; in reports of 13 bytes and more Rx, Ry, Rz behind them
///     2     Rx, Ry, Rz as le16
///     3     buttons, one bit each from the lowest on
///     0x17  battery, percent
///     0x1C  the pressed buttons' numbers, le16 each, six of them; 0: none
///
/// Full deflection is the Logical Maximum (350, of older firmware 500), 350 where there is none or
/// it is only what fits into the field. Values are displacements, whatever the descriptor's
/// Relative flag says (3Dconnexion's older ones have it wrongly), and never clamped. Axes and
/// buttons beyond those of a MotionSample are left out.
///
/// A device that falls silent for kSilence in mid-motion has lost its release: its motion ends
/// then, by a sample of the stream like any other (decode() of a later report, or advance()).
///
/// decode() allocates nothing, never fails and uses + - * / only. Movable. Not thread-safe.
class MotionDecoder {
 public:
  static constexpr std::chrono::milliseconds kSilence{100};

  /// Error: kMissing where neither descriptor nor ids make it a 3D mouse; the parser's for a broken
  /// descriptor of an unknown one.
  static Expected<MotionDecoder> make(std::uint16_t vendor, std::uint16_t product,
                                      std::span<const std::uint8_t> report_descriptor);

  struct Decoded {
    ReportClass kind = ReportClass::kOther;
    std::span<const MotionSample> samples;  ///< valid until the next call
  };

  /// The samples of one report: mostly one, two where silence went before, none where the report
  /// says nothing of motion, buttons or battery.
  Decoded decode(const Report& report) noexcept;

  /// The silence that is due by `now`, if it is. Valid until the next call.
  std::span<const MotionSample> advance(Timestamp now) noexcept;
  /// When silence ends a motion unless a report comes before.
  std::optional<Timestamp> due() const noexcept;

  /// The device went away: a motion ends and buttons are released, at `time`.
  std::span<const MotionSample> disconnect(DeviceIndex device, Timestamp time) noexcept;

  /// The row of its ids, or nullptr.
  const MotionSpec* spec() const noexcept { return spec_; }

 private:
  struct Axis {
    std::size_t index = 0;
    hid::FieldReader reader;
    double full_counts = kUsualFullCounts;
  };
  struct Button {
    unsigned number = 0;
    hid::FieldReader reader;
  };

  /// What a report holds.
  struct Layout {
    std::uint8_t id = 0;
    std::vector<Axis> axes;
    std::vector<Button> buttons;
    hid::FieldReader battery;
    bool pressed_numbers = false;  // as report 0x1C
  };

  MotionDecoder() = default;
  void take_layouts(const hid::ReportDescriptor& descriptor);
  void complete_3dconnexion();
  Layout& layout(std::uint8_t id);
  const Layout* find(std::span<const std::uint8_t> report) const noexcept;
  bool read_axes(const Layout& layout, std::span<const std::uint8_t> report) noexcept;
  bool read_buttons(const Layout& layout, std::span<const std::uint8_t> report) noexcept;
  void push_silence(Timestamp time) noexcept;
  std::span<const MotionSample> pushed() const noexcept { return {out_.data(), count_}; }

  const MotionSpec* spec_ = nullptr;
  MotionFrame frame_ = MotionFrame::kDown;
  bool numbered_ = true;
  std::vector<Layout> layouts_;
  std::vector<Axis> beyond_;                // of a report 1 that is longer than its descriptor says
  std::array<double, kMotionAxes> axes_{};  // in the device's frame
  MotionSample state_;
  std::optional<Timestamp> moved_;  // its last report of axes
  std::array<MotionSample, 2> out_;
  std::size_t count_ = 0;
};

}  // namespace limn
