#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>

#include "input/trace/line_trace_reader.hpp"

namespace limn {

/// Whether the line is the header of a stroke CSV file, or a row of as many numbers as one has.
bool is_stroke_csv_row(std::string_view line);

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

  std::size_t columns_ = 0;              // 4 or 6; 0 before the first row
  std::optional<Timestamp> last_;        // time of the last row
  std::optional<std::size_t> decimals_;  // fewest so far in the last column
};

}  // namespace limn
