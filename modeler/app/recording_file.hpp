#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "input/base/byte_stream.hpp"
#include "input/base/error.hpp"

namespace limn::app {

/// A recording in the making: it has its name from the start, and what was written is on the disk
/// soon, so that a crash or a cut cable costs moments, not the recording.
///
/// Records, each some whole lines, are gathered and written in pieces. Of a piece that the disk
/// does not take whole, its whole records stay, so the file always ends with one.
class RecordingFile final : public ByteSink {
 public:
  /// Creates `path`; "-" is standard output. Error: kIo: it exists (a recording is never written
  /// over another), or cannot be created.
  static Expected<RecordingFile> create(const std::string& path);

  RecordingFile(RecordingFile&& other) noexcept;
  RecordingFile& operator=(RecordingFile&&) = delete;
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;
  ~RecordingFile() override;

  /// Gathers a record. Writes where much is gathered. Error: kIo.
  Expected<void> write(std::string_view record) override;

  /// Whether something waits for sync().
  bool dirty() const noexcept { return dirty_; }

  /// Puts all on the disk. Error: kIo; what was synced before stands.
  Expected<void> sync();

 private:
  RecordingFile(std::string path, int descriptor, bool regular) noexcept;
  Expected<void> flush();

  std::string path_;
  int descriptor_ = -1;
  bool regular_ = false;
  bool dirty_ = false;
  long long whole_ = 0;  // bytes of the file up to the last whole record
  std::string gathered_;
  std::vector<std::size_t> record_ends_;  // in gathered_
};

}  // namespace limn::app
