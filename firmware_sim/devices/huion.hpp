#pragma once

#include "firmware_sim/devices/pen_function.hpp"
#include "firmware_sim/usb/string_answers.hpp"

namespace limn::firmware {

/// What tells one Huion tablet of the second kind from another.
struct HuionModel {
  DeviceSpec spec;
  std::span<const StringAnswer> strings;  ///< that of index 200 holds the parameters
  std::int32_t width_counts = 0;          ///< 200 a mm
  std::int32_t height_counts = 0;
  std::int32_t pressure_maximum = 0;
  bool has_tilt = false;
};

/// A Huion tablet of the second kind (v2): a mouse with pressure at interface 1 until the host
/// reads string 200, then a pen at interface 0, report 8 of 12 bytes, whatever its descriptor says:
///
///     d1: 80 in range, 04 and 02 barrel switches, 01 tip; le16 x 2, y 4, pressure 6; bits 16-23
///     of x 8, of y 9; s8 tilt x 10, minus tilt y 11, in degrees
///
/// It never tells that the pen leaves. As a mouse: report 10 of 8 bytes, d1 40 in range, 02 barrel,
/// 01 tip; le16 x 2, y 4 to 32767, pressure 6 to 2047. Strings: 200 parameters (le24 x maximum at
/// 2, y at 5, le16 pressure at 8, lines an inch at 10), 201 firmware.
/// Sources: the Linux kernel's hid-uclogic driver, recordings of DIGImend's.
/// Firmware: static storage, no heap, no exceptions, no RTTI. One thread.
class Huion final : public PenFunction {
 public:
  static constexpr std::chrono::microseconds kReportPeriod{4000};
  static constexpr std::int32_t kCountsPerMm = 200;
  static constexpr std::size_t kPenBytes = 12;
  static constexpr std::size_t kMouseBytes = 8;

  static const HuionModel& inspiroy() noexcept;       ///< 256c:006d, HUION_T191_190619, with tilt
  static const HuionModel& new_1060_plus() noexcept;  ///< 256c:006e, HUION_T174_170519

  /// Both must outlive this.
  Huion(const HuionModel& model, PenSensor& sensor) noexcept
      : PenFunction(sensor, kReportPeriod), model_(model) {}

  const DeviceSpec& spec() const noexcept override { return model_.spec; }
  int string_descriptor(std::uint8_t index, std::uint16_t language,
                        std::span<std::uint8_t> out) noexcept override;

 private:
  std::uint8_t pen_interface() const noexcept override { return is_mouse_ ? 1 : 0; }
  std::size_t scan(const PenPose& pose, ReportBuffer report) noexcept override;
  void restart() noexcept override;
  std::size_t mouse_report(const PenPose& pose, ReportBuffer report) const noexcept;

  const HuionModel& model_;
  bool is_mouse_ = true;
};

}  // namespace limn::firmware
