#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "input/trace/hid_recorder_reader.hpp"
#include "input/trace/hid_recorder_writer.hpp"
#include "input/trace/noted_string.hpp"
#include "input/trace/trace.hpp"
#include "tests/fuzz/require.hpp"

// The laws that every reader keeps, whatever the bytes. A broken one ends the program.

namespace limn::fuzz {

inline std::string_view as_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

inline void require_good_error(const Error& error) {
  require(!error.what.empty() && !error.remedy.empty(), "an error says what is wrong and to do");
  for (const std::string* part : {&error.at, &error.what, &error.remedy}) {
    for (const char c : *part) require(c >= ' ' && c <= '~', "an error is one printable line");
  }
}

struct KeptReport {
  DeviceIndex device;
  Timestamp time;
  std::vector<std::uint8_t> bytes;
  friend bool operator==(const KeptReport&, const KeptReport&) = default;
};

/// Checks each event of one reading as it comes.
class Laws {
 public:
  Laws(std::size_t input_bytes, bool salvage) : left_(2 * input_bytes + 4), salvage_(salvage) {}

  void operator()(const TraceEnd&) {}
  void operator()(const DeviceDescribed& described) {
    const TraceDevice& device = *described.device;
    described_[device.index] = true;
    require(described_.size() <= kMaxTraceDevices, "devices are limited");
    require(device.report_descriptor.size() <= kMaxDescriptorBytes, "descriptors are limited");
    require(device.name.size() <= kMaxDeviceTextBytes, "names are limited");
  }
  void operator()(const Report& report) {
    require(report.bytes.size() <= kMaxReportBytes, "reports are limited");
    require(described_[report.device], "a device is described before it reports");
    at(report.device, report.time);
    reports.push_back({report.device, report.time, {report.bytes.begin(), report.bytes.end()}});
  }
  void operator()(const EvdevFrame& frame) {
    require(frame.events.size() <= kMaxFrameEvents, "frames are limited");
    require(described_[frame.device], "a device is described before it reports");
    for (const EvdevEvent& event : frame.events) at(frame.device, event.time);
    at(frame.device, frame.time);
  }
  void operator()(const PenSample& sample) {
    at(sample.device, sample.time);
    for (const double value : {sample.x_mm, sample.y_mm, sample.tilt_x_rad, sample.tilt_y_rad}) {
      require(std::isfinite(value), "samples are finite");
    }
    require(sample.pressure >= 0 && sample.pressure <= 1, "pressure is from 0 to 1");
  }
  void operator()(const TraceNote& note) {
    require(note.text.find('\n') == std::string_view::npos, "a note is one line");
    if (const auto string = noted_string(note.text)) {
      const auto again = noted_string(note_of(*string));
      require(again && again->index == string->index && again->bytes == string->bytes,
              "a string's note reads as it was written");
    }
  }
  void operator()(const TraceDamage& damage) {
    require(salvage_, "only salvage skips damage");
    require_good_error(damage.error);
    require(damage.lost.size() <= kMaxTraceDevices, "devices are limited");
    for (const LostReports& lost : damage.lost) require(lost.count > 0, "what is lost is some");
  }

  void count_event() { require(left_-- > 0, "a reading ends"); }

  std::vector<KeptReport> reports;

 private:
  void at(DeviceIndex device, Timestamp time) {
    const auto [last, first] = last_.try_emplace(device, time);
    require(first || last->second <= time, "times never decrease within a device");
    last->second = time;
  }

  std::size_t left_;
  bool salvage_;
  std::map<DeviceIndex, bool> described_;
  std::map<DeviceIndex, Timestamp> last_;
};

struct Outcome {
  std::vector<std::size_t> kinds;  // TraceEvent::index() of each event
  std::vector<KeptReport> reports;
  bool failed = false;
};

inline Outcome read_whole(TraceReader& reader, std::size_t input_bytes, bool salvage) {
  Laws laws(input_bytes, salvage);
  Outcome outcome;
  for (;;) {
    const auto event = reader.next();
    laws.count_event();
    if (!event) {
      require(!salvage, "salvage gives no error where the bytes can be read");
      require_good_error(event.error());
      const auto again = reader.next();
      require(!again && again.error().what == event.error().what, "a spent reader stays spent");
      outcome.failed = true;
      break;
    }
    std::visit(laws, *event);
    if (std::holds_alternative<TraceEnd>(*event)) {
      const auto again = reader.next();
      require(again && std::holds_alternative<TraceEnd>(*again), "the end stays the end");
      break;
    }
    outcome.kinds.push_back(event->index());
  }
  outcome.reports = std::move(laws.reports);
  return outcome;
}

/// What the writer makes of the reports is read back as they were.
inline void require_round_trip(const std::vector<KeptReport>& reports) {
  StringSink sink;
  HidRecorderWriter writer(sink);
  for (const KeptReport& report : reports) {
    require(writer.write({report.device, report.time, report.bytes}).has_value(),
            "what was read can be written");
  }
  HidRecorderReader reader(memory_bytes(sink.text()), {});
  const Outcome again = read_whole(reader, sink.text().size(), false);
  require(!again.failed && again.reports == reports, "what is written is read back");
}

using MakeReader =
    std::function<std::unique_ptr<TraceReader>(std::unique_ptr<ByteSource>, TraceOptions)>;

/// Reads `text` strictly and with salvage.
inline void check_reader(std::string_view text, const MakeReader& make) {
  TraceOptions options;
  const auto strict_reader = make(memory_bytes(text), options);
  if (strict_reader == nullptr) return;
  const Outcome strict = read_whole(*strict_reader, text.size(), false);
  options.salvage = true;
  const auto salvage_reader = make(memory_bytes(text), options);
  require(salvage_reader != nullptr, "salvage opens what strict reading does");
  const Outcome salvaged = read_whole(*salvage_reader, text.size(), true);
  require(salvaged.kinds.size() >= strict.kinds.size(), "salvage gives no less");
  for (std::size_t i = 0; i < strict.kinds.size(); ++i) {
    require(strict.kinds[i] == salvaged.kinds[i], "salvage changes nothing before the damage");
  }
  if (!strict.failed) require(strict.kinds == salvaged.kinds, "salvage changes no whole file");
  require_round_trip(salvaged.reports);
}

}  // namespace limn::fuzz
