#include "firmware_sim/devices/hid_pen_tablet.hpp"

namespace limn::firmware {
namespace {

constexpr EndpointSpec kUsualEndpoint[] = {{0x81, 32, 4}};
constexpr EndpointSpec kFastEndpoint[] = {{0x81, 32, 1}};

}  // namespace

HidPenTablet::HidPenTablet(PenSensor& sensor, Pace pace) noexcept
    : PenFunction(sensor, period(pace)) {
  const bool fast = pace == Pace::kFast;
  interface_.report_descriptor = HidPen::report_descriptor();
  interface_.endpoints = fast ? kFastEndpoint : kUsualEndpoint;
  spec_.vendor = HidPen::kIdentity.vendor;
  // The next of the ids that pid.codes leaves to private tests.
  spec_.product = fast ? 0x0002 : HidPen::kIdentity.product;
  spec_.version = HidPen::kIdentity.version;
  spec_.manufacturer = "limn";
  spec_.product_name = fast ? "Simulated Fast Pen" : "Simulated Pen";
  spec_.interfaces = {&interface_, 1};
}

std::size_t HidPenTablet::scan(const PenPose& pose, ReportBuffer report) noexcept {
  return pen_.scan(pose, report.first<HidPen::kReportBytes>()) ? HidPen::kReportBytes : 0;
}

}  // namespace limn::firmware
