#pragma once

#include "firmware_sim/devices/pen_function.hpp"

namespace limn::firmware {

/// A Wacom Intuos Pro M of 2017 over Bluetooth (056a:0360), which saves its radio: seven
/// measurements of 5 ms share one report, number 80 hex, of 361 bytes.
///
///     bytes    field
///     1-98     seven frames of 14 bytes, the oldest first; those not used are zero
///     99-106   le64 serial number
///     107-108  le16 tool
///     284      battery, percent
///
///     d0: 80 valid, 40 near, 20 in range, 10 eraser, 02 and 04 barrel switches, 01 tip
///     le16 x 1, y 3, pressure 5; s8 tilt x 7, y 8, in degrees; distance d13
///
/// A pen that leaves sends what there is, its last frame 80 alone. Source: the Linux kernel's wacom
/// driver. Firmware: static storage, no heap, no exceptions, no RTTI. One thread.
class WacomBluetooth final : public PenFunction {
 public:
  static constexpr std::chrono::microseconds kFramePeriod{5000};
  static constexpr std::size_t kFrames = 7;
  static constexpr std::size_t kFrameBytes = 14;
  static constexpr std::size_t kReportBytes = 361;
  static constexpr std::int32_t kCountsPerMm = 200;
  static constexpr std::int32_t kWidthCounts = 44800;
  static constexpr std::int32_t kHeightCounts = 29600;
  static constexpr double kWidthMm = kWidthCounts / 200.0;
  static constexpr double kHeightMm = kHeightCounts / 200.0;
  static constexpr std::int32_t kPressureMaximum = 8191;
  static constexpr std::uint32_t kSerial = 0x4C494D4E;  ///< "LIMN" in ASCII
  static constexpr std::uint16_t kProPen2 = 0x842;
  static constexpr std::uint16_t kProPen2Eraser = 0x84A;

  explicit WacomBluetooth(PenSensor& sensor) noexcept : PenFunction(sensor, kFramePeriod) {}

  const DeviceSpec& spec() const noexcept override;

 private:
  std::size_t scan(const PenPose& pose, ReportBuffer report) noexcept override;
  void restart() noexcept override;
  std::size_t send(ReportBuffer report) noexcept;

  std::array<std::uint8_t, kFrames * kFrameBytes> frames_{};
  std::size_t filled_ = 0;
  bool present_ = false;
  PenEnd end_ = PenEnd::kTip;
};

}  // namespace limn::firmware
