#pragma once

#include <string>
#include <vector>

#include "tests/support/running_program.hpp"

namespace limn::test {

/// The built `limn` beside the test, and what it says on standard error.
class RunningLimn : public RunningProgram {
 public:
  explicit RunningLimn(std::vector<std::string> arguments)
      : RunningProgram(behind(LIMN_BINARY, std::move(arguments))) {}

 private:
  static std::vector<std::string> behind(const char* program, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), program);
    return arguments;
  }
};

}  // namespace limn::test
