#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <streambuf>
#include <string>

#include "input/base/byte_stream.hpp"
#include "input/base/error.hpp"

namespace limn {

/// Bytes as a std::streambuf for a parser of structured text that trusts its input: it ends where
/// the text would cost such a parser too much, and error() then says why.
///
/// Brackets of flow collections ([ and {) may nest to kMostNesting; what is in quotes and comments
/// does not count. No NUL bytes; at most `most_bytes` bytes.
class GuardedText final : public std::streambuf {
 public:
  static constexpr int kMostNesting = 32;

  GuardedText(std::unique_ptr<ByteSource> bytes, std::uint64_t most_bytes)
      : bytes_(std::move(bytes)), most_bytes_(most_bytes) {}

  /// Ends the text soon: nobody wants the rest.
  void stop() noexcept { stopped_ = true; }

  /// Why the text ended before its end: kIo, kLimit, kSyntax.
  const std::optional<Error>& error() const noexcept { return error_; }

 protected:
  int_type underflow() override;

 private:
  enum class In : std::uint8_t { kPlain, kDouble, kDoubleEscape, kSingle, kComment };

  /// How many of the bytes are fit to be given on; sets error_ where not all are.
  std::size_t fit(std::size_t size);
  void take(char c) noexcept;

  std::unique_ptr<ByteSource> bytes_;
  std::uint64_t most_bytes_;
  std::uint64_t taken_ = 0;
  std::uint64_t line_ = 1;
  In in_ = In::kPlain;
  char before_ = '\n';
  int depth_ = 0;
  bool stopped_ = false;
  std::optional<Error> error_;
  std::array<char, 16384> buffer_{};
};

}  // namespace limn
