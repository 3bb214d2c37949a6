// limn-bench AREA...: measures limn against its goals and, in the same run, against other
// libraries.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "tests/bench/areas.hpp"

namespace {

using limn::bench::Row;

struct Area {
  std::string_view name;
  std::string_view what;
  void (*run)(const limn::bench::RowSink&) = nullptr;
  bool when_named = false;  ///< it takes a minute: not measured unless asked for
  /// In place of run(), where it makes a picture.
  limn::bench::Picture (*draw)(const limn::bench::RowSink&) = nullptr;
};

constexpr Area kAreas[] = {
    {"decode", "reports to pen samples: time and heap allocations a report",
     limn::bench::decode_area},
    {"trace", "reading a hid-recorder file: time, and memory for a gigabyte",
     limn::bench::trace_area},
    {"transport", "replayed and live reports: how late they come", limn::bench::transport_area},
    {"footprint", "an embedded reader of pens: its file, and its memory at 1 kHz",
     limn::bench::footprint_area},
    {"fit", "curves through strokes: time and control points", limn::bench::fit_area},
    {"kernel", "surfaces: evaluation, closest points, rays, knot insertion",
     limn::bench::kernel_area},
    {"growth", "surfaces: how costs grow with the number of control points, with a picture",
     nullptr, false, limn::bench::growth_area},
    {"boot", "the first boot of tests/kernel: wall time; only where it is named",
     limn::bench::boot_area, true},
};

void list_areas() {
  for (const Area& area : kAreas)
    std::printf("%-10s %s\n", std::string(area.name).c_str(), std::string(area.what).c_str());
}

/// Whether the picture is whole in the file.
bool write_picture(const limn::bench::Picture& from, const std::string& path) {
  constexpr double kPixels = 1600;
  const auto picture = path.ends_with(".png") ? limn::draw_png(from.sheet, kPixels, from.drawing)
                                              : limn::draw_svg(from.sheet, from.drawing);
  if (!picture) {
    std::fprintf(stderr, "limn-bench: %s\n", picture.error().what.c_str());
    return false;
  }
  const std::string part = path + ".part";
  std::ofstream(part, std::ios::binary) << *picture;
  std::error_code failed;
  if (std::filesystem::file_size(part, failed) == picture->size()) {
    std::filesystem::rename(part, path, failed);
    if (!failed) return true;
  }
  std::fprintf(stderr, "limn-bench: %s can't be written; give a file in a folder that may be\n",
               path.c_str());
  return false;
}

/// What came of an area.
struct Outcome {
  int missed = 0;  ///< rows that miss their goal
  bool drawn = true;
};

/// Runs one area and prints its rows as they come; its picture goes to `plot`, if there are both.
Outcome run_area(const Area& area, bool as_json, const std::string& plot) {
  Outcome outcome;
  if (!as_json) std::printf("%s\n", limn::bench::table_heading().c_str());
  const limn::bench::RowSink sink = [&outcome, as_json](const Row& row) {
    const std::string line = as_json ? to_json(row) : to_table_line(row);
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
    if (row.holds() == false) ++outcome.missed;
  };
  if (area.draw == nullptr) {
    area.run(sink);
    return outcome;
  }
  const limn::bench::Picture picture = area.draw(sink);
  if (!plot.empty()) outcome.drawn = write_picture(picture, plot);
  return outcome;
}

constexpr const char* kHelp =
    "usage: limn-bench [AREA...] [--format text|jsonl] [--plot FILE] [--require] [--list]\n"
    "Measures limn against its goals and against other libraries in the same run. All figures are\n"
    "costs; ratio = peer / limn, so above 1 limn is better. Without AREA all are measured but\n"
    "those that say so.\n"
    "  --format  text: a table; jsonl: one object a row\n"
    "  --plot    write the picture of the area `growth` to a file: PNG where it is named .png,\n"
    "            else SVG\n"
    "  --require exit with 1 if a row misses its goal\n"
    "  --list    name the areas and end\n"
    "  --decode-reports COUNT  decode that many reports and end, for tools that count "
    "instructions\n";

struct Arguments {
  std::vector<const Area*> areas;
  bool as_json = false;
  std::string plot;
  bool require = false;
  bool list = false;
  bool help = false;
  std::size_t decode_count = 0;  ///< --decode-reports
  std::string complaint;         ///< what is wrong; empty if nothing is
};

const Area* find_area(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kAreas), std::end(kAreas),
                                         [name](const Area& area) { return area.name == name; });
  return found == std::end(kAreas) ? nullptr : found;
}

Arguments parse(const std::vector<std::string_view>& words) {
  Arguments result;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (word == "--list") {
      result.list = true;
    } else if (word == "--require") {
      result.require = true;
    } else if (word == "--help" || word == "-h") {
      result.help = true;
    } else if (word == "--format") {
      const std::string_view format = i + 1 < words.size() ? words[++i] : "";
      result.as_json = format == "jsonl";
      if (format != "jsonl" && format != "text") result.complaint = "--format is text or jsonl";
    } else if (word == "--plot") {
      if (i + 1 < words.size()) result.plot = words[++i];
      if (result.plot.empty()) result.complaint = "--plot takes a file";
    } else if (word == "--decode-reports") {
      const std::string count(i + 1 < words.size() ? words[++i] : "");
      result.decode_count = std::strtoul(count.c_str(), nullptr, 10);
      if (result.decode_count == 0) result.complaint = "--decode-reports takes a number above 0";
    } else if (const Area* area = find_area(word)) {
      result.areas.push_back(area);
    } else {
      result.complaint = "there is no area or option '" + std::string(word) + "'; see --help";
    }
  }
  if (result.areas.empty()) {
    for (const Area& area : kAreas) {
      if (!area.when_named) result.areas.push_back(&area);
    }
  }
  const bool draws = std::any_of(result.areas.begin(), result.areas.end(),
                                 [](const Area* area) { return area->draw != nullptr; });
  if (!result.plot.empty() && !draws) result.complaint = "--plot is for the area growth; name it";
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = parse({argv + 1, argv + argc});
  if (!arguments.complaint.empty()) {
    std::fprintf(stderr, "limn-bench: %s\n", arguments.complaint.c_str());
    return 2;
  }
  if (arguments.help) {
    std::fputs(kHelp, stdout);
    return 0;
  }
  if (arguments.list) {
    list_areas();
    return 0;
  }
  if (arguments.decode_count > 0) {
    limn::bench::decode_reports(arguments.decode_count);
    return 0;
  }
  int missed = 0;
  bool drawn = true;
  for (const Area* area : arguments.areas) {
    const Outcome outcome = run_area(*area, arguments.as_json, arguments.plot);
    missed += outcome.missed;
    drawn = drawn && outcome.drawn;
  }
  if (missed > 0) std::fprintf(stderr, "limn-bench: %d rows miss their goal\n", missed);
  return !drawn || (arguments.require && missed > 0) ? 1 : 0;
}
