#pragma once

#include <string>

#include "input/base/error.hpp"

namespace limn::app {

/// "cannot `action`: what `error`, an errno, means", with the remedy for that errno.
tl::unexpected<Error> io_error(const std::string& action, int error);

}  // namespace limn::app
