#include "modeler/app/terminal_text.hpp"

#include <algorithm>
#include <cstdio>

namespace limn::app {
namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// Bytes of the character that begins `text`; 0 where that is no UTF-8.
std::size_t length_of_character(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  if (lead < 0x80) return 1;
  const std::size_t length = lead < 0xC2 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  const bool whole =
      lead < 0xF5 && length > 0 && length <= text.size() &&
      std::all_of(text.begin() + 1, text.begin() + static_cast<int>(length), continues);
  return whole ? length : 0;
}

/// C0, DEL, and in two bytes C1.
bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) return first < ' ' || first == 0x7F;
  return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = length_of_character(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
    if (length == 0) {
      out += '?';
    } else if (is_control(character)) {
      out += ' ';
    } else {
      out += character;
    }
    text.remove_prefix(character.size());
  }
  return out;
}

std::string shortened(std::string text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t end = most - 2;
  while (end > 0 && continues(text[end])) --end;
  text.resize(end);
  return text + "..";
}

void print_error(std::string_view line) {
  std::fprintf(stderr, "limn: %s\n", printable(line).c_str());
}

void print_error(const Failure& failure) {
  std::string line;
  if (!failure.file.empty()) line += (failure.file == "-" ? "(stream)" : failure.file) + ": ";
  if (!failure.error.at.empty()) line += failure.error.at + ": ";
  line += failure.error.what;
  if (!failure.error.remedy.empty()) line += "; " + failure.error.remedy;
  print_error(line);
}

}  // namespace limn::app
