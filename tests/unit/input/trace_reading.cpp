#include "tests/unit/input/trace_reading.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace limn::test {
namespace {

class DribbleBytes final : public ByteSource {
 public:
  DribbleBytes(std::string_view text, std::size_t longest) : rest_(text), longest_(longest) {}

  Expected<std::size_t> read(std::span<char> out) override {
    piece_ = piece_ % longest_ + 1;
    const std::size_t count = std::min({out.size(), rest_.size(), piece_});
    if (count > 0) std::memcpy(out.data(), rest_.data(), count);
    rest_.remove_prefix(count);
    return count;
  }

 private:
  std::string_view rest_;
  std::size_t longest_;
  std::size_t piece_ = 0;
};

/// Copies what an event borrows.
class Collector {
 public:
  explicit Collector(Reading& reading) : reading_(reading) {}

  void operator()(const TraceEnd&) { reading_.order += '.'; }
  void operator()(const DeviceDescribed& described) {
    reading_.order += 'd';
    reading_.devices.push_back(*described.device);
  }
  void operator()(const Report& report) {
    reading_.order += 'r';
    reading_.reports.push_back(
        {report.device, report.time.count(), {report.bytes.begin(), report.bytes.end()}});
  }
  void operator()(const EvdevFrame& frame) {
    reading_.order += 'f';
    reading_.frames.push_back({frame.time.count(), {frame.events.begin(), frame.events.end()}});
  }
  void operator()(const PenSample& sample) {
    reading_.order += 's';
    reading_.samples.push_back(sample);
  }
  void operator()(const TraceNote& note) {
    reading_.order += 'n';
    reading_.notes.emplace_back(note.text);
  }
  void operator()(const TraceDamage& damage) {
    reading_.order += 'x';
    reading_.damage.push_back(damage.error);
  }

 private:
  Reading& reading_;
};

}  // namespace

Reading read_trace(std::unique_ptr<ByteSource> bytes, TraceOptions options) {
  return read_whole(open_trace(std::move(bytes), std::move(options)));
}

Reading read_whole(Expected<std::unique_ptr<TraceReader>> reader) {
  Reading reading;
  if (!reader) {
    reading.order = "!";
    reading.error = reader.error();
    return reading;
  }
  reading.format = (*reader)->format();
  for (;;) {
    const auto event = (*reader)->next();
    if (!event) {
      reading.order += '!';
      reading.error = event.error();
      return reading;
    }
    std::visit(Collector(reading), *event);
    if (std::holds_alternative<TraceEnd>(*event)) return reading;
    reading.places.push_back((*reader)->place());
  }
}

Reading read_trace(std::string_view text, TraceOptions options) {
  return read_trace(memory_bytes(text), std::move(options));
}

Reading salvage_trace(std::string_view text) {
  TraceOptions options;
  options.salvage = true;
  return read_trace(text, std::move(options));
}

std::unique_ptr<ByteSource> dribble_bytes(std::string_view text, std::size_t longest) {
  return std::make_unique<DribbleBytes>(text, longest);
}

std::string at_and_what(const Error& error) { return error.at + ": " + error.what; }

}  // namespace limn::test
