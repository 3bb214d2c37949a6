#include "modeler/surface/crossing_cell.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace limn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;

/// Of derivatives in a box: what makes determinants of parallel planes differ from 0.
constexpr double kRounding = 1e-14;

Matrix3d without(const Eigen::Matrix<double, 3, 4>& m, int column) {
  Matrix3d out;
  for (int i = 0; i < 3; ++i) out.col(i) = m.col(i < column ? i : i + 1);
  return out;
}

}  // namespace

CrossingCell::CrossingCell(const SurfaceIndex& first, const PatchBound& a,
                           const SurfaceIndex& second, const PatchBound& b)
    : first_(first), second_(second), a_(a), b_(b), turn_(std::hypot(a.turn, b.turn)) {
  center_ << a.box.center(), b.box.center();
  half_ << a.box.half(), b.box.half();
  const Jacobian m = jacobian({a.jet, b.jet});
  double largest = -1;
  for (int k = 0; k < 4; ++k) {
    const double det = std::abs(without(m, k).determinant());
    if (det > largest) {
      largest = det;
      axis_ = k;
    }
  }
  const double inverse = largest > 0 ? without(m, axis_).inverse().norm() : 0.0;
  rounding_ = kRounding * (m.norm() + a.jet.point.norm() + b.jet.point.norm());
  contraction_ =
      inverse > 0 ? inverse * (turn_ + rounding_) : std::numeric_limits<double>::infinity();
  const auto bends = [](const PatchBound& p) {
    return std::hypot(p.second_along + p.second_reach_along, p.second_off + p.second_reach_off);
  };
  most_second_ = std::max(bends(a), bends(b));
}

bool CrossingCell::is_transversal() const noexcept {
  constexpr double kMostContraction = 0.2;
  return contraction_ <= kMostContraction;
}

CrossingJets CrossingCell::jets(const Vector4d& x) const {
  const CrossingPlace at = place(x);
  return {first_.jet(a_, at.head<2>()), second_.jet(b_, at.tail<2>())};
}

bool CrossingCell::solve(double c, Vector4d& x) const {
  x = Vector4d::Zero();
  x[axis_] = c;
  constexpr int kMostSteps = 20;
  constexpr double kLastStep = 1e-9;  // of a part's half side: squared it is below rounding
  for (int step = 0; step < kMostSteps; ++step) {
    const CrossingJets pair = jets(x);
    const Matrix3d m = without(jacobian(pair), axis_);
    const Vector3d move = m.inverse() * pair.gap();
    if (!move.allFinite()) return false;
    for (int i = 0; i < 3; ++i) {
      double& y = x[i < axis_ ? i : i + 1];
      y = std::clamp(y + move[i], -2.0, 2.0);
    }
    if (move.cwiseAbs().maxCoeff() < kLastStep) return true;
  }
  return false;
}

/// From the place r in the box that is nearest to x, with the Jacobian M there, a crossing has
/// y(c') = l(c') + e, l being linear and e = -M_k^-1 R, where R is what the linear map leaves of G.
/// With h for |M_k^-1|, a for |l - r| at most and T, D the bounds of the changes of the first
/// derivatives and of the second derivatives:
///
///     |e| <= 2 h T |y - r|,    |e| <= h D / 2 (|y - r|^2 + reach^2),    |y - r| <= a + |e|.
bool CrossingCell::excludes(double c, double reach, const Vector4d& x) const {
  Vector4d r = x.cwiseMax(-1.0).cwiseMin(1.0);
  r[axis_] = c;
  const CrossingJets pair = jets(r);
  const Jacobian m = jacobian(pair);
  const Matrix3d inverse = without(m, axis_).inverse();
  const Vector3d move = inverse * pair.gap();
  const Vector3d slope = -inverse * m.col(axis_);
  const double a = move.norm() + reach * slope.norm();
  const double q = 2 * turn_ * inverse.norm();
  double error = q * (r.cwiseAbs() + Vector4d::Ones()).norm();  // y is in the box
  if (q < 1) error = std::min(error, q / (1 - q) * (a + reach));
  const double k = 0.5 * inverse.norm() * most_second_;
  const double half_linear = 0.5 - k * a;
  const double discriminant = half_linear * half_linear - k * k * (a * a + reach * reach);
  if (k > 0 && half_linear > 0 && discriminant >= 0) {
    // k e^2 - 2 half_linear e + k (a^2 + reach^2) >= 0: e is below one root or above the other.
    const double root = std::sqrt(discriminant);
    if (error < (half_linear + root) / k) error = std::min(error, (half_linear - root) / k);
  }
  error += inverse.norm() * rounding_;
  if (!std::isfinite(error)) return false;
  for (int i = 0; i < 3; ++i) {
    const double y = r[i < axis_ ? i : i + 1] + move[i];
    if (std::abs(y) - std::abs(slope[i]) * reach - error > 1) return true;
  }
  return false;
}

}  // namespace limn
