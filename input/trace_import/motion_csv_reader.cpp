#include "input/trace_import/motion_csv_reader.hpp"

#include <algorithm>
#include <utility>

#include "input/trace/text.hpp"

namespace limn {
namespace {

constexpr std::size_t kAxes = 6;
constexpr std::string_view kHeader = "Timestamp,Tx,Ty,Tz,Rx,Ry,Rz";
constexpr std::uint16_t kBusUsb = 3;  // Linux BUS_USB
constexpr std::uint16_t kVendor = 0x256F;
constexpr std::uint16_t kProduct = 0xC631;

// clang-format off
constexpr std::uint8_t kDescriptor[] = {
    0x05, 0x01,              // Usage Page (Generic Desktop)
    0x09, 0x08,              // Usage (Multi-axis Controller)
    0xA1, 0x01,              // Collection (Application)
    0xA1, 0x00,              //   Collection (Physical)
    0x85, 0x01,              //     Report ID (1)
    0x16, 0xA2, 0xFE,        //     Logical Minimum (-350)
    0x26, 0x5E, 0x01,        //     Logical Maximum (350)
    0x36, 0x88, 0xFA,        //     Physical Minimum (-1400)
    0x46, 0x78, 0x05,        //     Physical Maximum (1400)
    0x55, 0x0C,              //     Unit Exponent (-4)
    0x65, 0x11,              //     Unit (cm)
    0x09, 0x30,              //     Usage (X)
    0x09, 0x31,              //     Usage (Y)
    0x09, 0x32,              //     Usage (Z)
    0x09, 0x33,              //     Usage (Rx)
    0x09, 0x34,              //     Usage (Ry)
    0x09, 0x35,              //     Usage (Rz)
    0x75, 0x10,              //     Report Size (16)
    0x95, 0x06,              //     Report Count (6)
    0x81, 0x02,              //     Input (Data, Variable, Absolute)
    0xC0,                    //   End Collection
    0xC0,                    // End Collection
};
// clang-format on

/// Takes what stands before the next `end` off `rest`, and that; the whole rest where none is.
std::string_view take_until(std::string_view& rest, char end) {
  const std::size_t at = std::min(rest.find(end), rest.size());
  const std::string_view taken = rest.substr(0, at);
  rest.remove_prefix(std::min(at + 1, rest.size()));
  return taken;
}

/// Days since 1970-01-01 of the Gregorian calendar, y >= 1970: whole 400 years from 0000-03-01 on.
constexpr std::int64_t days_since_1970(std::int64_t y, std::int64_t m, std::int64_t d) {
  constexpr std::int64_t kDaysTo1970 = 719468;
  constexpr std::int64_t kDaysOf400Years = 146097;
  if (m <= 2) --y;
  const std::int64_t of_era = y % 400;
  const std::int64_t of_year = (153 * (m + (m > 2 ? -3 : 9)) + 2) / 5 + d - 1;
  return y / 400 * kDaysOf400Years + of_era * 365 + of_era / 4 - of_era / 100 + of_year -
         kDaysTo1970;
}
static_assert(days_since_1970(1970, 1, 1) == 0 && days_since_1970(2000, 3, 1) == 11017);

std::optional<std::int64_t> number_within(std::string_view word, std::int64_t low,
                                          std::int64_t high) {
  const auto number = text::parse_integer<std::int64_t>(word);
  if (!number || *number < low || *number > high) return std::nullopt;
  return number;
}

/// "2022-02-15 02:44:23.798001", or with a T, the fraction optional; or plain seconds.
std::optional<Timestamp> parse_time(std::string_view word) {
  if (word.find('-') == std::string_view::npos) return text::parse_seconds(word);
  const auto year = number_within(take_until(word, '-'), 1970, 2200);
  const auto month = number_within(take_until(word, '-'), 1, 12);
  const std::size_t gap = word.find_first_of(" T");
  if (!year || !month || gap == std::string_view::npos) return std::nullopt;
  const auto day = number_within(word.substr(0, gap), 1, 31);
  word.remove_prefix(gap + 1);
  const auto hour = number_within(take_until(word, ':'), 0, 23);
  const auto minute = number_within(take_until(word, ':'), 0, 59);
  const auto second = text::parse_seconds(word);
  constexpr std::int64_t kNanosecond = 1'000'000'000;
  if (!day || !hour || !minute || !second || second->count() >= 61 * kNanosecond) {
    return std::nullopt;
  }
  const std::int64_t minutes = (days_since_1970(*year, *month, *day) * 24 + *hour) * 60 + *minute;
  return Timestamp(minutes * 60 * kNanosecond) + *second;
}

struct Row {
  Timestamp time{};
  std::array<std::int16_t, kAxes> axes{};
};

/// nothing where the line is no row; `wrong` is then the cell that is none.
std::optional<Row> parse_row(std::string_view line, std::string_view& wrong) {
  Row row;
  wrong = text::trimmed(take_until(line, ','));
  const auto time = parse_time(wrong);
  if (!time) return std::nullopt;
  row.time = *time;
  for (std::int16_t& axis : row.axes) {
    wrong = text::trimmed(take_until(line, ','));
    const auto count = text::parse_integer<std::int16_t>(wrong);
    if (!count) return std::nullopt;
    axis = *count;
  }
  wrong = line;
  if (!line.empty()) return std::nullopt;
  return row;
}

}  // namespace

bool is_motion_csv_line(std::string_view line) {
  line = text::trimmed(line);
  if (line.starts_with(text::kByteOrderMark)) line.remove_prefix(text::kByteOrderMark.size());
  std::string_view wrong;
  return line == kHeader || (line.find('-') == 4 && parse_row(line, wrong));
}

MotionCsvReader::MotionCsvReader(std::unique_ptr<ByteSource> bytes, TraceOptions options)
    : LineTraceReader(std::move(bytes), options.salvage),
      devices_(std::move(options.supplied)),
      device_(*devices_.find_or_add(0)) {
  device_.description.bus = kBusUsb;
}

Expected<void> MotionCsvReader::take(const Line& line) {
  const std::string_view text = text::trimmed(line.text);
  if (text.empty() || text[0] == '#' || text == kHeader) return {};
  std::string_view wrong;
  const auto row = parse_row(text, wrong);
  if (!row) {
    return damaged(wrong.empty()
                       ? "the row has too few cells: a time and six whole numbers are due"
                       : text::quoted(wrong) + " is neither a time nor one of six whole numbers");
  }
  if (!line.terminated) return cut_short();  // digits may be missing
  if (device_.last && row->time < *device_.last) {
    return went_back(text.substr(0, text.find(',')), "row");
  }
  device_.last = row->time;
  if (!device_.announced) announce();
  report_[0] = 1;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const auto bits = static_cast<std::uint16_t>(row->axes[i]);
    report_[1 + 2 * i] = static_cast<std::uint8_t>(bits);
    report_[2 + 2 * i] = static_cast<std::uint8_t>(bits >> 8);
  }
  emit(Report{0, row->time, report_});
  return {};
}

Expected<void> MotionCsvReader::finish() {
  if (!device_.announced) announce();
  return {};
}

void MotionCsvReader::skipped(const Line& /*line*/) { lose_report(0); }

void MotionCsvReader::announce() {
  devices_.announce(device_);  // with what was supplied, if anything was
  TraceDevice& description = device_.description;
  if (description.vendor == 0 && description.product == 0) {
    description.name = "3Dconnexion SpaceMouse Pro Wireless";
    description.vendor = kVendor;
    description.product = kProduct;
  }
  if (description.report_descriptor.empty()) {
    description.report_descriptor.assign(std::begin(kDescriptor), std::end(kDescriptor));
  }
  emit(DeviceDescribed{&description});
}

}  // namespace limn
