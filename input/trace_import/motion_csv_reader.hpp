#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "input/trace/device_table.hpp"
#include "input/trace/line_trace_reader.hpp"

namespace limn {

/// Whether a line is the header or a row of a motion CSV.
bool is_motion_csv_line(std::string_view line);

/// Reads motion CSV files, see TraceFormat::kMotionCsv.
///
/// What a row becomes. The loggers that write such files read one report of a combined 3D mouse a
/// row and print its six numbers as they came, so a row holds all that the report did, and is
/// turned back into it:
///
///     byte 0       1, the report ID
///     bytes 1..12  Tx Ty Tz Rx Ry Rz, signed 16 bits each, low byte first
///
/// Ids and descriptor are not in the file. Unless they are supplied, they are those of the device
/// that the known logger opens, 256f:c631 (SpaceMouse Pro Wireless on its cable), and a descriptor
/// of exactly these bytes, +-350 for +-1.4 mm as 3D mice declare. Buttons and the reports of other
/// ids were not logged. Rows have the wall clock's time; a clock that is set back is damage.
class MotionCsvReader final : public LineTraceReader {
 public:
  MotionCsvReader(std::unique_ptr<ByteSource> bytes, TraceOptions options);
  TraceFormat format() const noexcept override { return TraceFormat::kMotionCsv; }

  static constexpr std::size_t kReportBytes = 13;

 private:
  Expected<void> take(const Line& line) override;
  Expected<void> finish() override;
  void skipped(const Line& line) override;
  void announce();

  DeviceTable devices_;
  TrackedDevice& device_;
  std::array<std::uint8_t, kReportBytes> report_{};
};

}  // namespace limn
