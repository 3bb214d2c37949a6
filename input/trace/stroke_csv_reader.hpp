#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "input/trace/line_trace_reader.hpp"

namespace limn {

/// Whether the line is the header of a stroke CSV file, or a row of as many numbers as one has.
bool is_stroke_csv_row(std::string_view line);

/// Whether a column's numbers all have the same number of decimals. A last line without a line end
/// is usual in CSV and may be whole; that it lost digits shows only in such a column.
class FixedDecimals {
 public:
  void take(std::string_view number) noexcept;

  /// Enough numbers before `number` had one length, and it has fewer decimals.
  bool lacks_digits(std::string_view number) const noexcept;

 private:
  std::uint64_t alike_ = 0;
  std::size_t decimals_ = 0;
  bool varying_ = false;
};

/// Reads stroke CSV files, see TraceFormat::kStrokeCsv.
class StrokeCsvReader final : public LineTraceReader {
 public:
  StrokeCsvReader(std::unique_ptr<ByteSource> bytes, const TraceOptions& options);
  TraceFormat format() const noexcept override { return TraceFormat::kStrokeCsv; }

 private:
  Expected<void> take(const Line& line) override;
  Expected<void> finish() override { return {}; }
  void skipped(const Line& line) override;

  Expected<void> take_header(std::string_view text);
  Expected<void> take_row(std::string_view text, bool terminated);
  Expected<double> take_number(std::size_t column, std::string_view word) const;

  std::size_t columns_ = 0;        // 4 or 6; 0 before the first row
  std::optional<Timestamp> last_;  // time of the last row
  FixedDecimals widths_;           // of the last column
};

}  // namespace limn
