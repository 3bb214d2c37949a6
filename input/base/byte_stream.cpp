#include "input/base/byte_stream.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace limn {
namespace {

tl::unexpected<Error> io_failure(const char* what, int number) {
  return fail(ErrorCode::kIo, "",
              std::string(what) + ": " + std::generic_category().message(number),
              "check the path, its permissions and the device behind it");
}

/// Reads with read(2) and not with stdio, which would wait on a pipe until its own buffer is full:
/// a live recording must come through as it is made.
class DescriptorBytes final : public ByteSource {
 public:
  DescriptorBytes(int descriptor, bool owned) : descriptor_(descriptor), owned_(owned) {}
  ~DescriptorBytes() override {
    if (owned_) ::close(descriptor_);
  }
  DescriptorBytes(const DescriptorBytes&) = delete;
  DescriptorBytes& operator=(const DescriptorBytes&) = delete;

  Expected<std::size_t> read(std::span<char> out) override {
    for (;;) {
      const ssize_t count = ::read(descriptor_, out.data(), out.size());
      if (count >= 0) return static_cast<std::size_t>(count);
      if (errno != EINTR) return io_failure("cannot be read", errno);
    }
  }

 private:
  int descriptor_;
  bool owned_;
};

class MemoryBytes final : public ByteSource {
 public:
  explicit MemoryBytes(std::string_view text) : rest_(text) {}

  Expected<std::size_t> read(std::span<char> out) override {
    const std::size_t count = std::min(out.size(), rest_.size());
    if (count > 0) std::memcpy(out.data(), rest_.data(), count);
    rest_.remove_prefix(count);
    return count;
  }

 private:
  std::string_view rest_;
};

}  // namespace

Expected<std::unique_ptr<ByteSource>> open_bytes(const std::string& path) {
  if (path == "-") return std::make_unique<DescriptorBytes>(STDIN_FILENO, false);
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return io_failure("cannot be opened", errno);
  auto bytes = std::make_unique<DescriptorBytes>(descriptor, true);
  struct stat status {};
  if (::fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode)) {
    return io_failure("cannot be read", EISDIR);  // now, not at the first read
  }
  return bytes;
}

std::unique_ptr<ByteSource> memory_bytes(std::string_view text) {
  return std::make_unique<MemoryBytes>(text);
}

}  // namespace limn
