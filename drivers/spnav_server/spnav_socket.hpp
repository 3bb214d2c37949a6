#pragma once

#include <cstdint>
#include <string>

#include "drivers/transport/file_handle.hpp"
#include "input/base/error.hpp"

namespace limn {

/// A listening socket with a name, which goes with it.
class SpnavSocket {
 public:
  /// Takes the name of a server that has ended; of nothing else. `mode`: the file's. Errors: kIo:
  /// somebody answers there, or the system refuses; kLimit: a longer path than sockets have.
  static Expected<SpnavSocket> listen(const std::string& path, unsigned mode);

  SpnavSocket(SpnavSocket&& other) noexcept = default;
  SpnavSocket& operator=(SpnavSocket&&) = delete;
  ~SpnavSocket();

  int get() const noexcept { return handle_.get(); }

 private:
  SpnavSocket(FileHandle handle, std::string path) noexcept;

  FileHandle handle_;
  std::string path_;
  std::uint64_t device_ = 0;
  std::uint64_t inode_ = 0;  // of the name, which may be another's by the end
};

}  // namespace limn
