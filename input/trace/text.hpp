#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include "input/base/time.hpp"

// Scanning and writing of one line of text: blanks, words, numbers. Shared by all text formats.

namespace limn::text {

constexpr bool is_blank(char c) noexcept { return c == ' ' || c == '\t'; }

constexpr bool is_letter(char c) noexcept {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

/// What may stand before the first line of a UTF-8 file.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Without blanks at both ends.
std::string_view trimmed(std::string_view text) noexcept;

/// Takes the next run of characters that are not blank off `rest`, blanks before it as well; empty
/// at the end.
inline std::string_view take_word(std::string_view& rest) noexcept {
  std::size_t begin = 0;
  while (begin < rest.size() && is_blank(rest[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest.size() && !is_blank(rest[end])) ++end;
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

/// All of `word` as a whole number that fits T; leading zeros are fine, a plus sign is not.
template <class T>
std::optional<T> parse_integer(std::string_view word, int base = 10) noexcept {
  T value{};
  const char* const last = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), last, value, base);
  if (error != std::errc{} || end != last) return std::nullopt;
  return value;
}

/// All of `word` as a decimal number, which may be infinite or NaN.
std::optional<double> parse_real(std::string_view word) noexcept;

/// Seconds as digits[.digits], exact to the nanosecond; further digits are cut off. Nothing for
/// anything else, and for what does not fit a Timestamp (292 years).
std::optional<Timestamp> parse_seconds(std::string_view word) noexcept;

/// How a row of two-digit hexadecimal bytes was read.
struct HexBytes {
  std::size_t count = 0;  ///< bytes in the text, stored or not
  std::string_view bad;   ///< the first word that is no two-digit byte; empty if all are
};

/// Reads blank-separated two-digit bytes; stores the first out.size() of them.
HexBytes parse_hex_bytes(std::string_view text, std::span<std::uint8_t> out) noexcept;

/// Whether the line is a sentence that a tool or a person put among the records: printable, with a
/// small letter that no hexadecimal number has. The remains of a torn record are not.
bool is_prose(std::string_view line) noexcept;

/// `text` in quotes for an error message: at most 24 characters, none but printable ones.
std::string quoted(std::string_view text);

/// Appends `value` with at least `width` digits, zeros in front.
template <class T>
void append_number(std::string& out, T value, int base = 10, std::size_t width = 1) {
  std::array<char, 24> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, base).ptr;
  const auto count = static_cast<std::size_t>(end - digits.data());
  if (count < width) out.append(width - count, '0');
  out.append(digits.data(), count);
}

/// Appends a time in seconds: six decimals, or nine where microseconds do not say it all.
/// Precondition: not negative.
void append_seconds(std::string& out, Timestamp time);

/// Appends how many bytes there are, the bytes in hexadecimal, and the line end.
void append_counted_bytes(std::string& out, std::span<const std::uint8_t> bytes);

/// Appends `text`, its control characters made blanks, and the line end.
void append_one_line(std::string& out, std::string_view text);

/// "1 byte", "2 bytes".
std::string counted(std::uint64_t count, std::string_view noun);

}  // namespace limn::text
