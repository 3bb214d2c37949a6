#pragma once

#include "firmware_sim/devices/pen_function.hpp"

namespace limn::firmware {

/// A Wacom Intuos5 M (056a:002a): a mouse until feature report 2 sets mode 2, then a pen in Wacom's
/// own form, report 2 of 10 bytes:
///
///     d1 C2  a tool enters: serial (d3 & F) << 28 | d4 << 20 | d5 << 12 | d6 << 4 | d7 >> 4,
///            tool d2 << 4 | d3 >> 4
///     d1 80  it leaves
///     d1 E0  a position: bits 1, 2 barrel switches; x = be16(2) << 1 | (d9 >> 1 & 1),
///            y = be16(4) << 1 | (d9 & 1), distance d9 >> 2,
///            pressure d6 << 3 | (d7 & C0) >> 5 | (d1 & 1),
///            tilt x ((d7 << 1 & 7E) | d8 >> 7) - 64, tilt y (d8 & 7F) - 64, in degrees
///
/// In mouse mode report 1: buttons d1 (bit 0 tip, 1 and 2 barrel switches), movement s8 d2, d3 in
/// 0.1 mm, wheel d4. Source: the Linux kernel's wacom driver.
/// Firmware: static storage, no heap, no exceptions, no RTTI. One thread.
class WacomIntuos final : public PenFunction {
 public:
  static constexpr std::chrono::microseconds kReportPeriod{5000};
  static constexpr std::int32_t kCountsPerMm = 200;
  static constexpr std::int32_t kWidthCounts = 44704;
  static constexpr std::int32_t kHeightCounts = 27940;
  static constexpr double kWidthMm = kWidthCounts / 200.0;
  static constexpr double kHeightMm = kHeightCounts / 200.0;
  static constexpr std::int32_t kPressureMaximum = 2047;
  static constexpr std::uint32_t kSerial = 0x4C494D4E;  ///< "LIMN" in ASCII
  static constexpr std::uint32_t kGripPen = 0x802;
  static constexpr std::uint32_t kGripPenEraser = 0x80A;

  explicit WacomIntuos(PenSensor& sensor) noexcept : PenFunction(sensor, kReportPeriod) {}

  const DeviceSpec& spec() const noexcept override;
  int get_report(std::uint8_t interface, ReportKind kind, std::uint8_t id,
                 std::span<std::uint8_t> out) noexcept override;
  bool set_report(std::uint8_t interface, ReportKind kind, std::uint8_t id,
                  std::span<const std::uint8_t> bytes) noexcept override;

 private:
  static constexpr std::uint8_t kMouseMode = 1;
  static constexpr std::uint8_t kPenMode = 2;

  std::size_t scan(const PenPose& pose, ReportBuffer report) noexcept override;
  void restart() noexcept override;
  std::size_t mouse_report(const PenPose& pose, ReportBuffer report) noexcept;

  std::uint8_t mode_ = kMouseMode;
  bool present_ = false;
  PenEnd end_ = PenEnd::kTip;
  PenPose last_;  // as the mouse told it, or has still to tell
};

}  // namespace limn::firmware
