#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "input/base/byte_stream.hpp"
#include "input/base/error.hpp"
#include "input/base/time.hpp"
#include "input/sample/pen_sample.hpp"
#include "input/sample/report.hpp"

namespace limn {

/// The recorded formats that limn tells apart by content. Line ends are LF or CR LF everywhere.
///
/// kHidRecorder  `#` comment, `#limn` note; `D:` selects a device (0 before the first); `R:`, `N:`,
///               `P:`, `I:` describe it; `E: sec.usec length bytes` is a report. Other prefixes and
///               prose (the recorder's prompts) are passed over.
/// kUsbhidDump   `[BUS:DEVICE:]INTERFACE:STREAM  sec.usec` (or DESCRIPTOR), then lines of up to 16
///               bytes, ended by a blank line, the next header or the end; but a report whose last
///               line is full may go on, so there the end alone is damage. DeviceIndex is the
///               interface number, plus 256 times the ordinal of the bus and device address.
/// kEvemu        1.0 to 1.3, the version line optional; `N:`, `I:`, `P:`, `B:`, `A:` and `E:`;
///               `#limn R: length bytes`, the report descriptor behind the kernel's axes, and other
///               `#limn` notes, all in comments, which other tools pass over.
/// kStrokeCsv    `t,x,y,p[,alt,az]`: seconds, mm, mm, 0..1, degrees, degrees; the header line is
///               optional, `#` lines and blank lines are passed over. Every row is a PenSample of
///               an ordinary pen in contact. alt and az become tilt, see input/sample/tilt.hpp; an
///               alt outside 0..90 is clamped. Such a file describes no device.
///
/// Those of other programs, which input/trace_import reads:
///
/// kUsbCapture   pcap or pcapng of USB, link types 189 and 220 (usbmon of Linux) and 249 (USBPcap
/// of
///               Windows). Every interrupt transfer from a HID interface is a report; ids, names,
///               descriptors and "string" notes are what the captured host asked for. DeviceIndex
///               is the interface number (128 + the endpoint where the capture does not tell it)
///               plus 256 times the ordinal of the device. Times count from the first packet.
/// kLibinputRecord  YAML of `libinput record`, version 1: each listed device with its kernel
/// frames,
///               DeviceIndex its position; each recorded hidraw node as a device of its own, behind
///               them. Where several event nodes tell the same hidraw node's reports, the first
///               does. Other keys are passed over. Times are libinput's, from the first event.
/// kMotionCsv    `Timestamp,Tx,Ty,Tz,Rx,Ry,Rz`: date and time, six counts of a 3D mouse; every row
///               is a report (motion_csv_reader.hpp).
enum class TraceFormat {
  kHidRecorder,
  kUsbhidDump,
  kEvemu,
  kStrokeCsv,
  kUsbCapture,
  kLibinputRecord,
  kMotionCsv
};

/// "hid-recorder", "usbhid-dump", "evemu", "stroke CSV", "USB capture", "libinput recording",
/// "motion CSV".
std::string_view name(TraceFormat format) noexcept;

/// What a recording may hold at most; beyond, a kLimit error. With these a reader's memory is
/// bounded: about 1 MB, plus the descriptors, together at most 4 MB.
inline constexpr std::size_t kMaxLineBytes = std::size_t{256} * 1024;
inline constexpr std::size_t kMaxDescriptorBytes = 65535;  // wDescriptorLength has 16 bits
inline constexpr std::size_t kMaxReportBytes = 16384;      // Linux's HID_MAX_BUFFER_SIZE
inline constexpr std::size_t kMaxDeviceTextBytes = 1024;   // a name, a physical path
inline constexpr std::size_t kMaxFrameEvents = 4096;
inline constexpr std::size_t kMaxTraceDevices = 64;
inline constexpr std::uint64_t kMaxLibinputBytes = std::uint64_t{256}
                                                   << 20;  // such a file is read whole

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
  std::vector<std::uint8_t> report_descriptor;  ///< empty: not known
  std::vector<EvdevAxis> axes;                  ///< of kernel-decoded devices: evemu, evdev
  /// Its own serial number or Bluetooth address. Of live devices; no format keeps it.
  std::string unique_id = {};
  /// Codes of relative axes, of kernel-decoded 3D mice that have no others. Of live devices.
  std::vector<std::uint16_t> relative_axes = {};

