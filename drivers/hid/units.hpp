#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/hid/descriptor_parser.hpp"

namespace limn::hid {

/// What a HID unit code measures, as far as limn converts it.
enum class Quantity : std::uint8_t {
  kNone,    ///< no unit declared
  kLength,  ///< 0x11 centimetre, 0x13 inch, 0x33 (read as inch: a common mistake)
  kAngle,   ///< 0x12 radian, 0x14 degree
  kTime,    ///< 0x1001 .. 0x1004 second
  kForce,   ///< 0xE111 g cm/s^2 (10^-5 N)
  kOther,   ///< any other unit: kept, not converted
};

Quantity quantity(std::uint32_t unit) noexcept;

/// "cm", "inch", "deg", "rad", "s", "dyn" as declared (without the exponent); "unit 0x.." for
/// kOther; empty for kNone.
std::string unit_name(std::uint32_t unit);

/// value = (counts - origin) * scale + offset. Exactly these operations in this order, so that the
/// bits are the same on every machine.
struct LinearMap {
  double origin = 0;
  double scale = 1;
  double offset = 0;

  constexpr double operator()(std::int64_t counts) const noexcept {
    return (static_cast<double>(counts) - origin) * scale + offset;
  }
  friend constexpr bool operator==(const LinearMap&, const LinearMap&) = default;
};

/// The physical range, or the logical one where the physical one is 0..0.
Range physical_range(const Field& field) noexcept;

/// Counts to the declared quantity in limn's units: mm, rad, s or N, with the physical minimum at
/// the logical minimum. Absent unless the field declares `wanted` and both ranges are well formed
/// (maximum above minimum).
std::optional<LinearMap> physical_map(const Field& field, Quantity wanted) noexcept;

/// Counts to mm with 0 at the Logical Minimum, whatever the physical minimum is.
std::optional<LinearMap> position_map(const Field& field) noexcept;

/// Counts of a tilt, azimuth, altitude or twist to radians. Where the field declares no angle, its
/// counts are degrees, tenths or hundredths: the largest of these steps that brings the logical
/// range within a full turn for `full_turn` axes (azimuth, twist), else within 127 degrees.
/// A field with an angle unit but without a usable range falls back to the same.
LinearMap angle_map(const Field& field, bool full_turn) noexcept;

/// Counts of a scan time to seconds; 100 us a count where no unit is declared (HID Usage Tables).
LinearMap time_map(const Field& field) noexcept;

/// Counts to 0 .. 1 over the logical range; values outside it leave that interval.
LinearMap unit_interval_map(const Field& field) noexcept;

/// (Lmax - Lmin) / ((Pmax - Pmin) 10^exponent): counts per declared unit (HID 1.11
/// section 6.2.2.7). Absent where a range is malformed or no unit is declared.
std::optional<double> resolution(const Field& field) noexcept;

/// Counts per mm of a field that declares a length. Lines per inch is this times 25.4.
std::optional<double> counts_per_mm(const Field& field) noexcept;

}  // namespace limn::hid
