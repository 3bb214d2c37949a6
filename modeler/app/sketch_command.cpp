#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <span>
#include <vector>

#include "drivers/devices/trace_decoder.hpp"
#include "input/stroke/stroke_sampler.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/output_file.hpp"
#include "modeler/app/standard_output.hpp"
#include "modeler/app/table.hpp"
#include "modeler/app/trace_input.hpp"
#include "modeler/exchange/sketch_json.hpp"
#include "modeler/exchange/sketch_step.hpp"
#include "modeler/sketch/sketch.hpp"
#include "modeler/view/picture.hpp"

namespace limn::app {
namespace {

using SketchWriter = Expected<std::string> (*)(const Sketch&);

struct SketchFileType {
  std::string_view extension;
  SketchWriter write;
};

constexpr std::array<SketchFileType, 5> kFileTypes = {{
    {".svg", [](const Sketch& sketch) { return sketch_to_svg(sketch); }},
    {".pdf", [](const Sketch& sketch) { return sketch_to_pdf(sketch); }},
    {".png", [](const Sketch& sketch) { return sketch_to_png(sketch); }},
    {".step", [](const Sketch& sketch) { return sketch_to_step(sketch); }},
    {".json", [](const Sketch& sketch) -> Expected<std::string> { return sketch_to_json(sketch); }},
}};

struct SketchOutput {
  OutputFile file;
  SketchWriter write;
};

/// The type by the extension; JSON for standard output and for devices without one (/dev/null).
const SketchFileType* type_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  const bool device = std::filesystem::exists(status) &&
                      !std::filesystem::is_regular_file(status) &&
                      !std::filesystem::is_directory(status);
  if (path == "-" || (device && extension.empty())) extension = ".json";
  const auto type = std::find_if(kFileTypes.begin(), kFileTypes.end(),
                                 [&](const auto& t) { return t.extension == extension; });
  return type == kFileTypes.end() ? nullptr : &*type;
}

/// Opens every output before any work, so that a wrong name costs nobody a wait.
tl::expected<std::vector<SketchOutput>, Failure> open_outputs(
    const std::vector<std::string>& paths) {
  std::vector<SketchOutput> outputs;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const SketchFileType* type = type_of(paths[i]);
    if (type == nullptr) {
      return usage_error("'" + paths[i] + "' has no extension that limn writes",
                         "choose .svg, .pdf, .png, .step or .json");
    }
    if (std::find(paths.begin(), paths.begin() + static_cast<std::ptrdiff_t>(i), paths[i]) !=
        paths.begin() + static_cast<std::ptrdiff_t>(i)) {
      return usage_error("-o " + paths[i] + " is given twice", "name each file once");
    }
    auto file = in_file(paths[i], OutputFile::open(paths[i]));
    if (!file) return tl::unexpected(std::move(file.error()));
    outputs.push_back({std::move(*file), type->write});
  }
  return outputs;
}

/// Writes all files to the disk, then names them all: where one cannot be written, none appears.
Outcome write_outputs(const Sketch& sketch, std::span<SketchOutput> outputs) {
  for (SketchOutput& output : outputs) {
    const Expected<void> written =
        output.write(sketch)
            .and_then([&](const std::string& bytes) { return output.file.write(bytes); })
            .and_then([&] { return output.file.finish(); });
    if (!written) return in_file(output.file.path(), written);
  }
  for (SketchOutput& output : outputs) {
    if (auto named = output.file.commit(); !named) return in_file(output.file.path(), named);
  }
  return {};
}

/// Strokes of the recording as curves; what the recording held goes to standard error.
tl::expected<Sketch, Failure> make_sketch(const SketchArguments& arguments) {
  auto reader = open_trace_input(arguments.trace);
  if (!reader) return tl::unexpected(std::move(reader.error()));
  TraceDecoder decoder(std::move(*reader), {.salvage = arguments.trace.salvage});

  Sketch sketch;
  sketch.tolerance_mm = arguments.tolerance_mm;
  SketchOptions options;
  options.fit.tolerance_mm = arguments.tolerance_mm;
  std::size_t unlifted = 0;
  Expected<void> fitted;
  const auto fit = [&](const Stroke& stroke) {
    if (!fitted) return;
    if (!stroke.closed_by_lift) ++unlifted;
    auto curve = sketch_stroke(stroke, options);
    if (curve) {
      sketch.strokes.push_back(std::move(*curve));
    } else {
      Error error = std::move(curve.error());
      error.at = "stroke " + std::to_string(sketch.strokes.size() + 1) +
                 (error.at.empty() ? "" : ", " + error.at);
      fitted = tl::unexpected(std::move(error));
    }
  };

  StrokeSampler sampler;
  for (;;) {
    auto sample = decoder.next();
    if (!sample) {
      return in_file(arguments.trace.path, Expected<Sketch>(tl::unexpected(sample.error())));
    }
    if (*sample == nullptr) break;
    sampler.push(**sample, fit);
    if (!fitted) break;
  }
  sampler.finish(fit);
  if (!fitted) {
    return in_file(arguments.trace.path, Expected<Sketch>(tl::unexpected(fitted.error())));
  }
  std::string summary = summarise(decoder.summary());
  summary += ", " + count_of(sketch.strokes.size(), "stroke");
  if (unlifted > 0) {
    summary +=
        "; in " + std::to_string(unlifted) + " the pen never lifts: ended where the trace does";
  }
  std::fprintf(stderr, "%s\n", summary.c_str());
  return sketch;
}

Table stroke_table(const Sketch& sketch) {
  Table table({{"stroke", "stroke"},
               {"samples", "samples"},
               {"tool", "tool"},
               {"length_mm", "length mm", 2},
               {"duration_s", "duration s", 3},
               {"control_points", "control points"},
               {"deviation_max_mm", "max deviation mm", 4},
               {"deviation_rms_mm", "RMS mm", 4},
               {"corners", "corners"},
               {"closed", "closed"}});
  const auto count = [](std::size_t n) { return static_cast<std::int64_t>(n); };
  for (std::size_t i = 0; i < sketch.strokes.size(); ++i) {
    const SketchStroke& stroke = sketch.strokes[i];
    table.add({count(i + 1), count(stroke.samples), std::string(name(stroke.tool)),
               stroke.length_mm, to_seconds(stroke.t1 - stroke.t0),
               count(stroke.control_point_count()), stroke.deviation_max_mm,
               stroke.deviation_rms_mm, count(stroke.corners.size()), stroke.closed()});
  }
  return table;
}

}  // namespace

Outcome run_sketch(const SketchArguments& arguments) {
  const auto& paths = arguments.outputs;
  const bool json_on_stdout = std::find(paths.begin(), paths.end(), "-") != paths.end();
  if (json_on_stdout && arguments.format != OutputFormat::kText &&
      arguments.format != OutputFormat::kJson) {
    return usage_error("-o - writes JSON to standard output, --format another format",
                       "give one of them");
  }
  auto outputs = open_outputs(arguments.outputs);
  if (!outputs) return tl::unexpected(std::move(outputs.error()));
  auto sketch = make_sketch(arguments);
  if (!sketch) return tl::unexpected(std::move(sketch.error()));
  if (auto written = write_outputs(*sketch, *outputs); !written) return written;

  if (json_on_stdout) return {};
  if (arguments.format == OutputFormat::kJson) return print(sketch_to_json(*sketch));
  return print(stroke_table(*sketch).print(arguments.format));
}

}  // namespace limn::app
