#include "drivers/devices/report_class.hpp"

#include <array>

namespace limn {

std::string_view name(ReportClass report) noexcept {
  constexpr std::array<std::string_view, kReportClassCount> kNames = {"pen",
                                                                      "touch",
                                                                      "pad",
                                                                      "mouse",
                                                                      "status",
                                                                      "other",
                                                                      "unknown report ID",
                                                                      "too short",
                                                                      "motion",
                                                                      "pen without size"};
  return kNames[static_cast<std::size_t>(report)];
}

}  // namespace limn
