#include "modeler/surface/constructions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include "modeler/base/tolerance.hpp"
#include "modeler/bspline/simplify.hpp"
#include "modeler/surface/collocation.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;

/// Homogeneous control points of curves, rows of a surface.
struct Rows {
  KnotVector u;
  KnotVector v;
  std::size_t width;  ///< 3, or 4 with the weight
  std::vector<double> values;

  Expected<BsplineSurface> make() const {
    const KnotVector knots[] = {u, v};
    return BsplineSurface::from(
        SplineData::make(knots, 3, width == 4 ? Form::kRational : Form::kPolynomial, values));
  }
};

/// The curve's coordinates, in `width` doubles a point.
std::vector<double> coordinates_of(const SplineData& curve, std::size_t width) {
  std::vector<double> from = curve.coordinates().to_vector();
  const auto own = static_cast<std::size_t>(curve.width());
  if (own == width) return from;
  std::vector<double> to;
  for (std::size_t i = 0; i < from.size(); i += own) {
    to.insert(to.end(), {from[i], from[i + 1], from[i + 2], 1.0});
  }
  return to;
}

struct Pair {
  SplineData first;
  SplineData second;
  std::size_t width;
};

Expected<Pair> compatible(const BsplineCurve<3>& a, const BsplineCurve<3>& b) {
  auto both = make_compatible(a.data(), b.data(), 0);
  if (!both) return tl::unexpected(std::move(both.error()));
  const std::size_t width = a.is_rational() || b.is_rational() ? 4 : 3;
  return Pair{std::move(both->first), std::move(both->second), width};
}

std::vector<double> ruled_values(const Pair& pair) {
  std::vector<double> values = coordinates_of(pair.first, pair.width);
  const auto top = coordinates_of(pair.second, pair.width);
  values.insert(values.end(), top.begin(), top.end());
  return values;
}

/// A surface raised and refined to the degrees and knots of another.
Expected<SplineData> like(const SplineData& surface, const SplineData& other) {
  SplineData out = surface;
  for (int d = 0; d < 2; ++d) {
    auto both = make_compatible(out, other, d);
    if (!both) return tl::unexpected(std::move(both.error()));
    out = std::move(both->first);
  }
  return out;
}

}  // namespace

Expected<BsplineSurface> revolve(const BsplineCurve<3>& curve, const Frame& axis, double angle) {
  constexpr double kTurn = 2 * std::numbers::pi;
  if (!(angle > 0 && angle <= kTurn)) {
    return fail(ErrorCode::kOutOfRange, "angle", "it is not above 0 and at most a full turn",
                "give it in radians, up to 6.2831853");
  }
  const int arcs = std::max(1, static_cast<int>(std::ceil(angle / (kTurn / 4) - 1e-12)));
  const double each = angle / arcs;
  const double middle_weight = std::cos(each / 2);
  std::vector<double> interior;
  for (int i = 1; i < arcs; ++i) interior.insert(interior.end(), 2, i * each);
  auto around = KnotVector::make_clamped(2, 0, angle, interior);
  if (!around) return tl::unexpected(std::move(around.error()));
  Rows rows{*std::move(around), curve.knots(), 4, {}};
  const auto points = curve.control_points();
  for (std::size_t j = 0; j < points.size(); ++j) {
    const Vector3d from = points[j] - axis.origin;
    const Vector3d along = axis.origin + axis.z * axis.z.dot(from);
    const Vector3d x = points[j] - along;
    const Vector3d y = axis.z.cross(x);
    const double w = curve.weight(j);
    for (int i = 0; i <= 2 * arcs; ++i) {
      const double turned = 0.5 * i * each;
      const bool between = i % 2 == 1;
      // A full turn ends exactly where it began.
      const bool closes = i == 2 * arcs && angle == kTurn;
      const double out = between ? 1 / middle_weight : 1.0;
      const Vector3d p =
          closes ? points[j]
                 : Vector3d(along + out * (std::cos(turned) * x + std::sin(turned) * y));
      const double weight = w * (between ? middle_weight : 1.0);
      rows.values.insert(rows.values.end(),
                         {weight * p.x(), weight * p.y(), weight * p.z(), weight});
    }
  }
  return rows.make();
}

