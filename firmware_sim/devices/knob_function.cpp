#include "firmware_sim/devices/knob_function.hpp"

#include <algorithm>

#include "firmware_sim/devices/counts.hpp"

namespace limn::firmware {

void KnobFunction::reset() noexcept {
  clock_.restart();
  measured_.fill(0);
  zero_.fill(0);
  buttons_ = 0;
  zeros_left_ = 0;
  light_ = false;
  restart();
}

std::size_t KnobFunction::next_report(std::uint8_t interface, std::chrono::microseconds now,
                                      std::span<std::uint8_t> report) noexcept {
  if (interface != 0) return 0;
  while (const auto time = clock_.take(now)) {
    std::array<std::uint8_t, kMostReportBytes> made{};
    const std::size_t bytes = std::min(scan(sensor_.measure(*time), made), report.size());
    if (bytes == 0) continue;
    std::copy_n(made.begin(), bytes, report.begin());
    return bytes;
  }
  return 0;
}

std::size_t KnobFunction::scan(const KnobPose& pose, ReportBuffer report) noexcept {
  Counts counts{};
  for (std::size_t axis = 0; axis < kKnobAxes; ++axis) {
    measured_[axis] = to_counts(pose.deflection[axis], kMostCounts, -kMostCounts, kMostCounts);
    counts[axis] = std::clamp(measured_[axis] - zero_[axis], -kMostCounts, kMostCounts);
  }
  if (pose.buttons != buttons_) {
    buttons_ = pose.buttons;
    report[0] = 3;
    put_le16(report, 1, buttons_);
    return 3;
  }
  const bool rests = std::all_of(counts.begin(), counts.end(), [](auto c) { return c == 0; });
  if (!rests) zeros_left_ = kZeroReports;
  if (rests && zeros_left_-- <= 0) {
    zeros_left_ = 0;
    return 0;
  }
  return axis_report(counts, report);
}

bool KnobFunction::set_report(std::uint8_t interface, ReportKind kind, std::uint8_t id,
                              std::span<const std::uint8_t> bytes) noexcept {
  if (interface != 0 || bytes.size() < 2) return false;
  if (kind == ReportKind::kOutput && id == 4) {
    light_ = (bytes[1] & 1U) != 0;
    return true;
  }
  if (kind == ReportKind::kFeature && id == 7) {
    zero_ = measured_;
    return true;
  }
  return kind == ReportKind::kFeature && set_feature(id, bytes);
}

}  // namespace limn::firmware
