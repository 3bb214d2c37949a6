#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace limn::firmware {

/// Why a link cannot be made or goes on no longer. Each part is one line without a full stop;
/// `remedy` may be empty.
struct LinkError {
  std::string what;
  std::string remedy;
};

template <class T>
using LinkResult = tl::expected<T, LinkError>;

inline tl::unexpected<LinkError> link_fail(std::string what, std::string remedy) {
  return tl::unexpected<LinkError>(LinkError{std::move(what), std::move(remedy)});
}

/// How a running link came to its end.
enum class LinkEnd : std::uint8_t {
  kTimeUp,  ///< the simulated time that it was given has passed
  kStopped  ///< Waiter::stop()
};

}  // namespace limn::firmware
