#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "drivers/devices/device_traits.hpp"
#include "input/trace/evemu_writer.hpp"
#include "input/trace/hid_recorder_writer.hpp"
#include "input/trace/noted_loss.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/output_file.hpp"
#include "modeler/app/trace_input.hpp"

namespace limn::app {
namespace {

/// Takes the events of a recording in, and writes them with times from the first one that is kept:
/// reports as a hid-recorder file; kernel frames each device for itself as an evemu file, which
/// only counts where no report came at all, so that it is kept until then. An evemu file stays one,
/// and is written as it comes.
class Conversion {
 public:
  Conversion(ByteSink& output, TraceFormat format, std::optional<DeviceIndex> wanted)
      : output_(output),
        reports_(output),
        stays_evemu_(format == TraceFormat::kEvemu),
        wanted_(wanted) {}

  /// Of devices that may report only what is known; they are written when they first report.
  Expected<void> operator()(const DeviceDescribed& described) {
    const TraceDevice& device = *described.device;
    if (!is_wanted(device.index)) return {};
    Device& known = devices_[device.index];
    known.description = device;
    known.stale = true;
    if (known.frames == nullptr) return {};
    return known.frames->writer.describe(device);
  }

  Expected<void> operator()(const Report& report) {
    if (!is_wanted(report.device)) return {};
    const Timestamp time = since_start(report.time);
    if (report_count_++ == 0) {
      for (auto& [index, device] : devices_) device.frames.reset();
    }
    reporting_.insert(report.device);
    return describe(report.device).and_then([&] {
      return reports_.write({report.device, time, report.bytes});
    });
  }

  Expected<void> operator()(const EvdevFrame& frame) {
    if (!is_wanted(frame.device)) return {};
    shifted_.assign(frame.events.begin(), frame.events.end());
    for (EvdevEvent& event : shifted_) event.time = since_start(event.time);
    const Timestamp time = since_start(frame.time);
    ++frame_count_;
    Device& device = devices_[frame.device];
    device.kernel = true;
    if (report_count_ > 0) return {};
    return frames_of(device).and_then([&](Frames* frames) {
      ++frames->count;
      return frames->writer.write({frame.device, time, shifted_});
    });
  }

  Expected<void> operator()(const TraceNote& note) {
    if (!is_wanted(note.device)) return {};
    Device& device = devices_[note.device];
    if (!device.kernel && device.description.axes.empty()) {
      return describe(note.device).and_then([&] { return reports_.note(note.text, note.device); });
    }
    if (report_count_ > 0) return {};
    return frames_of(device).and_then([&](Frames* frames) {
      return noted_loss(note.text) ? frames->writer.lost() : frames->writer.note(note.text);
    });
  }

  /// What was skipped stays known: as lost reports of their device.
  Expected<void> operator()(const TraceDamage& damage) {
    ++damage_count_;
    for (const LostReports& lost : damage.lost) {
      const std::string note = "lost " + std::to_string(lost.count);
      if (auto noted = (*this)(TraceNote{note, lost.device}); !noted) return noted;
    }
    return {};
  }

  Expected<void> operator()(const PenSample&) {
    return fail(ErrorCode::kUnknown, "", "holds a pen's samples, not a device's reports",
                "decode or sketch it as it is");
  }
  Expected<void> operator()(const TraceEnd&) { return {}; }

  /// Describes what did not report, too. The text of the evemu file that is still to be written;
  /// nothing where all is written.
  Expected<std::optional<std::string>> finish() {
    std::vector<const Device*> recorded;
    for (const auto& [index, device] : devices_) {
      if (device.frames != nullptr) recorded.push_back(&device);
    }
    if (recorded.size() == 1) return text_of(*recorded[0]->frames);
    if (recorded.size() > 1) return several(recorded);
    const bool silent = report_count_ + frame_count_ == 0;
    if (silent && devices_.size() == 1 && !devices_.begin()->second.description.axes.empty()) {
      return frames_of(devices_.begin()->second).map([this](Frames* frames) {
        return text_of(*frames);
      });
    }
    for (const auto& [index, device] : devices_) {
      if (!silent && (device.kernel || !device.description.axes.empty())) continue;
      if (auto written = describe(index); !written) return tl::unexpected(written.error());
    }
    if (devices_.empty()) {
      return fail(ErrorCode::kMissing, "",
                  wanted_ ? "has no device " + std::to_string(*wanted_)
                          : "no device and no report is in it",
                  wanted_ ? "name one that the recording has, or none"
                          : "record while the device is plugged in and used");
    }
    return std::nullopt;
  }

  /// "763 reports of 1 device in 3.5 s, 2 damaged parts".
  std::string summary(bool evemu) const {
    std::string text = evemu ? count_of(frame_count_, "frame") + " of 1 device"
                             : count_of(report_count_, "report") + " of " +
                                   count_of(std::max(reporting_.size(), described_), "device");
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, " in %.1f s",
                  to_seconds(last_ - start_.value_or(last_)));
    text += seconds;
    if (damage_count_ > 0) text += ", " + count_of(damage_count_, "damaged part");
    if (!evemu && frame_count_ > 0) {
      text += ", without " + count_of(frame_count_, "frame") + " that the kernel decoded";
    }
    return text;
  }

