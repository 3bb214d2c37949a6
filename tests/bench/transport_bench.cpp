// Time as a device's user meets it: how late a replayed report comes, and how long a live one takes
// from the device's write to the event. Wall clock, unlike the other areas: waiting is the job.

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "drivers/transport/hidraw_transport.hpp"
#include "drivers/transport/live_reader.hpp"
#include "drivers/transport/paced_reader.hpp"
#include "tests/bench/areas.hpp"

namespace limn::bench {
namespace {

constexpr int kReports = 1000;
constexpr Timestamp kInterval{1'000'000};  // 1 kHz, the fastest that pens are
constexpr double kMost = 1;                // ms

double median_ms(std::vector<Timestamp> times) {
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return to_seconds(*middle) * 1e3;
}

/// How much later than their times the reports of a replayed recording come.
double replay_lateness_ms() {
  std::string text;
  char line[48];
  for (int i = 0; i < kReports; ++i) {
    std::snprintf(line, sizeof line, "E: %.6f 2 01 02\n", to_seconds(i * kInterval));
    text += line;
  }
  PacedReader reader(*open_trace(memory_bytes(text)), 1, monotonic_clock());
  std::vector<Timestamp> late;
  for (;;) {
    const auto event = reader.next();
    if (!event || std::holds_alternative<TraceEnd>(*event)) break;
    if (std::holds_alternative<Report>(*event)) late.push_back(reader.lateness());
  }
  return median_ms(std::move(late));
}

/// From a device's write to the event in the reader's thread.
double live_latency_ms() {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) != 0) std::abort();
  std::vector<std::unique_ptr<Transport>> devices;
  devices.push_back(open_messages(ends[1], {}));
  const auto reader = LiveReader::start(std::move(devices));
  if (!reader) std::abort();
  (void)(*reader)->next();  // described
  const std::array<std::uint8_t, 16> report{};
  std::vector<Timestamp> latency;
  WaitingClock& clock = monotonic_clock();
  for (int i = 0; i < kReports; ++i) {
    clock.wait_until(clock.now() + kInterval);
    const Timestamp sent = clock.now();
    if (::write(ends[0], report.data(), report.size()) < 0) std::abort();
    (void)(*reader)->next();
    latency.push_back(clock.now() - sent);
  }
  ::close(ends[0]);
  return median_ms(std::move(latency));
}

}  // namespace

void transport_area(const RowSink& sink) {
  sink({"transport/replay at 1 kHz, lateness", replay_lateness_ms(), "ms, median", std::nullopt,
        at_most(kMost)});
  sink({"transport/live at 1 kHz, latency", live_latency_ms(), "ms, median", std::nullopt,
        std::nullopt});
}

}  // namespace limn::bench
