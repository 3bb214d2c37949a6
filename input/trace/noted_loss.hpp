#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

namespace limn {

/// What a "lost N" or "lost? N" note (see TraceNote) says is missing.
struct NotedLoss {
  std::uint32_t count = 0;
  bool estimated = false;  ///< nobody counted: at least so many
};

/// Reads such a note's text; nothing for any other.
inline std::optional<NotedLoss> noted_loss(std::string_view note) noexcept {
  for (const std::string_view kind : {"lost ", "lost? "}) {
    if (!note.starts_with(kind)) continue;
    NotedLoss loss{0, kind[4] == '?'};
    const char* const end = note.data() + note.size();
    const auto parsed = std::from_chars(note.data() + kind.size(), end, loss.count);
    if (parsed.ec == std::errc{} && parsed.ptr == end) return loss;
  }
  return std::nullopt;
}

}  // namespace limn
