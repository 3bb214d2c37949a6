#include "drivers/transport/node_error.hpp"

#include <cerrno>
#include <cstring>

namespace limn {

tl::unexpected<Error> node_error(const std::string& node, const std::string& doing, int error) {
  const std::string what = "cannot be " + doing + ": " + std::strerror(error);
  std::string remedy = "check the name with 'limn devices'";
  switch (error) {
    case EACCES:
    case EPERM:
      remedy = "install limn's udev rules and plug the device in again, or see 'limn doctor'";
      break;
    case ENODEV:
    case ENOENT:
    case ENXIO:
      remedy = "plug the device in and see 'limn devices'";
      break;
    case EBUSY:
      remedy = "end the program that has it ('limn doctor' may name it)";
      break;
    case EPIPE:
    case EIO:
    case ETIMEDOUT:
      remedy = "unplug the device and plug it in again";
      break;
    default:
      break;
  }
  return fail(ErrorCode::kIo, node, what, remedy);
}

}  // namespace limn
