#pragma once

#include <string>
#include <string_view>

#include "modeler/app/command.hpp"

namespace limn::app {

/// Text of devices and files without what a terminal would obey: a control character becomes a
/// space, and a byte that is no UTF-8 a question mark.
std::string printable(std::string_view text);

/// At most `most` (>= 2) bytes: what is longer ends in "..", cut between characters of UTF-8.
std::string shortened(std::string text, std::size_t most);

/// "limn: LINE" on standard error, printable.
void print_error(std::string_view line);
/// The same: "limn: FILE: AT: WHAT; REMEDY".
void print_error(const Failure& failure);

}  // namespace limn::app
