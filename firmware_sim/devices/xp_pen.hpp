#pragma once

#include "firmware_sim/devices/pen_function.hpp"

namespace limn::firmware {

/// An XP-Pen Deco 01 V2 (28bd:0905). Until 02 B0 04 .. is written to the interrupt-out endpoint of
/// interface 2 it is the pen that interface 1 declares, report 7 of 10 bytes, to 32767 counts;
/// then a pen at interface 2, report 2 of 12 bytes, 100 counts a mm:
///
///     d1: A0 in range (of report 2: C0 when it leaves), 08 eraser, 04 and 02 barrel switches, 01
///     tip; le16 x 2, y 4, pressure 6; s8 tilt x 8, y 9, in degrees; bits 16-23 of x 10, of y 11
///
/// Strings: 100 parameters (le16 x maximum at 2, y at 4, pressure at 8, lines an inch at 10).
/// Sources: the Linux kernel's hid-uclogic driver, recordings and probe of DIGImend's.
/// Firmware: static storage, no heap, no exceptions, no RTTI. One thread.
class XpPen final : public PenFunction {
 public:
  static constexpr std::chrono::microseconds kReportPeriod{4000};
  static constexpr std::int32_t kCountsPerMm = 100;
  static constexpr std::int32_t kWidthCounts = 25400;
  static constexpr std::int32_t kHeightCounts = 15875;
  static constexpr double kWidthMm = 254;
  static constexpr double kHeightMm = 158.75;
  static constexpr std::int32_t kPressureMaximum = 8191;
  static constexpr std::size_t kPenBytes = 12;
  static constexpr std::size_t kPlainBytes = 10;

  explicit XpPen(PenSensor& sensor) noexcept : PenFunction(sensor, kReportPeriod) {}

  const DeviceSpec& spec() const noexcept override;
  int string_descriptor(std::uint8_t index, std::uint16_t language,
                        std::span<std::uint8_t> out) noexcept override;
  bool set_report(std::uint8_t interface, ReportKind kind, std::uint8_t id,
                  std::span<const std::uint8_t> bytes) noexcept override;

 private:
  std::uint8_t pen_interface() const noexcept override { return vendor_mode_ ? 2 : 1; }
  std::size_t scan(const PenPose& pose, ReportBuffer report) noexcept override;
  void restart() noexcept override;

  bool vendor_mode_ = false;
  bool present_ = false;
};

}  // namespace limn::firmware
