#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <cstdio>
#include <string>
#include <vector>

namespace limn::test {

/// A program that runs beside the test, which reads what it prints to one of its streams.
class RunningProgram {
 public:
  /// `words`: the program's path and its arguments.
  explicit RunningProgram(std::vector<std::string> words, int stream = STDERR_FILENO);
  /// Kills it where it still runs.
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  /// Its next line, "\n" included; empty: it says no more.
  std::string line();
  /// The first of its next lines that has `text`; empty: none.
  std::string line_with(const std::string& text);

  /// Sends it a signal, or none (0), and waits for its end: its exit status, 128 + n where signal n
  /// ended it.
  int end(int signal);

 private:
  pid_t child_ = -1;
  std::FILE* output_ = nullptr;
};

}  // namespace limn::test
