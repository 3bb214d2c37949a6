#include "modeler/app/table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "input/base/expect.hpp"
#include "modeler/app/terminal_text.hpp"

namespace limn::app {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Cell& cell) {
  return std::visit(
      [](const auto& value) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::monostate>) {
          return nullptr;
        } else {
          return value;
        }
      },
      cell);
}

std::string for_people(const Cell& cell, int decimals) {
  if (const auto* text = std::get_if<std::string>(&cell)) return printable(*text);
  if (const auto* integer = std::get_if<std::int64_t>(&cell)) return std::to_string(*integer);
  if (const auto* truth = std::get_if<bool>(&cell)) return *truth ? "yes" : "no";
  if (const auto* number = std::get_if<double>(&cell)) {
    // Fixed decimals up to a length that a column can bear; the largest doubles have 309 digits.
    constexpr double kWidest = 1e15;
    std::array<char, 32> text;
    const bool wide = !(std::abs(*number) < kWidest);
    std::snprintf(text.data(), text.size(), wide ? "%.*g" : "%.*f", wide ? 6 : decimals, *number);
    return text.data();
  }
  return {};
}

std::string csv_cell(const Cell& cell) {
  const auto* text = std::get_if<std::string>(&cell);
  if (text == nullptr) {
    return std::holds_alternative<std::monostate>(cell) ? std::string() : to_json(cell).dump();
  }
  if (text->find_first_of(",\"\r\n") == std::string::npos) return *text;
  std::string quoted = "\"";
  for (const char c : *text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

void Table::add(std::vector<Cell> row) {
  LIMN_EXPECT(row.size() == columns_.size());
  rows_.push_back(std::move(row));
}

std::string Table::print(OutputFormat format) const {
  if (format == OutputFormat::kText) return print_text();
  if (format == OutputFormat::kCsv) return print_csv();
  std::string out = format == OutputFormat::kJson ? "[" : "";
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Json object = Json::object();
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      if (!std::holds_alternative<std::monostate>(rows_[i][j])) {
        object[columns_[j].key] = to_json(rows_[i][j]);
      }
    }
    // Names come from devices and may hold any bytes: what is no UTF-8 is replaced.
    const std::string text = object.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (format == OutputFormat::kJson) out += i == 0 ? "\n" : ",\n";
    out += text;
    if (format == OutputFormat::kJsonl) out += '\n';
  }
  if (format == OutputFormat::kJson) out += rows_.empty() ? "]\n" : "\n]\n";
  return out;
}

std::string Table::print_text() const {
  std::vector<std::vector<std::string>> texts(rows_.size());
  std::vector<std::size_t> widths;
  for (const Column& column : columns_) widths.push_back(column.heading.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      texts[i].push_back(for_people(rows_[i][j], columns_[j].decimals));
      widths[j] = std::max(widths[j], texts[i][j].size());
    }
  }
  // Words to the left, numbers to the right; a column is one or the other in all its rows.
  const auto is_text = [this](std::size_t j) {
    return std::any_of(rows_.begin(), rows_.end(), [j](const auto& row) {
      return std::holds_alternative<std::string>(row[j]);
    });
  };
  std::string out;
  const auto append_line = [&](const auto& text_of) {
    std::string line;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      const std::string& text = text_of(j);
      const std::string padding(widths[j] - text.size(), ' ');
      if (j > 0) line += "  ";
      line += is_text(j) ? text + padding : padding + text;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + '\n';
  };
  append_line([this](std::size_t j) -> const std::string& { return columns_[j].heading; });
  for (const auto& row : texts) {
    append_line([&row](std::size_t j) -> const std::string& { return row[j]; });
  }
  return out;
}

std::string Table::print_csv() const {
  std::string out;
  const auto append_line = [&](const auto& text_of) {
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      if (j > 0) out += ',';
      out += text_of(j);
    }
    out += '\n';
  };
  append_line([this](std::size_t j) { return columns_[j].key; });
  for (const auto& row : rows_) append_line([&row](std::size_t j) { return csv_cell(row[j]); });
  return out;
}

}  // namespace limn::app
