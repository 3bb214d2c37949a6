#pragma once

#include <string>
#include <vector>

#include "tests/conventions/source_tree.hpp"

namespace limn::test {

/// What in `file` breaks the layering: an include of a folder that its own may not see, an include
/// that is not written from the repository root, a third-party or platform header where none
/// belongs, or a folder that the table of layers does not know. Empty if nothing does. One sentence
/// each.
std::vector<std::string> layering_violations(const SourceFile& file);

/// Third-party headers that cost seconds each stay in one source file a program or library: what in
/// `files` breaks that.
std::vector<std::string> heavy_header_violations(const std::vector<SourceFile>& files);

}  // namespace limn::test
