#include "modeler/sketch/sketch.hpp"

#include <array>
#include <cmath>

namespace limn {
namespace {

// Abscissae and weights of 8-point Gauss-Legendre quadrature on [-1, 1], positive half.
constexpr std::array<double, 4> kGaussAbscissae = {0.1834346424956498, 0.5255324099163290,
                                                   0.7966664774136267, 0.9602898564975363};
constexpr std::array<double, 4> kGaussWeights = {0.3626837833783620, 0.3137066458778873,
                                                 0.2223810344533745, 0.1012285362903763};

constexpr double kLengthError = 1e-9;  // relative, where the halving stops
constexpr int kMostHalvings = 8;       // reached only towards a cusp

double speed(const BsplineCurve<2>& curve, double u) {
  std::array<Eigen::Vector2d, 2> d;
  curve.derivatives(u, d);
  return d[1].norm();
}

double quadrature(const BsplineCurve<2>& curve, double a, double b) {
  const double middle = 0.5 * (a + b);
  const double half = 0.5 * (b - a);
  double sum = 0;
  for (std::size_t k = 0; k < kGaussAbscissae.size(); ++k) {
    const double offset = half * kGaussAbscissae[k];
    sum += kGaussWeights[k] * (speed(curve, middle - offset) + speed(curve, middle + offset));
  }
  return half * sum;
}

/// Halves [a, b] until both halves together agree with the whole.
double refined_quadrature(const BsplineCurve<2>& curve, double a, double b, double whole,
                          int halvings) {
  const double middle = 0.5 * (a + b);
  const double left = quadrature(curve, a, middle);
  const double right = quadrature(curve, middle, b);
  if (halvings == 0 || std::abs(left + right - whole) <= kLengthError * whole) return left + right;
  return refined_quadrature(curve, a, middle, left, halvings - 1) +
         refined_quadrature(curve, middle, b, right, halvings - 1);
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
    const double a = breakpoints[i];
    const double b = breakpoints[i + 1];
    length += refined_quadrature(curve, a, b, quadrature(curve, a, b), kMostHalvings);
  }
  return length;
}

}  // namespace limn
