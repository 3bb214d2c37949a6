// The text form of a Description: a tree of collections, then one aligned table a report.

#include <algorithm>
#include <array>
#include <charconv>

#include "drivers/hid/describe.hpp"

namespace limn::hid {
namespace {

constexpr double kMmPerInch = 25.4;
constexpr int kDigits = 6;
// A longer cell does not widen its column for all rows.
constexpr std::size_t kWidestCell = 72;

using Cells = std::vector<std::string>;

/// Rows of cells, the first row the heading; columns two spaces apart, no spaces at line ends.
class Table {
 public:
  explicit Table(std::string indent) : indent_(std::move(indent)) {}

  void add(Cells cells) { rows_.push_back(std::move(cells)); }

  void write_to(std::string& out) const {
    std::vector<std::size_t> widths;
    for (const Cells& row : rows_) {
      if (row.size() > widths.size()) widths.resize(row.size());
      for (std::size_t i = 0; i < row.size(); ++i) {
        widths[i] = std::max(widths[i], std::min(row[i].size(), kWidestCell));
      }
    }
    for (const Cells& row : rows_) write_row(row, widths, out);
  }

 private:
  void write_row(const Cells& row, const std::vector<std::size_t>& widths, std::string& out) const {
    std::string line = indent_;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (widths[i] == 0) continue;  // a column without any text
      line += row[i];
      line.append(row[i].size() < widths[i] ? widths[i] - row[i].size() : 0, ' ');
      line += "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line;
    out += '\n';
  }

  std::string indent_;
  std::vector<Cells> rows_;
};

std::string number(double value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value,
                                          std::chars_format::general, kDigits);
  return error == std::errc{} ? std::string(text.data(), end) : std::string("?");
}

std::string range_text(Range range) {
  return std::to_string(range.minimum) + " .. " + std::to_string(range.maximum);
}

std::string plural(std::size_t count, std::string_view word) {
  std::string text = std::to_string(count) + ' ' + std::string(word);
  return count == 1 ? text : text + 's';
}

std::string physical_text(const FieldRow& row) {
  if (row.minimum && row.maximum) {
    return number(*row.minimum) + " .. " + number(*row.maximum) + ' ' +
           std::string(unit_of(row.quantity));
  }
  if (row.unit.empty()) return {};
  std::string text = range_text(row.physical);
  if (row.unit_exponent != 0) text += " e" + std::to_string(row.unit_exponent);
  return text + ' ' + row.unit;
}

std::string resolution_text(const FieldRow& row) {
  if (!row.counts_per_mm) return {};
  return number(*row.counts_per_mm) + "/mm (" + number(*row.counts_per_mm * kMmPerInch) + " lpi)";
}

Cells cells_of(const FieldRow& row) {
  std::string size = std::to_string(row.bit_size);
  if (row.count != 1) size = std::to_string(row.count) + " x " + size;
  const std::string place =
      std::to_string(row.bit_offset / 8) + '.' + std::to_string(row.bit_offset % 8);
  if (row.padding) return {place, size, row.usage};
  // Stale units on switches would only distract.
  const bool is_switch = row.bit_size == 1;
  return {place,
          size,
          row.usage,
          range_text(row.logical),
          is_switch ? std::string{} : physical_text(row),
          is_switch ? std::string{} : resolution_text(row),
          row.flags,
          row.collections};
}

std::string report_heading(const ReportShape& report) {
  std::string text{name(report.kind)};
  text += " report";
  if (report.id != 0) text += ' ' + std::to_string(report.id);
  return text + ", " + plural(report.byte_length, "byte");
}

void write_summary(const Description& description, std::string& out) {
  out += plural(description.byte_length, "byte");
  for (const ReportKind kind : {ReportKind::kInput, ReportKind::kOutput, ReportKind::kFeature}) {
    const auto count = static_cast<std::size_t>(
        std::count_if(description.reports.begin(), description.reports.end(),
                      [kind](const ReportShape& report) { return report.kind == kind; }));
    if (count != 0) out += ", " + plural(count, std::string(name(kind)) + " report");
  }
  out += '\n';
}

void write_transducers(const Description& description, std::string& out) {
  if (description.transducers.empty()) return;
  out += "\npens and fingers\n";
  Table table("  ");
  table.add({"what", "report", "collections", "axes", "switches"});
  for (const TransducerRow& row : description.transducers) {
    table.add(
        {row.name, std::to_string(row.layout.report_id), row.collections, row.axes, row.switches});
  }
  table.write_to(out);
}

void write_collections(const Description& description, std::string& out) {
  if (description.collections.empty()) return;
  out += "\ncollections\n";
  Table table("  ");
  table.add({"byte", "usage", "type"});
  for (const CollectionRow& row : description.collections) {
    table.add({std::to_string(row.offset), std::string(2 * row.depth, ' ') + row.usage, row.type});
  }
  table.write_to(out);
}

void write_reports(const Description& description, std::string& out) {
  auto row = description.rows.begin();
  for (const ReportShape& report : description.reports) {
    out += '\n' + report_heading(report) + '\n';
    Table table("  ");
    table.add({"byte.bit", "bits", "usage", "logical", "physical", "resolution", "flags", "in"});
    for (; row != description.rows.end() && row->kind == report.kind && row->report_id == report.id;
         ++row) {
      table.add(cells_of(*row));
    }
    table.write_to(out);
  }
}

void write_notes(const Description& description, std::string& out) {
  if (description.notes.empty() && description.complete) return;
  out += "\nnotes\n";
  Table table("  ");
  for (const DescriptorNote& note : description.notes) {
    table.add({"byte " + std::to_string(note.offset), note.what});
  }
  if (!description.complete) {
    table.add({"", "only the first " + std::to_string(kMaxDescriptionRows) + " rows are shown"});
  }
  table.write_to(out);
}

}  // namespace

std::string to_text(const Description& description) {
  std::string out;
  write_summary(description, out);
  write_transducers(description, out);
  write_collections(description, out);
  write_reports(description, out);
  write_notes(description, out);
  return out;
}

}  // namespace limn::hid
