#include "input/trace/hid_recorder_reader.hpp"

#include <utility>

#include "input/trace/text.hpp"

namespace limn {
namespace {

constexpr std::string_view kNotePrefix = "#limn";

/// "key:" at the start of a line, for keys of letters only.
bool is_keyed(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == 0 || colon == std::string_view::npos) return false;
  for (const char c : line.substr(0, colon)) {
    if (!text::is_letter(c)) return false;
  }
  return true;
}

}  // namespace

HidRecorderReader::HidRecorderReader(std::unique_ptr<ByteSource> bytes, TraceOptions options)
    : LineTraceReader(std::move(bytes), options.salvage), devices_(std::move(options.supplied)) {}

Expected<void> HidRecorderReader::take(const Line& line) {
  const std::string_view text = line.text;
  if (text.size() >= 2 && text[1] == ':') {
    return take_keyed(text[0], text.substr(2), line.terminated);
  }
  if (!text.empty() && text[0] == '#') return take_comment(line);
  if (text::trimmed(text).empty()) return {};
  if (!line.terminated) return cut_short();
  if (is_keyed(text) || text::is_prose(text)) return {};
  return damaged(text::quoted(text) + " is no line of a hid-recorder file");
}

Expected<void> HidRecorderReader::take_keyed(char key, std::string_view rest, bool terminated) {
  // These prove themselves whole: their length is in them, or their digits are fixed.
  switch (key) {
    case 'E':
      return take_event(rest);
    case 'R':
      return take_descriptor(rest);
    case 'I':
      return take_ids(rest, terminated);
    default:
      break;
  }
  if (!terminated) return cut_short();
  switch (key) {
    case 'D':
      return take_device(rest);
    case 'N':
      return take_text(&TraceDevice::name, rest);
    case 'P':
      return take_text(&TraceDevice::physical_path, rest);
    default:
      if (text::is_letter(key)) return {};
      return damaged(text::quoted(std::string(1, key)) + " is no prefix of a hid-recorder line");
  }
}

Expected<void> HidRecorderReader::take_comment(const Line& line) {
  std::string_view rest = line.text;
  if (rest.substr(0, kNotePrefix.size()) != kNotePrefix) return {};
  rest.remove_prefix(kNotePrefix.size());
  if (!rest.empty() && !text::is_blank(rest[0])) return {};
  if (!line.terminated) return cut_short();
  if (!rest.empty()) rest.remove_prefix(1);
  if (device_ != nullptr && !device_->announced)
    announce();  // what a note is about stands above it
  emit(TraceNote{rest, selected_index()});
  return {};
}

Expected<void> HidRecorderReader::take_device(std::string_view rest) {
  const auto index = text::parse_integer<DeviceIndex>(text::trimmed(rest));
  if (!index) return damaged(text::quoted(rest) + " is no device number");
  const bool other = device_ == nullptr || device_->description.index != *index;
  if (other && device_ != nullptr && !device_->announced) announce();
  device_lost_ = false;
  return select(*index);
}

Expected<void> HidRecorderReader::select(DeviceIndex index) {
  device_ = devices_.find_or_add(index);
  if (device_ != nullptr) return {};
  device_lost_ = true;
  return damaged("more than " + std::to_string(kMaxTraceDevices) + " devices", ErrorCode::kLimit);
}

/// The selected device's description, which is about to change.
Expected<TraceDevice*> HidRecorderReader::description() {
  if (device_lost_) return damaged("whose line this is was lost with the damage before it");
  if (device_ == nullptr) {
    if (const auto selected = select(0); !selected) return tl::unexpected(selected.error());
  }
  device_->announced = false;
  return &device_->description;
}

DeviceIndex HidRecorderReader::selected_index() const noexcept {
  return device_ == nullptr ? 0 : device_->description.index;
}

void HidRecorderReader::announce() { emit(devices_.announce(*device_)); }

