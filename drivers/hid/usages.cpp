#include "drivers/hid/usages.hpp"

#include <algorithm>
#include <iterator>

namespace limn::hid {
namespace {

struct PageName {
  std::uint16_t page;
  std::string_view name;
};

// clang-format off
constexpr PageName kPages[] = {
    {0x01, "Generic Desktop"}, {0x02, "Simulation"},      {0x05, "Game"},
    {0x06, "Generic Device"},  {0x07, "Keyboard"},        {0x08, "LED"},
    {0x09, "Button"},          {0x0B, "Telephony"},       {0x0C, "Consumer"},
    {0x0D, "Digitizer"},       {0x0E, "Haptics"},         {0x0F, "Physical Input Device"},
    {0x14, "Alphanumeric Display"}, {0x20, "Sensor"},     {0x84, "Power Device"},
    {0x85, "Battery System"},  {0xFF00, "Vendor FF00"},   {0xFF09, "Wacom G9"},
    {0xFF0D, "Wacom"},         {0xFF11, "Wacom G11"},
};

struct IdName {
  Usage usage;
  std::string_view name;
};

// Sorted by page, then id.
constexpr IdName kUsages[] = {
    {{0x01, 0x01}, "Pointer"},           {{0x01, 0x02}, "Mouse"},
    {{0x01, 0x04}, "Joystick"},          {{0x01, 0x05}, "Gamepad"},
    {{0x01, 0x06}, "Keyboard"},          {{0x01, 0x07}, "Keypad"},
    {{0x01, 0x08}, "Multi-axis Controller"}, {{0x01, 0x0C}, "Wireless Radio Controls"},
    {{0x01, 0x0E}, "System Multi-Axis Controller"},
    {{0x01, 0x30}, "X"},                 {{0x01, 0x31}, "Y"},
    {{0x01, 0x32}, "Z"},                 {{0x01, 0x33}, "Rx"},
    {{0x01, 0x34}, "Ry"},                {{0x01, 0x35}, "Rz"},
    {{0x01, 0x36}, "Slider"},            {{0x01, 0x37}, "Dial"},
    {{0x01, 0x38}, "Wheel"},             {{0x01, 0x39}, "Hat Switch"},
    {{0x01, 0x3B}, "Byte Count"},        {{0x01, 0x3C}, "Motion Wakeup"},
    {{0x01, 0x48}, "Resolution Multiplier"},
    {{0x01, 0x80}, "System Control"},    {{0x01, 0x81}, "System Power Down"},
    {{0x01, 0x82}, "System Sleep"},      {{0x01, 0x83}, "System Wake Up"},
    {{0x01, 0x90}, "D-pad Up"},          {{0x01, 0x91}, "D-pad Down"},
    {{0x01, 0x92}, "D-pad Right"},       {{0x01, 0x93}, "D-pad Left"},
    {{0x01, 0xC6}, "Wireless Radio Button"},
    {{0x08, 0x01}, "Num Lock"},          {{0x08, 0x02}, "Caps Lock"},
    {{0x08, 0x03}, "Scroll Lock"},       {{0x08, 0x04}, "Compose"},
    {{0x08, 0x05}, "Kana"},              {{0x08, 0x4B}, "Generic Indicator"},
    {{0x0C, 0x01}, "Consumer Control"},  {{0x0C, 0x02}, "Numeric Key Pad"},
    {{0x0C, 0x36}, "Function Buttons"},
    {{0x0C, 0xB5}, "Scan Next Track"},   {{0x0C, 0xB6}, "Scan Previous Track"},
    {{0x0C, 0xB7}, "Stop"},              {{0x0C, 0xCD}, "Play/Pause"},
    {{0x0C, 0xE2}, "Mute"},              {{0x0C, 0xE9}, "Volume Increment"},
    {{0x0C, 0xEA}, "Volume Decrement"},  {{0x0C, 0x238}, "AC Pan"},
    {{0x0D, 0x01}, "Digitizer"},         {{0x0D, 0x02}, "Pen"},
    {{0x0D, 0x03}, "Light Pen"},         {{0x0D, 0x04}, "Touch Screen"},
    {{0x0D, 0x05}, "Touch Pad"},         {{0x0D, 0x06}, "Whiteboard"},
    {{0x0D, 0x07}, "Coordinate Measuring Machine"}, {{0x0D, 0x08}, "3D Digitizer"},
    {{0x0D, 0x09}, "Stereo Plotter"},    {{0x0D, 0x0A}, "Articulated Arm"},
    {{0x0D, 0x0B}, "Armature"},          {{0x0D, 0x0C}, "Multiple Point Digitizer"},
    {{0x0D, 0x0D}, "Free Space Wand"},   {{0x0D, 0x0E}, "Device Configuration"},
    {{0x0D, 0x0F}, "Capacitive Heat Map Digitizer"},
    {{0x0D, 0x20}, "Stylus"},            {{0x0D, 0x21}, "Puck"},
    {{0x0D, 0x22}, "Finger"},            {{0x0D, 0x23}, "Device Settings"},
    {{0x0D, 0x24}, "Character Gesture"}, {{0x0D, 0x30}, "Tip Pressure"},
    {{0x0D, 0x31}, "Barrel Pressure"},   {{0x0D, 0x32}, "In Range"},
    {{0x0D, 0x33}, "Touch"},             {{0x0D, 0x34}, "Untouch"},
    {{0x0D, 0x35}, "Tap"},               {{0x0D, 0x36}, "Quality"},
    {{0x0D, 0x37}, "Data Valid"},        {{0x0D, 0x38}, "Transducer Index"},
    {{0x0D, 0x39}, "Tablet Function Keys"}, {{0x0D, 0x3A}, "Program Change Keys"},
    {{0x0D, 0x3B}, "Battery Strength"},  {{0x0D, 0x3C}, "Invert"},
    {{0x0D, 0x3D}, "X Tilt"},            {{0x0D, 0x3E}, "Y Tilt"},
    {{0x0D, 0x3F}, "Azimuth"},           {{0x0D, 0x40}, "Altitude"},
    {{0x0D, 0x41}, "Twist"},             {{0x0D, 0x42}, "Tip Switch"},
    {{0x0D, 0x43}, "Secondary Tip Switch"}, {{0x0D, 0x44}, "Barrel Switch"},
    {{0x0D, 0x45}, "Eraser"},            {{0x0D, 0x46}, "Tablet Pick"},
    {{0x0D, 0x47}, "Touch Valid"},       {{0x0D, 0x48}, "Width"},
    {{0x0D, 0x49}, "Height"},            {{0x0D, 0x51}, "Contact Identifier"},
    {{0x0D, 0x52}, "Device Mode"},       {{0x0D, 0x53}, "Device Identifier"},
    {{0x0D, 0x54}, "Contact Count"},     {{0x0D, 0x55}, "Contact Count Maximum"},
    {{0x0D, 0x56}, "Scan Time"},         {{0x0D, 0x57}, "Surface Switch"},
    {{0x0D, 0x58}, "Button Switch"},     {{0x0D, 0x59}, "Pad Type"},
    {{0x0D, 0x5A}, "Secondary Barrel Switch"}, {{0x0D, 0x5B}, "Transducer Serial Number"},
    {{0x0D, 0x5C}, "Preferred Color"},   {{0x0D, 0x5D}, "Preferred Color is Locked"},
    {{0x0D, 0x5E}, "Preferred Line Width"}, {{0x0D, 0x5F}, "Preferred Line Width is Locked"},
    {{0x0D, 0x60}, "Latency Mode"},      {{0x0D, 0x61}, "Gesture Character Quality"},
    {{0x0D, 0x6E}, "Transducer Serial Number Part 2"},
    {{0x0D, 0x6F}, "No Preferred Color"}, {{0x0D, 0x70}, "Preferred Line Style"},
    {{0x0D, 0x71}, "Preferred Line Style is Locked"},
    {{0x0D, 0x72}, "Ink"},               {{0x0D, 0x73}, "Pencil"},
    {{0x0D, 0x74}, "Highlighter"},       {{0x0D, 0x75}, "Chisel Marker"},
    {{0x0D, 0x76}, "Brush"},             {{0x0D, 0x77}, "No Preference"},
    {{0x0D, 0x80}, "Digitizer Diagnostic"}, {{0x0D, 0x81}, "Digitizer Error"},
    {{0x0D, 0x90}, "Transducer Software Info"}, {{0x0D, 0x91}, "Transducer Vendor Id"},
    {{0x0D, 0x92}, "Transducer Product Id"}, {{0x0D, 0x93}, "Device Supported Protocols"},
    {{0x0D, 0x94}, "Transducer Supported Protocols"}, {{0x0D, 0x95}, "No Protocol"},
    {{0x0D, 0x96}, "Wacom AES Protocol"}, {{0x0D, 0x97}, "USI Protocol"},
    {{0x0D, 0x98}, "Microsoft Pen Protocol"}, {{0x0D, 0xA0}, "Supported Report Rates"},
    {{0x0D, 0xA1}, "Report Rate"},       {{0x0D, 0xA2}, "Transducer Connected"},
    {{0x0D, 0xA3}, "Switch Disabled"},   {{0x0D, 0xA4}, "Switch Unimplemented"},
    {{0x0D, 0xA5}, "Transducer Switches"}, {{0x0D, 0xA6}, "Transducer Index Selector"},
    {{0x0D, 0xB0}, "Button Press Threshold"},
    {{0x0E, 0x01}, "Simple Haptic Controller"},
    {{0xFF0D, 0x36}, "Sense"},           {{0xFF0D, 0x5C}, "Serial High"},
    {{0xFF0D, 0x5D}, "Barrel Switch 3"}, {{0xFF0D, 0x77}, "Tool Type"},
    {{0xFF0D, 0x132}, "Distance"},       {{0xFF0D, 0x136}, "Touch Strip"},
    {{0xFF0D, 0x137}, "Touch Strip 2"},  {{0xFF0D, 0x138}, "Touch Ring"},
    {{0xFF0D, 0x139}, "Touch Ring Status"}, {{0xFF0D, 0x1D0}, "Report Valid"},
    {{0xFF0D, 0x220}, "Sequence Number"}, {{0xFF0D, 0x43B}, "Battery Level"},
    {{0xFF0D, 0xD03}, "Finger Wheel"},   {{0xFF0D, 0xD30}, "Offset Left"},
    {{0xFF0D, 0xD31}, "Offset Top"},     {{0xFF0D, 0xD32}, "Offset Right"},
    {{0xFF0D, 0xD33}, "Offset Bottom"},  {{0xFF0D, 0x1002}, "Data Mode"},
    {{0xFF0D, 0x1013}, "Digitizer Info"},
};
// clang-format on

constexpr bool is_sorted_by_usage() {
  for (std::size_t i = 1; i < std::size(kUsages); ++i) {
    if (!(kUsages[i - 1].usage < kUsages[i].usage)) return false;
  }
  return true;
}
static_assert(is_sorted_by_usage(), "usage_name searches by halving");

std::string_view listed_name(Usage usage) {
  const auto* const found =
      std::lower_bound(std::begin(kUsages), std::end(kUsages), usage,
                       [](const IdName& entry, Usage wanted) { return entry.usage < wanted; });
  return found != std::end(kUsages) && found->usage == usage ? found->name : std::string_view{};
}

std::string hexadecimal(std::uint16_t value, int digits) {
  std::string text;
  for (int i = digits - 1; i >= 0; --i) text += "0123456789ABCDEF"[(value >> (4 * i)) & 0xF];
  return text;
}

}  // namespace

std::string_view page_name(std::uint16_t page) noexcept {
  for (const auto& entry : kPages) {
    if (entry.page == page) return entry.name;
  }
  return {};
}

std::string usage_name(Usage usage) {
  if (const auto name = listed_name(usage); !name.empty()) {
    return usage.page == page::kWacom ? "Wacom " + std::string(name) : std::string(name);
  }
  if (usage.page == page::kButton && usage.id > 0) return "Button " + std::to_string(usage.id);
  if (const Usage twin = standard_usage(usage); twin != usage) {
    if (const auto name = listed_name(twin); !name.empty()) return "Wacom " + std::string(name);
  }
  return "0x" + hexadecimal(usage.page, 4) + ":" + hexadecimal(usage.id, 4);
}

}  // namespace limn::hid
