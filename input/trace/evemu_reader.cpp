#include "input/trace/evemu_reader.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "input/trace/text.hpp"

namespace limn {
namespace {

constexpr int kHexadecimal = 16;
constexpr std::uint16_t kEvSyn = 0;  // <linux/input-event-codes.h>
constexpr std::uint16_t kSynReport = 0;
constexpr std::uint16_t kAbsMax = 0x3F;
constexpr std::string_view kNotePrefix = "#limn ";
constexpr std::string_view kDescriptorPrefix = "#limn R:";

/// A comment may stand behind the fields of a line, but for a name, to which a # may belong.
std::string_view without_comment(std::string_view text) {
  return text.substr(0, std::min(text.find('#'), text.size()));
}

}  // namespace

EvemuReader::EvemuReader(std::unique_ptr<ByteSource> bytes, TraceOptions options)
    : LineTraceReader(std::move(bytes), options.salvage),
      devices_(std::move(options.supplied)),
      device_(*devices_.find_or_add(0)) {}

Expected<void> EvemuReader::take(const Line& line) {
  const std::string_view text = line.text;
  if (text.starts_with(kDescriptorPrefix)) {
    if (!line.terminated) return cut_short();
    return take_descriptor(text.substr(kDescriptorPrefix.size()));
  }
  if (text.starts_with(kNotePrefix)) {
    if (!line.terminated) return cut_short();
    if (!device_.announced) announce();  // what a note is about stands above it
    emit(TraceNote{text.substr(kNotePrefix.size()), 0});
    return {};
  }
  if (text.empty() || text[0] == '#' || text::trimmed(text).empty()) return {};
  const bool keyed = text.size() >= 2 && text[1] == ':' && text::is_letter(text[0]);
  if (keyed && text[0] == 'E') return take_event(text.substr(2), line.terminated);
  if (!line.terminated) return cut_short();
  if (!keyed) {
    if (text::is_prose(text)) return {};
    return damaged(text::quoted(text) + " is no line of an evemu file");
  }
  const std::string_view rest = text.substr(2);
  switch (text[0]) {
    case 'N':
      return take_name(rest);
    case 'I':
      return take_ids(without_comment(rest));
    case 'A':
      return take_axis(without_comment(rest));
    default:
      return {};  // P: and B: say which events may come, L: and S: the initial LEDs and switches
  }
}

/// The description, which is about to change. A name begins a new one.
TraceDevice& EvemuReader::description() {
  device_.announced = false;
  return device_.description;
}

void EvemuReader::announce() { emit(devices_.announce(device_)); }

Expected<void> EvemuReader::take_name(std::string_view rest) {
  rest = text::trimmed(rest);
  if (rest.size() > kMaxDeviceTextBytes) {
    return damaged("a device name of " + text::counted(rest.size(), "byte"), ErrorCode::kLimit);
  }
  TraceDevice anew;
  anew.name = rest;
  description() = std::move(anew);
  return {};
}

Expected<void> EvemuReader::take_ids(std::string_view rest) {
  std::array<std::uint16_t, 4> ids{};
  for (std::uint16_t& id : ids) {
    const auto number = text::parse_integer<std::uint16_t>(text::take_word(rest), kHexadecimal);
    if (!number) {
      return damaged("I: wants bus, vendor, product and version as four hexadecimal numbers");
    }
    id = *number;
  }
  TraceDevice& device = description();
  device.bus = ids[0];
  device.vendor = ids[1];
  device.product = ids[2];
  device.version = ids[3];
  return {};
}

Expected<void> EvemuReader::take_descriptor(std::string_view rest) {
  const auto length = text::parse_integer<std::uint32_t>(text::take_word(rest));
  if (!length || *length > kMaxDescriptorBytes) {
    return damaged("#limn R: wants a length of at most " + std::to_string(kMaxDescriptorBytes));
  }
  std::vector<std::uint8_t> bytes(*length);
  const auto read = text::parse_hex_bytes(rest, bytes);
  if (!read.bad.empty() || read.count != *length) {
    return damaged("#limn R: wants " + text::counted(*length, "byte") + " behind the length");
  }
  description().report_descriptor = std::move(bytes);
  return {};
}

Expected<void> EvemuReader::take_axis(std::string_view rest) {
  EvdevAxis axis;
  const auto code = text::parse_integer<std::uint16_t>(text::take_word(rest), kHexadecimal);
  if (!code || *code > kAbsMax) return damaged("A: wants an axis code from 00 to 3f");
  axis.code = *code;
  for (std::int32_t* field : {&axis.minimum, &axis.maximum, &axis.fuzz, &axis.flat}) {
    const auto number = text::parse_integer<std::int32_t>(text::take_word(rest));
    if (!number) return damaged("A: wants minimum, maximum, fuzz and flat behind the code");
    *field = *number;
  }
  const std::string_view word = text::take_word(rest);  // resolution: not in 1.0
  const auto resolution = text::parse_integer<std::int32_t>(word.empty() ? "0" : word);
  if (!resolution) return damaged(text::quoted(word) + " is no resolution");
  axis.resolution = *resolution;
  std::vector<EvdevAxis>& axes = description().axes;
  const auto same = std::find_if(axes.begin(), axes.end(),
                                 [&axis](const EvdevAxis& a) { return a.code == axis.code; });
  if (same != axes.end()) {
    *same = axis;
  } else {
    axes.push_back(axis);
  }
  return {};
}

Expected<void> EvemuReader::take_event(std::string_view rest, bool terminated) {
  const std::string_view word = text::take_word(rest);
  const auto time = text::parse_seconds(word);
  if (!time) return damaged(text::quoted(word) + " is no time");
  const auto type = text::parse_integer<std::uint16_t>(text::take_word(rest), kHexadecimal);
  const auto code = text::parse_integer<std::uint16_t>(text::take_word(rest), kHexadecimal);
  const auto value = text::parse_integer<std::int32_t>(text::take_word(rest));
  if (!type || !code || !value) return damaged("E: wants type, code and value behind the time");
  if (!text::trimmed(without_comment(rest)).empty()) {
    return damaged(text::quoted(rest) + " stands behind the value");
  }
  // Digits of the value may be missing; that of a SYN_REPORT means nothing.
  const bool ends_frame = *type == kEvSyn && *code == kSynReport;
  if (!terminated && !ends_frame && rest.empty()) return cut_short();
  if (frame_damaged_) {
    if (!ends_frame) return damaged("its frame was damaged before it");
    frame_damaged_ = false;
    return {};
  }
  if (device_.last && *time < *device_.last) {
    return went_back(word, "event");
  }
  device_.last = time;
  return add_to_frame({*time, *type, *code, *value});
}

Expected<void> EvemuReader::add_to_frame(const EvdevEvent& event) {
  if (std::exchange(frame_sent_, false)) frame_.clear();
  if (event.type != kEvSyn || event.code != kSynReport) {
    if (frame_.size() == kMaxFrameEvents) {
      return damaged("a frame of more than " + std::to_string(kMaxFrameEvents) + " events",
                     ErrorCode::kLimit);
    }
    frame_.push_back(event);
    return {};
  }
  if (!device_.announced) announce();
  emit(EvdevFrame{device_.description.index, event.time, frame_});
  frame_sent_ = true;
  return {};
}

Expected<void> EvemuReader::finish() {
  if (!device_.announced) announce();
  if (!frame_.empty() && !frame_sent_) {
    return damaged("the last frame is cut short: no SYN_REPORT ends it");
  }
  return {};
}

/// A frame that lacks an event would pair new values with old ones, so the whole frame goes.
void EvemuReader::skipped(const Line& line) {
  const bool in_frame = !frame_.empty() && !frame_sent_;
  if (!in_frame && !device_.last && line.text.substr(0, 2) != "E:") return;  // still the header
  if (!frame_damaged_) lose_report(device_.description.index);
  frame_.clear();
  frame_sent_ = false;
  frame_damaged_ = true;
}

}  // namespace limn
