#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

/// The fields of a simulated device's reports, as one table that both its descriptor and its
/// encoder are made from. Source: Device Class Definition for HID 1.11, sections 5.8 and 6.2.2;
/// HID Usage Tables 1.5. Memory: constants only; no heap, exceptions or RTTI.
namespace limn::firmware {

enum class UsagePage : std::uint16_t {
  kNone = 0,
  kGenericDesktop = 0x01,
  kLed = 0x08,
  kButton = 0x09,
  kDigitizer = 0x0D,
  kVendor = 0xFF00,
};

struct Usage {
  UsagePage page = UsagePage::kNone;
  std::uint16_t id = 0;
  friend constexpr bool operator==(const Usage&, const Usage&) = default;
};

namespace usages {
inline constexpr Usage kPointer{UsagePage::kGenericDesktop, 0x01};
inline constexpr Usage kMouse{UsagePage::kGenericDesktop, 0x02};
inline constexpr Usage kMultiAxisController{UsagePage::kGenericDesktop, 0x08};
inline constexpr Usage kX{UsagePage::kGenericDesktop, 0x30};
inline constexpr Usage kY{UsagePage::kGenericDesktop, 0x31};
inline constexpr Usage kZ{UsagePage::kGenericDesktop, 0x32};
inline constexpr Usage kRx{UsagePage::kGenericDesktop, 0x33};
inline constexpr Usage kRy{UsagePage::kGenericDesktop, 0x34};
inline constexpr Usage kRz{UsagePage::kGenericDesktop, 0x35};
inline constexpr Usage kWheel{UsagePage::kGenericDesktop, 0x38};
inline constexpr Usage kDigitizer{UsagePage::kDigitizer, 0x01};
inline constexpr Usage kPen{UsagePage::kDigitizer, 0x02};
inline constexpr Usage kStylus{UsagePage::kDigitizer, 0x20};
inline constexpr Usage kTipPressure{UsagePage::kDigitizer, 0x30};
inline constexpr Usage kInRange{UsagePage::kDigitizer, 0x32};
inline constexpr Usage kInvert{UsagePage::kDigitizer, 0x3C};
inline constexpr Usage kTiltX{UsagePage::kDigitizer, 0x3D};
inline constexpr Usage kTiltY{UsagePage::kDigitizer, 0x3E};
inline constexpr Usage kTipSwitch{UsagePage::kDigitizer, 0x42};
inline constexpr Usage kBarrelSwitch{UsagePage::kDigitizer, 0x44};
inline constexpr Usage kEraser{UsagePage::kDigitizer, 0x45};
inline constexpr Usage kScanTime{UsagePage::kDigitizer, 0x56};
inline constexpr Usage kSecondaryBarrelSwitch{UsagePage::kDigitizer, 0x5A};
inline constexpr Usage kTransducerSerial{UsagePage::kDigitizer, 0x5B};
inline constexpr Usage kGenericIndicator{UsagePage::kLed, 0x4B};
inline constexpr Usage kVendor1{UsagePage::kVendor, 0x01};
constexpr Usage button(std::uint16_t number) { return {UsagePage::kButton, number}; }
}  // namespace usages

/// An inclusive range of counts (logical) or of units (physical).
struct Range {
  std::int32_t minimum = 0;
  std::int32_t maximum = 0;
  friend constexpr bool operator==(const Range&, const Range&) = default;
};

/// Physical range of a field that measures nothing: HID then uses the logical one.
inline constexpr Range kNoPhysical{0, 0};

/// The HID units that simulated devices declare, as the value of the Unit item: one nibble a base
/// quantity, the lowest naming the system. HID has no millimetre: that is a centimetre with
/// exponent -1.
enum class Unit : std::uint32_t {
  kNone = 0,
  kCentimeter = 0x11,
  kInch = 0x13,
  kDegree = 0x14,
  kSecond = 0x1001,
};

/// Power of ten that a Unit is multiplied by, -8 to 7: what the Unit Exponent item's nibble holds.
class UnitExponent {
 public:
  // Implicit, so that a field table reads as numbers. A value outside the nibble does not compile.
  consteval UnitExponent(int power)  // NOLINT(google-explicit-constructor)
      : power_(static_cast<std::int8_t>(power)) {
    if (power < -8 || power > 7) the_exponent_must_be_minus_8_to_7();
  }
  constexpr int power() const noexcept { return power_; }
  friend constexpr bool operator==(const UnitExponent&, const UnitExponent&) = default;

