#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "input/base/error.hpp"

namespace limn {

/// Where bytes come from: a file, standard input, or memory in tests and fuzzers.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// Fills up to out.size() bytes, at least one unless out is empty or the bytes have ended; gives
  /// how many. 0 means the end. May give less than asked for: a pipe gives what it has.
  /// Error: kIo.
  virtual Expected<std::size_t> read(std::span<char> out) = 0;
};

/// Where bytes go: a file, or memory in tests.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  /// Takes all of `bytes` or gives an error. Error: kIo.
  virtual Expected<void> write(std::string_view bytes) = 0;
};

/// Opens `path` for reading; "-" is standard input, which stays open. Error: kIo, for a directory
/// as well.
Expected<std::unique_ptr<ByteSource>> open_bytes(const std::string& path);

/// Reads from `text`, which must outlive the source.
std::unique_ptr<ByteSource> memory_bytes(std::string_view text);

/// Keeps what it is given.
class StringSink final : public ByteSink {
 public:
  Expected<void> write(std::string_view bytes) override {
    text_.append(bytes);
    return {};
  }
  const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
};

}  // namespace limn
