#include "drivers/hid/field_reader.hpp"

#include <algorithm>

#include "input/base/expect.hpp"

namespace limn::hid {
namespace {

constexpr std::uint32_t kMaxReadableBits = 64;

/// `bit_size` (1 to 64) bits from bit `shift` (0 to 7) of at[0] on; all of them must be there.
std::uint64_t gather(const std::uint8_t* at, std::uint32_t shift, std::uint32_t bit_size) noexcept {
  const std::uint32_t bytes = (shift + bit_size + 7) / 8;  // 9 at most
  std::uint64_t value = 0;
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(bytes, 8); ++i) {
    value |= std::uint64_t{at[i]} << (8 * i);
  }
  value >>= shift;
  if (bytes == 9) value |= std::uint64_t{at[8]} << (64 - shift);  // shift is 1 or more here
  return bit_size == 64 ? value : value & ((std::uint64_t{1} << bit_size) - 1);
}

}  // namespace

FieldReader FieldReader::of_bits(std::uint32_t bit_offset, std::uint32_t bit_size,
                                 bool is_signed) noexcept {
  LIMN_EXPECT(bit_size >= 1 && bit_size <= kMaxReadableBits);
  FieldReader reader;
  reader.first_byte_ = bit_offset / 8;
  reader.shift_ = static_cast<std::uint8_t>(bit_offset % 8);
  reader.bit_size_ = static_cast<std::uint8_t>(bit_size);
  reader.end_byte_ = (std::size_t{bit_offset} + bit_size + 7) / 8;
  if (is_signed && bit_size < 64) reader.sign_ = std::uint64_t{1} << (bit_size - 1);
  reader.logical_ = {0, -1};  // none
  reader.access_ = reader.shift_ + bit_size <= 64 ? Access::kWord : Access::kBits;
  return reader;
}

FieldReader FieldReader::of_element(const Field& field, std::uint32_t element) noexcept {
  if (element >= field.count || field.bit_size > kMaxReadableBits) return {};
  FieldReader reader =
      of_bits(field.bit_offset + element * field.bit_size, field.bit_size, field.is_signed());
  reader.logical_ = field.logical;
  reader.null_state_ = field.flags.null_state() && field.logical.minimum <= field.logical.maximum;
  return reader;
}

FieldReader FieldReader::of_selection(const Field& field, std::int64_t value) noexcept {
  FieldReader reader = of_element(field, 0);
  if (!reader) return reader;
  reader.access_ = Access::kSelection;
  reader.count_ = field.count;
  reader.selected_ = value;
  reader.null_state_ = false;
  reader.logical_ = {0, 1};
  return reader;
}

std::optional<std::int64_t> FieldReader::read_selection(
    std::span<const std::uint8_t> report) const noexcept {
  std::size_t bit = std::size_t{first_byte_} * 8 + shift_;
  for (std::uint32_t i = 0; i < count_; ++i, bit += bit_size_) {
    if ((bit + bit_size_ + 7) / 8 > report.size()) return std::nullopt;  // it may be in the rest
    const std::uint64_t bits =
        gather(report.data() + bit / 8, static_cast<std::uint32_t>(bit % 8), bit_size_);
    if (with_sign(bits) == selected_) return 1;
  }
  return 0;
}

bool FieldReader::read_slowly(std::span<const std::uint8_t> report,
                              std::int64_t& value) const noexcept {
  if (access_ == Access::kAbsent) return false;
  if (access_ == Access::kSelection) {
    const auto selected = read_selection(report);
    value = selected.value_or(value);
    return selected.has_value();
  }
  const std::int64_t sent = with_sign(gather(report.data() + first_byte_, shift_, bit_size_));
  if (null_state_ && !logical_.contains(sent)) return false;
  value = sent;
  return true;
}

std::optional<std::uint64_t> FieldReader::read_bits(
    std::span<const std::uint8_t> report) const noexcept {
  if (report.size() < end_byte_) return std::nullopt;
  if (access_ == Access::kSelection) {
    const auto selected = read_selection(report);
    if (!selected) return std::nullopt;
    return static_cast<std::uint64_t>(*selected);
  }
  return gather(report.data() + first_byte_, shift_, bit_size_);
}

}  // namespace limn::hid
