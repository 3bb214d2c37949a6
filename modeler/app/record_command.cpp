#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <vector>

#include "drivers/transport/paced_reader.hpp"
#include "input/trace/evemu_writer.hpp"
#include "input/trace/hid_recorder_writer.hpp"
#include "input/trace/noted_loss.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/live_input.hpp"
#include "modeler/app/recording_file.hpp"
#include "modeler/app/trace_input.hpp"

namespace limn::app {
namespace {

using namespace std::chrono_literals;

/// How long a report may wait for the disk. The promise is 100 ms; a disk needs some of that.
constexpr Timestamp kSyncPeriod = 40ms;
constexpr Timestamp kProgressPeriod = 200ms;

/// What a recording holds so far.
struct Counts {
  std::uint64_t reports = 0;
  std::uint64_t frames = 0;
  StreamLosses losses;  // as far as the devices' transports tell
  std::uint64_t devices = 0;
};

/// Writes events with times from the first event's on: reports as a hid-recorder file, what the
/// kernel decoded as an evemu file, which holds one device.
class Recorder {
 public:
  explicit Recorder(ByteSink& sink) : reports_(sink), frames_(sink) {
    shifted_.reserve(kMaxFrameEvents);
  }
  const Counts& counts() const noexcept { return counts_; }

  Expected<void> operator()(const DeviceDescribed& described) {
    const bool decoded = !described.device->axes.empty();
    const bool mixed = counts_.devices > 0 && (decoded || evemu_) &&
                       (decoded != evemu_ || described.device->index != 0);
    if (mixed) {
      return fail(ErrorCode::kLimit, "", "an evemu file, for event nodes, holds one device",
                  "name the one to record");
    }
    evemu_ = decoded;
    counts_.devices = std::max<std::uint64_t>(counts_.devices, described.device->index + 1U);
    return evemu_ ? frames_.describe(*described.device) : reports_.describe(*described.device);
  }
  Expected<void> operator()(const Report& report) {
    ++counts_.reports;
    return reports_.write({report.device, since_start(report.time), report.bytes});
  }
  Expected<void> operator()(const EvdevFrame& frame) {
    ++counts_.frames;
    shifted_.assign(frame.events.begin(), frame.events.end());
    for (EvdevEvent& event : shifted_) event.time = since_start(event.time);
    return frames_.write({frame.device, since_start(frame.time), shifted_});
  }
  Expected<void> operator()(const TraceNote& note) {
    if (const auto loss = noted_loss(note.text)) {
      counts_.losses.lost += loss->count;
      counts_.losses.lost_estimated |= loss->estimated;
      ++counts_.losses.overruns;
    }
    if (note.text == "gone") ++counts_.losses.resets;
    if (!evemu_) return reports_.note(note.text, note.device);
    return noted_loss(note.text) ? frames_.lost() : Expected<void>();
  }
  /// Nothing else comes from devices.
  template <class Other>
  Expected<void> operator()(const Other&) {
    return {};
  }

 private:
  /// A device's first report may have been stamped before another one's that came out first.
  Timestamp since_start(Timestamp time) noexcept {
    if (!start_) start_ = time;
    return std::max(Timestamp(0), time - *start_);
  }

  HidRecorderWriter reports_;
  EvemuWriter frames_;
  bool evemu_ = false;
  std::vector<EvdevEvent> shifted_;
  std::optional<Timestamp> start_;
  Counts counts_;
};

std::string summarise(const Counts& counts, Timestamp duration) {
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.1f s", to_seconds(duration));
  return (counts.frames > 0 ? count_of(counts.frames, "frame")
                            : count_of(counts.reports, "report")) +
         " of " + count_of(counts.devices, "device") + " in " + seconds +
         losses_text(counts.losses);
}

}  // namespace

Outcome run_record(const RecordArguments& arguments) {
  auto reader = open_live_input(arguments.live);
  if (!reader) return tl::unexpected(std::move(reader.error()));
  auto file = in_file(arguments.output, RecordingFile::create(arguments.output));
  if (!file) return tl::unexpected(std::move(file.error()));
  Recorder recorder(*file);
  const StopOnSignal stop(**reader);
  const bool shows_progress = ::isatty(STDERR_FILENO) != 0;
  if (shows_progress) std::fputs("recording; Ctrl-C ends it\n", stderr);

  WaitingClock& clock = monotonic_clock();
  const Timestamp start = clock.now();
  Timestamp end = arguments.seconds > 0
                      ? start + Timestamp(static_cast<std::int64_t>(arguments.seconds * 1e9))
                      : Timestamp::max();
  Timestamp sync_due = Timestamp::max();
  Timestamp progress_due = shows_progress ? start + kProgressPeriod : Timestamp::max();
  Expected<void> written;
  for (bool ended = false; !ended && written;) {
    const auto event = *(*reader)->next_until(std::min({sync_due, progress_due, end}));
    const Timestamp now = clock.now();
    if (event) {
      written = std::visit(recorder, *event);
      ended = std::holds_alternative<TraceEnd>(*event);
      if (sync_due == Timestamp::max() && file->dirty()) sync_due = now + kSyncPeriod;
    }
    if (written && now >= sync_due) {
      written = file->sync();
      sync_due = Timestamp::max();
    }
    if (now >= progress_due) {
      std::fprintf(stderr, "\r\033[K%s", summarise(recorder.counts(), now - start).c_str());
      progress_due = now + kProgressPeriod;
    }
    if (now >= end) {  // what has come by now still comes out, and then the end
      (*reader)->stop();
      end = Timestamp::max();
    }
  }
  if (shows_progress) std::fputs("\r\033[K", stderr);
  if (written) written = file->sync();
  if (!written) {
    written.error().remedy += "; what was recorded before stands";
    return in_file(arguments.output, std::move(written));
  }
  std::fprintf(stderr, "%s\n", summarise(recorder.counts(), clock.now() - start).c_str());
  return {};
}

}  // namespace limn::app
