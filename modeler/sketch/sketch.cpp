#include "modeler/sketch/sketch.hpp"

#include <array>
#include <utility>

namespace limn {
namespace {

// Abscissae and weights of 8-point Gauss-Legendre quadrature on [-1, 1], positive half.
constexpr std::array<double, 4> kGaussAbscissae = {0.1834346424956498, 0.5255324099163290,
                                                   0.7966664774136267, 0.9602898564975363};
constexpr std::array<double, 4> kGaussWeights = {0.3626837833783620, 0.3137066458778873,
                                                 0.2223810344533745, 0.1012285362903763};

double speed(const BsplineCurve<2>& curve, double u) {
  std::array<Eigen::Vector2d, 2> d;
  curve.derivatives(u, d);
  return d[1].norm();
}

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

std::size_t SketchStroke::control_point_count() const noexcept {
  const std::size_t count = curve.control_points().size();
  return closed() ? count - static_cast<std::size_t>(curve.knots().degree()) : count;
}

double arc_length(const BsplineCurve<2>& curve) {
  if (curve.knots().degree() == 0) return 0;
  const std::vector<double> breakpoints = curve.knots().breakpoints();
  double length = 0;
  for (std::size_t i = 0; i + 1 < breakpoints.size(); ++i) {
    const double middle = 0.5 * (breakpoints[i] + breakpoints[i + 1]);
    const double half = 0.5 * (breakpoints[i + 1] - breakpoints[i]);
    for (std::size_t k = 0; k < kGaussAbscissae.size(); ++k) {
      const double offset = half * kGaussAbscissae[k];
      length +=
          half * kGaussWeights[k] * (speed(curve, middle - offset) + speed(curve, middle + offset));
    }
  }
  return length;
}

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
  out.length_mm = arc_length(fit->curve);
  out.corners = std::move(fit->corners);
  out.deviation_max_mm = fit->deviation_max;
  out.deviation_rms_mm = fit->deviation_rms;
  out.pressure = pressure_profile(stroke, fit->sample_parameters);
  out.curve = std::move(fit->curve);
  return out;
}

}  // namespace limn
