#include "modeler/app/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "modeler/app/io_error.hpp"
#include "modeler/app/temporary_files.hpp"

namespace limn::app {
namespace {

constexpr int kClosed = -1;

// The permissions that open(2) would give a new file; mkstemp gives 0600.
mode_t default_mode() {
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

// What a chain of links ends at, whether that exists or not.
std::filesystem::path followed(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // as the kernel has it
  std::error_code error;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(path, error); ++i) {
    const auto target = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / target;  // an absolute target replaces the folder
  }
  return path;
}

}  // namespace

OutputFile::OutputFile(std::string path, std::string temporary, int descriptor) noexcept
    : path_(std::move(path)), temporary_(std::move(temporary)), descriptor_(descriptor) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, kClosed)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this != &other) {
    discard();
    path_ = std::move(other.path_);
    temporary_ = std::exchange(other.temporary_, {});
    descriptor_ = std::exchange(other.descriptor_, kClosed);
  }
  return *this;
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::discard() noexcept {
  if (descriptor_ != kClosed && descriptor_ != STDOUT_FILENO) ::close(descriptor_);
  if (!temporary_.empty()) {
    ::unlink(temporary_.c_str());
    keep_on_signal(temporary_);
  }
  descriptor_ = kClosed;
  temporary_.clear();
}

Expected<OutputFile> OutputFile::open(const std::string& path) {
  if (path == "-") return OutputFile(path, {}, STDOUT_FILENO);

  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return io_error("write", EISDIR);
  if (exists && !S_ISREG(status.st_mode)) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) return io_error("open for writing", errno);
    return OutputFile(path, {}, descriptor);
  }

  // A link stays a link: what it points to is replaced, beside itself, so that rename stays within
  // one file system.
  const std::filesystem::path target = followed(path);
  std::string pattern = target.string() + ".XXXXXX";
  const int descriptor = ::mkostemp(pattern.data(), O_CLOEXEC);
  if (descriptor < 0) return io_error("create", errno);
  remove_on_signal(pattern);
  ::fchmod(descriptor, exists ? status.st_mode & 07777 : default_mode());
  return OutputFile(target.string(), std::move(pattern), descriptor);
}

Expected<void> OutputFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return io_error("write", errno);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return {};
}

Expected<void> OutputFile::finish() {
  const int descriptor = std::exchange(descriptor_, kClosed);
  if (descriptor == kClosed || descriptor == STDOUT_FILENO) return {};
  if (!temporary_.empty() && ::fsync(descriptor) != 0) {
    const int error = errno;
    ::close(descriptor);
    return io_error("write", error);
  }
  if (::close(descriptor) != 0) return io_error("write", errno);
  return {};
}

Expected<void> OutputFile::commit() {
  if (auto finished = finish(); !finished) return finished;
  if (temporary_.empty()) return {};
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) {
    return io_error("rename into place", errno);
  }
  keep_on_signal(temporary_);
  temporary_.clear();
  return {};
}

}  // namespace limn::app
