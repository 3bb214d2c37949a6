#include "input/trace/hid_recorder_writer.hpp"

#include <array>
#include <charconv>

#include "input/trace/text.hpp"

namespace limn {
namespace {

template <class T>
void append_number(std::string& out, T value, int base = 10, std::size_t width = 1) {
  std::array<char, 24> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, base).ptr;
  const auto count = static_cast<std::size_t>(end - digits.data());
  if (count < width) out.append(width - count, '0');
  out.append(digits.data(), count);
}

void append_time(std::string& out, Timestamp time) {
  constexpr std::int64_t kNanosecond = 1'000'000'000;
  constexpr std::int64_t kMicrosecond = 1'000;
  const std::int64_t fraction = time.count() % kNanosecond;
  append_number(out, time.count() / kNanosecond);
  out += '.';
  if (fraction % kMicrosecond == 0) {
    append_number(out, fraction / kMicrosecond, 10, 6);
  } else {
    append_number(out, fraction, 10, 9);
  }
}

tl::unexpected<Error> too_large(std::string_view noun, std::size_t size, std::size_t limit) {
  return fail(ErrorCode::kLimit, "",
              std::string(noun) + " of " + text::counted(size, "byte") + " cannot be recorded",
              "keep it to " + std::to_string(limit) + " bytes");
}

}  // namespace

Expected<void> HidRecorderWriter::describe(const TraceDevice& device) {
  if (device.report_descriptor.size() > kMaxDescriptorBytes) {
    return too_large("a descriptor", device.report_descriptor.size(), kMaxDescriptorBytes);
  }
  for (const std::string* text : {&device.name, &device.physical_path}) {
    if (text->size() > kMaxDeviceTextBytes) {
      return too_large("a device name", text->size(), kMaxDeviceTextBytes);
    }
  }
  begin_device(device.index);
  if (!device.report_descriptor.empty()) {
    lines_ += "R: ";
    append_bytes(device.report_descriptor);
  }
  if (!device.name.empty()) {
    lines_ += "N: ";
    append_text(device.name);
  }
  if (!device.physical_path.empty()) {
    lines_ += "P: ";
    append_text(device.physical_path);
  }
  if (device.bus != 0 || device.vendor != 0 || device.product != 0) {
    constexpr int kHexadecimal = 16;
    lines_ += "I: ";
    append_number(lines_, device.bus, kHexadecimal);
    lines_ += ' ';
    append_number(lines_, device.vendor, kHexadecimal, 4);
    lines_ += ' ';
    append_number(lines_, device.product, kHexadecimal, 4);
    lines_ += '\n';
  }
  return flush(device.index);
}

Expected<void> HidRecorderWriter::write(const Report& report) {
  if (report.bytes.size() > kMaxReportBytes) {
    return too_large("a report", report.bytes.size(), kMaxReportBytes);
  }
  if (report.time < Timestamp::zero()) {
    return fail(ErrorCode::kOutOfRange, "", "a report before time zero cannot be recorded",
                "count time from the first event");
  }
  begin_device(report.device);
  lines_ += "E: ";
  append_time(lines_, report.time);
  lines_ += ' ';
  append_bytes(report.bytes);
  return flush(report.device);
}

Expected<void> HidRecorderWriter::note(std::string_view text) {
  lines_.clear();
  if (auto appended = append_note(text); !appended) return appended;
  return flush(selected_);
}

Expected<void> HidRecorderWriter::note(std::string_view text, DeviceIndex device) {
  begin_device(device);
  if (auto appended = append_note(text); !appended) return appended;
  return flush(device);
}

Expected<void> HidRecorderWriter::append_note(std::string_view text) {
  constexpr std::string_view kPrefix = "#limn";
  if (text.size() + kPrefix.size() + 1 > kMaxLineBytes) {
    return too_large("a note", text.size(), kMaxLineBytes - kPrefix.size() - 1);
  }
  lines_ += kPrefix;
  if (!text.empty()) lines_ += ' ';
  append_text(text);
  return {};
}

/// Empties lines_ but for a D: where one is needed.
void HidRecorderWriter::begin_device(DeviceIndex device) {
  lines_.clear();
  if (selected_ == device) return;
  lines_ += "D: ";
  append_number(lines_, device);
  lines_ += '\n';
}

/// "length bytes" and the line end.
void HidRecorderWriter::append_bytes(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  append_number(lines_, bytes.size());
  for (const std::uint8_t byte : bytes) {
    lines_ += ' ';
    lines_ += kDigits[byte >> 4];
    lines_ += kDigits[byte & 0xF];
  }
  lines_ += '\n';
}

/// `text` on one line, and the line end.
void HidRecorderWriter::append_text(std::string_view text) {
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    lines_ += code < ' ' || code == 0x7F ? ' ' : c;
  }
  lines_ += '\n';
}

Expected<void> HidRecorderWriter::flush(std::optional<DeviceIndex> device) {
  auto written = sink_.write(lines_);
  if (written) selected_ = device;
  return written;
}

}  // namespace limn