Expected<BsplineSurface> extrude(const BsplineCurve<3>& curve, const Vector3d& direction) {
  if (!direction.allFinite() || direction.isZero(0)) {
    return fail(ErrorCode::kOutOfRange, "direction", "it is zero or not finite",
                "give a direction with a length in mm");
  }
  const std::size_t width = curve.is_rational() ? 4 : 3;
  Rows rows{curve.knots(), *KnotVector::make_clamped(1, 0, 1), width,
            coordinates_of(curve.data(), width)};
  const std::size_t size = rows.values.size();
  for (std::size_t i = 0; i < size; i += width) {
    const double w = width == 4 ? rows.values[i + 3] : 1.0;
    for (std::size_t c = 0; c < 3; ++c) {
      rows.values.push_back(rows.values[i + c] + w * direction[static_cast<Eigen::Index>(c)]);
    }
    if (width == 4) rows.values.push_back(w);
  }
  return rows.make();
}

Expected<BsplineSurface> make_ruled(const BsplineCurve<3>& bottom, const BsplineCurve<3>& top) {
  auto pair = compatible(bottom, top);
  if (!pair) return tl::unexpected(std::move(pair.error()));
  return Rows{pair->first.knots(0), *KnotVector::make_clamped(1, 0, 1), pair->width,
              ruled_values(*pair)}
      .make();
}

Expected<BsplineSurface> make_coons(const BsplineCurve<3>& bottom, const BsplineCurve<3>& top,
                                    const BsplineCurve<3>& left, const BsplineCurve<3>& right) {
  auto across = compatible(bottom, top);
  if (!across) return tl::unexpected(std::move(across.error()));
  auto up = compatible(left, right);
  if (!up) return tl::unexpected(std::move(up.error()));
  const std::size_t width = std::max(across->width, up->width);
  across->width = up->width = width;
  const auto horizontal = ruled_values(*across);
  const auto vertical = ruled_values(*up);
  const std::size_t columns = across->first.count();
  const std::size_t rows = up->first.count();
  const auto corner = [width](const std::vector<double>& values, std::size_t i) {
    return Eigen::Map<const Eigen::VectorXd>(values.data() + i * width,
                                             static_cast<Eigen::Index>(width));
  };
  // Corners (0,0), (1,0), (0,1), (1,1) by both pairs.
  const std::array<std::size_t, 4> in_horizontal = {0, columns - 1, columns, 2 * columns - 1};
  const std::array<std::size_t, 4> in_vertical = {0, rows, rows - 1, 2 * rows - 1};
  std::vector<double> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::VectorXd a = corner(horizontal, in_horizontal[i]);
    const Eigen::VectorXd b = corner(vertical, in_vertical[i]);
    const double wa = width == 4 ? a[3] : 1;
    const double wb = width == 4 ? b[3] : 1;
    const double gap = (a.head<3>() / wa - b.head<3>() / wb).norm();
    constexpr double kSameWeight = 1e-12;
    if (gap > kGeometric || std::abs(wa - wb) > kSameWeight * std::abs(wa)) {
      return fail(ErrorCode::kNumeric, "corner " + std::to_string(i),
                  gap > kGeometric ? "the edges are " + std::to_string(gap) + " mm apart there"
                                   : "the edges have different weights there",
                  "let the four edges meet");
    }
    corners.insert(corners.end(), a.begin(), a.end());
  }

  // Ruled one way + ruled the other way - bilinear in the corners, all on the same knots.
  const KnotVector u1 = *KnotVector::make_clamped(1, across->first.knots(0).domain_begin(),
                                                  across->first.knots(0).domain_end());
  const KnotVector v1 = *KnotVector::make_clamped(1, up->first.knots(0).domain_begin(),
                                                  up->first.knots(0).domain_end());
  auto one = Rows{across->first.knots(0), v1, width, horizontal}.make();
  if (!one) return tl::unexpected(std::move(one.error()));
  std::vector<double> turned(vertical.size());  // left, right: u slowest there
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < rows; ++j) {
      std::copy_n(vertical.data() + (i * rows + j) * width, width,
                  turned.data() + (i + 2 * j) * width);
    }
  }
  auto other = Rows{u1, up->first.knots(0), width, turned}.make();
  if (!other) return tl::unexpected(std::move(other.error()));
  auto bilinear = Rows{u1, v1, width, corners}.make();
  if (!bilinear) return tl::unexpected(std::move(bilinear.error()));
  auto a = like(one->data(), other->data());
  if (!a) return tl::unexpected(std::move(a.error()));
  auto b = like(other->data(), *a);
  if (!b) return tl::unexpected(std::move(b.error()));
  auto c = like(bilinear->data(), *a);
  if (!c) return tl::unexpected(std::move(c.error()));
  std::vector<double> sum = a->coordinates().to_vector();
  const auto plus = b->coordinates().to_vector();
  const auto minus = c->coordinates().to_vector();
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += plus[i] - minus[i];
  return Rows{a->knots(0), a->knots(1), width, sum}.make();
}

