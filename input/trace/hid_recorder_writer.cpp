#include "input/trace/hid_recorder_writer.hpp"

#include "input/trace/text.hpp"

namespace limn {
namespace {

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
    text::append_counted_bytes(lines_, device.report_descriptor);
  }
  if (!device.name.empty()) {
    lines_ += "N: ";
    text::append_one_line(lines_, device.name);
  }
  if (!device.physical_path.empty()) {
    lines_ += "P: ";
    text::append_one_line(lines_, device.physical_path);
  }
  if (device.bus != 0 || device.vendor != 0 || device.product != 0) {
    constexpr int kHexadecimal = 16;
    lines_ += "I: ";
    text::append_number(lines_, device.bus, kHexadecimal);
    lines_ += ' ';
    text::append_number(lines_, device.vendor, kHexadecimal, 4);
    lines_ += ' ';
    text::append_number(lines_, device.product, kHexadecimal, 4);
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
  text::append_seconds(lines_, report.time);
  lines_ += ' ';
  text::append_counted_bytes(lines_, report.bytes);
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
  text::append_one_line(lines_, text);
  return {};
}

/// Empties lines_ but for a D: where one is needed.
void HidRecorderWriter::begin_device(DeviceIndex device) {
  lines_.clear();
  if (selected_ == device) return;
  lines_ += "D: ";
  text::append_number(lines_, device);
  lines_ += '\n';
}

Expected<void> HidRecorderWriter::flush(std::optional<DeviceIndex> device) {
  auto written = sink_.write(lines_);
  if (written) selected_ = device;
  return written;
}

}  // namespace limn
