#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

namespace limn::firmware {

/// The nearest count, halves upwards, limited to 32 bits. No libm, so the same on every machine.
constexpr std::int32_t to_counts(double value, double counts_per_unit) noexcept {
  constexpr double kLimit = 2e9;
  const double scaled = std::clamp(value * counts_per_unit + 0.5, -kLimit, kLimit);
  const auto toward_zero = static_cast<std::int32_t>(scaled);
  return toward_zero - (static_cast<double>(toward_zero) > scaled ? 1 : 0);
}

/// The same, limited to a sensor's range.
constexpr std::int32_t to_counts(double value, double counts_per_unit, std::int32_t minimum,
                                 std::int32_t maximum) noexcept {
  return std::clamp(to_counts(value, counts_per_unit), minimum, maximum);
}

/// The low byte of a count, two's complement, and the others as vendors' reports are put together.
constexpr std::uint8_t byte_of(std::int32_t count, unsigned index = 0) noexcept {
  return static_cast<std::uint8_t>(static_cast<std::uint32_t>(count) >> (8 * index) & 0xFFU);
}

/// Writes a count as 16 bits, the low byte first. Precondition: at + 2 <= report.size().
constexpr void put_le16(std::span<std::uint8_t> report, std::size_t at,
                        std::int32_t count) noexcept {
  report[at] = byte_of(count, 0);
  report[at + 1] = byte_of(count, 1);
}

}  // namespace limn::firmware
