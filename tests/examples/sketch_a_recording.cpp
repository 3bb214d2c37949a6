// sketch_a_recording TRACE FILE.svg: from a pen's recording to a picture of curves.

#include <cstdio>
#include <fstream>

#include "drivers/devices/trace_decoder.hpp"
#include "input/stroke/stroke_sampler.hpp"
#include "modeler/view/picture.hpp"

limn::Expected<limn::Sketch> sketch_of(const char* path) {
  auto bytes = limn::open_bytes(path);
  if (!bytes) return tl::unexpected(bytes.error());
  auto reader = limn::open_trace(*std::move(bytes));
  if (!reader) return tl::unexpected(reader.error());

  limn::TraceDecoder decoder(*std::move(reader));
  limn::StrokeSampler sampler;
  limn::SketchOptions options;
  options.fit.tolerance_mm = 0.1;
  limn::Sketch sketch{options.fit.tolerance_mm, {}};
  const auto fit = [&](const limn::Stroke& stroke) {
    if (auto curve = limn::sketch_stroke(stroke, options)) sketch.strokes.push_back(*curve);
  };
  for (;;) {
    const auto sample = decoder.next();
    if (!sample) return tl::unexpected(sample.error());
    if (*sample == nullptr) break;  // the end
    sampler.push(**sample, fit);
  }
  sampler.finish(fit);
  return sketch;
}

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto sketch = sketch_of(argv[1]);
  const auto svg = sketch ? limn::sketch_to_svg(*sketch) : tl::unexpected(sketch.error());
  if (!svg) {
    std::fprintf(stderr, "%s: %s\n", svg.error().at.c_str(), svg.error().what.c_str());
    return 1;
  }
  for (const auto& stroke : sketch->strokes)
    std::printf("%zu samples, %zu control points, within %.3f mm\n", stroke.samples,
                stroke.control_point_count(), stroke.deviation_max_mm);
  return std::ofstream(argv[2]) << *svg ? 0 : 1;
}
