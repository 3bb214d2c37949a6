#include "modeler/surface/patch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "input/base/expect.hpp"
#include "modeler/bspline/control_point_map.hpp"

namespace limn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kWidth = 4;

/// A net of numerators and denominators.
using Net = std::span<double>;

/// Takes coefficients of w offset off a net, w being the last coordinate of `by`; both are of the
/// same degree. The last coordinate stays.
void subtract(Net net, Net by, const Vector3d& offset) {
  for (std::size_t i = 0; i < net.size(); i += kWidth) {
    net[i] -= by[i + 3] * offset.x();
    net[i + 1] -= by[i + 3] * offset.y();
    net[i + 2] -= by[i + 3] * offset.z();
  }
}

/// Largest parts of a net's vectors along and off a tangent plane, and largest last coordinate.
struct Largest {
  double along = 0;
  double off = 0;
  double weight = 0;
};

Largest largest_of(Net net, const Vector3d& normal) {
  Largest out;
  for (std::size_t i = 0; i < net.size(); i += kWidth) {
    const Vector3d x(net[i], net[i + 1], net[i + 2]);
    const double off = x.dot(normal);
    out.off = std::max(out.off, std::abs(off));
    out.along = std::max(out.along, (x - off * normal).squaredNorm());
    out.weight = std::max(out.weight, std::abs(net[i + 3]));
  }
  out.along = std::sqrt(out.along);
  return out;
}

/// The Frobenius norm of a symmetric matrix of two directions.
double norm_of(double uu, double uv, double vv) {
  return std::hypot(uu, std::numbers::sqrt2 * uv, vv);
}

