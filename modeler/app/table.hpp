#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "modeler/app/output_format.hpp"

namespace limn::app {

/// One value of a table; monostate is an absent one.
using Cell = std::variant<std::monostate, std::string, std::int64_t, double, bool>;

/// A column: its name in JSON and CSV, its heading for people, and the decimals that people see
/// (machines always get every digit).
struct Column {
  std::string key;
  std::string heading;
  int decimals = 3;
};

/// A small table for standard output, in any --format. All rows are held, so not for samples.
class Table {
 public:
  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// Precondition: as many cells as columns.
  void add(std::vector<Cell> row);

  /// The whole table: aligned text, a JSON array of objects, one object a line, or CSV.
  std::string print(OutputFormat format) const;

 private:
  std::string print_text() const;
  std::string print_csv() const;

  std::vector<Column> columns_;
  std::vector<std::vector<Cell>> rows_;
};

}  // namespace limn::app
