#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

/// What a "string INDEX BYTES" note (see TraceNote) says: a string descriptor that the device gave
/// when it was initialised, which decides how its reports are decoded.
///
///     string 201 1c 03 48 00 55 00 ..   the descriptor as it came, two digits a byte
///     string 123                        the device gave none
struct NotedString {
  std::uint8_t index = 0;
  std::vector<std::uint8_t> bytes;  ///< at most kMostBytes; empty: none came

  static constexpr std::size_t kMostBytes = 256;  ///< as much as vendors' drivers ask for
};

/// Reads such a note's text; nothing for any other.
std::optional<NotedString> noted_string(std::string_view note);

/// The note's text. Precondition: at most kMostBytes bytes.
std::string note_of(const NotedString& string);

}  // namespace limn
