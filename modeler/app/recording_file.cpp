#include "modeler/app/recording_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "modeler/app/io_error.hpp"

namespace limn::app {
RecordingFile::RecordingFile(std::string path, int descriptor, bool regular) noexcept
    : path_(std::move(path)), descriptor_(descriptor), regular_(regular) {}

RecordingFile::RecordingFile(RecordingFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      regular_(other.regular_),
      dirty_(other.dirty_),
      whole_(other.whole_),
      gathered_(std::move(other.gathered_)),
      record_ends_(std::move(other.record_ends_)) {}

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
  return io_error("create", errno);
}

Expected<void> RecordingFile::write(std::string_view record) {
  constexpr std::size_t kPiece = 1 << 16;
  gathered_ += record;
  record_ends_.push_back(gathered_.size());
  dirty_ = true;
  return gathered_.size() < kPiece ? Expected<void>() : flush();
}

Expected<void> RecordingFile::flush() {
  std::size_t taken = 0;
  int error = 0;
  while (taken < gathered_.size() && error == 0) {
    const ssize_t size = ::write(descriptor_, gathered_.data() + taken, gathered_.size() - taken);
    if (size > 0) {
      taken += static_cast<std::size_t>(size);
    } else if (size == 0 || errno != EINTR) {
      error = size < 0 ? errno : ENOSPC;
    }
  }
  const auto torn = std::upper_bound(record_ends_.begin(), record_ends_.end(), taken);
  if (torn != record_ends_.begin()) whole_ += static_cast<long long>(*std::prev(torn));
  gathered_.clear();
  record_ends_.clear();
  if (error == 0) return {};
  auto failure = io_error("write", error);
  if (regular_ && ::ftruncate(descriptor_, whole_) != 0) {
    failure.value().remedy += "; the last line may be torn";
  }
  return failure;
}

Expected<void> RecordingFile::sync() {
  if (auto flushed = flush(); !flushed) return flushed;
  if (regular_ && ::fdatasync(descriptor_) != 0) {
    return io_error("write", errno);
  }
  dirty_ = false;
  return {};
}

}  // namespace limn::app
