#include "tests/support/running_program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>  // kill is POSIX
#include <sys/wait.h>

#include <array>

namespace limn::test {

RunningProgram::RunningProgram(std::vector<std::string> words, int stream) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int ends[2];
  EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  child_ = ::fork();
  if (child_ == 0) {
    ::dup2(ends[1], stream);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  EXPECT_GT(child_, 0);
  ::close(ends[1]);
  output_ = ::fdopen(ends[0], "r");
}

RunningProgram::~RunningProgram() {
  if (child_ > 0) end(SIGKILL);
  std::fclose(output_);
}

std::string RunningProgram::line() {
  std::array<char, 1024> text{};
  return std::fgets(text.data(), text.size(), output_) != nullptr ? text.data() : "";
}

std::string RunningProgram::line_with(const std::string& text) {
  for (std::string one = line(); !one.empty(); one = line()) {
    if (one.find(text) != std::string::npos) return one;
  }
  return "";
}

int RunningProgram::end(int signal) {
  if (signal > 0) ::kill(child_, signal);
  int status = 0;
  ::waitpid(child_, &status, 0);
  child_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace limn::test
