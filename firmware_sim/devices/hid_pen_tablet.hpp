#pragma once

#include "firmware_sim/devices/hid_pen.hpp"
#include "firmware_sim/devices/pen_function.hpp"

namespace limn::firmware {

/// HidPen as a USB device: one interface, one interrupt-in endpoint. In two forms, which differ in
/// product, name and pace alone.
/// Firmware: static storage, no heap, no exceptions, no RTTI. One thread.
class HidPenTablet final : public PenFunction {
 public:
  enum class Pace { kUsual, kFast };  ///< 200, or 1000 reports a second

  static constexpr std::chrono::microseconds period(Pace pace) noexcept {
    return pace == Pace::kUsual ? HidPen::kReportPeriod : std::chrono::microseconds(1000);
  }

  /// `sensor` must outlive this.
  HidPenTablet(PenSensor& sensor, Pace pace) noexcept;
  HidPenTablet(const HidPenTablet&) = delete;  // spec_ points into it
  HidPenTablet& operator=(const HidPenTablet&) = delete;

  const DeviceSpec& spec() const noexcept override { return spec_; }

 private:
  std::size_t scan(const PenPose& pose, ReportBuffer report) noexcept override;
  void restart() noexcept override { pen_ = HidPen(); }

  InterfaceSpec interface_;
  DeviceSpec spec_;
  HidPen pen_;
};

}  // namespace limn::firmware