 private:
  static void the_exponent_must_be_minus_8_to_7();  // not constexpr: calling it stops the compiler
  std::int8_t power_;
};

/// One field of an input report.
///
///     physical = physical.minimum + (count - logical.minimum)
///                * (physical.maximum - physical.minimum) / (logical.maximum - logical.minimum)
///
/// in `unit` times 10^exponent. A field with a negative logical minimum is two's complement.
struct FieldSpec {
  Usage usage;
  std::uint16_t bit = 0;  ///< offset of the lowest bit, counted after the report ID byte
  std::uint8_t width = 0;
  Range logical;
  Range physical;
  Unit unit = Unit::kNone;
  UnitExponent exponent = 0;

  constexpr std::size_t end() const noexcept { return std::size_t{bit} + width; }
};

/// Whether every count of `logical` can be written in `width` bits (1 to 32), and it is not empty.
constexpr bool fits(Range logical, unsigned width) noexcept {
  if (width < 1 || width > 32 || logical.minimum >= logical.maximum) return false;
  const bool is_signed = logical.minimum < 0;
  const std::int64_t span = std::int64_t{1} << (is_signed ? width - 1 : width);
  return logical.minimum >= (is_signed ? -span : 0) && logical.maximum < span;
}

/// Whether the fields are in bit order, disjoint and inside `report_bits` (the report ID byte not
/// counted; whole bytes), each with a usage that no other has, counts that fit its width, and a
/// physical range wherever it has a unit.
constexpr bool is_well_formed(std::span<const FieldSpec> fields, std::size_t report_bits) noexcept {
  std::size_t free_from = 0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const FieldSpec& field = fields[i];
    if (field.bit < free_from || !fits(field.logical, field.width)) return false;
    if (field.usage.page == UsagePage::kNone) return false;
    for (std::size_t earlier = 0; earlier < i; ++earlier) {
      if (fields[earlier].usage == field.usage) return false;
    }
    const bool measures = field.physical.minimum < field.physical.maximum;
    if (!measures && field.physical != kNoPhysical) return false;
    if (measures != (field.unit != Unit::kNone)) return false;
    free_from = field.end();
  }
  return !fields.empty() && free_from <= report_bits && report_bits % 8 == 0;
}

/// Index of the field with that usage; fields.size() where there is none.
constexpr std::size_t index_of(std::span<const FieldSpec> fields, Usage usage) noexcept {
  std::size_t i = 0;
  while (i < fields.size() && fields[i].usage != usage) ++i;
  return i;
}

/// Writes `count`, limited to the field's logical range, into the field's bits of `payload` (the
/// report without its ID byte) and leaves all other bits as they are. Little-endian, bit 0 is the
/// lowest of byte 0 [HID 1.11, 5.8]. Precondition: the field lies inside `payload`.
constexpr void put_field(std::span<std::uint8_t> payload, const FieldSpec& field,
                         std::int64_t count) noexcept {
  if (count < field.logical.minimum) count = field.logical.minimum;
  if (count > field.logical.maximum) count = field.logical.maximum;
  const auto bits = static_cast<std::uint64_t>(count);
  for (std::size_t i = 0; i < field.width; ++i) {
    const std::size_t at = field.bit + i;
    const auto mask = static_cast<std::uint8_t>(1U << (at % 8));
    std::uint8_t& byte = payload[at / 8];
    byte = static_cast<std::uint8_t>((bits >> i & 1U) != 0 ? byte | mask : byte & ~mask);
  }
}

}  // namespace limn::firmware
