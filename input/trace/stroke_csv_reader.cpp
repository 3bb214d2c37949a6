#include "input/trace/stroke_csv_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "input/sample/tilt.hpp"
#include "input/trace/text.hpp"

namespace limn {
namespace {

constexpr std::size_t kPlainColumns = 4;
constexpr std::size_t kTiltColumns = 6;

struct Column {
  std::string_view name;
  double least;
  double most;
  std::string_view range;
};

// Bounds far outside any tablet keep every later step finite.
// clang-format off
constexpr std::array<Column, kTiltColumns> kColumns = {{
    {"t",   -9e9, 9e9, "within 9e9 s"},
    {"x",   -1e6, 1e6, "within 1e6 mm"},
    {"y",   -1e6, 1e6, "within 1e6 mm"},
    {"p",   0,    1,   "from 0 to 1"},
    {"alt", -1e6, 1e6, "within 1e6 degrees"},
    {"az",  -1e6, 1e6, "within 1e6 degrees"},
}};
// clang-format on

using Values = std::array<double, kTiltColumns>;  // [0], the time, is not used

/// The fields of a row; `count` goes on where there are more than fit.
struct Fields {
  std::array<std::string_view, kTiltColumns> text;
  std::size_t count = 0;
};

Fields split(std::string_view line) {
  Fields fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    if (fields.count < kTiltColumns) {
      fields.text[fields.count] = text::trimmed(line.substr(0, comma));
    }
    ++fields.count;
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

bool is_header(const Fields& fields) {
  if (fields.count != kPlainColumns && fields.count != kTiltColumns) return false;
  for (std::size_t i = 0; i < fields.count; ++i) {
    if (fields.text[i] != kColumns[i].name) return false;
  }
  return true;
}

/// A time written as a plain decimal is exact; others, and negative ones, are rounded to the
/// nanosecond.
std::optional<Timestamp> parse_time(std::string_view word) {
  if (const auto exact = text::parse_seconds(word)) return exact;
  const auto seconds = text::parse_real(word);
  if (!seconds || !(std::fabs(*seconds) <= kColumns[0].most)) return std::nullopt;
  return Timestamp(static_cast<Timestamp::rep>(std::floor(*seconds * 1e9 + 0.5)));
}

std::size_t decimals(std::string_view number) {
  const std::size_t point = number.find('.');
  return point == std::string_view::npos ? 0 : number.size() - point - 1;
}

PenSample make_sample(Timestamp time, const Values& values, std::size_t columns) {
  PenSample sample;
  sample.time = time;
  sample.tool = Tool::kPen;
  sample.state = PenState::kInContact;
  sample.x_mm = values[1];
  sample.y_mm = values[2];
  sample.pressure = values[3];
  for (const PenAxis axis : {PenAxis::kX, PenAxis::kY, PenAxis::kPressure}) sample.axes.add(axis);
  if (columns == kPlainColumns) return sample;
  const Tilt tilt = tilt_from_altitude_azimuth(values[4], values[5]);
  sample.tilt_x_rad = tilt.x_rad;
  sample.tilt_y_rad = tilt.y_rad;
  sample.axes.add(PenAxis::kTiltX);
  sample.axes.add(PenAxis::kTiltY);
  return sample;
}

}  // namespace

bool is_stroke_csv_row(std::string_view line) {
  const Fields fields = split(line);
  if (fields.count == 1) return false;
  if (fields.text[0] == kColumns[0].name && fields.text[1] == kColumns[1].name) return true;
  if (fields.count != kPlainColumns && fields.count != kTiltColumns) return false;
  return std::all_of(fields.text.begin(),
                     fields.text.begin() + static_cast<std::ptrdiff_t>(fields.count),
                     [](std::string_view field) { return text::parse_real(field).has_value(); });
}

void FixedDecimals::take(std::string_view number) noexcept {
  const std::size_t count = decimals(number);
  varying_ = varying_ || (alike_ > 0 && count != decimals_);
  decimals_ = count;
  ++alike_;
}

bool FixedDecimals::lacks_digits(std::string_view number) const noexcept {
  // Where trailing zeros are left out, one number in ten is shorter: this many of one length by
  // chance are one in eight hundred.
  constexpr std::uint64_t kTelling = 64;
  return !varying_ && alike_ >= kTelling && decimals(number) < decimals_;
}

StrokeCsvReader::StrokeCsvReader(std::unique_ptr<ByteSource> bytes, const TraceOptions& options)
    : LineTraceReader(std::move(bytes), options.salvage) {}

Expected<void> StrokeCsvReader::take(const Line& line) {
  const std::string_view text = text::trimmed(line.text);
  if (text.empty() || text[0] == '#') return {};
  if (columns_ == 0 && text[0] == 't') return take_header(text);
  return take_row(text, line.terminated);
}

Expected<void> StrokeCsvReader::take_header(std::string_view text) {
  const Fields fields = split(text);
  if (!is_header(fields)) {
    return damaged("the columns are " + text::quoted(text) + " where t,x,y,p or t,x,y,p,alt,az " +
                   "are expected");
  }
  columns_ = fields.count;
  return {};
}

Expected<void> StrokeCsvReader::take_row(std::string_view text, bool terminated) {
  const Fields fields = split(text);
  const bool possible = fields.count == kPlainColumns || fields.count == kTiltColumns;
  if (columns_ == 0 ? !possible : fields.count != columns_) {
    return damaged(text::counted(fields.count, "column") + " where " +
                       (columns_ == 0 ? "4 or 6" : std::to_string(columns_)) + " are expected",
                   ErrorCode::kPointCount);
  }
  const std::string_view word = fields.text[0];
  const auto time = parse_time(word);
  if (!time) return damaged(text::quoted(word) + " is no time");
  Values values{};
  for (std::size_t i = 1; i < fields.count; ++i) {
    const auto value = take_number(i, fields.text[i]);
    if (!value) return tl::unexpected(value.error());
    values[i] = *value;
  }
  const std::string_view last_word = fields.text[fields.count - 1];
  if (!terminated && widths_.lacks_digits(last_word)) return cut_short();
  widths_.take(last_word);
  if (last_ && *time < *last_) {
    return went_back(text::quoted(word), "row");
  }
  last_ = time;
  columns_ = fields.count;
  emit(make_sample(*time, values, columns_));
  return {};
}

Expected<double> StrokeCsvReader::take_number(std::size_t column, std::string_view word) const {
  const auto value = text::parse_real(word);
  if (!value) return damaged(text::quoted(word) + " is no number");
  if (kColumns[column].least <= *value && *value <= kColumns[column].most) return *value;
  return damaged(std::string(kColumns[column].name) + " is " + text::quoted(word) + ", not " +
                     std::string(kColumns[column].range),
                 ErrorCode::kOutOfRange);
}

void StrokeCsvReader::skipped(const Line& line) {
  const bool header = columns_ == 0 && text::trimmed(line.text).substr(0, 1) == "t";
  if (!header) lose_report(0);
}

}  // namespace limn
