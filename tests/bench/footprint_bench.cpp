// What an embedded program costs that reads pens (tests/examples/limn_input.cpp): its file, and its
// memory while reports come at 1 kHz.

#include <fcntl.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

#include "drivers/transport/paced_reader.hpp"
#include "tests/bench/areas.hpp"
#include "tests/bench/process_memory.hpp"
#include "tests/bench/simulated_reports.hpp"

namespace limn::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReports = 3000;
constexpr Timestamp kInterval{1'000'000};  // 1 kHz
constexpr double kMostFileKib = 400;
constexpr double kMostResidentMib = 8;
constexpr double kMebibyte = 1024.0 * 1024.0;

std::optional<double> stripped_kib(const fs::path& program) {
  const fs::path stripped = fs::temp_directory_path() / ("limn-input." + std::to_string(getpid()));
  const std::string command = "strip -o '" + stripped.string() + "' '" + program.string() + "'";
  std::error_code error;
  std::optional<double> kib;
  if (std::system(command.c_str()) == 0) {
    kib = static_cast<double>(fs::file_size(stripped, error)) / 1024;
  }
  fs::remove(stripped, error);
  return kib;
}

/// Peak memory of the program while a generic pen's reports come through a socket; nothing where
/// that fails.
std::optional<double> resident_mib(const fs::path& program) {
  const auto stream = generic_pen_stream(kReports);
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) return std::nullopt;
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDIN_FILENO);
    dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
    execl(program.c_str(), "limn-input", "-", static_cast<char*>(nullptr));
    _exit(127);
  }
  close(ends[1]);
  const auto send = [&ends](const std::vector<std::uint8_t>& bytes) {
    return write(ends[0], bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  };
  bool fed = send(stream.descriptor);
  WaitingClock& clock = monotonic_clock();
  const Timestamp start = clock.now();
  for (std::size_t i = 0; fed && i < kReports; ++i) {
    clock.wait_until(start + static_cast<std::int64_t>(i) * kInterval);
    fed = send(stream.reports[i]);
  }
  const auto peak = peak_resident_bytes(child);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!fed || !peak || !WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
  return *peak / kMebibyte;
}

}  // namespace

void footprint_area(const RowSink& sink) {
  signal(SIGPIPE, SIG_IGN);  // a child that dies shows as a failed write
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "limn-input";
  const auto kib = stripped_kib(program);
  const auto mib = resident_mib(program);
  if (kib) {
    sink({"footprint/limn-input, file", *kib, "KiB stripped", std::nullopt, at_most(kMostFileKib)});
  }
  if (mib) {
    sink({"footprint/limn-input at 1 kHz, memory", *mib, "MiB resident", std::nullopt,
          at_most(kMostResidentMib)});
  }
  if (!kib || !mib) {
    std::fprintf(stderr, "limn-bench: no figure for what \"%s -\" takes: it or strip did not run\n",
                 program.c_str());
  }
}

}  // namespace limn::bench
