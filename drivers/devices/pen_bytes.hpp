#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>

#include "input/sample/pen_sample.hpp"

namespace limn::pen_bytes {

using Bytes = std::span<const std::uint8_t>;

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

constexpr std::int32_t le16(Bytes b, std::size_t at) noexcept { return b[at] | b[at + 1] << 8; }
constexpr std::int32_t be16(Bytes b, std::size_t at) noexcept { return b[at] << 8 | b[at + 1]; }
constexpr std::int32_t signed8(std::uint8_t byte) noexcept {
  return byte < 128 ? byte : byte - 256;
}
constexpr bool has(std::uint8_t byte, unsigned mask) noexcept { return (byte & mask) != 0; }

/// Bit `number` (from 0) of PenButtons where `pressed`.
constexpr PenButtons button(bool pressed, unsigned number) noexcept {
  return static_cast<PenButtons>(pressed ? 1U << number : 0U);
}

constexpr PenButtons buttons(bool first, bool second) noexcept {
  return static_cast<PenButtons>(button(first, 0) | button(second, 1));
}

constexpr PenButtons buttons(bool first, bool second, bool third, bool fourth = false,
                             bool fifth = false) noexcept {
  return static_cast<PenButtons>(buttons(first, second) | button(third, 2) | button(fourth, 3) |
                                 button(fifth, 4));
}

}  // namespace limn::pen_bytes
