#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace limn {

/// Devices that speak alike: one decode function each, see wacom_decoder.hpp (to kTabletPc) and
/// vendor_pen_decoder.hpp (the others).
enum class PenFamily : std::uint8_t {
  kPenPartner,
  kGraphire,           ///< Graphire 1 to 3, Volito, PenStation, Bamboo One
  kGraphirePad,        ///< Graphire4, first Bamboo: pad keys in the pen's report
  kGraphireBluetooth,  ///< Graphire Wireless
  kPl,                 ///< PL displays, DTF, DTU-710, DTU-1931
  kPtu,                ///< Cintiq Partner
  kDtu,                ///< DTU-1631, DTU-2231
  kDtus,               ///< DTU-1031, DTU-1141, DTK-1651
  kIntuos,             ///< Intuos, Intuos2: two tools at once
  kIntuos3,
  kIntuos4,
  kIntuos4Bluetooth,  ///< Intuos4 Wireless over Bluetooth: packets bundled
  kIntuos5,
  kIntuosPro,             ///< first Intuos Pro (2013)
  kCintiq,                ///< Cintiq 21UX to 27QHD, Companion, DTK-2241, DTH-2242
  kIntuosArt,             ///< Intuos Art, Draw, Photo, Comic (2015)
  kBamboo,                ///< Bamboo Pen and Touch, One by Wacom, Intuos Pen (2013)
  kIntuosPro2Bluetooth,   ///< Intuos Pro (2017) over Bluetooth: seven frames a report
  kIntuosSmallBluetooth,  ///< Intuos BT (2018) over Bluetooth: four frames a report
  kTabletPc,              ///< pens of notebook displays, ISDv4
  kUcLogicV1,             ///< UC-Logic, older Huion and XP-Pen, after string 100 was read
  kUcLogicV2,             ///< Huion and Gaomon, after string 200 was read
  kUgee,                  ///< XP-Pen and UGEE, after bytes to an interrupt-out endpoint
  kUgeeGen2,              ///< XP-Pen, second generation: 14 bits of pressure
  kVeikk,                 ///< VEIKK, after bytes to an interrupt-out endpoint
  kKye,                   ///< KYE (Genius), after a feature report
  kKyeMouse,              ///< KYE before that: position and buttons only
  kPenAsMouse,            ///< Huion, XP-Pen, VEIKK before that: a mouse with pressure
};
inline constexpr int kPenFamilyCount = 28;
inline constexpr PenFamily kLastWacomFamily = PenFamily::kTabletPc;

/// "Intuos3", "Graphire", ..
std::string_view name(PenFamily family) noexcept;

/// What the pens of a family can give beyond what its rows say.
struct FamilyAxes {
  bool tilt = false;
  bool twist = false;  ///< of an art pen
  bool serial = false;
};
FamilyAxes family_axes(PenFamily family) noexcept;

/// One row of a vendor's table: what the device's reports do not say themselves. A device that
/// speaks differently before and after its initialisation has a row for either, told apart by the
/// report ID. Where models share their USB ids, the conditions at the end tell rows apart.
struct PenSpec {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string_view name = {};
  PenFamily family = PenFamily::kPenPartner;
  std::int32_t x_max = 0;         ///< counts at the right edge, 0 at the left
  std::int32_t y_max = 0;         ///< counts at the edge near the user, 0 at the far one
  std::int32_t pressure_max = 0;  ///< counts; 0: the device gives no pressure
  std::int32_t distance_max = 0;  ///< counts; 0: the device gives no distance
  double counts_per_mm = 0;       ///< of both axes, of x where counts_per_mm_y differs
  double counts_per_mm_y = 0;     ///< of y; 0: as x
  bool tilt = false;              ///< the pen gives its tilt (of Wacom's, the family tells)
  /// The pen's leaving is not reported, or only once it is back: PenDecoder supplies it when no
  /// report came for kLeavingTimeout.
  bool leaves_silently = false;
  std::uint8_t report_id = 0;  ///< of this row's reports; 0: the family's

  // Conditions, for ids that several models share. Empty or 0: none.
  std::string_view firmware = {};      ///< how string 201 begins, whatever the product id
  std::string_view product_name = {};  ///< part of the device's name
  std::uint16_t descriptor_bytes = 0;  ///< length of the report descriptor

  /// What the row rests on: a recording ("recording FOLDER"), a reply of the device ("probe
  /// FOLDER"), or a public driver. Wacom's rows: see their table.
  std::string_view evidence = {};

  constexpr double y_counts_per_mm() const noexcept {
    return counts_per_mm_y > 0 ? counts_per_mm_y : counts_per_mm;
  }
  constexpr double width_mm() const noexcept { return x_max / counts_per_mm; }
  constexpr double height_mm() const noexcept { return y_max / y_counts_per_mm(); }
  constexpr bool unconditional() const noexcept {
    return firmware.empty() && product_name.empty() && descriptor_bytes == 0;
  }
};

/// All rows of all vendors, by vendor and product; of one product those without conditions first.
std::span<const PenSpec> pen_specs() noexcept;

/// The first row of a device that has no condition, or nullptr. Logarithmic.
const PenSpec* find_pen_spec(std::uint16_t vendor, std::uint16_t product) noexcept;

/// What is known of a device. Empty or 0: not known.
struct PenIdentity {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string_view product_name;   ///< as the device or the recording calls it
  std::string_view firmware = {};  ///< its string 201
  std::size_t descriptor_bytes = 0;
};

/// Most rows that apply to one device: one a report ID.
inline constexpr std::size_t kMaxPenForms = 4;

/// The rows that apply to a device, in the tables' order: the most specific one for each report ID.
/// A row with conditions applies where all of them hold. Of several, the one with a firmware
/// (the longest) beats the one with a name, this the one with a descriptor's length, and this the
/// one without conditions. Linear in the vendor's rows; meant for start.
struct PenForms {
  std::array<const PenSpec*, kMaxPenForms> rows{};
  std::size_t count = 0;
};
PenForms find_pen_forms(const PenIdentity& identity) noexcept;

/// The ID of the reports that a row speaks of; of Wacom's, which share several, 0.
std::uint8_t form_report_id(const PenSpec& spec) noexcept;

}  // namespace limn
