#include "drivers/hid/units.hpp"

#include <algorithm>
#include <array>
#include <numbers>

namespace limn::hid {
namespace {

constexpr double kMmPerCm = 10.0;
constexpr double kMmPerInch = 25.4;
constexpr double kRadPerDegree = std::numbers::pi / 180;
constexpr double kNewtonPerDyne = 1e-5;
constexpr double kDegreesPerTurn = 360.0;
constexpr double kWidestTiltDegrees = 127.0;      // what an 8-bit tilt without unit declares
constexpr double kScanTimeCountsPerSecond = 1e4;  // 100 us a count

// Unit codes (HID 1.11 section 6.2.2.7): the lowest nibble names the system, the others hold the
// powers of length or angle, mass, time, temperature, current and luminous intensity.
constexpr std::uint32_t kCentimeter = 0x11;
constexpr std::uint32_t kRadian = 0x12;
constexpr std::uint32_t kInch = 0x13;
constexpr std::uint32_t kDegree = 0x14;
constexpr std::uint32_t kCubicInch = 0x33;  // always meant as inch
constexpr std::uint32_t kDyne = 0xE111;
constexpr std::uint32_t kSystemMask = 0xF;
constexpr std::uint32_t kSecondsOfAnySystem = 0x1000;
constexpr std::uint32_t kLastSystem = 4;

/// What one declared unit is in limn's unit of its quantity.
double limn_units(std::uint32_t unit) noexcept {
  switch (unit) {
    case kCentimeter:
      return kMmPerCm;
    case kInch:
    case kCubicInch:
      return kMmPerInch;
    case kDegree:
      return kRadPerDegree;
    case kDyne:
      return kNewtonPerDyne;
    default:
      return 1.0;
  }
}

/// value * 10^exponent. Powers up to 10^22 are exact, so the usual ones cost one rounding.
double scale_by_ten(double value, int exponent) noexcept {
  double power = 1.0;
  for (int i = 0; i < (exponent < 0 ? -exponent : exponent); ++i) power *= 10.0;
  return exponent < 0 ? value / power : value * power;
}

double span_of(Range range) noexcept { return static_cast<double>(range.maximum - range.minimum); }

bool has_span(Range range) noexcept { return range.maximum > range.minimum; }

bool has_spans(const Field& field) noexcept {
  return has_span(field.logical) && has_span(physical_range(field));
}

double widest_degrees(const Field& field, const LinearMap& map) noexcept {
  const double low = map(field.logical.minimum) / kRadPerDegree;
  const double high = map(field.logical.maximum) / kRadPerDegree;
  return std::max({low, -low, high, -high});
}

/// Counts that are degrees, tenths or hundredths: the largest step that keeps within `limit`.
LinearMap undeclared_angle(const Field& field, double limit) noexcept {
  constexpr std::array<double, 3> kStepsPerDegree = {1.0, 10.0, 100.0};
  const auto extreme = static_cast<double>(std::max(-field.logical.minimum, field.logical.maximum));
  LinearMap map;
  for (const double steps : kStepsPerDegree) {
    map.scale = kRadPerDegree / steps;
    if (extreme / steps <= limit) break;
  }
  return map;
}

}  // namespace

Quantity quantity(std::uint32_t unit) noexcept {
  const std::uint32_t system = unit & kSystemMask;
  if (unit == 0) return Quantity::kNone;
  switch (unit) {
    case kCentimeter:
    case kInch:
    case kCubicInch:
      return Quantity::kLength;
    case kRadian:
    case kDegree:
      return Quantity::kAngle;
    case kDyne:
      return Quantity::kForce;
    default:
      break;
  }
  const bool is_time =
      (unit & ~kSystemMask) == kSecondsOfAnySystem && system >= 1 && system <= kLastSystem;
  return is_time ? Quantity::kTime : Quantity::kOther;
}

std::string unit_name(std::uint32_t unit) {
  switch (quantity(unit)) {
    case Quantity::kNone:
      return {};
    case Quantity::kLength:
      return unit == kCentimeter ? "cm" : "inch";
    case Quantity::kAngle:
      return unit == kRadian ? "rad" : "deg";
    case Quantity::kTime:
      return "s";
    case Quantity::kForce:
      return "dyn";
    case Quantity::kOther:
      break;
  }
  std::string digits;
  for (std::uint32_t rest = unit; rest != 0; rest >>= 4) {
    digits.insert(digits.begin(), "0123456789ABCDEF"[rest & 0xF]);
  }
  return "unit 0x" + digits;
}

Range physical_range(const Field& field) noexcept {
  return field.physical == Range{} ? field.logical : field.physical;
}

std::optional<LinearMap> physical_map(const Field& field, Quantity wanted) noexcept {
  if (quantity(field.unit) != wanted || !has_spans(field)) return std::nullopt;
  const Range physical = physical_range(field);
  const std::int64_t physical_span = physical.maximum - physical.minimum;
  const std::int64_t logical_span = field.logical.maximum - field.logical.minimum;
  const double unit = limn_units(field.unit);
  LinearMap map;
  map.scale = scale_by_ten(span_of(physical), field.unit_exponent) * unit / span_of(field.logical);
  // The physical minimum in counts: minima have 32 bits and spans 33, so this cannot overflow.
  const std::int64_t scaled_minimum = physical.minimum * logical_span;
  if (scaled_minimum % physical_span == 0) {
    // Zero lies on a count, which then gives exactly 0: an upright pen has no tilt.
    const std::int64_t counts_to_zero = scaled_minimum / physical_span;
    map.origin = static_cast<double>(field.logical.minimum - counts_to_zero);
  } else {
    map.origin = static_cast<double>(field.logical.minimum);
    map.offset = scale_by_ten(static_cast<double>(physical.minimum), field.unit_exponent) * unit;
  }
  return map;
}

std::optional<LinearMap> position_map(const Field& field) noexcept {
  auto map = physical_map(field, Quantity::kLength);
  if (map) {
    map->origin = static_cast<double>(field.logical.minimum);
    map->offset = 0;
  }
  return map;
}

LinearMap angle_map(const Field& field, bool full_turn) noexcept {
  const double limit = full_turn ? kDegreesPerTurn : kWidestTiltDegrees;
  constexpr double kRounding = 1e-9;  // degrees; the declared ends may sit on the limit
  if (const auto map = physical_map(field, Quantity::kAngle);
      map && widest_degrees(field, *map) <= limit + kRounding) {
    return *map;
  }
  return undeclared_angle(field, limit);
}

LinearMap time_map(const Field& field) noexcept {
  if (const auto map = physical_map(field, Quantity::kTime)) return *map;
  return {0, 1 / kScanTimeCountsPerSecond, 0};
}

LinearMap unit_interval_map(const Field& field) noexcept {
  const double span = has_span(field.logical) ? span_of(field.logical) : 1.0;
  return {static_cast<double>(field.logical.minimum), 1.0 / span, 0};
}

std::optional<double> resolution(const Field& field) noexcept {
  if (quantity(field.unit) == Quantity::kNone || !has_spans(field)) return std::nullopt;
  return span_of(field.logical) / scale_by_ten(span_of(physical_range(field)), field.unit_exponent);
}

std::optional<double> counts_per_mm(const Field& field) noexcept {
  if (quantity(field.unit) != Quantity::kLength) return std::nullopt;
  const auto per_unit = resolution(field);
  if (!per_unit) return std::nullopt;
  return *per_unit / limn_units(field.unit);
}

}  // namespace limn::hid