Expected<void> HidRecorderReader::take_descriptor(std::string_view rest) {
  const auto count = take_bytes(rest, kMaxDescriptorBytes);
  if (!count) return tl::unexpected(count.error());
  const auto device = description();
  if (!device) return tl::unexpected(device.error());
  (*device)->report_descriptor.assign(bytes_.data(), bytes_.data() + *count);
  return {};
}

Expected<void> HidRecorderReader::take_text(std::string TraceDevice::*member,
                                            std::string_view rest) {
  rest = text::trimmed(rest);
  if (rest.size() > kMaxDeviceTextBytes) {
    return damaged("a device name of " + text::counted(rest.size(), "byte"), ErrorCode::kLimit);
  }
  const auto device = description();
  if (!device) return tl::unexpected(device.error());
  ((*device)->*member) = rest;
  return {};
}

Expected<void> HidRecorderReader::take_ids(std::string_view rest, bool terminated) {
  constexpr int kHexadecimal = 16;
  constexpr std::size_t kFullWidth = 4;
  const auto bus = text::parse_integer<std::uint16_t>(text::take_word(rest), kHexadecimal);
  const auto vendor = text::parse_integer<std::uint16_t>(text::take_word(rest), kHexadecimal);
  const std::string_view last = text::take_word(rest);
  const auto product = text::parse_integer<std::uint16_t>(last, kHexadecimal);
  if (!terminated && last.size() < kFullWidth) return cut_short();
  if (!bus || !vendor || !product || !text::trimmed(rest).empty()) {
    return damaged("I: wants bus, vendor and product as three hexadecimal numbers");
  }
  const auto device = description();
  if (!device) return tl::unexpected(device.error());
  (*device)->bus = *bus;
  (*device)->vendor = *vendor;
  (*device)->product = *product;
  return {};
}

/// Reads "length bytes" into bytes_.
Expected<std::size_t> HidRecorderReader::take_bytes(std::string_view rest, std::size_t limit) {
  const std::string_view word = text::take_word(rest);
  const auto length = text::parse_integer<std::uint32_t>(word);
  if (!length) return damaged(text::quoted(word) + " is no length");
  if (*length > limit) {
    return damaged("a length of " + std::to_string(*length) + " where at most " +
                       std::to_string(limit) + " bytes are possible",
                   ErrorCode::kLimit);
  }
  if (bytes_.size() < *length) bytes_.resize(*length);
  const auto read = text::parse_hex_bytes(rest, bytes_);
  if (!read.bad.empty()) return damaged(text::quoted(read.bad) + " is no two-digit byte");
  if (read.count != *length) {
    return damaged("the length says " + text::counted(*length, "byte") + " but " +
                       std::to_string(read.count) + " follow",
                   ErrorCode::kPointCount);
  }
  return read.count;
}

Expected<void> HidRecorderReader::take_event(std::string_view rest) {
  const std::string_view word = text::take_word(rest);
  const auto time = text::parse_seconds(word);
  if (!time) return damaged(text::quoted(word) + " is no time");
  const auto count = take_bytes(rest, kMaxReportBytes);
  if (!count) return tl::unexpected(count.error());
  if (device_lost_) return damaged("whose report this is was lost with the damage before it");
  if (device_ == nullptr) {
    if (auto selected = select(0); !selected) return selected;
  }
  if (device_->last && *time < *device_->last) {
    return went_back(word, "report");
  }
  device_->last = time;
  if (!device_->announced) announce();
  emit(Report{device_->description.index, *time, std::span(bytes_.data(), *count)});
  return {};
}

Expected<void> HidRecorderReader::finish() {
  if (device_ != nullptr && !device_->announced) announce();
  return {};
}

/// Where several devices record, a D: may have gone with any line but one that begins as a report
/// does and is all text.
void HidRecorderReader::skipped(const Line& line) {
  const std::string_view key = line.text.substr(0, 2);
  if (key == "E:" && !device_lost_) lose_report(selected_index());
  const bool report =
      key == "E:" && !line.too_long && line.text.find('\0') == std::string_view::npos;
  if (key == "D:" || (!report && devices_.size() > 1)) device_lost_ = true;
}

}  // namespace limn
