#include "modeler/app/io_error.hpp"

#include <cerrno>
#include <system_error>

namespace limn::app {
namespace {

const char* remedy_for(int error) {
  switch (error) {
    case ENOENT:
      return "create its folder first";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a place that you may write to";
    case ENOSPC:
    case EDQUOT:
      return "free some space or choose another disk";
    case EFBIG:
      return "raise the limit of file sizes (ulimit -f) or choose another disk";
    case EISDIR:
      return "name a file, not a folder";
    default:
      return "choose another place";
  }
}

}  // namespace

tl::unexpected<Error> io_error(const std::string& action, int error) {
  return fail(ErrorCode::kIo, "",
              "cannot " + action + ": " + std::generic_category().message(error),
              remedy_for(error));
}

}  // namespace limn::app
