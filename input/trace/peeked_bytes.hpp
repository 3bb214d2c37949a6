#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "input/base/byte_stream.hpp"

namespace limn {

/// A byte source whose beginning can be looked at before it is read, to tell a format from content.
/// NUL bytes at the very start, as an unclean power-off leaves them, are counted instead of kept,
/// so that the window begins at the first real content however many they are; read() gives them
/// back.
class PeekedBytes final : public ByteSource {
 public:
  static constexpr std::size_t kWindowBytes = std::size_t{256} * 1024;

  explicit PeekedBytes(std::unique_ptr<ByteSource> inner) : inner_(std::move(inner)) {}

  /// Reads some more into the window; false once it is full or the bytes have ended. Error: kIo.
  /// Precondition: nothing was read() yet.
  Expected<bool> grow();

  std::string_view window() const noexcept { return {window_.data(), window_.size()}; }
  std::uint64_t leading_nuls() const noexcept { return leading_nuls_; }
  /// Whether the window reaches to the end of the bytes.
  bool ended() const noexcept { return ended_; }

  Expected<std::size_t> read(std::span<char> out) override;

 private:
  std::unique_ptr<ByteSource> inner_;
  std::vector<char> window_;
  std::size_t given_ = 0;  // of window_
  std::uint64_t leading_nuls_ = 0;
  std::uint64_t nuls_given_ = 0;
  bool ended_ = false;
};

}  // namespace limn
