#pragma once

#include <string>
#include <string_view>

#include "modeler/app/command.hpp"
#include "modeler/app/output_file.hpp"

namespace limn::app {

/// Standard output, written in blocks, so that a full disk is an error and not silence. `text()` is
/// the block to append to.
class StandardOutput {
 public:
  std::string& text() noexcept { return text_; }

  /// Writes the block where it has grown large. Call after each line.
  Outcome flush_if_large() { return text_.size() < kBlock ? Outcome{} : flush(); }

  /// Writes the block. Call at the end.
  Outcome flush();

 private:
  static constexpr std::size_t kBlock = 1 << 16;
  std::string text_;
};

/// Writes all of `text` to standard output.
Outcome print(std::string_view text);

}  // namespace limn::app
