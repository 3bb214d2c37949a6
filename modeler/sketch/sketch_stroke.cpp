#include <utility>

#include "modeler/sketch/sketch.hpp"
#include "modeler/surface/measures.hpp"

namespace limn {
namespace {

std::vector<PressureAt> pressure_profile(const Stroke& stroke,
                                         const std::vector<double>& parameters) {
  std::vector<PressureAt> profile;
  if (!stroke.axes.has(PenAxis::kPressure)) return profile;
  profile.reserve(parameters.size());
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    profile.push_back({parameters[i], stroke.points[i].pressure});
  }
  return profile;
}

}  // namespace

Expected<SketchStroke> sketch_stroke(const Stroke& stroke, const SketchOptions& options) {
  std::vector<Eigen::Vector2d> positions;
  std::vector<double> times;
  positions.reserve(stroke.points.size());
  times.reserve(stroke.points.size());
  for (const StrokePoint& p : stroke.points) {
    positions.emplace_back(p.x_mm, p.y_mm);
    times.push_back(to_seconds(p.time - stroke.points.front().time));
  }
  auto fit = fit_curve<2>(positions, times, options.fit);
  if (!fit) return tl::unexpected(std::move(fit.error()));

  SketchStroke out;
  out.device = stroke.device;
  out.tool = stroke.tool;
  out.samples = stroke.points.size();
  out.t0 = stroke.points.front().time - options.time_zero;
  out.t1 = stroke.points.back().time - options.time_zero;
  out.length_mm = arc_length(fit->curve).value;
  out.corners = std::move(fit->corners);
  out.deviation_max_mm = fit->deviation_max;
  out.deviation_rms_mm = fit->deviation_rms;
  out.pressure = pressure_profile(stroke, fit->sample_parameters);
  out.curve = std::move(fit->curve);
  return out;
}

}  // namespace limn
