#pragma once

#include <string>
#include <vector>

#include "tests/conventions/source_tree.hpp"

namespace limn::test {

/// What in `file` breaks the rules of files: a header without #pragma once, a name that says
/// nothing, more than 700 lines. One sentence each, empty if nothing does.
std::vector<std::string> file_violations(const SourceFile& file);

/// What in `file`, where it belongs to a library, breaks the rules of libraries: they throw
/// nothing, print nothing and end no program; bytes are decoded without the mathematical library,
/// whose last bits differ between machines.
std::vector<std::string> library_violations(const SourceFile& file);

}  // namespace limn::test
