#include "tests/support/simulated_tablet.hpp"

#include <linux/input.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <span>

#include "tests/support/umockdev_text.hpp"

namespace limn::test {
namespace {

constexpr char kName[] = "Simulated Tablet";
constexpr char kPhys[] = "usb-1/input0";

/// A line of an ioctl file: "EVIOCGBIT(3) 8 0300..".
std::string answer(const std::string& request, std::size_t result,
                   std::span<const std::uint8_t> bytes) {
  return request + ' ' + std::to_string(result) + ' ' + digits_of(bytes) + '\n';
}

template <class T>
std::vector<std::uint8_t> bytes_of(const T& value) {
  std::vector<std::uint8_t> bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

/// A bitmap of the size that EVIOCGBIT and EVIOCGKEY are asked for.
std::vector<std::uint8_t> bitmap(std::size_t size, const std::vector<unsigned>& set) {
  std::vector<std::uint8_t> bytes(size);
  for (const unsigned bit : set) bytes[bit / 8] |= static_cast<std::uint8_t>(1U << bit % 8);
  return bytes;
}

struct Axis {
  std::uint16_t code;
  int PenAction::*member;
  std::int32_t minimum;
  std::int32_t maximum;
  std::int32_t resolution;
};
constexpr Axis kAxes[] = {
    {ABS_X, &PenAction::x, 0, 20000, 190},
    {ABS_Y, &PenAction::y, 0, 10000, 190},
    {ABS_PRESSURE, &PenAction::pressure, 0, 1023, 0},
    {ABS_TILT_X, &PenAction::tilt_x, -64, 63, 57},
    {ABS_TILT_Y, &PenAction::tilt_y, -64, 63, 57},
};

struct Key {
  std::uint16_t code;
  bool PenAction::*member;
};
constexpr Key kKeys[] = {{BTN_TOOL_PEN, &PenAction::in_range},
                         {BTN_TOUCH, &PenAction::tip},
                         {BTN_STYLUS, &PenAction::barrel}};

// Sizes that libevdev asks for.
constexpr std::size_t kTextBytes = 255;
constexpr std::size_t kWord = sizeof(long);
constexpr std::size_t kKeyBytes = (KEY_CNT + 8 * kWord - 1) / (8 * kWord) * kWord;
constexpr std::size_t kForceFeedbackBytes = (FF_CNT + 8 * kWord - 1) / (8 * kWord) * kWord;

}  // namespace

std::string SimulatedTablet::usb_and_hid_devices() {
  return "P: " + hid_path() +
         "\nE: DRIVER=hid-generic\nE: HID_ID=0003:00001209:00000002\nE: HID_NAME=" + kName +
         "\nE: HID_PHYS=" + kPhys +
         "\nE: HID_UNIQ=\nE: SUBSYSTEM=hid\nL: driver=../../../../../bus/hid/drivers/hid-generic\n"
         "H: report_descriptor=" +
         digits_of(report_descriptor()) + "\n\nP: " + usb_path() +
         "/1-1:1.0\nE: DEVTYPE=usb_interface\nE: SUBSYSTEM=usb\nA: bInterfaceNumber=00\\n\n"
         "A: ep_81/interval=5ms\\n\n\nP: " +
         usb_path() +
         "\nN: bus/usb/001/002\nE: DEVTYPE=usb_device\nE: DEVNAME=/dev/bus/usb/001/002\n"
         "E: SUBSYSTEM=usb\nA: idVendor=1209\\n\nA: idProduct=0002\\n\nA: bcdDevice=0100\\n\n"
         "A: product=" +
         kName + "\\n\nA: manufacturer=Limn\\n\n\n";
}

std::string SimulatedTablet::hidraw_device(int number) {
  const std::string digits = std::to_string(number);
  return "P: " + hidraw_path(number) + "\nN: hidraw" + digits + "\nE: DEVNAME=/dev/hidraw" +
         digits + "\nE: MAJOR=243\nE: MINOR=" + digits +
         "\nE: SUBSYSTEM=hidraw\nA: dev=243:" + digits +
         "\\n\nL: device=../../../0003:1209:0002.0001\n\n";
}

std::string SimulatedTablet::event_device() {
  // A minor that no node of this machine has, so that its udev's notes are not taken for ours.
  return "P: " + event_path() +
         "\nN: input/event300\nE: DEVNAME=/dev/input/event300\nE: MAJOR=13\nE: MINOR=60000\n"
         "E: SUBSYSTEM=input\nA: dev=13:60000\\n\n\nP: " +
         hid_path() +
         "/input/input5\nE: SUBSYSTEM=input\n"
         "A: name=" +
         kName + "\\n\nA: phys=" + kPhys +
         "\\n\nA: id/bustype=0003\\n\nA: id/vendor=1209\\n\nA: id/product=0002\\n\n"
         "A: id/version=0100\\n\nA: capabilities/abs=d000003\\n\n"
         "A: capabilities/key=c01 0 0 0 0 0\\n\n\n";
}

std::string SimulatedTablet::hidraw_ioctls(int number) {
  return limn::test::hidraw_ioctls({.path = "/dev/hidraw" + std::to_string(number),
                                    .vendor = 0x1209,
                                    .product = 2,
                                    .report_descriptor = report_descriptor(),
                                    .name = kName,
                                    .phys = kPhys});
}

std::string SimulatedTablet::event_ioctls(const PenAction& state) {
  std::vector<unsigned> axes;
  std::vector<unsigned> keys;
  std::vector<unsigned> down;
  for (const Axis& axis : kAxes) axes.push_back(axis.code);
  for (const Key& key : kKeys) {
    keys.push_back(key.code);
    if (state.*key.member) down.push_back(key.code);
  }
  std::string text = std::string("@DEV ") + kEvent + "\n";
  text += answer("EVIOCGVERSION", 0, bytes_of(std::uint32_t{0x010001}));
  text += answer("EVIOCGID", 0, bytes_of(input_id{BUS_USB, 0x1209, 2, 0x100}));
  text +=
      "EVIOCGNAME(0) " + std::to_string(sizeof kName) + " " + digits_of(kName, kTextBytes) + "\n";
  text +=
      "EVIOCGPHYS(0) " + std::to_string(sizeof kPhys) + " " + digits_of(kPhys, kTextBytes) + "\n";
  text += "EVIOCGUNIQ(0) 1 " + digits_of("", kTextBytes) + "\n";
  text += answer("EVIOCGPROP(0)", kWord, bitmap(kWord, {}));
  text += answer("EVIOCGBIT(0)", kWord, bitmap(kWord, {EV_SYN, EV_KEY, EV_ABS, EV_MSC}));
  text += answer("EVIOCGBIT(1)", kKeyBytes, bitmap(kKeyBytes, keys));
  text += answer("EVIOCGBIT(2)", kWord, bitmap(kWord, {}));
  text += answer("EVIOCGBIT(3)", kWord, bitmap(kWord, axes));
  text += answer("EVIOCGBIT(4)", kWord, bitmap(kWord, {MSC_SERIAL}));
  for (const int type : {EV_SW, EV_LED, EV_SND}) {
    text += answer("EVIOCGBIT(" + std::to_string(type) + ")", kWord, bitmap(kWord, {}));
  }
  text += answer("EVIOCGBIT(21)", kForceFeedbackBytes, bitmap(kForceFeedbackBytes, {}));
  text += answer("EVIOCGKEY(0)", kKeyBytes, bitmap(kKeyBytes, down));
  text += answer("EVIOCGLED(0)", kWord, bitmap(kWord, {}));
  text += answer("EVIOCGSW(0)", kWord, bitmap(kWord, {}));
  for (const Axis& axis : kAxes) {
    text += answer("EVIOCGABS(" + std::to_string(axis.code) + ")", 0,
                   bytes_of(input_absinfo{state.*axis.member, axis.minimum, axis.maximum, 0, 0,
                                          axis.resolution}));
  }
  return text;
}

std::vector<std::uint8_t> SimulatedTablet::report_descriptor() {
  // clang-format off
  return {0x05, 0x0d, 0x09, 0x02, 0xa1, 0x01, 0x85, 0x01, 0x09, 0x20, 0xa1, 0x00,
          // tip, barrel, in range, 5 bits of padding
          0x09, 0x42, 0x09, 0x44, 0x09, 0x32, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x03,
          0x81, 0x02, 0x95, 0x05, 0x81, 0x03,
          // X 0..20000 over 1053, Y 0..10000 over 526 of 10^-2 cm
          0x05, 0x01, 0x55, 0x0e, 0x65, 0x11, 0x75, 0x10, 0x95, 0x01, 0x35, 0x00,
          0x26, 0x20, 0x4e, 0x46, 0x1d, 0x04, 0x09, 0x30, 0x81, 0x02,
          0x26, 0x10, 0x27, 0x46, 0x0e, 0x02, 0x09, 0x31, 0x81, 0x02,
          // pressure 0..1023
          0x05, 0x0d, 0x55, 0x00, 0x65, 0x00, 0x45, 0x00, 0x26, 0xff, 0x03, 0x09, 0x30, 0x81, 0x02,
          // tilt -64..63 degrees
          0x65, 0x14, 0x15, 0xc0, 0x25, 0x3f, 0x35, 0xc0, 0x45, 0x3f, 0x75, 0x08, 0x95, 0x02,
          0x09, 0x3d, 0x09, 0x3e, 0x81, 0x02, 0xc0, 0xc0};
  // clang-format on
}

std::vector<std::uint8_t> SimulatedTablet::report(const PenAction& action) {
  const auto low = [](int value) { return static_cast<std::uint8_t>(value & 0xFF); };
  const auto high = [](int value) { return static_cast<std::uint8_t>(value >> 8 & 0xFF); };
  const int flags = (action.tip ? 1 : 0) | (action.barrel ? 2 : 0) | (action.in_range ? 4 : 0);
  return {1,
          low(flags),
          low(action.x),
          high(action.x),
          low(action.y),
          high(action.y),
          low(action.pressure),
          high(action.pressure),
          low(action.tilt_x),
          low(action.tilt_y)};
}

std::vector<KernelEvent> SimulatedTablet::events(const PenAction& before, const PenAction& after) {
  std::vector<KernelEvent> events;
  for (const Axis& axis : kAxes) {
    if (before.*axis.member == after.*axis.member) continue;
    events.push_back({EV_ABS, axis.code, after.*axis.member});
  }
  for (const Key& key : kKeys) {
    if (before.*key.member == after.*key.member) continue;
    events.push_back({EV_KEY, key.code, after.*key.member ? 1 : 0});
  }
  events.push_back({EV_SYN, SYN_REPORT, 0});
  return events;
}

std::vector<std::uint8_t> SimulatedTablet::bytes(const std::vector<KernelEvent>& events) {
  std::vector<std::uint8_t> all;
  for (const KernelEvent& event : events) {
    input_event raw{};
    raw.type = event.type;
    raw.code = event.code;
    raw.value = event.value;
    const auto bytes = bytes_of(raw);
    all.insert(all.end(), bytes.begin(), bytes.end());
  }
  return all;
}

}  // namespace limn::test
