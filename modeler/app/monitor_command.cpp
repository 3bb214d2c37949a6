#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "drivers/devices/trace_decoder.hpp"
#include "drivers/transport/paced_reader.hpp"
#include "input/stroke/drag_sampler.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/live_input.hpp"
#include "modeler/app/report_timing.hpp"
#include "modeler/app/standard_output.hpp"
#include "modeler/app/stop_on_signal.hpp"
#include "modeler/app/table.hpp"
#include "modeler/app/terminal_text.hpp"
#include "modeler/app/trace_input.hpp"

namespace limn::app {
namespace {

using namespace std::chrono_literals;

struct Watched {
  std::string name;
  std::string id;
  ReportTiming timing;
  DurationStatistics latency;  // from a report's time to its sample
  StreamLosses losses;
  std::uint64_t repaired = 0;
  bool gone = false;
  std::optional<PenSample> pen;
  std::optional<MotionSample> motion;
  Drag drag;  // of that
};

/// Hands the events of live devices on, counts them, and calls for a picture now and then.
class WatchingReader final : public TraceReader {
 public:
  using Show = std::function<void(std::map<DeviceIndex, Watched>&)>;

  WatchingReader(LiveReader& live, Timestamp period, Timestamp end, Show show)
      : live_(live), period_(period), end_(end), show_(std::move(show)) {}

  TraceFormat format() const noexcept override { return live_.format(); }
  std::string place() const override { return live_.place(); }

  Expected<TraceEvent> next() override {
    auto event = next_until(Timestamp::max());
    if (!event) return tl::unexpected(std::move(event.error()));
    return **std::move(event);
  }

  Expected<std::optional<TraceEvent>> next_until(Timestamp deadline) override {
    WaitingClock& clock = monotonic_clock();
    last_report.reset();
    for (;;) {
      const Timestamp now = clock.now();
      if (now >= due_) {
        if (due_ > Timestamp::zero()) show_(devices);
        due_ = now + period_;
      }
      if (now >= end_) return TraceEnd{};
      const Timestamp until = std::min({due_, end_, deadline});
      auto event = live_.next_until(until);
      if (event && !*event && until != deadline) continue;
      if (event && *event) std::visit([this](const auto& content) { count(content); }, **event);
      return event;
    }
  }

  std::map<DeviceIndex, Watched> devices;
  std::optional<Timestamp> last_report;  ///< of the last event, where it was a report

 private:
  void count(const DeviceDescribed& described) {
    Watched& device = devices[described.device->index];
    char id[16];
    std::snprintf(id, sizeof id, "%04x:%04x", described.device->vendor, described.device->product);
    device.id = id;
    device.name = described.device->name;
    device.gone = false;
  }
  void count(const Report& report) { count(report.device, report.time); }
  void count(const EvdevFrame& frame) { count(frame.device, frame.time); }
  void count(DeviceIndex device, Timestamp time) {
    last_report = time;
    devices[device].timing.report(time);
  }
  void count(const TraceNote& note) {
    Watched& device = devices[note.device];
    device.gone |= note.text == "gone";
  }
  template <class Other>
  void count(const Other&) {}