  /// A line of each device whose reports nothing explains: no descriptor, no table.
  std::string unexplained() const {
    std::string text;
    for (const DeviceIndex index : reporting_) {
      const TraceDevice& device = devices_.at(index).description;
      if (!device.report_descriptor.empty() || traits_of(device).kind != DeviceKind::kOther) {
        continue;
      }
      char ids[16];
      std::snprintf(ids, sizeof ids, "%04x:%04x", device.vendor, device.product);
      text += "device " + std::to_string(index) + " (" + ids +
              ") has no report descriptor in it: decode with --salvage, or give it with "
              "--descriptor";
      if (reporting_.size() > 1) text += ", or convert another one with --device N";
      text += '\n';
    }
    return text;
  }

 private:
  struct Frames {
    explicit Frames(ByteSink* direct) : writer(direct != nullptr ? *direct : kept) {}
    StringSink kept;
    EvemuWriter writer;
    std::uint64_t count = 0;
  };
  struct Device {
    TraceDevice description;
    bool stale = true;    // its description, as it stands, is not yet written
    bool kernel = false;  // it gave frames
    std::unique_ptr<Frames> frames;
  };

  bool is_wanted(DeviceIndex device) const noexcept { return !wanted_ || *wanted_ == device; }

  /// A device's first event may have been stamped before another one's that came out first.
  Timestamp since_start(Timestamp time) noexcept {
    if (!start_) start_ = last_ = time;
    last_ = std::max(last_, time);
    return std::max(Timestamp(0), time - *start_);
  }

  /// The evemu file of a device, begun with its description. Precondition: no report came.
  Expected<Frames*> frames_of(Device& device) {
    if (device.frames == nullptr) {
      device.frames = std::make_unique<Frames>(stays_evemu_ ? &output_ : nullptr);
      if (auto written = device.frames->writer.describe(device.description); !written) {
        return tl::unexpected(written.error());
      }
    }
    return device.frames.get();
  }

  std::optional<std::string> text_of(const Frames& frames) const {
    return stays_evemu_ ? std::nullopt : std::optional<std::string>(frames.kept.text());
  }

  /// Writes the device's description where it is news.
  Expected<void> describe(DeviceIndex index) {
    Device& device = devices_[index];
    device.description.index = index;
    if (!std::exchange(device.stale, false)) return {};
    ++described_;
    return reports_.describe(device.description);
  }

  tl::unexpected<Error> several(const std::vector<const Device*>& recorded) const {
    std::string what = "the kernel's events of " + std::to_string(recorded.size()) +
                       " devices, and an evemu file holds one:";
    for (const Device* device : recorded) {
      what += ' ' + std::to_string(device->description.index) + " (" + device->description.name +
              ", " + count_of(device->frames->count, "frame") + ")";
    }
    return fail(ErrorCode::kLimit, "", std::move(what), "choose one with --device N");
  }

  ByteSink& output_;
  HidRecorderWriter reports_;
  bool stays_evemu_;
  std::optional<DeviceIndex> wanted_;
  std::map<DeviceIndex, Device> devices_;
  std::set<DeviceIndex> reporting_;
  std::size_t described_ = 0;
  std::vector<EvdevEvent> shifted_;
  std::optional<Timestamp> start_;
  Timestamp last_{};
  std::uint64_t report_count_ = 0;
  std::uint64_t frame_count_ = 0;
  std::uint64_t damage_count_ = 0;
};

/// Reports go to the file as they come; an error of the file is not one of the recording.
class Output final : public ByteSink {
 public:
  explicit Output(OutputFile& file) : file_(file) {}
  Expected<void> write(std::string_view bytes) override {
    constexpr std::size_t kPiece = 1 << 16;
    gathered_ += bytes;
    return gathered_.size() < kPiece ? Expected<void>() : flush();
  }
  Expected<void> flush() {
    auto written = file_.write(gathered_);
    gathered_.clear();
    failed = !written;
    return written;
  }
  bool failed = false;

 private:
  OutputFile& file_;
  std::string gathered_;
};

}  // namespace

Outcome run_convert(const ConvertArguments& arguments) {
  const std::string& input = arguments.trace.path;
  auto reader = open_import_input(arguments.trace);
  if (!reader) return tl::unexpected(std::move(reader.error()));
  auto file = in_file(arguments.output, OutputFile::open(arguments.output));
  if (!file) return tl::unexpected(std::move(file.error()));

  Output output(*file);
  Conversion conversion(output, (*reader)->format(), arguments.device);
  for (;;) {
    auto event = (*reader)->next();
    if (!event) return in_file(input, Expected<void>(tl::unexpected(std::move(event.error()))));
    auto taken = std::visit(conversion, *event);
    if (!taken) {
      if (!output.failed) taken.error().at = (*reader)->place();
      return in_file(output.failed ? arguments.output : input, std::move(taken));
    }
    if (std::holds_alternative<TraceEnd>(*event)) break;
  }
  auto evemu = conversion.finish();
  if (!evemu) {
    return in_file(output.failed ? arguments.output : input,
                   Expected<void>(tl::unexpected(std::move(evemu.error()))));
  }
  auto written =
      (*evemu ? file->write(**evemu) : output.flush()).and_then([&] { return file->commit(); });
  if (!written) return in_file(arguments.output, std::move(written));
  const bool is_evemu = evemu->has_value() || (*reader)->format() == TraceFormat::kEvemu;
  std::fprintf(stderr, "%s to %s: %s\n", std::string(name((*reader)->format())).c_str(),
               is_evemu ? "evemu" : "hid-recorder", conversion.summary(is_evemu).c_str());
  std::fputs(conversion.unexplained().c_str(), stderr);
  return {};
}

}  // namespace limn::app
