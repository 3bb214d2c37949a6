#include "firmware_sim/devices/pen_function.hpp"

#include <algorithm>

namespace limn::firmware {

void PenFunction::reset() noexcept {
  clock_.restart();
  restart();
}

std::size_t PenFunction::next_report(std::uint8_t interface, std::chrono::microseconds now,
                                     std::span<std::uint8_t> report) noexcept {
  if (interface != pen_interface()) return 0;
  while (const auto time = clock_.take(now)) {
    report_.fill(0);
    const std::size_t bytes = std::min(scan(sensor_.measure(*time), report_), report.size());
    if (bytes == 0) continue;
    std::copy_n(report_.begin(), bytes, report.begin());
    return bytes;
  }
  return 0;
}

}  // namespace limn::firmware
