#include "modeler/bspline/jet.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace limn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A cross product below this part of its factors' lengths is rounding: its direction means
/// nothing.
constexpr double kParallel = 1e-14;

}  // namespace

FirstForm first_form(const SurfaceJet& jet) noexcept {
  return {jet.du.dot(jet.du), jet.du.dot(jet.dv), jet.dv.dot(jet.dv)};
}

std::optional<Vector3d> normal(const SurfaceJet& jet) noexcept {
  const Vector3d cross = jet.du.cross(jet.dv);
  const double length = cross.norm();
  if (!(length > kParallel * jet.du.norm() * jet.dv.norm())) return std::nullopt;
  return Vector3d(cross / length);
}

std::optional<SecondForm> second_form(const SurfaceJet& jet) noexcept {
  const auto n = normal(jet);
  if (!n) return std::nullopt;
  return SecondForm{jet.duu.dot(*n), jet.duv.dot(*n), jet.dvv.dot(*n)};
}

std::optional<SurfaceCurvature> curvature(const SurfaceJet& jet) noexcept {
  const auto second = second_form(jet);
  if (!second) return std::nullopt;
  const auto [l, m, n] = *second;
  const FirstForm first = first_form(jet);
  // In the orthonormal tangents e = S_u / |S_u| and f = n x e the second form is a symmetric matrix
  // [[a, b], [b, c]], whose eigenvalues need no difference of large numbers.
  const double root_e = std::sqrt(first.e);
  const double area = std::sqrt(first.determinant());
  const Vector2d along_v(first.f / root_e, area / root_e);  // S_v in (e, f); S_u is (root_e, 0)
  const double a = l / first.e;
  const double b = (m - a * root_e * along_v.x()) / (root_e * along_v.y());
  const double c =
      (n - along_v.x() * (a * along_v.x() + 2 * b * along_v.y())) / (along_v.y() * along_v.y());
  SurfaceCurvature out;
  out.mean = 0.5 * (a + c);
  const double half = 0.5 * (a - c);
  const double radius = std::hypot(half, b);
  out.max = out.mean + radius;
  out.min = out.mean - radius;
  out.gaussian = a * c - b * b;
  const double angle = radius > 0 ? 0.5 * std::atan2(b, half) : 0.0;
  const Vector3d e = jet.du / root_e;
  const Vector3d f = (jet.dv - along_v.x() * e) / along_v.y();
  out.max_direction = std::cos(angle) * e + std::sin(angle) * f;
  out.min_direction = -std::sin(angle) * e + std::cos(angle) * f;
  return out;
}

std::optional<double> curvature(const CurveJet<2>& jet) noexcept {
  const double speed = jet.d1.norm();
  if (!(speed > 0)) return std::nullopt;
  return (jet.d1.x() * jet.d2.y() - jet.d1.y() * jet.d2.x()) / (speed * speed * speed);
}

std::optional<double> curvature(const CurveJet<3>& jet) noexcept {
  const double speed = jet.d1.norm();
  if (!(speed > 0)) return std::nullopt;
  return jet.d1.cross(jet.d2).norm() / (speed * speed * speed);
}

std::optional<double> torsion(const CurveJet<3>& jet) noexcept {
  const Vector3d binormal = jet.d1.cross(jet.d2);
  if (!(binormal.norm() > kParallel * jet.d1.norm() * jet.d2.norm())) return std::nullopt;
  return binormal.dot(jet.d3) / binormal.squaredNorm();
}

}  // namespace limn
