#include <algorithm>
#include <filesystem>

#include "input/stroke/stroke_sampler.hpp"
#include "input/trace/trace.hpp"
#include "tests/bench/strokes.hpp"

namespace limn::bench {

namespace fs = std::filesystem;

namespace {

SampledStroke sampled(const std::string& name, const Stroke& stroke) {
  SampledStroke result{name, {}, {}};
  for (const auto& point : stroke.points) {
    result.positions.emplace_back(point.x_mm, point.y_mm);
    result.times.push_back(to_seconds(point.time));
  }
  return result;
}

void append_strokes(const fs::path& file, std::vector<SampledStroke>& out) {
  auto bytes = open_bytes(file.string());
  if (!bytes) return;
  auto reader = open_trace(*std::move(bytes));
  if (!reader) return;
  StrokeSampler sampler;
  const auto keep = [&](const Stroke& stroke) { out.push_back(sampled(file.stem(), stroke)); };
  for (auto event = (*reader)->next(); event; event = (*reader)->next()) {
    if (std::holds_alternative<TraceEnd>(*event)) break;
    if (const auto* sample = std::get_if<PenSample>(&*event)) sampler.push(*sample, keep);
  }
  sampler.finish(keep);
}

}  // namespace

std::vector<SampledStroke> recorded_strokes(const std::string& folder, const std::string& part) {
  const fs::path root = fs::path(LIMN_SOURCE_DIR).parent_path() / "shared/strokes" / folder;
  std::vector<fs::path> files;
  if (fs::exists(root))
    for (const auto& entry : fs::directory_iterator(root))
      if (entry.path().extension() == ".csv" &&
          entry.path().stem().string().find(part) != std::string::npos)
        files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<SampledStroke> strokes;
  for (const auto& file : files) append_strokes(file, strokes);
  return strokes;
}

}  // namespace limn::bench
