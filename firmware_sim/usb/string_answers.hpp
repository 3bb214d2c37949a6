#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware_sim/usb/usb_function.hpp"

namespace limn::firmware {

/// A string descriptor in which a vendor hides something, with its length and type bytes.
struct StringAnswer {
  std::uint8_t index = 0;
  std::span<const std::uint8_t> bytes;
};

/// Writes the answer with that index, cut to `out`; its bytes, or UsbFunction::kStall.
inline int answer_string(std::span<const StringAnswer> answers, std::uint8_t index,
                         std::span<std::uint8_t> out) noexcept {
  for (const StringAnswer& answer : answers) {
    if (answer.index != index) continue;
    const std::size_t bytes = std::min(answer.bytes.size(), out.size());
    std::copy_n(answer.bytes.begin(), bytes, out.begin());
    return static_cast<int>(bytes);
  }
  return UsbFunction::kStall;
}

}  // namespace limn::firmware
