#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "input/trace/device_table.hpp"
#include "input/trace/line_trace_reader.hpp"

namespace limn {

/// Whether the line begins a record of a usbhid-dump file.
bool is_usbhid_dump_header(std::string_view line);

/// Reads usbhid-dump files, see TraceFormat::kUsbhidDump. A DESCRIPTOR record describes its
/// interface at once.
class UsbhidDumpReader final : public LineTraceReader {
 public:
  UsbhidDumpReader(std::unique_ptr<ByteSource> bytes, TraceOptions options);
  TraceFormat format() const noexcept override { return TraceFormat::kUsbhidDump; }

 private:
  enum class RecordKind : std::uint8_t { kNone, kReport, kDescriptor };

  struct Record {
    RecordKind kind = RecordKind::kNone;
    TrackedDevice* device = nullptr;
    Timestamp time{};
    std::uint64_t line = 0;    // of its header
    std::size_t size = 0;      // of its bytes
    std::size_t last_row = 0;  // bytes in its last line
    std::size_t capacity = 0;
  };

  Expected<void> take(const Line& line) override;
  Expected<void> finish() override;
  void skipped(const Line& line) override;

  Expected<void> take_header(std::string_view text);
  Expected<void> take_row(std::string_view text);
  Expected<TrackedDevice*> device(std::uint16_t bus, std::uint16_t address, std::uint8_t interface);
  void complete();

  DeviceTable devices_;
  std::vector<std::uint32_t> addresses_;  // bus and device address; the position is the ordinal
  Record record_;
  std::vector<std::uint8_t> bytes_;  // of record_; as many as the largest so far
};

}  // namespace limn