  bool is_kernel_decoded() const noexcept { return !axes.empty() || !relative_axes.empty(); }
};

/// The trace describes a device: sent before its first report or frame, and again when the trace
/// describes it anew (a replug). A device that is described but never reports is sent too, at the
/// end of its description. `device` is borrowed until the reader's next call.
struct DeviceDescribed {
  const TraceDevice* device = nullptr;
};

/// Kernel events up to, without, a SYN_REPORT, whose time it has; no events where SYN_REPORTs
/// follow each other. Borrowed until the reader's next call.
struct EvdevFrame {
  DeviceIndex device = 0;
  Timestamp time{};
  std::span<const EvdevEvent> events;
};

/// A "#limn" comment line of a hid-recorder or evemu file, without that prefix and the blank after
/// it: an event beside the reports of the selected device. "lost N" says that N of its reports are
/// missing here, "lost? N" that some are, at least N; "gone" that it was unplugged; "string INDEX
/// BYTES" (noted_string.hpp), before its first report, what it answered when it was initialised. A
/// note comes behind the description that stands above it. Borrowed until the reader's next call.
struct TraceNote {
  std::string_view text;
  DeviceIndex device = 0;
};

/// Reports (frames, rows) of one device that are known to be missing.
struct LostReports {
  DeviceIndex device = 0;
  std::uint32_t count = 0;
  bool time_went_back = false;  ///< one of them was earlier than the one before it
};

/// A part of the file that TraceOptions::salvage skipped: everything damaged between the event
/// before and the event after. `error` is that of the first damage and says how many lines went.
struct TraceDamage {
  Error error;
  /// What of that were reports whose device is known, one entry a device.
  std::vector<LostReports> lost;
};

struct TraceEnd {};

using TraceEvent =
    std::variant<TraceEnd, DeviceDescribed, Report, EvdevFrame, PenSample, TraceNote, TraceDamage>;

/// Streams the events of one recording in file order, in constant memory. Times are the file's own,
/// to the nanosecond, and never decrease within one device: a line whose time does is damage. (A
/// recorder may count each device from its own start, so times of two devices may interleave
/// backwards.) Not thread-safe.
class TraceReader {
 public:
  virtual ~TraceReader() = default;
  virtual TraceFormat format() const noexcept = 0;

  /// The next event; TraceEnd for ever after the last one. After an error the reader is spent and
  /// gives the same error again. Everything returned before an error stands.
  virtual Expected<TraceEvent> next() = 0;

  /// The same, but where the stream is silent until `deadline`, in the time of its events, nothing:
  /// no event from before `deadline` comes any more. Only readers that wait for their events have
  /// silence; a recording is there as a whole and gives its next event, whenever that was.
  virtual Expected<std::optional<TraceEvent>> next_until(Timestamp deadline);

  /// Where the last event stood, e.g. "line 12", for error messages about its content.
  virtual std::string place() const = 0;
};

/// A descriptor and ids from outside, for formats that carry none (usbhid-dump streams).
struct SuppliedDevice {
  std::vector<std::uint8_t> report_descriptor;
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
};

struct TraceOptions {
  /// Skip what is damaged (as TraceDamage events) instead of stopping at it with an error. Skipped
  /// with a damaged line is what can no longer be trusted: the rest of its record or frame, and,
  /// where several devices record, what follows until the next D: line says whose it is.
  bool salvage = false;
  /// Used for every device that the trace itself gives no descriptor or ids.
  SuppliedDevice supplied;
};

/// Tells the format from the first bytes and gives its reader. Reads no further than it must, so a
/// pipe's first event comes as soon as its line is there.
/// Error: kIo; kSyntax for an empty file or an unknown format.
Expected<std::unique_ptr<TraceReader>> open_trace(std::unique_ptr<ByteSource> bytes,
                                                  TraceOptions options = {});

}  // namespace limn