/// An orthonormal frame with the first axis along S_u and the third along the normal; any where
/// they vanish.
Matrix3d tangent_frame(const SurfaceJet& jet) {
  Matrix3d frame = Matrix3d::Identity();
  const Vector3d along = jet.du.squaredNorm() > 0 ? jet.du : jet.dv;
  if (!(along.norm() > 0)) return frame;
  frame.col(0) = along.normalized();
  const auto n = normal(jet);
  frame.col(2) = n ? *n : frame.col(0).unitOrthogonal();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

/// With A' = A - w S_c, so that A' = w (S - S_c), the product rule gives
///
///     A'_u  = w S_u + w_u (S - S_c),
///     A'_uu = w S_uu + 2 w_u S_u + w_uu (S - S_c),
///     A'_uv = w S_uv + w_u S_v + w_v S_u + w_uv (S - S_c).
///
/// Each is solved for a derivative minus its value in the middle: what is subtracted is a
/// polynomial of the same degree, and what is left is bounded by the reaches found before.
void bound_derivatives(const Patch& patch, double least_weight, PatchBound& out) {
  const SurfaceJet& jet = out.jet;
  const Vector3d n = out.frame.col(2);
  const std::size_t size = patch.net.size();
  std::vector<double> memory(7 * size);
  const auto net = [&](std::size_t i) { return Net(memory.data() + i * size, size); };
  const Net w = net(0);
  const Net u = net(1);
  const Net v = net(2);
  const Net uu = net(3);
  const Net uv = net(4);
  const Net vv = net(5);
  const Net first = net(6);
  const auto copy = [](Net from, Net to) { std::copy(from.begin(), from.end(), to.begin()); };
  const auto derive = [&](Net from, int direction, Net to) {
    copy(from, to);
    const Eigen::Index d = direction;
    differentiate_bezier(patch.shape, direction, 1 / (patch.box.high[d] - patch.box.low[d]), to);
  };
  std::copy(patch.net.begin(), patch.net.end(), w.begin());
  subtract(w, w, jet.point);  // A'; its last coordinate is w still
  derive(w, 0, u);
  derive(w, 1, v);
  derive(u, 0, uu);
  derive(u, 1, uv);
  derive(v, 1, vv);

  PatchBound::Reach& along = out.along;
  PatchBound::Reach& off = out.off;
  copy(u, first);
  subtract(first, w, jet.du);
  const Largest in_u = largest_of(first, n);
  along.du = (in_u.along + in_u.weight * along.point) / least_weight;
  off.du = (in_u.off + in_u.weight * off.point) / least_weight;
  copy(v, first);
  subtract(first, w, jet.dv);
  const Largest in_v = largest_of(first, n);
  along.dv = (in_v.along + in_v.weight * along.point) / least_weight;
  off.dv = (in_v.off + in_v.weight * off.point) / least_weight;

  subtract(uu, w, jet.duu);
  subtract(uu, u, 2 * jet.du);
  subtract(uv, w, jet.duv);
  subtract(uv, u, jet.dv);
  subtract(uv, v, jet.du);
  subtract(vv, w, jet.dvv);
  subtract(vv, v, 2 * jet.dv);
  const Largest in_uu = largest_of(uu, n);
  const Largest in_uv = largest_of(uv, n);
  const Largest in_vv = largest_of(vv, n);
  const double w_u = in_u.weight;
  const double w_v = in_v.weight;
  along.duu = (in_uu.along + 2 * w_u * along.du + in_uu.weight * along.point) / least_weight;
  off.duu = (in_uu.off + 2 * w_u * off.du + in_uu.weight * off.point) / least_weight;
  along.duv =
      (in_uv.along + w_u * along.dv + w_v * along.du + in_uv.weight * along.point) / least_weight;
  off.duv = (in_uv.off + w_u * off.dv + w_v * off.du + in_uv.weight * off.point) / least_weight;
  along.dvv = (in_vv.along + 2 * w_v * along.dv + in_vv.weight * along.point) / least_weight;
  off.dvv = (in_vv.off + 2 * w_v * off.dv + in_vv.weight * off.point) / least_weight;
}

/// What follows from the reaches in coordinates of -1 to 1 over the box.
void bound_in_box_units(PatchBound& out) {
  const SurfaceJet& jet = out.jet;
  const Eigen::Vector2d half = out.box.half();
  const Vector3d a = jet.du * half.x();
  const Vector3d b = jet.dv * half.y();
  const double mean = 0.5 * (a.squaredNorm() + b.squaredNorm());
  const double area = a.cross(b).norm();
  const double largest = std::sqrt(mean + std::sqrt(std::max(0.0, mean * mean - area * area)));
  out.least_stretch = largest > 0 ? area / largest : 0.0;
  out.flatten.setZero();
  if (out.least_stretch > 0) {
    const double a0 = a.dot(out.frame.col(0));  // a has no second coordinate there
    const double b0 = b.dot(out.frame.col(0));
    const double b1 = b.dot(out.frame.col(1));
    out.flatten << 1 / a0, -b0 / (a0 * b1), 0, 1 / b1;
  }
  out.turn_along = std::hypot(out.along.du * half.x(), out.along.dv * half.y());
  out.turn = std::hypot(out.turn_along, out.off.du * half.x(), out.off.dv * half.y());
  const double uu = half.x() * half.x();
  const double uv = half.x() * half.y();
  const double vv = half.y() * half.y();
  const Vector3d n = out.frame.col(2);
  const auto off = [&n](const Vector3d& x) { return std::abs(x.dot(n)); };
  const auto along = [&n](const Vector3d& x) { return (x - x.dot(n) * n).norm(); };
  out.second_off = norm_of(off(jet.duu) * uu, off(jet.duv) * uv, off(jet.dvv) * vv);
  out.second_along = norm_of(along(jet.duu) * uu, along(jet.duv) * uv, along(jet.dvv) * vv);
  out.second_reach_off = norm_of(out.off.duu * uu, out.off.duv * uv, out.off.dvv * vv);
  out.second_reach_along = norm_of(out.along.duu * uu, out.along.duv * uv, out.along.dvv * vv);
}

}  // namespace

double PatchBound::bending() const noexcept {
  return least_stretch > 0 ? turn / least_stretch : std::numeric_limits<double>::infinity();
}

bool Patch::has_positive_weights() const noexcept {
  for (std::size_t i = 3; i < net.size(); i += kWidth) {
    if (!(net[i] > 0)) return false;
  }
  return true;
}

