// For builds without libspnav.

#include "drivers/transport/spnav_transport.hpp"

namespace limn {

Expected<std::unique_ptr<Transport>> open_spnav(const std::string& socket) {
  return fail(ErrorCode::kMissing, socket, "this build has no libspnav, which asks spacenavd",
              "build limn where libspnav-dev is installed, or stop spacenavd");
}

}  // namespace limn
