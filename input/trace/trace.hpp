#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "input/base/error.hpp"
#include "input/base/time.hpp"
#include "input/sample/pen_sample.hpp"
#include "input/sample/report.hpp"

namespace limn {

/// The recorded formats that limn tells apart by content.
enum class TraceFormat { kHidRecorder, kUsbhidDump, kEvemu, kStrokeCsv };

/// "hid-recorder", "usbhid-dump", "evemu", "stroke CSV".
std::string_view name(TraceFormat format) noexcept;

/// Range of one kernel-decoded absolute axis (evemu's A: line). Resolution in units per mm (per
/// radian for tilt); 0 where the kernel did not know it.
struct EvdevAxis {
  std::uint16_t code = 0;
  std::int32_t minimum = 0;
  std::int32_t maximum = 0;
  std::int32_t fuzz = 0;
  std::int32_t flat = 0;
  std::int32_t resolution = 0;
};

/// One kernel input event, as in <linux/input.h>.
struct EvdevEvent {
  Timestamp time{};
  std::uint16_t type = 0;
  std::uint16_t code = 0;
  std::int32_t value = 0;
};

/// What a trace says of one of its devices. Members the format does not carry are zero or empty.
struct TraceDevice {
  DeviceIndex index = 0;
  std::string name;
  std::string physical_path;
  std::uint16_t bus = 0;  ///< Linux BUS_*: 3 USB, 5 Bluetooth
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::uint16_t version = 0;
  std::vector<std::uint8_t> report_descriptor;
  std::vector<EvdevAxis> axes;  ///< evemu only
};

/// The trace describes a device: sent before its first report or frame, and again when the trace
/// describes it anew (a replug). `device` is borrowed until the reader's next call.
struct DeviceDescribed {
  const TraceDevice* device = nullptr;
};

/// Kernel events up to, without, a SYN_REPORT. Borrowed until the reader's next call.
struct EvdevFrame {
  DeviceIndex device = 0;
  Timestamp time{};
  std::span<const EvdevEvent> events;
};

/// A "#limn" comment line of a hid-recorder file, without that prefix: an event beside the reports
/// (loss, hot-plug). Borrowed until the reader's next call.
struct TraceNote {
  std::string_view text;
};

/// A part of the file that TraceOptions::salvage skipped.
struct TraceDamage {
  Error error;
};

struct TraceEnd {};

using TraceEvent =
    std::variant<TraceEnd, DeviceDescribed, Report, EvdevFrame, PenSample, TraceNote, TraceDamage>;

/// Streams the events of one recording in file order, with the file's own times, in constant memory
/// (apart from device descriptions). Not thread-safe.
class TraceReader {
 public:
  virtual ~TraceReader() = default;
  virtual TraceFormat format() const noexcept = 0;

  /// The next event; TraceEnd for ever after the last one. After an error the reader is spent and
  /// gives the same error again. Everything returned before an error stands.
  virtual Expected<TraceEvent> next() = 0;

  /// Where the last event stood, e.g. "line 12", for error messages about its content.
  virtual std::string place() const = 0;
};

/// Where bytes come from: a file, standard input, or memory in tests and fuzzers.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// Fills up to out.size() bytes; 0 means the end. Error: kIo.
  virtual Expected<std::size_t> read(std::span<char> out) = 0;
};

/// Opens `path` for reading; "-" is standard input. Error: kIo.
Expected<std::unique_ptr<ByteSource>> open_bytes(const std::string& path);

/// Reads from `text`, which must outlive the source.
std::unique_ptr<ByteSource> memory_bytes(std::string_view text);

/// A descriptor and ids from outside, for formats that carry none (usbhid-dump streams).
struct SuppliedDevice {
  std::vector<std::uint8_t> report_descriptor;
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
};

struct TraceOptions {
  /// Skip what is damaged (as TraceDamage events) instead of stopping at it with an error.
  bool salvage = false;
  /// Used for every device that the trace itself gives no descriptor or ids.
  SuppliedDevice supplied;
};

/// Tells the format from the first bytes and gives its reader.
/// Error: kSyntax for an empty file or an unknown format.
Expected<std::unique_ptr<TraceReader>> open_trace(std::unique_ptr<ByteSource> bytes,
                                                  TraceOptions options = {});

}  // namespace limn
