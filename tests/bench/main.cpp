// limn-bench AREA...: measures limn against its goals and, in the same run, against other
// libraries.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/areas.hpp"

namespace {

using limn::bench::Row;

struct Area {
  std::string_view name;
  std::string_view what;
  void (*run)(const limn::bench::RowSink&);
};

constexpr Area kAreas[] = {
    {"decode", "reports to pen samples: time and heap allocations a report",
     limn::bench::decode_area},
    {"trace", "reading a hid-recorder file: time, and memory for a gigabyte",
     limn::bench::trace_area},
    {"fit", "curves through strokes: time and control points", limn::bench::fit_area},
};

void list_areas() {
  for (const Area& area : kAreas)
    std::printf("%-8s %s\n", std::string(area.name).c_str(), std::string(area.what).c_str());
}

/// Runs one area and prints its rows as they come; returns how many miss their goal.
int run_area(const Area& area, bool as_json) {
  int missed = 0;
  if (!as_json) std::printf("%s\n", limn::bench::table_heading().c_str());
  area.run([&missed, as_json](const Row& row) {
    const std::string line = as_json ? to_json(row) : to_table_line(row);
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
    if (row.holds() == false) ++missed;
  });
  return missed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Measures limn against its goals and against other libraries in the same run. All figures "
      "are "
      "costs;\nratio = peer / limn, so above 1 limn is better."};
  std::vector<std::string> wanted;
  std::string format = "text";
  bool list = false;
  bool require = false;
  std::vector<std::string> names;
  for (const Area& area : kAreas) names.emplace_back(area.name);
  app.add_option("AREA", wanted, "What to measure; everything unless given")
      ->check(CLI::IsMember(names));
  app.add_option("--format", format, "text: a table; jsonl: one object a row")
      ->check(CLI::IsMember({"text", "jsonl"}));
  app.add_flag("--list", list, "Name the areas and end");
  app.add_flag("--require", require, "Exit with 1 if a row misses its goal");
  CLI11_PARSE(app, argc, argv);
  if (list) {
    list_areas();
    return 0;
  }
  int missed = 0;
  for (const Area& area : kAreas) {
    if (wanted.empty() || std::count(wanted.begin(), wanted.end(), area.name) > 0)
      missed += run_area(area, format == "jsonl");
  }
  if (missed > 0) std::fprintf(stderr, "limn-bench: %d rows miss their goal\n", missed);
  return require && missed > 0 ? 1 : 0;
}
