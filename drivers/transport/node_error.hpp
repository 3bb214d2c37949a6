#pragma once

#include <string>

#include "input/base/error.hpp"

namespace limn {

/// A device's node gave this errno when it was opened or asked: a kIo error with the remedy.
/// `doing` completes "cannot be ..".
tl::unexpected<Error> node_error(const std::string& node, const std::string& doing, int error);

}  // namespace limn