  LiveReader& live_;
  Timestamp period_;
  Timestamp end_;
  Show show_;
  Timestamp due_{};
};

/// "|  .:#|": each bin's share of the fullest.
std::string bars(const DurationStatistics& durations) {
  constexpr std::string_view kHeights = " .:-=+*#";
  std::uint64_t most = 1;
  for (const auto count : durations.bins()) most = std::max(most, count);
  std::string text = "|";
  for (const auto count : durations.bins()) {
    // Any count shows: the lowest mark stands for "few", not for "none".
    const auto height = count == 0 ? 0 : 1 + count * (kHeights.size() - 2) / most;
    text += kHeights[static_cast<std::size_t>(height)];
  }
  return text + '|';
}

std::string describe(const MotionSample& sample, const Drag& drag) {
  char line[128];
  std::snprintf(line, sizeof line, "%7.2f %7.2f %7.2f mm/s  %7.4f %7.4f %7.4f rad/s",
                drag.mm_per_s[0], drag.mm_per_s[1], drag.mm_per_s[2], drag.rad_per_s[0],
                drag.rad_per_s[1], drag.rad_per_s[2]);
  std::string text = line;
  sample.buttons.for_each(
      [&text](unsigned number) { text += "  button " + std::to_string(number); });
  return text;
}

std::string describe(const Watched& device) {
  char line[256];
  std::string text =
      device.id + " " + printable(device.name) + (device.gone ? " (gone)" : "") + "\n  ";
  if (device.motion) {
    text += describe(*device.motion, device.drag);
  } else if (device.pen) {
    const PenSample& s = *device.pen;
    std::snprintf(line, sizeof line, "%-16s x %8.3f  y %8.3f mm",
                  std::string(name(s.state)).c_str(), s.x_mm, s.y_mm);
    text += line;
    if (s.axes.has(PenAxis::kPressure)) {
      std::snprintf(line, sizeof line, "  pressure %.3f", s.pressure);
      text += line;
    }
  } else {
    text += "nothing yet";
  }
  const DurationStatistics& intervals = device.timing.intervals();
  std::snprintf(line, sizeof line,
                "\n  %llu reports, %.1f a second, interval %.3f ms, jitter %.3f ms",
                static_cast<unsigned long long>(device.timing.reports()), device.timing.rate(),
                intervals.mean_ms(), intervals.deviation_ms());
  text += line;
  const std::string losses = losses_text(device.losses);
  text += losses.empty() ? ", 0 lost" : losses;
  if (device.repaired > 0) text += ", " + count_of(device.repaired, "repaired state transition");
  text += "\n  intervals 1/16 ms .. 64 ms " + bars(intervals);
  std::snprintf(line, sizeof line, "  latency %.3f ms, longest %.3f ms ", device.latency.mean_ms(),
                to_seconds(device.latency.longest()) * 1e3);
  text += line + bars(device.latency) + '\n';
  return text;
}

}  // namespace

Outcome run_monitor(const MonitorArguments& arguments) {
  auto live = open_live_input(arguments.live);
  if (!live) return tl::unexpected(std::move(live.error()));
  const StopOnSignal stop(**live);
  const bool redraws = ::isatty(STDOUT_FILENO) != 0 && arguments.format == OutputFormat::kText;
  const Timestamp start = monotonic_clock().now();
  const Timestamp end = arguments.seconds > 0
                            ? start + Timestamp(static_cast<std::int64_t>(arguments.seconds * 1e9))
                            : Timestamp::max();
  std::size_t lines = 0;
  Outcome written;
  const TraceDecoder* decoding = nullptr;
  const auto show = [&](std::map<DeviceIndex, Watched>& devices) {
    for (const TraceDeviceSummary& seen : decoding->summary().devices) {
      devices[seen.index].losses = seen.losses;
      devices[seen.index].repaired = seen.repaired_transitions;
    }
    std::string text;
    if (arguments.format == OutputFormat::kText) {
      if (redraws && lines > 0) text += "\033[" + std::to_string(lines) + "A\033[J";
      const std::size_t head = text.size();
      for (const auto& [index, device] : devices) text += describe(device);
      lines = static_cast<std::size_t>(
          std::count(text.begin() + static_cast<std::ptrdiff_t>(head), text.end(), '\n'));
    } else {
      Table table({{"t", "t"},
                   {"device", "device"},
                   {"id", "id"},
                   {"name", "name"},
                   {"reports", "reports"},
                   {"rate", "rate"},
                   {"interval_ms", "interval"},
                   {"jitter_ms", "jitter"},
                   {"latency_ms", "latency"},
                   {"latency_max_ms", "longest"},
                   {"lost", "lost"},
                   {"lost_estimated", "estimated"},
                   {"gone", "gone"},
                   {"overruns", "overruns"},
                   {"gaps", "gaps"},
                   {"resets", "resets"},
                   {"repaired", "repaired"},
                   {"clock_jumps", "jumps"}});
      for (const auto& [index, d] : devices) {
        const auto& intervals = d.timing.intervals();
        table.add(
            {to_seconds(monotonic_clock().now() - start), std::int64_t{index}, d.id, d.name,
             static_cast<std::int64_t>(d.timing.reports()), d.timing.rate(), intervals.mean_ms(),
             intervals.deviation_ms(), d.latency.mean_ms(), to_seconds(d.latency.longest()) * 1e3,
             static_cast<std::int64_t>(d.losses.lost), d.losses.lost_estimated, d.gone,
             static_cast<std::int64_t>(d.losses.overruns), static_cast<std::int64_t>(d.losses.gaps),
             static_cast<std::int64_t>(d.losses.resets), static_cast<std::int64_t>(d.repaired),
             static_cast<std::int64_t>(d.losses.clock_jumps)});
      }
      text = table.print(arguments.format);
    }
    if (written) written = print(text);
    if (!written) (*live)->stop();
  };
  const Timestamp period = redraws ? Timestamp(100ms) : Timestamp(1s);
  auto watching = std::make_unique<WatchingReader>(**live, period, end, show);
  WatchingReader& watched = *watching;
  TraceDecoder decoder(std::move(watching), {.salvage = true});
  decoding = &decoder;
  DragSampler drags(arguments.drag);
  for (;;) {
    auto sample = decoder.next_any();
    if (!sample) return in_file("", Expected<void>(tl::unexpected(sample.error())));
    if (std::holds_alternative<std::monostate>(*sample)) break;
    const auto* const pen = std::get_if<const PenSample*>(&*sample);
    const auto* const motion = std::get_if<const MotionSample*>(&*sample);
    Watched& device = watched.devices[pen != nullptr ? (*pen)->device : (*motion)->device];
    if (pen != nullptr) {
      device.pen = **pen;
    } else {
      device.motion = **motion;
      device.drag = drags.push(**motion);
    }
    if (watched.last_report) device.latency.add(monotonic_clock().now() - *watched.last_report);
  }
  show(watched.devices);
  return written;
}

}  // namespace limn::app
