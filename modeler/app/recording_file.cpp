#include "modeler/app/recording_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace limn::app {
namespace {

tl::unexpected<Error> io_error(const std::string& action, int error, const std::string& remedy) {
  return fail(ErrorCode::kIo, "",
              "cannot " + action + ": " + std::generic_category().message(error), remedy);
}

}  // namespace

RecordingFile::RecordingFile(std::string path, int descriptor, bool regular) noexcept
    : path_(std::move(path)), descriptor_(descriptor), regular_(regular) {}

RecordingFile::RecordingFile(RecordingFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      regular_(other.regular_),
      dirty_(other.dirty_),
      whole_(other.whole_),
      gathered_(std::move(other.gathered_)) {}

RecordingFile::~RecordingFile() {
  if (descriptor_ >= 0 && descriptor_ != STDOUT_FILENO) ::close(descriptor_);
}

Expected<RecordingFile> RecordingFile::create(const std::string& path) {
  if (path == "-") return RecordingFile(path, STDOUT_FILENO, false);
  struct stat status {};
  const bool device = ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
  const int flags = device ? O_WRONLY | O_CLOEXEC : O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
  const int descriptor = ::open(path.c_str(), flags, 0666);
  if (descriptor >= 0) return RecordingFile(path, descriptor, !device);
  if (errno == EEXIST) {
    return fail(ErrorCode::kIo, "", "exists already", "choose another name or remove it");
  }
  return io_error("create", errno, "choose a place that you may write to");
}

Expected<void> RecordingFile::write(std::string_view lines) {
  constexpr std::size_t kPiece = 1 << 16;
  gathered_ += lines;
  dirty_ = true;
  return gathered_.size() < kPiece ? Expected<void>() : flush();
}

Expected<void> RecordingFile::flush() {
  std::string_view left = gathered_;
  while (!left.empty()) {
    const ssize_t size = ::write(descriptor_, left.data(), left.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) {
      const int error = size < 0 ? errno : ENOSPC;
      const bool torn = regular_ && ::ftruncate(descriptor_, whole_) != 0;
      std::string remedy = "free some space or choose another disk";
      if (torn) remedy += "; the last line may be torn";
      gathered_.clear();
      return io_error("write", error, remedy);
    }
    left.remove_prefix(static_cast<std::size_t>(size));
  }
  whole_ += static_cast<long long>(gathered_.size());
  gathered_.clear();
  return {};
}

Expected<void> RecordingFile::sync() {
  if (auto flushed = flush(); !flushed) return flushed;
  if (regular_ && ::fdatasync(descriptor_) != 0) {
    return io_error("write", errno, "free some space or choose another disk");
  }
  dirty_ = false;
  return {};
}

}  // namespace limn::app
