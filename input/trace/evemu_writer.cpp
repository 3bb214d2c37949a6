#include "input/trace/evemu_writer.hpp"

#include <utility>

#include "input/trace/text.hpp"

namespace limn {
namespace {

constexpr int kHexadecimal = 16;
constexpr std::uint16_t kEvSyn = 0;  // <linux/input-event-codes.h>
constexpr std::uint16_t kSynReport = 0;
constexpr std::uint16_t kSynDropped = 3;

}  // namespace

Expected<void> EvemuWriter::describe(const TraceDevice& device) {
  if (device.report_descriptor.size() > kMaxDescriptorBytes ||
      device.name.size() > kMaxDeviceTextBytes) {
    return fail(ErrorCode::kLimit, "", "a device that describes itself at such length",
                "keep descriptors to " + std::to_string(kMaxDescriptorBytes) + " bytes, names to " +
                    std::to_string(kMaxDeviceTextBytes));
  }
  lines_ = "# EVEMU 1.3\nN: ";
  text::append_one_line(lines_, device.name);
  lines_ += "I:";
  for (const std::uint16_t id : {device.bus, device.vendor, device.product, device.version}) {
    lines_ += ' ';
    text::append_number(lines_, id, kHexadecimal, 4);
  }
  lines_ += '\n';
  if (!device.report_descriptor.empty()) {
    lines_ += "#limn R: ";
    text::append_counted_bytes(lines_, device.report_descriptor);
  }
  for (const EvdevAxis& axis : device.axes) {
    lines_ += "A: ";
    text::append_number(lines_, axis.code, kHexadecimal, 2);
    for (const std::int32_t number :
         {axis.minimum, axis.maximum, axis.fuzz, axis.flat, axis.resolution}) {
      lines_ += ' ';
      text::append_number(lines_, number);
    }
    lines_ += '\n';
  }
  return sink_.write(lines_);
}

Expected<void> EvemuWriter::write(const EvdevFrame& frame) {
  if (frame.events.size() > kMaxFrameEvents) {
    return fail(ErrorCode::kLimit, "",
                "a frame of " + text::counted(frame.events.size(), "event") + " cannot be recorded",
                "keep it to " + std::to_string(kMaxFrameEvents));
  }
  lines_.clear();
  Timestamp last = last_;
  bool in_order = true;
  const auto step_to = [&](Timestamp time) { in_order &= std::exchange(last, time) <= time; };
  for (const EvdevEvent& event : frame.events) {
    step_to(event.time);
    if (in_order) append_event(event.time, event.type, event.code, event.value);
  }
  step_to(frame.time);
  if (!in_order) {
    return fail(ErrorCode::kOutOfRange, "", "an event before the one before it cannot be recorded",
                "count time from the first event");
  }
  append_event(frame.time, kEvSyn, kSynReport, 0);
  auto written = sink_.write(lines_);
  if (written) last_ = frame.time;
  return written;
}

Expected<void> EvemuWriter::lost() {
  lines_.clear();
  append_event(last_, kEvSyn, kSynDropped, 0);
  append_event(last_, kEvSyn, kSynReport, 0);
  return sink_.write(lines_);
}

Expected<void> EvemuWriter::note(std::string_view note) {
  lines_ = "#limn ";
  text::append_one_line(lines_, note);
  return sink_.write(lines_);
}

void EvemuWriter::append_event(Timestamp time, std::uint16_t type, std::uint16_t code,
                               std::int32_t value) {
  lines_ += "E: ";
  text::append_seconds(lines_, time);
  lines_ += ' ';
  text::append_number(lines_, type, kHexadecimal, 4);
  lines_ += ' ';
  text::append_number(lines_, code, kHexadecimal, 4);
  lines_ += ' ';
  text::append_number(lines_, value);
  lines_ += '\n';
}

}  // namespace limn
