#pragma once

#include <optional>
#include <string_view>

#include "input/trace/peeked_bytes.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// The format that this one line shows, if it does. A line that several formats share (a name, a
/// comment, a torn one) shows nothing.
std::optional<TraceFormat> format_of_line(std::string_view line);

/// The format of the first line that shows one, among those that begin in the window; reads as
/// little into the window as that takes. Nothing where none does. Error: kIo.
Expected<std::optional<TraceFormat>> detect_format(PeekedBytes& bytes);

}  // namespace limn
