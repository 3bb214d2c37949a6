#include "firmware_sim/devices/catalogue.hpp"

#include <optional>
#include <utility>

#include "firmware_sim/devices/drawings.hpp"
#include "firmware_sim/devices/hand_sensor.hpp"
#include "firmware_sim/devices/hid_pen_tablet.hpp"
#include "firmware_sim/devices/huion.hpp"
#include "firmware_sim/devices/knob_hand.hpp"
#include "firmware_sim/devices/motions.hpp"
#include "firmware_sim/devices/space_mouse.hpp"
#include "firmware_sim/devices/space_navigator.hpp"
#include "firmware_sim/devices/wacom_bluetooth.hpp"
#include "firmware_sim/devices/wacom_intuos.hpp"
#include "firmware_sim/devices/xp_pen.hpp"
#include "firmware_sim/usb/usb_device.hpp"

namespace limn::firmware {
namespace {

/// A device behind the USB core, with its hand. `Function` is made of what `make(sensor)` returns:
/// devices point into themselves, so none is ever moved.
template <class Sensor, class Function>
class Held final : public SimulatedDevice {
 public:
  template <class Make>
  Held(Sensor&& sensor, const Make& make)
      : sensor_(std::move(sensor)), function_(make(sensor_)), device_(function_) {}
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

  BusDevice& bus() noexcept override { return device_; }
  std::chrono::microseconds duration() const noexcept override { return sensor_.duration(); }

 private:
  Sensor sensor_;
  Function function_;
  UsbDevice device_;
};

using Made = std::unique_ptr<SimulatedDevice>;
using Maker = Made (*)(std::string_view movement, std::uint64_t seed);

template <class Function, class Make>
Made make_pen(std::string_view drawing_name, std::uint64_t seed, PlanePoint size_mm,
              const Make& make) {
  const auto drawing = find_drawing(drawing_name);
  if (!drawing) return nullptr;
  return std::make_unique<Held<HandSensor, Function>>(HandSensor(*drawing, size_mm, seed), make);
}

template <class Function>
Made make_pen(std::string_view drawing, std::uint64_t seed) {
  return make_pen<Function>(drawing, seed, {Function::kWidthMm, Function::kHeightMm},
                            [](PenSensor& sensor) { return Function(sensor); });
}

template <HidPenTablet::Pace kPace>
Made make_hid_pen(std::string_view drawing, std::uint64_t seed) {
  return make_pen<HidPenTablet>(drawing, seed, {HidPen::kWidthMm, HidPen::kHeightMm},
                                [](PenSensor& sensor) { return HidPenTablet(sensor, kPace); });
}

Made make_huion(const HuionModel& model, std::string_view drawing, std::uint64_t seed) {
  constexpr double kCountsPerMm = Huion::kCountsPerMm;
  return make_pen<Huion>(drawing, seed,
                         {model.width_counts / kCountsPerMm, model.height_counts / kCountsPerMm},
                         [&model](PenSensor& sensor) { return Huion(model, sensor); });
}

Made make_inspiroy(std::string_view drawing, std::uint64_t seed) {
  return make_huion(Huion::inspiroy(), drawing, seed);
}

Made make_new_1060_plus(std::string_view drawing, std::uint64_t seed) {
  return make_huion(Huion::new_1060_plus(), drawing, seed);
}

template <class Function>
Made make_knob(std::string_view motion_name, std::uint64_t seed) {
  const auto motion = find_motion(motion_name);
  if (!motion) return nullptr;
  return std::make_unique<Held<KnobHand, Function>>(
      KnobHand(*motion, seed), [](KnobSensor& sensor) { return Function(sensor); });
}

constexpr SimulatedInfo kInfos[] = {
    {"pen", "generic HID pen tablet, 200 reports a second, with scan time", SimulatedKind::kPen},
    {"intuos", "Wacom Intuos5 M: a mouse until feature report 2 sets mode 2", SimulatedKind::kPen},
    {"huion", "Huion tablet (v2): a mouse until string 200 is read", SimulatedKind::kPen},
    {"huion-1060", "Huion New 1060 Plus (v2), without tilt", SimulatedKind::kPen},
    {"xppen", "XP-Pen Deco 01 V2: interface 2 speaks once 02 B0 04 is written to it",
     SimulatedKind::kPen},
    {"bluetooth-pen", "Wacom Intuos Pro M over Bluetooth: seven measurements a report",
     SimulatedKind::kPen},
    {"fast-pen", "generic HID pen tablet, 1000 reports a second", SimulatedKind::kPen},
    {"spacenavigator", "3Dconnexion SpaceNavigator: translations and rotations by turns",
     SimulatedKind::k3dMouse},
    {"spacemouse", "3Dconnexion SpaceMouse Wireless: all six axes in one report",
     SimulatedKind::k3dMouse},
};

constexpr Maker kMakers[] = {
    make_hid_pen<HidPenTablet::Pace::kUsual>,
    make_pen<WacomIntuos>,
    make_inspiroy,
    make_new_1060_plus,
    make_pen<XpPen>,
    make_pen<WacomBluetooth>,
    make_hid_pen<HidPenTablet::Pace::kFast>,
    make_knob<SpaceNavigator>,
    make_knob<SpaceMouse>,
};
static_assert(std::size(kInfos) == std::size(kMakers));

}  // namespace

std::span<const SimulatedInfo> simulated_devices() noexcept { return kInfos; }

std::unique_ptr<SimulatedDevice> make_simulated_device(std::string_view name,
                                                       std::string_view movement,
                                                       std::uint64_t seed) {
  for (std::size_t i = 0; i < std::size(kInfos); ++i) {
    if (kInfos[i].name == name) return kMakers[i](movement, seed);
  }
  return nullptr;
}

}  // namespace limn::firmware
