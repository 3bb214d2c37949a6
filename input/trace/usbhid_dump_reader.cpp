#include "input/trace/usbhid_dump_reader.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "input/trace/text.hpp"

namespace limn {
namespace {

constexpr std::size_t kRowBytes = 16;  // the dump starts a new line after this many
constexpr std::uint16_t kBusUsb = 3;   // Linux BUS_USB
constexpr DeviceIndex kInterfaces = 256;

/// "BUS:DEVICE:INTERFACE:REST" or, as the first releases wrote, "INTERFACE:REST".
struct Address {
  std::uint16_t bus = 0;
  std::uint16_t device = 0;
  std::uint8_t interface = 0;
  std::string_view rest;
};

std::optional<Address> parse_address(std::string_view text) {
  constexpr std::size_t kNumbers = 3;
  constexpr std::size_t kDigits = 3;
  std::array<std::uint16_t, kNumbers> numbers{};
  std::size_t count = 0;
  while (count < kNumbers) {
    const std::size_t colon = text.find(':');
    if (colon > kDigits) break;
    const auto number = text::parse_integer<std::uint16_t>(text.substr(0, colon));
    if (!number) break;
    numbers[count++] = *number;
    text.remove_prefix(colon + 1);
  }
  Address address;
  address.rest = text;
  if (count == kNumbers) {
    address.bus = numbers[0];
    address.device = numbers[1];
  } else if (count != 1) {
    return std::nullopt;
  }
  const std::uint16_t interface = numbers[count - 1];
  if (interface >= kInterfaces) return std::nullopt;
  address.interface = static_cast<std::uint8_t>(interface);
  return address;
}

}  // namespace

bool is_usbhid_dump_header(std::string_view line) {
  auto address = parse_address(text::trimmed(line));
  if (!address) return false;
  const std::string_view kind = text::take_word(address->rest);
  return kind == "STREAM" || kind == "DESCRIPTOR";
}

UsbhidDumpReader::UsbhidDumpReader(std::unique_ptr<ByteSource> bytes, TraceOptions options)
    : LineTraceReader(std::move(bytes), options.salvage), devices_(std::move(options.supplied)) {}

Expected<void> UsbhidDumpReader::take(const Line& line) {
  const std::string_view text = text::trimmed(line.text);
  if (text.empty()) {
    complete();
    return {};
  }
  if (!line.terminated) return cut_short();
  // Only a header has a colon, and within its first number.
  const std::size_t colon = text.substr(0, 4).find(':');
  if (colon != std::string_view::npos) return take_header(text);
  return take_row(text);
}

Expected<void> UsbhidDumpReader::take_header(std::string_view text) {
  if (record_.kind != RecordKind::kNone && record_.size == 0) {
    return damaged("no bytes follow the record's first line before this one");
  }
  complete();
  auto address = parse_address(text);
  if (!address) return damaged(text::quoted(text) + " is no record's first line");
  const std::string_view kind = text::take_word(address->rest);
  const std::string_view word = text::take_word(address->rest);
  const bool is_report = kind == "STREAM";
  if (!is_report && kind != "DESCRIPTOR") {
    if (text::is_prose(kind)) return {};  // "006:002:000:Interrupt transfer timed out"
    return damaged(text::quoted(kind) + " is neither STREAM nor DESCRIPTOR");
  }
  const auto time = text::parse_seconds(word);
  if (!time || !text::trimmed(address->rest).empty()) {
    return damaged("no time follows " + std::string(kind));
  }
  const auto found = device(address->bus, address->device, address->interface);
  if (!found) return tl::unexpected(found.error());
  std::optional<Timestamp>& last = (*found)->last;
  if (is_report && last && *time < *last) {
    return went_back(word, "report");
  }
  if (is_report) last = time;
  record_.kind = is_report ? RecordKind::kReport : RecordKind::kDescriptor;
  record_.capacity = is_report ? kMaxReportBytes : kMaxDescriptorBytes;
  record_.device = *found;
  record_.time = *time;
  record_.line = line_number();
  return {};
}

Expected<TrackedDevice*> UsbhidDumpReader::device(std::uint16_t bus, std::uint16_t address,
                                                  std::uint8_t interface) {
  const std::uint32_t key = std::uint32_t{bus} << 16 | address;
  const auto known = std::find(addresses_.begin(), addresses_.end(), key);
  const auto ordinal = static_cast<DeviceIndex>(known - addresses_.begin());
  TrackedDevice* const found = ordinal < kMaxTraceDevices
                                   ? devices_.find_or_add(ordinal * kInterfaces + interface)
                                   : nullptr;
  if (found == nullptr) {
    return damaged("more than " + std::to_string(kMaxTraceDevices) + " devices", ErrorCode::kLimit);
  }
  if (known == addresses_.end()) addresses_.push_back(key);
  found->description.bus = kBusUsb;
  return found;
}

Expected<void> UsbhidDumpReader::take_row(std::string_view text) {
  if (bytes_.size() < record_.size + kRowBytes) bytes_.resize(record_.size + kRowBytes);
  const auto read = text::parse_hex_bytes(text, std::span(bytes_).subspan(record_.size));
  if (!read.bad.empty()) {
    if (text::is_prose(text)) return {};  // the tool's messages: "Starting dumping interrupt .."
    return damaged(text::quoted(read.bad) + " is no two-digit byte");
  }
  if (record_.kind == RecordKind::kNone) {
    return damaged(text::quoted(text) + " belongs to no record");
  }
  if (read.count > kRowBytes) {
    return damaged(text::counted(read.count, "byte") + " in a line that holds at most " +
                       std::to_string(kRowBytes),
                   ErrorCode::kPointCount);
  }
  if (record_.size + read.count > record_.capacity) {
    return damaged("the record has more than " + std::to_string(record_.capacity) + " bytes",
                   ErrorCode::kLimit);
  }
  record_.size += read.count;
  record_.last_row = read.count;
  return {};
}

/// Sends the record in hand, if there is one.
void UsbhidDumpReader::complete() {
  const Record record = std::exchange(record_, Record{});
  if (record.kind == RecordKind::kNone) return;
  const auto bytes = std::span(bytes_).first(record.size);
  TrackedDevice& from = *record.device;
  if (record.kind == RecordKind::kDescriptor) {
    from.description.report_descriptor.assign(bytes.begin(), bytes.end());
    emit(devices_.announce(from), record.line);
    return;
  }
  if (!from.announced) emit(devices_.announce(from), record.line);
  emit(Report{from.description.index, record.time, bytes}, record.line);
}

Expected<void> UsbhidDumpReader::finish() {
  const bool cut = record_.kind == RecordKind::kReport && record_.last_row == kRowBytes;
  if (record_.kind != RecordKind::kNone && (record_.size == 0 || cut)) {
    return damaged("the last record is cut short: no blank line ends it");
  }
  complete();
  return {};
}

void UsbhidDumpReader::skipped(const Line& line) {
  const Record record = std::exchange(record_, Record{});
  if (record.kind == RecordKind::kReport) lose_report(record.device->description.index);
  auto address = parse_address(text::trimmed(line.text));
  if (!address || text::take_word(address->rest) != "STREAM") return;
  const auto found = device(address->bus, address->device, address->interface);
  if (found) lose_report((*found)->description.index);
}

}  // namespace limn