Expected<Skin> make_skin(std::span<const BsplineCurve<3>> sections, Skinning skinning,
                         std::span<const double> wanted_parameters) {
  if (sections.size() < 2) {
    return fail(ErrorCode::kPointCount, "sections", "a skin needs two at least", "add a section");
  }
  if (!wanted_parameters.empty()) {
    if (wanted_parameters.size() != sections.size()) {
      return fail(ErrorCode::kPointCount, "parameters",
                  std::to_string(wanted_parameters.size()) + " are given for " +
                      std::to_string(sections.size()) + " sections",
                  "give one a section");
    }
    for (std::size_t i = 1; i < wanted_parameters.size(); ++i) {
      if (!(wanted_parameters[i] > wanted_parameters[i - 1])) {
        return fail(ErrorCode::kOutOfRange, "parameter " + std::to_string(i),
                    "it is not above the one before", "give ascending parameters");
      }
    }
  }
  // All on the knots of all: each meets the union so far, then all are brought to it.
  std::vector<SplineData> all;
  bool rational = false;
  for (const auto& section : sections) {
    rational = rational || section.is_rational();
    SplineData next = section.data();
    if (!all.empty()) {
      auto both = make_compatible(all.back(), next, 0);
      if (!both) return tl::unexpected(std::move(both.error()));
      next = std::move(both->second);
    }
    all.push_back(std::move(next));
  }
  const std::size_t width = rational ? 4 : 3;
  std::vector<std::vector<double>> rows;
  KnotVector u = all.back().knots(0);
  for (SplineData& section : all) {
    auto both = make_compatible(section, all.back(), 0);
    if (!both) return tl::unexpected(std::move(both.error()));
    rows.push_back(coordinates_of(both->first, width));
  }
  const std::size_t count = sections.size();
  auto parameters = wanted_parameters.empty()
                        ? average_chords(rows, width)
                        : Expected<std::vector<double>>(std::vector<double>(
                              wanted_parameters.begin(), wanted_parameters.end()));
  if (!parameters) return tl::unexpected(std::move(parameters.error()));
  const int degree = std::min<int>(3, static_cast<int>(count) - 1);
  const bool local = skinning == Skinning::kLocal && count >= 4;
  auto v = local ? quasi_interpolation_knots(*parameters) : averaged_knots(degree, *parameters);
  if (!v) return tl::unexpected(std::move(v.error()));
  auto solved =
      local ? quasi_interpolate(*v, *parameters, rows) : interpolate(*v, *parameters, rows);
  if (!solved) return tl::unexpected(std::move(solved.error()));
  Rows surface{std::move(u), *v, width, {}};
  for (const auto& row : *solved) {
    surface.values.insert(surface.values.end(), row.begin(), row.end());
  }
  auto made = surface.make();
  if (!made) return tl::unexpected(std::move(made.error()));

  double deviation = 0;
  std::vector<double> basis(static_cast<std::size_t>(v->degree()) + 1);
  for (std::size_t s = 0; s < count; ++s) {
    const int span = v->find_span((*parameters)[s]);
    v->basis(span, (*parameters)[s], basis);
    for (std::size_t i = 0; i < rows[s].size(); i += width) {
      Eigen::Vector4d sum(0, 0, 0, 0);
      for (std::size_t k = 0; k < basis.size(); ++k) {
        const auto& row = (*solved)[static_cast<std::size_t>(span - v->degree()) + k];
        for (std::size_t c = 0; c < width; ++c)
          sum[static_cast<Eigen::Index>(c)] += basis[k] * row[i + c];
      }
      const double w = width == 4 ? sum[3] : 1.0;
      const double ws = width == 4 ? rows[s][i + 3] : 1.0;
      const Vector3d wanted(rows[s][i] / ws, rows[s][i + 1] / ws, rows[s][i + 2] / ws);
      deviation = std::max(deviation, (sum.head<3>() / w - wanted).norm());
    }
  }
  return Skin{*std::move(made), deviation, *std::move(parameters)};
}

}  // namespace limn
