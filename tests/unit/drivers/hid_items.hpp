#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/hid/usages.hpp"

namespace limn::hid::test {

/// Writes report descriptors item by item, each value in the fewest bytes unless told otherwise.
/// Knows nothing of the parser: only HID 1.11 section 6.2.2.
class Items {
 public:
  Items& usage_page(std::uint32_t page) { return unsigned_item(0x04, page); }
  Items& logical(std::int64_t minimum, std::int64_t maximum) {
    return signed_item(0x14, minimum).maximum_item(0x24, minimum, maximum);
  }
  Items& physical(std::int64_t minimum, std::int64_t maximum) {
    return signed_item(0x34, minimum).maximum_item(0x44, minimum, maximum);
  }
  Items& unit_exponent(std::uint8_t raw) { return item(0x54, raw, 1); }
  Items& unit(std::uint32_t code) { return unsigned_item(0x64, code); }
  Items& report_size(std::uint32_t bits) { return unsigned_item(0x74, bits); }
  Items& report_id(std::uint32_t id) { return unsigned_item(0x84, id); }
  Items& report_count(std::uint32_t count) { return unsigned_item(0x94, count); }
  Items& push() { return item(0xA4, 0, 0); }
  Items& pop() { return item(0xB4, 0, 0); }

  Items& usage(std::uint32_t id) { return unsigned_item(0x08, id); }
  /// Four bytes, page included.
  Items& full_usage(Usage usage) {
    return item(0x08, std::uint32_t{usage.page} << 16 | usage.id, 4);
  }
  Items& usages(std::uint32_t first, std::uint32_t last) {
    return unsigned_item(0x18, first).unsigned_item(0x28, last);
  }
  Items& delimiter(bool open) { return item(0xA8, open ? 1 : 0, 1); }

  Items& input(std::uint32_t flags) { return unsigned_item(0x80, flags); }
  Items& output(std::uint32_t flags) { return unsigned_item(0x90, flags); }
  Items& feature(std::uint32_t flags) { return unsigned_item(0xB0, flags); }
  Items& collection(std::uint32_t type) { return item(0xA0, type, 1); }
  Items& end_collection() { return item(0xC0, 0, 0); }

  /// `prefix` without its size bits; `size` is 0, 1, 2 or 4.
  Items& item(std::uint8_t prefix, std::uint32_t value, unsigned size) {
    bytes_.push_back(static_cast<std::uint8_t>(prefix | (size == 4 ? 3U : size)));
    for (unsigned i = 0; i < size; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> 8 * i));
    return *this;
  }
  Items& raw(std::initializer_list<std::uint8_t> bytes) {
    bytes_.insert(bytes_.end(), bytes);
    return *this;
  }

  std::span<const std::uint8_t> bytes() const { return bytes_; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(bytes_.size()); }

 private:
  Items& unsigned_item(std::uint8_t prefix, std::uint32_t value) {
    return item(prefix, value, value < 0x100 ? 1 : value < 0x10000 ? 2 : 4);
  }
  Items& signed_item(std::uint8_t prefix, std::int64_t value) {
    const unsigned size = value >= -0x80 && value < 0x80       ? 1
                          : value >= -0x8000 && value < 0x8000 ? 2
                                                               : 4;
    return item(prefix, static_cast<std::uint32_t>(value), size);
  }
  /// Devices write a maximum in the fewest bytes that hold it as they mean it: 255 is one byte
  /// after a minimum of 0.
  Items& maximum_item(std::uint8_t prefix, std::int64_t minimum, std::int64_t maximum) {
    if (minimum < 0) return signed_item(prefix, maximum);
    return unsigned_item(prefix, static_cast<std::uint32_t>(maximum));
  }

  std::vector<std::uint8_t> bytes_;
};

inline constexpr std::uint32_t kPhysical = 0;
inline constexpr std::uint32_t kApplication = 1;
inline constexpr std::uint32_t kLogical = 2;

inline constexpr std::uint32_t kConstant = 1;
inline constexpr std::uint32_t kVariable = 2;
inline constexpr std::uint32_t kArray = 0;
inline constexpr std::uint32_t kRelative = 4 | kVariable;
inline constexpr std::uint32_t kNullState = 0x40 | kVariable;

}  // namespace limn::hid::test
