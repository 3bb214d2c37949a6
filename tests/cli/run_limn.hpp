#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/support/temp_folder.hpp"

namespace limn::test {

/// What a run of the built command left behind.
struct CommandRun {
  int exit_code = -1;  ///< 128 + n where signal n ended it
  std::string out;
  std::string err;
};

/// Runs the built `limn` with `arguments` in the current folder, `input` on its standard input.
CommandRun run_limn(const std::vector<std::string>& arguments, std::string_view input = {});

/// Runs a shell script with the path of the built `limn` as "$0".
CommandRun run_shell(const std::string& script);

/// Names of all that a folder holds, sorted.
std::vector<std::string> names_in(const TempFolder& folder);

}  // namespace limn::test
