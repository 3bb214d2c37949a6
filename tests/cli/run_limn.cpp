#include "tests/cli/run_limn.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "tests/support/recordings.hpp"

extern char** environ;

namespace limn::test {
namespace fs = std::filesystem;

namespace {

constexpr const char* kUmockdev = "/usr/bin/umockdev-run";

CommandRun run(std::vector<std::string> words, std::string_view input) {
  // Files rather than pipes: no deadlock, whatever the sizes.
  const TempFolder streams;
  const std::string out = streams.path() / "out";
  const std::string err = streams.path() / "err";
  const std::string in = streams.write("in", input).string();
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const int create = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, in.c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), create, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), create, 0600);
  pid_t child = 0;
  const int error = posix_spawn(&child, words[0].c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  EXPECT_EQ(error, 0) << "cannot start " << words[0];
  if (error != 0) return {};

  int status = 0;
  waitpid(child, &status, 0);
  CommandRun done;
  done.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  done.out = read_file(out);
  done.err = read_file(err);
  return done;
}

}  // namespace

CommandRun run_limn(const std::vector<std::string>& arguments, std::string_view input) {
  std::vector<std::string> words = {LIMN_BINARY};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run(std::move(words), input);
}

CommandRun run_shell(const std::string& script) {
  return run({"/bin/sh", "-c", script, LIMN_BINARY}, {});
}

bool has_umockdev() { return fs::exists(kUmockdev); }

CommandRun run_umockdev(const std::string& words) {
  // AddressSanitizer wants to be the first library; umockdev's comes before it, harmlessly.
  return run_shell("export ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0; timeout 60 " +
                   std::string(kUmockdev) + " " + words);
}

std::vector<std::string> names_in(const TempFolder& folder) {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    found.push_back(entry.path().filename().string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace limn::test
