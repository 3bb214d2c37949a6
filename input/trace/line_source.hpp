#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "input/base/byte_stream.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// One line of a file. `text` is borrowed until the next line is asked for.
struct Line {
  std::string_view text;     ///< without LF or CR LF
  std::uint64_t number = 0;  ///< 1 for the first
  std::uint64_t offset = 0;  ///< of its first byte in the file, from 0
  bool terminated = true;    ///< false: the file ends without a line end
  bool too_long = false;     ///< `text` is only its first kMaxLineBytes bytes
};

/// Cuts bytes into lines with one buffer, which grows to hold the longest line but never beyond
/// kMaxBufferBytes. A UTF-8 byte order mark at the start is left out.
class LineSource {
 public:
  static constexpr std::size_t kBlockBytes = std::size_t{64} * 1024;
  static constexpr std::size_t kMaxBufferBytes = kMaxLineBytes + kBlockBytes;

  explicit LineSource(std::unique_ptr<ByteSource> bytes)
      : bytes_(std::move(bytes)), buffer_(kBlockBytes) {}

  /// The next line, nothing at the end. Error: kIo.
  Expected<std::optional<Line>> next();

  /// Bytes of memory held.
  std::size_t buffer_bytes() const noexcept { return buffer_.size(); }

 private:
  Expected<bool> refill();
  Expected<void> discard_line();
  Line cut(std::size_t size, std::size_t line_end);

  std::unique_ptr<ByteSource> bytes_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  // what is not yet given out: buffer_[begin_, end_)
  std::size_t end_ = 0;
  std::uint64_t number_ = 0;
  std::uint64_t offset_ = 0;  // of buffer_[begin_]
  bool in_long_line_ = false;
  bool at_end_ = false;
};

}  // namespace limn
