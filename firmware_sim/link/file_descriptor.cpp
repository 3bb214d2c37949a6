#include "firmware_sim/link/file_descriptor.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace limn::firmware {

FileDescriptor::~FileDescriptor() {
  if (number_ >= 0) ::close(number_);
}

void make_nonblocking(const FileDescriptor& file) noexcept {
  const int flags = ::fcntl(file.get(), F_GETFL);
  if (flags >= 0) ::fcntl(file.get(), F_SETFL, flags | O_NONBLOCK);
}

}  // namespace limn::firmware
