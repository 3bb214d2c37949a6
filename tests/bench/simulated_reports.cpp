#include "tests/bench/simulated_reports.hpp"

#include <cmath>
#include <numbers>

#include "firmware_sim/devices/hid_pen.hpp"

namespace limn::bench {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::chrono::milliseconds kPeriod{5};

struct Place {
  double x_mm;
  double y_mm;
  double pressure;
};

// Circles of 30 mm about the middle of an A5 tablet, one a second, the pressure swelling.
Place place(std::size_t i) {
  const double a = 2 * std::numbers::pi * static_cast<double>(i) / 200;
  return {105 + 30 * std::cos(a), 74 + 30 * std::sin(a), 0.5 + 0.4 * std::sin(0.37 * a)};
}

std::uint8_t byte(std::uint32_t value) { return static_cast<std::uint8_t>(value & 0xffU); }

// Type "pen", in proximity. The least bits of x, y and pressure have places of their own.
Bytes intuos_packet(const Place& p) {
  constexpr double kCountsPerMm = 200;
  constexpr std::uint32_t kLevelTilt = 64;
  const auto x = static_cast<std::uint32_t>(p.x_mm * kCountsPerMm);
  const auto y = static_cast<std::uint32_t>(p.y_mm * kCountsPerMm);
  const auto pressure = static_cast<std::uint32_t>(p.pressure * 2047);
  return {0x02,
          byte(0xe0 | (pressure & 1)),
          byte(x >> 9),
          byte(x >> 1),
          byte(y >> 9),
          byte(y >> 1),
          byte(pressure >> 3),
          byte(((pressure >> 1) & 3) << 6 | kLevelTilt >> 1),
          byte((kLevelTilt & 1) << 7 | kLevelTilt),
          byte((x & 1) << 1 | (y & 1))};
}

}  // namespace

Report ReportStream::report(std::size_t i) const { return {0, kPeriod * i, reports[i]}; }

ReportStream generic_pen_stream(std::size_t count) {
  firmware::HidPen pen;
  const auto descriptor = firmware::HidPen::report_descriptor();
  ReportStream stream{"generic HID pen",
                      firmware::HidPen::kIdentity.vendor,
                      firmware::HidPen::kIdentity.product,
                      Bytes(descriptor.begin(), descriptor.end()),
                      {}};
  for (std::size_t i = 0; i < count; ++i) {
    const Place p = place(i);
    firmware::PenPose pose;
    pose.time = firmware::HidPen::kReportPeriod * i;
    pose.proximity = firmware::Proximity::kTouching;
    pose.x_mm = p.x_mm;
    pose.y_mm = p.y_mm;
    pose.pressure = p.pressure;
    std::array<std::uint8_t, firmware::HidPen::kReportBytes> report{};
    if (pen.scan(pose, report)) stream.reports.emplace_back(report.begin(), report.end());
  }
  return stream;
}

ReportStream wacom_intuos_stream(std::size_t count) {
  // Tool enters: stylus 0x802 with a serial number.
  const Bytes enter = {0x02, 0xc2, 0x80, 0x21, 0x23, 0x45, 0x67, 0x80, 0x00, 0x00};
  ReportStream stream{"Wacom Intuos5 touch M", 0x056a, 0x0027, {}, {enter}};
  for (std::size_t i = 0; i < count; ++i) stream.reports.push_back(intuos_packet(place(i)));
  return stream;
}

}  // namespace limn::bench
