#include "modeler/app/temporary_files.hpp"

#include <signal.h>  // sigaction is POSIX
#include <unistd.h>

#include <algorithm>
#include <array>
#include <vector>

namespace limn::app {
namespace {

constexpr std::array<int, 4> kEndings = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};

// Read by the handler: changed only while the signals are blocked. Never destroyed, for a signal
// may come while the program exits.
std::vector<std::string>& pending() {
  static auto* paths = new std::vector<std::string>;
  return *paths;
}

void remove_all(int signal) {
  for (const std::string& path : pending()) ::unlink(path.c_str());
  ::raise(signal);  // pending until this returns; SA_RESETHAND has put the default back
}

void handle_endings() {
  for (const int signal : kEndings) {
    struct sigaction action {};
    ::sigaction(signal, nullptr, &action);
    if (action.sa_handler != SIG_DFL) continue;
    action.sa_handler = remove_all;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(signal, &action, nullptr);
  }
}

class BlockedSignals {
 public:
  BlockedSignals() {
    sigset_t endings;
    ::sigemptyset(&endings);
    for (const int signal : kEndings) ::sigaddset(&endings, signal);
    ::sigprocmask(SIG_BLOCK, &endings, &before_);
  }
  ~BlockedSignals() { ::sigprocmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

void remove_on_signal(const std::string& path) {
  const BlockedSignals blocked;
  if (pending().empty()) handle_endings();
  pending().push_back(path);
}

void keep_on_signal(const std::string& path) {
  const BlockedSignals blocked;
  auto& paths = pending();
  paths.erase(std::remove(paths.begin(), paths.end(), path), paths.end());
}

}  // namespace limn::app
