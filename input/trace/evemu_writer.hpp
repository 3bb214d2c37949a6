#pragma once

#include <string>
#include <string_view>

#include "input/base/byte_stream.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// Writes an evemu 1.3 file of one device that this project's reader reads: `N:`,
/// `I:`, `A:` for a description, `E:` for the events of a frame and the SYN_REPORT behind them. The
/// report descriptor, which evemu has no line for, stands in a comment (TraceFormat::kEvemu), so
/// that a recording decodes as the live device did. There are no `P:` and `B:` lines: limn does not
/// know what else a device may send.
///
/// What one call writes goes to the sink in one piece that ends with a frame, so after a crash the
/// file holds whole frames. Errors of all members: kIo from the sink.
class EvemuWriter {
 public:
  /// `sink` must outlive the writer.
  explicit EvemuWriter(ByteSink& sink) : sink_(sink) {}

  /// Describes the device, or describes it anew (a replug); its index is not kept. Control
  /// characters of the name become blanks. kLimit: a descriptor or name larger than the reader
  /// takes.
  Expected<void> describe(const TraceDevice& device);

  /// kLimit: more events than the reader takes. kOutOfRange: a time that is negative, or before
  /// that of what was written before it.
  Expected<void> write(const EvdevFrame& frame);

  /// Frames are missing here: an empty frame with a SYN_DROPPED, as the kernel tells it, at the
  /// time of the frame before. (evemu cannot say how many: it reads as one or more.)
  Expected<void> lost();

  /// A "#limn" note, which other tools pass over: "gone" where the device was unplugged. Line ends
  /// become blanks.
  Expected<void> note(std::string_view note);

 private:
  void append_event(Timestamp time, std::uint16_t type, std::uint16_t code, std::int32_t value);

  ByteSink& sink_;
  std::string lines_;  // of the call in progress
  Timestamp last_{};   // of what was written
};

}  // namespace limn
