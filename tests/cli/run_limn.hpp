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

/// Whether umockdev, which simulates devices below the C library, is installed.
bool has_umockdev();

/// Runs umockdev-run with these words, of the shell, in which "$0" is the built `limn`.
CommandRun run_umockdev(const std::string& words);

/// Names of all that a folder holds, sorted.
std::vector<std::string> names_in(const TempFolder& folder);

}  // namespace limn::test
