#pragma once

#include <string>
#include <string_view>

#include "input/base/byte_stream.hpp"
#include "input/base/error.hpp"

namespace limn::app {

/// A file that comes into being whole or not at all.
///
/// A regular file is written under a temporary name beside its place and renamed there by commit();
/// dropped uncommitted, or ended by a signal, it leaves nothing. What is no regular file
/// (/dev/null, a pipe, "-" for standard output) is written directly, for there is nothing to
/// rename.
class OutputFile final : public ByteSink {
 public:
  /// Opens for writing at once, so that an unwritable place is told before any work.
  /// Error: kIo, `what` naming the cause.
  static Expected<OutputFile> open(const std::string& path);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile() override;

  const std::string& path() const noexcept { return path_; }

  /// Appends all of `bytes`. Error: kIo (disk full). A closed pipe ends the program by SIGPIPE, as
  /// it ends others.
  Expected<void> write(std::string_view bytes) override;

  /// Makes sure that the bytes are on the disk; nothing can be written any more. Error: kIo.
  Expected<void> finish();

  /// finish(), and gives the file its name. Error: kIo.
  Expected<void> commit();

 private:
  OutputFile(std::string path, std::string temporary, int descriptor) noexcept;
  void discard() noexcept;

  std::string path_;
  std::string temporary_;  ///< empty where the target is written directly
  int descriptor_ = -1;
};

}  // namespace limn::app
