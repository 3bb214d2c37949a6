#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "input/base/byte_stream.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// Writes a hid-recorder file that this project's reader and other people's tools read: `D:` where
/// the device changes, `R:`, `N:`, `P:`, `I:` for a description, `E:` for a report, `#limn` for a
/// note. Times have six decimals, or nine where microseconds do not say it all.
///
/// What one call writes goes to the sink in one piece that ends with a line end, so after a crash
/// the file holds whole lines. After an error nothing of that call counts as written.
///
/// Errors of all members: kIo from the sink.
class HidRecorderWriter {
 public:
  /// `sink` must outlive the writer.
  explicit HidRecorderWriter(ByteSink& sink) : sink_(sink) {}

  /// Leaves out what the description does not know. Control characters in its texts become blanks.
  /// kLimit: a descriptor or text larger than the reader takes.
  Expected<void> describe(const TraceDevice& device);

  /// kLimit: larger than the reader takes. kOutOfRange: a negative time, which the format lacks.
  Expected<void> write(const Report& report);

  /// A note about the selected device. Control characters become blanks. kLimit: longer than the
  /// reader takes.
  Expected<void> note(std::string_view text);

  /// The same about `device`.
  Expected<void> note(std::string_view text, DeviceIndex device);

 private:
  void begin_device(DeviceIndex device);
  Expected<void> append_note(std::string_view text);
  Expected<void> flush(std::optional<DeviceIndex> device);

  ByteSink& sink_;
  std::string lines_;                    // of the call in progress
  std::optional<DeviceIndex> selected_;  // by the last D: written
};

}  // namespace limn
