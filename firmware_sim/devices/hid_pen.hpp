#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "firmware_sim/devices/pen_pose.hpp"

namespace limn::firmware {

/// What a USB device says of itself besides its reports.
struct DeviceIdentity {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::uint16_t version = 0;  ///< binary coded decimal
  std::string_view name;
};

/// A generic HID pen tablet in the form that Windows and Linux drive without a vendor driver
/// (Microsoft, "Required HID Top-Level Collections": pen). A5 landscape, 5080 lines an inch, 200
/// reports a second.
///
///     byte   bits  field                     counts           physical
///     0      8     report ID                 1
///     1      0     tip switch                0..1
///     1      1     barrel switch             0..1
///     1      2     secondary barrel switch   0..1
///     1      3     invert                    0..1
///     1      4     eraser                    0..1
///     1      5     in range                  0..1
///     1      6-7   padding
///     2-3    16    X                         0..42000         0..210 mm
///     4-5    16    Y                         0..29600         0..148 mm
///     6-7    16    tip pressure              0..8191
///     8-9    16    X tilt, signed            -9000..9000      -90..90 degrees
///     10-11  16    Y tilt, signed            -9000..9000      -90..90 degrees
///     12-13  16    scan time, wraps          0..65535         0..6.5535 s
///     14-17  32    transducer serial number  0..2^31 - 1
///
/// It tells states as that form demands: invert says that the eraser points down, eraser that it
/// touches (the tip switch then stays open), and a transducer that leaves is told once, with its
/// last position; then the device is silent.
/// Firmware: static storage, no heap, no exceptions, no RTTI. One thread.
class HidPen {
 public:
  static constexpr std::size_t kReportBytes = 18;
  static constexpr std::chrono::microseconds kReportPeriod{5000};
  static constexpr double kWidthMm = 210;
  static constexpr double kHeightMm = 148;
  static constexpr std::int32_t kCountsPerMm = 200;  ///< 5080 an inch
  static constexpr std::int32_t kPressureMaximum = 8191;
  static constexpr std::int32_t kCountsPerDegree = 100;
  static constexpr std::uint32_t kTransducerSerial = 0x4C494D4E;  ///< "LIMN" in ASCII

  /// 1209:0001 is the first of the ids that pid.codes leaves to private tests: never ship them.
  static constexpr DeviceIdentity kIdentity{0x1209, 0x0001, 0x0100, "limn Simulated Pen"};

  static std::span<const std::uint8_t> report_descriptor() noexcept;

  /// One measurement, due every kReportPeriod. Fills `report` and returns true, or returns false
  /// with `report` unmodified where the device has nothing to say: no transducer, and its leaving
  /// already told. Values outside the sensor's range are told as its limits.
  bool scan(const PenPose& pose, std::span<std::uint8_t, kReportBytes> report) noexcept;

 private:
  bool in_range_ = false;
  std::int32_t x_ = 0;  // counts, as last told
  std::int32_t y_ = 0;
};

}  // namespace limn::firmware
