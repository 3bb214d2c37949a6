#pragma once

#include <span>
#include <string>
#include <string_view>

namespace limn::app {

/// The names nearest to a mistyped one, as "did you mean star or spiral?"; all of them, as
/// "choose circle, signature or star", where none is near. `known` must not be empty.
std::string suggest(std::string_view mistyped, std::span<const std::string_view> known);

}  // namespace limn::app
