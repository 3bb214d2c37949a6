#include "input/trace/noted_string.hpp"

#include "input/trace/text.hpp"

namespace limn {
namespace {

constexpr std::string_view kWord = "string";

}  // namespace

std::optional<NotedString> noted_string(std::string_view note) {
  if (text::take_word(note) != kWord) return std::nullopt;
  const auto index = text::parse_integer<std::uint8_t>(text::take_word(note));
  if (!index) return std::nullopt;
  NotedString string{*index, std::vector<std::uint8_t>(NotedString::kMostBytes)};
  const auto read = text::parse_hex_bytes(note, string.bytes);
  if (!read.bad.empty() || read.count > NotedString::kMostBytes) return std::nullopt;
  string.bytes.resize(read.count);
  return string;
}

std::string note_of(const NotedString& string) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string note = std::string(kWord) + ' ' + std::to_string(string.index);
  for (const std::uint8_t byte : string.bytes) {
    note += ' ';
    note += kDigits[byte >> 4];
    note += kDigits[byte & 0xF];
  }
  return note;
}

}  // namespace limn
