#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace limn {

/// Devices that speak alike: one decoder each, see wacom_decoder.hpp.
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
};
inline constexpr int kPenFamilyCount = 20;

/// "Intuos3", "Graphire", ..
std::string_view name(PenFamily family) noexcept;

/// One row of a vendor's table: what the device's reports do not say themselves.
struct PenSpec {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string_view name;
  PenFamily family = PenFamily::kPenPartner;
  std::int32_t x_max = 0;         ///< counts at the right edge, 0 at the left
  std::int32_t y_max = 0;         ///< counts at the edge near the user, 0 at the far one
  std::int32_t pressure_max = 0;  ///< counts
  std::int32_t distance_max = 0;  ///< counts; 0: the device gives no distance
  double counts_per_mm = 0;       ///< of both axes

  constexpr double width_mm() const noexcept { return x_max / counts_per_mm; }
  constexpr double height_mm() const noexcept { return y_max / counts_per_mm; }
};

/// All rows of all vendors, by vendor and product, each pair once.
std::span<const PenSpec> pen_specs() noexcept;

/// The row of a device, or nullptr. Logarithmic.
const PenSpec* find_pen_spec(std::uint16_t vendor, std::uint16_t product) noexcept;

}  // namespace limn
