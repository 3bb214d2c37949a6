#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/devices/trace_decoder.hpp"
#include "drivers/transport/paced_reader.hpp"
#include "input/trace/evemu_writer.hpp"
#include "input/trace/hid_recorder_writer.hpp"
#include "input/trace/noted_loss.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/live_input.hpp"
#include "modeler/app/recording_file.hpp"
#include "modeler/app/stop_on_signal.hpp"
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
    const bool decoded = described.device->is_kernel_decoded();
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
    if (!evemu_) return reports_.note(note.text, note.device);
    return noted_loss(note.text) ? frames_.lost() : frames_.note(note.text);
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

std::string summarise(const Counts& counts, const TraceSummary& decoded, Timestamp duration) {
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.1f s", to_seconds(duration));
  return (counts.frames > 0 ? count_of(counts.frames, "frame")
                            : count_of(counts.reports, "report")) +
         " of " + count_of(counts.devices, "device") + " in " + seconds +
         losses_text(decoded.losses());
}

/// Records the events of live devices and hands them on, keeps the file on the disk, shows progress
/// and ends in time. After an error of the file, which written() has, it gives the end.
class RecordingReader final : public TraceReader {
 public:
  RecordingReader(LiveReader& live, RecordingFile& file, Timestamp end)
      : live_(live), file_(file), recorder_(file), end_(end) {}

  TraceFormat format() const noexcept override { return live_.format(); }
  std::string place() const override { return live_.place(); }

  Expected<TraceEvent> next() override {
    for (;;) {
      auto event = next_until(Timestamp::max());
      if (!event) return tl::unexpected(std::move(event.error()));
      if (*event) return **std::move(event);
    }
  }

  Expected<std::optional<TraceEvent>> next_until(Timestamp deadline) override {
    for (;;) {
      if (!written_) return TraceEnd{};
      auto event = live_.next_until(std::min({sync_due_, progress_due_, end_, deadline}));
      if (!event) return event;
      const Timestamp now = monotonic_clock().now();
      if (*event) written_ = std::visit(recorder_, **event);
      if (sync_due_ == Timestamp::max() && file_.dirty()) sync_due_ = now + kSyncPeriod;
      if (written_ && now >= sync_due_) {
        written_ = file_.sync();
        sync_due_ = Timestamp::max();
      }
      if (!written_) continue;
      if (now >= progress_due_) {
        show_();
        progress_due_ = now + kProgressPeriod;
      }
      if (now >= end_) {  // what has come by now still comes out, and then the end
        live_.stop();
        end_ = Timestamp::max();
      }
      if (*event || now >= deadline) return event;
    }
  }

  void show_progress(std::function<void()> show) {
    show_ = std::move(show);
    progress_due_ = monotonic_clock().now() + kProgressPeriod;
  }

  const Counts& counts() const noexcept { return recorder_.counts(); }
  Expected<void>& written() noexcept { return written_; }

 private:
  LiveReader& live_;
  RecordingFile& file_;
  Recorder recorder_;
  Expected<void> written_;
  std::function<void()> show_;
  Timestamp end_;
  Timestamp sync_due_ = Timestamp::max();
  Timestamp progress_due_ = Timestamp::max();
};

}  // namespace

Outcome run_record(const RecordArguments& arguments) {
  auto live = open_live_input(arguments.live);
  if (!live) return tl::unexpected(std::move(live.error()));
  auto file = in_file(arguments.output, RecordingFile::create(arguments.output));
  if (!file) return tl::unexpected(std::move(file.error()));
  const StopOnSignal stop(**live);

  WaitingClock& clock = monotonic_clock();
  const Timestamp start = clock.now();
  const Timestamp end = arguments.seconds > 0
                            ? start + Timestamp(static_cast<std::int64_t>(arguments.seconds * 1e9))
                            : Timestamp::max();
  auto recording = std::make_unique<RecordingReader>(**live, *file, end);
  RecordingReader& reader = *recording;
  // Decoding what is recorded shows what disturbs it: gaps, clock jumps, repaired transitions.
  TraceDecoder decoder(std::move(recording), {.salvage = true});
  const auto summary = [&] {
    return summarise(reader.counts(), decoder.summary(), clock.now() - start);
  };
  const bool shows_progress = ::isatty(STDERR_FILENO) != 0;
  if (shows_progress) {
    std::fputs("recording; Ctrl-C ends it\n", stderr);
    reader.show_progress([&] { std::fprintf(stderr, "\r\033[K%s", summary().c_str()); });
  }
  for (;;) {
    const auto sample = decoder.next();
    if (!sample) return in_file("", Expected<void>(tl::unexpected(sample.error())));
    if (*sample == nullptr) break;
  }
  if (shows_progress) std::fputs("\r\033[K", stderr);
  Expected<void> written = std::move(reader.written());
  if (written) written = file->sync();
  if (!written) {
    written.error().remedy += "; what was recorded before stands";
    return in_file(arguments.output, std::move(written));
  }
  std::fprintf(stderr, "%s\n", summary().c_str());
  return {};
}

}  // namespace limn::app
