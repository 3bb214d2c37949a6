#include "modeler/sketch/sketch.hpp"

#include <array>

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

}  // namespace limn
