// Reading a hid-recorder file: time, and the memory that a gigabyte of it takes.

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "input/trace/trace.hpp"
#include "tests/bench/areas.hpp"
#include "tests/bench/measure.hpp"
#include "tests/bench/process_memory.hpp"
#include "tests/bench/simulated_reports.hpp"

namespace limn::bench {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReports = 20'000;  // a minute and a half of a 200 Hz pen
constexpr std::size_t kGigabyte = 1'000'000'000;
constexpr double kMostResidentMb = 32;

void append_hex(std::string& text, const std::vector<std::uint8_t>& bytes) {
  char pair[4];
  for (const auto b : bytes) {
    std::snprintf(pair, sizeof pair, " %02x", b);
    text += pair;
  }
}

std::string recording_head(const ReportStream& stream) {
  std::string text = "D: 0\nR: " + std::to_string(stream.descriptor.size());
  append_hex(text, stream.descriptor);
  char ids[32];
  std::snprintf(ids, sizeof ids, "I: 3 %04x %04x\n", stream.vendor, stream.product);
  return text + "\nN: " + stream.name + "\nP: bench\n" + ids;
}

/// The event lines, the first at `start` seconds.
std::string recording_events(const ReportStream& stream, double start) {
  std::string text;
  char head[48];
  for (std::size_t i = 0; i < stream.reports.size(); ++i) {
    const double t = start + to_seconds(stream.report(i).time);
    std::snprintf(head, sizeof head, "E: %013.6f %zu", t, stream.reports[i].size());
    text += head;
    append_hex(text, stream.reports[i]);
    text += '\n';
  }
  return text;
}

/// Reads all of `text` and returns the number of reports; ends the program where it cannot.
std::size_t count_reports(const std::string& text) {
  auto reader = open_trace(memory_bytes(text));
  std::size_t reports = 0;
  while (reader) {
    const auto event = (*reader)->next();
    if (!event || std::holds_alternative<TraceEnd>(*event)) break;
    if (std::holds_alternative<Report>(*event)) ++reports;
  }
  return reports;
}

bool write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = write(file, text.data() + done, text.size() - done);
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

/// Feeds a gigabyte of recording to `limn decode -` and returns its peak memory; nothing where that
/// fails.
std::optional<double> memory_of_decoding_a_gigabyte(const fs::path& limn,
                                                    const ReportStream& stream) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return std::nullopt;
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[0], STDIN_FILENO);
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);  // its summary would stand among the rows
    execl(limn.c_str(), "limn", "decode", "--format", "csv", "-", static_cast<char*>(nullptr));
    _exit(127);
  }
  close(ends[0]);
  bool fed = write_all(ends[1], recording_head(stream));
  const double seconds_a_round = to_seconds(stream.report(stream.reports.size() - 1).time) + 0.005;
  double start = 0;
  for (std::size_t sent = 0; fed && sent < kGigabyte; start += seconds_a_round) {
    const std::string text = recording_events(stream, start);
    fed = write_all(ends[1], text);
    sent += text.size();
  }
  const auto peak = peak_resident_bytes(child);  // while it still waits for more
  close(ends[1]);
  int status = 0;
  waitpid(child, &status, 0);
  return fed && WIFEXITED(status) && WEXITSTATUS(status) == 0 ? peak : std::nullopt;
}

}  // namespace

void trace_area(const RowSink& sink) {
  const auto stream = generic_pen_stream(kReports);
  const std::string text = recording_head(stream) + recording_events(stream, 0);
  if (count_reports(text) != kReports) {
    std::fprintf(stderr, "limn-bench: the reader does not give every report of a recording\n");
    std::exit(2);
  }
  const double seconds = measure({{"read", [&text] { keep(count_reports(text)); }}})[0];
  sink({"trace/hid-recorder, time", seconds / static_cast<double>(text.size()) * 1e9, "s/GB",
        std::nullopt, std::nullopt});

  signal(SIGPIPE, SIG_IGN);  // a child that dies shows as a failed write
  const fs::path limn = fs::read_symlink("/proc/self/exe").parent_path() / "limn";
  if (const auto peak = memory_of_decoding_a_gigabyte(limn, stream)) {
    sink({"trace/limn decode of 1 GB, memory", *peak / 1e6, "MB resident", std::nullopt,
          at_most(kMostResidentMb)});
  } else {
    std::fprintf(stderr, "limn-bench: no figure for memory: \"%s decode -\" did not run\n",
                 limn.c_str());
  }
}

}  // namespace limn::bench
