#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

namespace limn::hid {

/// What a control or collection is for: a number within a usage page.
/// Source: HID Usage Tables 1.5 (usb.org); vendor pages (0xFF00 and above) from the vendors' public
/// Linux drivers.
struct Usage {
  std::uint16_t page = 0;
  std::uint16_t id = 0;

  friend constexpr auto operator<=>(const Usage&, const Usage&) = default;
};

/// Usage pages.
namespace page {
inline constexpr std::uint16_t kGenericDesktop = 0x01;
inline constexpr std::uint16_t kButton = 0x09;
inline constexpr std::uint16_t kDigitizer = 0x0D;
/// Wacom's own page. The upper byte of a usage id names the standard page whose usage it repeats:
/// 0x0130 is Generic Desktop X, 0x0042 (upper byte 0) the digitizer page's Tip Switch.
inline constexpr std::uint16_t kWacom = 0xFF0D;
/// Wacom's copies of the digitizer page, with its usage ids (Tip Switch 0x42 ..), in the raw twin
/// that its built-in pens declare beside the standard report. 0x11 is their touch screen.
inline constexpr std::uint16_t kWacomG9 = 0xFF09;
inline constexpr std::uint16_t kWacomG11 = 0xFF11;
}  // namespace page

/// Usages that limn asks for by name. Digitizer usages are those of page 0x0D.
namespace usage {
inline constexpr Usage kPointer{page::kGenericDesktop, 0x01};
inline constexpr Usage kMouse{page::kGenericDesktop, 0x02};
inline constexpr Usage kMultiAxisController{page::kGenericDesktop, 0x08};  ///< a 3D mouse
inline constexpr Usage kX{page::kGenericDesktop, 0x30};
inline constexpr Usage kY{page::kGenericDesktop, 0x31};
inline constexpr Usage kZ{page::kGenericDesktop, 0x32};

inline constexpr Usage kPen{page::kDigitizer, 0x02};
inline constexpr Usage kTouchScreen{page::kDigitizer, 0x04};
inline constexpr Usage kTouchPad{page::kDigitizer, 0x05};
inline constexpr Usage kMultiplePointDigitizer{page::kDigitizer, 0x0C};
inline constexpr Usage kStylus{page::kDigitizer, 0x20};
inline constexpr Usage kPuck{page::kDigitizer, 0x21};
inline constexpr Usage kFinger{page::kDigitizer, 0x22};
inline constexpr Usage kTabletFunctionKeys{page::kDigitizer, 0x39};
inline constexpr Usage kTipPressure{page::kDigitizer, 0x30};
inline constexpr Usage kBarrelPressure{page::kDigitizer, 0x31};
inline constexpr Usage kInRange{page::kDigitizer, 0x32};
inline constexpr Usage kDataValid{page::kDigitizer, 0x37};
inline constexpr Usage kBatteryStrength{page::kDigitizer, 0x3B};
inline constexpr Usage kInvert{page::kDigitizer, 0x3C};
inline constexpr Usage kXTilt{page::kDigitizer, 0x3D};
inline constexpr Usage kYTilt{page::kDigitizer, 0x3E};
inline constexpr Usage kAzimuth{page::kDigitizer, 0x3F};
inline constexpr Usage kAltitude{page::kDigitizer, 0x40};
inline constexpr Usage kTwist{page::kDigitizer, 0x41};
inline constexpr Usage kTipSwitch{page::kDigitizer, 0x42};
inline constexpr Usage kBarrelSwitch{page::kDigitizer, 0x44};
inline constexpr Usage kEraser{page::kDigitizer, 0x45};
inline constexpr Usage kConfidence{page::kDigitizer, 0x47};  ///< "Touch Valid" in newer tables
inline constexpr Usage kContactCount{page::kDigitizer, 0x54};
inline constexpr Usage kScanTime{page::kDigitizer, 0x56};
inline constexpr Usage kSecondaryBarrelSwitch{page::kDigitizer, 0x5A};
inline constexpr Usage kTransducerSerial{page::kDigitizer, 0x5B};
inline constexpr Usage kTransducerSerialPart2{page::kDigitizer, 0x6E};

inline constexpr Usage kWacomSense{page::kWacom, 0x36};
inline constexpr Usage kWacomSerialHigh{page::kWacom, 0x5C};
inline constexpr Usage kWacomBarrelSwitch3{page::kWacom, 0x5D};
inline constexpr Usage kWacomToolType{page::kWacom, 0x77};
inline constexpr Usage kWacomDistance{page::kWacom, 0x132};
inline constexpr Usage kWacomSequenceNumber{page::kWacom, 0x220};
inline constexpr Usage kWacomFingerWheel{page::kWacom, 0xD03};
}  // namespace usage

/// The standard usage that `usage` repeats on a vendor page (see page::kWacom, page::kWacomG9);
/// `usage` itself where it repeats none: standard pages, unknown vendors, and Wacom usages without
/// a twin (kWacomSense, kWacomSerialHigh, kWacomToolType, kWacomDistance ..).
constexpr Usage standard_usage(Usage usage) noexcept {
  if (usage.page == page::kWacomG9 || usage.page == page::kWacomG11) {
    return usage.id == 0x11 ? usage::kTouchScreen : Usage{page::kDigitizer, usage.id};
  }
  if (usage.page != page::kWacom) return usage;
  switch (usage.id) {
    case usage::kWacomSense.id:
    case usage::kWacomSerialHigh.id:
    case usage::kWacomBarrelSwitch3.id:
    case usage::kWacomToolType.id:
    case usage::kWacomDistance.id:
    case usage::kWacomSequenceNumber.id:
    case usage::kWacomFingerWheel.id:
      return usage;
    default:
      break;
  }
  const auto subpage = static_cast<std::uint16_t>(usage.id >> 8);
  const auto id = static_cast<std::uint16_t>(usage.id & 0xFF);
  if (subpage == 0) return {page::kDigitizer, id};
  if (subpage == page::kGenericDesktop && (id == usage::kX.id || id == usage::kY.id)) {
    return {page::kGenericDesktop, id};
  }
  return usage;
}

/// Whether fingers report in an application collection of this usage.
constexpr bool is_touch_application(Usage application) noexcept {
  const Usage standard = standard_usage(application);
  return standard == usage::kTouchScreen || standard == usage::kTouchPad ||
         standard == usage::kMultiplePointDigitizer;
}

/// "Digitizer", "Generic Desktop", ..; empty for a page without a name here.
std::string_view page_name(std::uint16_t page) noexcept;

/// "Tip Pressure", "Button 3", ..; "0xFF0D:0130" in hexadecimal for a usage without a name here.
std::string usage_name(Usage usage);

}  // namespace limn::hid
