#include "input/trace/text.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace limn::text {
namespace {

constexpr std::uint8_t kNoDigit = 0xFF;

constexpr std::array<std::uint8_t, 256> make_digits() {
  std::array<std::uint8_t, 256> digits{};
  digits.fill(kNoDigit);
  for (unsigned i = 0; i < 10; ++i) digits['0' + i] = static_cast<std::uint8_t>(i);
  for (unsigned i = 0; i < 6; ++i) {
    digits['a' + i] = static_cast<std::uint8_t>(10 + i);
    digits['A' + i] = static_cast<std::uint8_t>(10 + i);
  }
  return digits;
}

constexpr std::array<std::uint8_t, 256> kDigits = make_digits();

constexpr unsigned digit(char c) noexcept { return kDigits[static_cast<unsigned char>(c)]; }

constexpr bool is_decimal_digit(char c) noexcept { return c >= '0' && c <= '9'; }

constexpr bool is_printable(char c) noexcept { return (c >= ' ' && c <= '~') || c == '\t'; }

}  // namespace

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> parse_real(std::string_view word) noexcept {
  double value = 0;
  const char* const last = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), last, value);
  if (error != std::errc{} || end != last) return std::nullopt;
  return value;
}

std::optional<Timestamp> parse_seconds(std::string_view word) noexcept {
  constexpr std::int64_t kNanosecond = 1'000'000'000;
  constexpr std::int64_t kMaxSeconds = std::numeric_limits<std::int64_t>::max() / kNanosecond - 1;
  constexpr std::size_t kDecimals = 9;
  constexpr std::array<std::int64_t, kDecimals + 1> kScale = {
      1'000'000'000, 100'000'000, 10'000'000, 1'000'000, 100'000, 10'000, 1'000, 100, 10, 1};
  std::size_t i = 0;
  std::int64_t seconds = 0;
  for (; i < word.size() && word[i] != '.'; ++i) {
    if (!is_decimal_digit(word[i])) return std::nullopt;
    seconds = seconds * 10 + (word[i] - '0');
    if (seconds > kMaxSeconds) return std::nullopt;
  }
  // "1.", ".5" and "" are no times: a digit is missing where a record was torn.
  if (i == 0 || i + 1 == word.size()) return std::nullopt;
  std::int64_t fraction = 0;
  std::size_t decimals = 0;
  for (++i; i < word.size(); ++i) {
    if (!is_decimal_digit(word[i])) return std::nullopt;
    if (decimals == kDecimals) continue;
    fraction = fraction * 10 + (word[i] - '0');
    ++decimals;
  }
  return Timestamp(seconds * kNanosecond + fraction * kScale[decimals]);
}

HexBytes parse_hex_bytes(std::string_view text, std::span<std::uint8_t> out) noexcept {
  HexBytes result;
  std::size_t i = 0;
  while (i < text.size()) {
    if (is_blank(text[i])) {
      ++i;
      continue;
    }
    const bool two = i + 1 < text.size() && (i + 2 == text.size() || is_blank(text[i + 2]));
    const unsigned high = digit(text[i]);
    const unsigned low = two ? digit(text[i + 1]) : kNoDigit;
    if ((high | low) > 0xF) {
      std::string_view rest = text.substr(i);
      result.bad = take_word(rest);
      return result;
    }
    if (result.count < out.size()) {
      out[result.count] = static_cast<std::uint8_t>(high << 4 | low);
    }
    ++result.count;
    i += 2;
  }
  return result;
}

bool is_prose(std::string_view line) noexcept {
  return std::all_of(line.begin(), line.end(), is_printable) &&
         std::any_of(line.begin(), line.end(), [](char c) { return c >= 'g' && c <= 'z'; });
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 24;
  std::string result = "\"";
  for (const char c : text.substr(0, kLongest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > kLongest ? "..\"" : "\"");
}

void append_seconds(std::string& out, Timestamp time) {
  constexpr std::int64_t kNanosecond = 1'000'000'000;
  constexpr std::int64_t kMicrosecond = 1'000;
  const std::int64_t fraction = time.count() % kNanosecond;
  append_number(out, time.count() / kNanosecond);
  out += '.';
  if (fraction % kMicrosecond == 0) {
    append_number(out, fraction / kMicrosecond, 10, 6);
  } else {
    append_number(out, fraction, 10, 9);
  }
}

void append_counted_bytes(std::string& out, std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kHexadecimal = "0123456789abcdef";
  append_number(out, bytes.size());
  for (const std::uint8_t byte : bytes) {
    out += ' ';
    out += kHexadecimal[byte >> 4];
    out += kHexadecimal[byte & 0xF];
  }
  out += '\n';
}

void append_one_line(std::string& out, std::string_view text) {
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    out += code < ' ' || code == 0x7F ? ' ' : c;
  }
  out += '\n';
}

std::string counted(std::uint64_t count, std::string_view noun) {
  std::string result = std::to_string(count) + ' ';
  result.append(noun);
  if (count != 1) result += 's';
  return result;
}

}  // namespace limn::text
