#include "firmware_sim/devices/pen_session.hpp"

namespace limn::firmware {

bool PenSession::next(TimedReport& report) noexcept {
  // One period beyond the hand's time, at which the pen is surely away.
  while (time_ <= hand_.duration() + HidPen::kReportPeriod) {
    PenPose pose = hand_.pose(time_);
    time_ += HidPen::kReportPeriod;
    pose.x_mm += kJitterMm * noise_.next();
    pose.y_mm += kJitterMm * noise_.next();
    if (pen_.scan(pose, report.bytes)) {
      report.time = pose.time;
      return true;
    }
  }
  return false;
}

}  // namespace limn::firmware
