// The first boot of tests/kernel: every simulated device on every path of a stock kernel, and
// devices that come and go, as ./check runs them.

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include "tests/bench/areas.hpp"

namespace limn::bench {
namespace {

namespace fs = std::filesystem;

constexpr double kMostSeconds = 60;
constexpr int kSkipped = 77;  // as tests/kernel/boot ends where something is missing

struct Boot {
  double seconds = 0;
  int status = -1;
  std::string last_line;
};

/// Runs one entry of ctest's.
Boot boot(const fs::path& script) {
  Boot done;
  if (!fs::exists(script)) {
    done.status = kSkipped;
    done.last_line = "skipped: " + script.string() + " is not there (the release preset makes it)";
    return done;
  }
  const auto start = std::chrono::steady_clock::now();
  std::FILE* const output = popen(("'" + script.string() + "' 2>&1").c_str(), "r");
  if (output == nullptr) return done;
  char line[1024];
  while (std::fgets(line, sizeof line, output) != nullptr) {
    done.last_line = line;
    if (done.last_line.back() == '\n') done.last_line.pop_back();
  }
  const int status = pclose(output);
  done.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  done.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return done;
}

}  // namespace

void boot_area(const RowSink& sink) {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path() / "tests" / "kernel";
  // ./check runs its two entries side by side, an emulated processor each.
  const char* const names[] = {"kernel_links", "kernel_replugs"};
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::future<Boot>> running;
  for (const char* name : names) {
    running.push_back(std::async(std::launch::async, boot, folder / (std::string(name) + ".sh")));
  }
  std::vector<Boot> done;
  for (auto& one : running) done.push_back(one.get());
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  for (std::size_t i = 0; i < done.size(); ++i) {
    if (done[i].status != 0) {
      std::fprintf(stderr, "limn-bench: no figure for the first boot: %s\n",
                   done[i].status == kSkipped ? done[i].last_line.c_str()
                                              : (std::string(names[i]) + " failed").c_str());
      return;
    }
  }
  for (std::size_t i = 0; i < done.size(); ++i) {
    sink({std::string("boot/") + names[i] + ", wall time", done[i].seconds, "s", std::nullopt,
          std::nullopt});
  }
  sink({"boot/first boot, wall time", wall.count(), "s", std::nullopt, at_most(kMostSeconds)});
}

}  // namespace limn::bench
