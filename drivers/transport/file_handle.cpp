#include "drivers/transport/file_handle.hpp"

#include <unistd.h>

namespace limn {

FileHandle::~FileHandle() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace limn
