#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace limn::fuzz {

/// The bytes of one run, taken one after the other; zeros and nothing once they are used up.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}
  bool empty() const { return rest_.empty(); }
  std::uint8_t byte() {
    const auto taken = take(1);
    return taken.empty() ? std::uint8_t{0} : taken[0];
  }
  /// Low byte first.
  std::uint16_t word() {
    const unsigned low = byte();
    return static_cast<std::uint16_t>(low | static_cast<unsigned>(byte()) << 8);
  }
  std::int32_t number() {
    const std::uint32_t low = word();
    return static_cast<std::int32_t>(low | static_cast<std::uint32_t>(word()) << 16);
  }
  /// As many as there are, at most `count`.
  std::span<const std::uint8_t> take(std::size_t count) {
    const auto taken = rest_.first(std::min(count, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }

 private:
  std::span<const std::uint8_t> rest_;
};

}  // namespace limn::fuzz