Patch Patch::halve(int direction) {
  Patch after{box, spans, shape, std::vector<double>(net.size())};
  cut_bezier(shape, direction, 0.5, net, after.net);
  box.high[direction] = after.box.low[direction] = box.center()[direction];
  return after;
}

PatchGrid::PatchGrid(const BsplineSurface& surface) : surface_(surface) {
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots(static_cast<int>(d));
    const auto& values = knots.values();
    for (int s = knots.degree(); s < knots.basis_count(); ++s) {
      const auto at = static_cast<std::size_t>(s);
      extractions_[d].emplace_back();
      if (!(values[at] < values[at + 1])) continue;
      spans_[d].push_back(s);
      extractions_[d].back() = bezier_extraction(knots, s);
    }
  }
}

Patch PatchGrid::patch(const std::array<int, 2>& spans) const {
  Patch out;
  out.spans = spans;
  out.shape.width = static_cast<int>(kWidth);
  std::array<std::size_t, 2> first{};
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = surface_.knots(static_cast<int>(d));
    const auto span = static_cast<std::size_t>(spans[d]);
    out.box.low[static_cast<Eigen::Index>(d)] = knots.values()[span];
    out.box.high[static_cast<Eigen::Index>(d)] = knots.values()[span + 1];
    out.shape.count[d] = knots.degree() + 1;
    first[d] = span - static_cast<std::size_t>(knots.degree());
  }
  out.net.resize(out.shape.size());
  const SplineData& data = surface_.data();
  const auto width = static_cast<std::size_t>(data.width());
  const auto row = static_cast<std::size_t>(surface_.knots(0).basis_count());
  double* to = out.net.data();
  for (int j = 0; j < out.shape.count[1]; ++j) {
    std::size_t at = ((first[1] + static_cast<std::size_t>(j)) * row + first[0]) * width;
    for (int i = 0; i < out.shape.count[0]; ++i, to += kWidth) {
      to[3] = 1;
      for (std::size_t c = 0; c < width; ++c) to[c] = data.coordinates()[at++];
    }
  }
  map_along(out.shape, 0, extractions_[0][first[0]], out.net);
  map_along(out.shape, 1, extractions_[1][first[1]], out.net);
  return out;
}

PatchBound bound_of(const Patch& patch, const SurfaceJet& jet) {
  LIMN_EXPECT(patch.has_positive_weights());
  PatchBound out;
  out.box = patch.box;
  out.spans = patch.spans;
  out.jet = jet;
  out.frame = tangent_frame(jet);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  out.low = out.frame_low = Vector3d::Constant(kInfinity);
  out.high = out.frame_high = Vector3d::Constant(-kInfinity);
  double least_weight = kInfinity;
  for (std::size_t i = 0; i < patch.net.size(); i += kWidth) {
    const double* x = patch.net.data() + i;
    const Vector3d p(x[0] / x[3], x[1] / x[3], x[2] / x[3]);
    out.low = out.low.cwiseMin(p);
    out.high = out.high.cwiseMax(p);
    const Vector3d local = out.frame.transpose() * (p - jet.point);
    out.frame_low = out.frame_low.cwiseMin(local);
    out.frame_high = out.frame_high.cwiseMax(local);
    out.reach = std::max(out.reach, local.squaredNorm());
    out.along.point = std::max(out.along.point, local.head<2>().squaredNorm());
    least_weight = std::min(least_weight, x[3]);
  }
  // What extraction and evaluation round: neighbours' boxes may not leave a crack.
  const double rounding =
      2e-15 * std::max(out.low.cwiseAbs().maxCoeff(), out.high.cwiseAbs().maxCoeff());
  out.low.array() -= rounding;
  out.high.array() += rounding;
  out.frame_low.array() -= rounding;
  out.frame_high.array() += rounding;
  out.reach = std::sqrt(out.reach);
  out.along.point = std::sqrt(out.along.point);
  out.off.point = std::max(-out.frame_low.z(), out.frame_high.z());

  bound_derivatives(patch, least_weight, out);
  bound_in_box_units(out);
  return out;
}

}  // namespace limn
