#include "drivers/spnav_server/spnav_socket.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

namespace limn {
namespace {

/// Clients that wait to be accepted.
constexpr int kBacklog = 16;

constexpr const char* kElsewhere = "name another place by --socket PATH";

tl::unexpected<Error> refused(const std::string& path, const std::string& what) {
  return fail(ErrorCode::kIo, path, what + ": " + std::generic_category().message(errno),
              kElsewhere);
}

FileHandle stream_socket() {
  return FileHandle(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
}

/// Two servers that start at once look at a dead one's name, and take it, one after the other. A
/// folder that cannot be locked is used all the same.
FileHandle lock_folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  const std::string folder =
      slash == std::string::npos ? "." : path.substr(0, std::max<std::size_t>(slash, 1));
  FileHandle handle(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  constexpr int kTries = 50;
  for (int i = 0; handle && i < kTries && ::flock(handle.get(), LOCK_EX | LOCK_NB) != 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return handle;
}

/// Makes sure that nothing has the name.
Expected<void> clear(const std::string& path, const sockaddr_un& address) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return {};
  if (!S_ISSOCK(status.st_mode)) {
    return fail(ErrorCode::kIo, path, "is there already and is no socket", kElsewhere);
  }
  const FileHandle probe = stream_socket();
  if (!probe) return refused(path, "no socket could be made");
  if (::connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ||
      errno == EAGAIN) {
    return fail(ErrorCode::kIo, path, "another server (spacenavd?) answers there",
                "stop it, or name another place by --socket PATH");
  }
  if (errno != ECONNREFUSED && errno != ENOENT) return refused(path, "cannot be looked at");
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) {
    return refused(path, "the socket of a server that has ended cannot be removed");
  }
  return {};
}

}  // namespace

Expected<SpnavSocket> SpnavSocket::listen(const std::string& path, unsigned mode) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    return fail(ErrorCode::kLimit, path, "a socket's path has 1 to 107 bytes", kElsewhere);
  }
  std::memcpy(address.sun_path, path.c_str(), path.size());
  FileHandle handle = stream_socket();
  if (!handle) return refused(path, "no socket could be made");
  const FileHandle lock = lock_folder_of(path);
  if (auto cleared = clear(path, address); !cleared) {
    return tl::unexpected(std::move(cleared.error()));
  }
  // Its mode is the name's from the first moment, less what the umask takes.
  if (::fchmod(handle.get(), mode) != 0 ||
      ::bind(handle.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return refused(path, "no socket could be made there");
  }
  SpnavSocket listening(std::move(handle), path);
  if (::chmod(path.c_str(), mode) != 0 || ::listen(listening.get(), kBacklog) != 0) {
    return refused(path, "no socket could be made there");
  }
  return listening;
}

SpnavSocket::SpnavSocket(FileHandle handle, std::string path) noexcept
    : handle_(std::move(handle)), path_(std::move(path)) {
  struct stat status {};
  if (::lstat(path_.c_str(), &status) != 0) return;
  device_ = status.st_dev;
  inode_ = status.st_ino;
}

SpnavSocket::~SpnavSocket() {
  struct stat status {};
  if (!handle_ || ::lstat(path_.c_str(), &status) != 0) return;
  if (status.st_dev == device_ && status.st_ino == inode_) ::unlink(path_.c_str());
}

}  // namespace limn
