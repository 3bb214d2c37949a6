#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>

#include "drivers/hid/descriptor_parser.hpp"

namespace limn::hid {

/// Reads one element of a report: a precompiled bit offset, size and sign. A regular value; the
/// default one is absent and reads nothing. Bits are numbered as in HID: bit 0 is the lowest of the
/// first byte, the report ID byte included.
///
/// Reading never allocates and checks the report's length for this element alone, so a short report
/// still gives its first elements, and a long one (several layouts in one packet) is no error.
class FieldReader {
 public:
  constexpr FieldReader() = default;

  /// For element `element` of `field`. Absent where element >= field.count, or the element is wider
  /// than 64 bits. In an array field this reads the index as sent.
  static FieldReader of_element(const Field& field, std::uint32_t element) noexcept;

  /// For one control of an array field: reads 1 while any element equals `value`, else 0. Absent
  /// where elements are wider than 64 bits.
  static FieldReader of_selection(const Field& field, std::int64_t value) noexcept;

  /// For `bit_size` (1 to 64) bits anywhere, without a logical range.
  static FieldReader of_bits(std::uint32_t bit_offset, std::uint32_t bit_size,
                             bool is_signed) noexcept;

  constexpr bool present() const noexcept { return access_ != Access::kAbsent; }
  constexpr explicit operator bool() const noexcept { return present(); }

  /// The value with its sign. Absent where this reader is absent, the report ends before the
  /// element does, or the field has a Null State and the value lies outside its logical range (the
  /// device has nothing to say; without Null State values are given as sent, never clamped).
  /// An unsigned 64-bit element above 2^63-1 comes out negative: use read_bits for serial numbers.
  std::optional<std::int64_t> read(std::span<const std::uint8_t> report) const noexcept {
    std::int64_t value = 0;
    if (!read(report, value)) return std::nullopt;
    return value;
  }

  /// The same into `value`; false, and `value` as it was, where read() gives none. An optional is
  /// written in two parts and read in one, for which processors wait; decoders ask for ten fields.
  bool read(std::span<const std::uint8_t> report, std::int64_t& value) const noexcept {
    if (report.size() < end_byte_) return false;
    if (access_ != Access::kWord || report.size() < kWordBytes) return read_slowly(report, value);
    // One load without branches: the eight bytes from the element's first on, or the report's last
    // eight, which then hold all of the element.
    const std::size_t start = std::min<std::size_t>(first_byte_, report.size() - kWordBytes);
    const std::uint64_t word = load_word(report.data() + start) >> (bit_offset() - 8 * start);
    const std::int64_t sent = with_sign(word & (~std::uint64_t{0} >> (64 - bit_size_)));
    if (null_state_ && !logical_.contains(sent)) return false;
    value = sent;
    return true;
  }

  /// The bits as sent, for serial numbers and identifiers of up to 64 bits: no sign, and no Null
  /// State, because real descriptors leave another field's logical range on them. Absent where this
  /// reader is absent or the report ends before the element does.
  std::optional<std::uint64_t> read_bits(std::span<const std::uint8_t> report) const noexcept;

  /// For switches: whether the value is there and not zero.
  bool is_set(std::span<const std::uint8_t> report) const noexcept {
    std::int64_t value = 0;
    return read(report, value) && value != 0;
  }

  /// The declared logical range; 0..0 for an absent reader. minimum > maximum means: none.
  constexpr Range logical() const noexcept { return logical_; }
  constexpr std::uint32_t bit_offset() const noexcept { return first_byte_ * 8 + shift_; }
  constexpr std::uint32_t bit_size() const noexcept { return bit_size_; }

 private:
  enum class Access : std::uint8_t { kAbsent, kWord, kBits, kSelection };

  static constexpr std::size_t kWordBytes = 8;

  /// Little-endian.
  static std::uint64_t load_word(const std::uint8_t* at) noexcept {
    std::uint64_t word = 0;
    if constexpr (std::endian::native == std::endian::little) {
      std::memcpy(&word, at, kWordBytes);
    } else {
      for (std::size_t i = kWordBytes; i-- > 0;) word = word << 8 | at[i];
    }
    return word;
  }

  std::int64_t with_sign(std::uint64_t bits) const noexcept {
    return static_cast<std::int64_t>((bits ^ sign_) - sign_);
  }

  bool read_slowly(std::span<const std::uint8_t> report, std::int64_t& value) const noexcept;
  std::optional<std::int64_t> read_selection(std::span<const std::uint8_t> report) const noexcept;

  Range logical_;
  std::uint64_t sign_ = 0;     // the sign bit; 0 where unsigned, or where all 64 bits are used
  std::int64_t selected_ = 0;  // kSelection: the index looked for
  // No report is as long as an absent reader asks for.
  std::size_t end_byte_ = std::numeric_limits<std::size_t>::max();
  std::uint32_t first_byte_ = 0;
  std::uint32_t count_ = 0;  // kSelection: elements to look at
  std::uint8_t shift_ = 0;   // of the lowest bit within first_byte_
  std::uint8_t bit_size_ = 0;
  Access access_ = Access::kAbsent;
  bool null_state_ = false;
};

}  // namespace limn::hid
