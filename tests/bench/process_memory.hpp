#pragma once

#include <sys/types.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>

namespace limn::bench {

/// "VmHWM" of a process: the most memory it had resident, in bytes. From there and not from rusage,
/// which also counts what the parent had resident before the exec.
inline std::optional<double> peak_resident_bytes(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::atof(line.c_str() + 6) * 1024;
  return std::nullopt;
}

}  // namespace limn::bench
