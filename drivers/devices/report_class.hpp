#pragma once

#include <cstdint>
#include <string_view>

namespace limn {

/// What a report was for. Only kPen, and of 3D mice kMotion and kStatus, can come with samples;
/// kPen without any means: the pen said nothing that has a place in a sample (a tool announced
/// itself, or has not yet).
enum class ReportClass : std::uint8_t {
  kPen,
  kTouch,      ///< fingers
  kPad,        ///< keys, rings and strips of the tablet itself
  kMouse,      ///< relative mouse of a tablet outside its own mode
  kStatus,     ///< battery, wireless link, tool lists
  kOther,      ///< named by the descriptor, but nothing of the above
  kUnknownId,  ///< known neither to the descriptor nor to the device's table
  kTooShort,   ///< a pen's, but it ends before the last byte that its decoder needs
  kMotion,     ///< axes and buttons of a 3D mouse
  kNoSize,     ///< a pen's, but the descriptor gives its positions no physical size
};
inline constexpr int kReportClassCount = 10;

/// "pen", "touch", "pad", "mouse", "status", "other", "unknown report ID", "too short",
/// "motion", "pen without size".
std::string_view name(ReportClass report) noexcept;

}  // namespace limn
