#include "input/trace/format_detection.hpp"

#include <algorithm>

#include "input/trace/stroke_csv_reader.hpp"
#include "input/trace/text.hpp"
#include "input/trace/usbhid_dump_reader.hpp"

namespace limn {
namespace {

bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

std::size_t word_count(std::string_view text) {
  std::size_t count = 0;
  while (!text::take_word(text).empty()) ++count;
  return count;
}

/// hid-recorder's "E: time length bytes" against evemu's "E: time type code value": the length is
/// decimal without padding and bytes have two digits; type and code have four digits.
std::optional<TraceFormat> format_of_event(std::string_view rest) {
  constexpr std::size_t kCodeDigits = 4;
  if (!text::parse_seconds(text::take_word(rest))) return std::nullopt;
  const std::string_view first = text::take_word(rest);
  const std::string_view second = text::take_word(rest);
  if (first.size() == kCodeDigits && second.size() == kCodeDigits) return TraceFormat::kEvemu;
  const bool has_length = text::parse_integer<std::uint32_t>(first).has_value();
  if (has_length && (second.empty() || second.size() == 2)) return TraceFormat::kHidRecorder;
  return std::nullopt;
}

/// `I: bus vendor product` against evemu's `I: bus vendor product version`.
std::optional<TraceFormat> format_of_ids(std::string_view rest) {
  switch (word_count(rest)) {
    case 3:
      return TraceFormat::kHidRecorder;
    case 4:
      return TraceFormat::kEvemu;
    default:
      return std::nullopt;
  }
}

std::optional<TraceFormat> format_of_keyed_line(char key, std::string_view rest) {
  switch (key) {
    case 'D':
    case 'R':
      if (!text::parse_integer<std::uint32_t>(text::take_word(rest))) return std::nullopt;
      return TraceFormat::kHidRecorder;
    case 'A':
      if (word_count(rest) < 5) return std::nullopt;
      return TraceFormat::kEvemu;
    case 'I':
      return format_of_ids(rest);
    case 'E':
      return format_of_event(rest);
    default:
      return std::nullopt;
  }
}

std::optional<TraceFormat> format_of_lines(std::string_view text, bool whole) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos && !whole) break;
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (const auto format = format_of_line(line)) return format;
  }
  return std::nullopt;
}

}  // namespace

std::optional<TraceFormat> format_of_line(std::string_view line) {
  if (starts_with(line, text::kByteOrderMark)) line.remove_prefix(text::kByteOrderMark.size());
  if (starts_with(line, "# EVEMU")) return TraceFormat::kEvemu;
  if (starts_with(line, "#limn")) return TraceFormat::kHidRecorder;
  if (line.size() >= 2 && line[1] == ':') {
    if (const auto format = format_of_keyed_line(line[0], line.substr(2))) return format;
  }
  if (is_usbhid_dump_header(line)) return TraceFormat::kUsbhidDump;
  if (is_stroke_csv_row(line)) return TraceFormat::kStrokeCsv;
  return std::nullopt;
}

Expected<std::optional<TraceFormat>> detect_format(PeekedBytes& bytes) {
  for (;;) {
    const auto grown = bytes.grow();
    if (!grown) return tl::unexpected(grown.error());
    const bool whole = bytes.ended() || !*grown;
    if (const auto format = format_of_lines(bytes.window(), whole)) return format;
    if (!*grown) return std::optional<TraceFormat>();
  }
}

}  // namespace limn
