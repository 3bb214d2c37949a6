#pragma once

#include <string>

namespace limn::app {

/// Files that must not outlive the program: a signal that ends it (SIGINT, SIGTERM, SIGHUP,
/// SIGPIPE) removes them first and then ends it as it would have. A signal that the caller ignores
/// stays ignored. For one thread.
void remove_on_signal(const std::string& path);

/// Takes `path` back: it was renamed or removed.
void keep_on_signal(const std::string& path);

}  // namespace limn::app
