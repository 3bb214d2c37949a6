#include "modeler/bspline/compose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "modeler/bspline/bernstein.hpp"
#include "modeler/bspline/control_point_map.hpp"
#include "modeler/bspline/refine.hpp"
#include "modeler/bspline/roots.hpp"

namespace limn {
namespace {

/// A polynomial in Bernstein form.
using Polynomial = std::vector<double>;
/// The homogeneous coordinates x, y, z, w of a point that moves with t.
using MovingPoint = std::array<Polynomial, 4>;

/// A curve in the parameter plane on one Bézier piece, w u, w v and w.
struct Piece {
  double low;
  double high;
  std::array<Polynomial, 3> coordinates;
};

/// Values of the parameters that are rounding of a knot, relative to the domain's length.
constexpr double kAtKnot = 1e-13;

std::vector<Piece> pieces_of(const BsplineCurve<2>& bezier) {
  std::vector<Piece> out;
  const auto ends = bezier.knots().breakpoints();
  const int p = bezier.knots().degree();
  const std::vector<double> x = bezier.data().coordinates().to_vector();
  const auto width = static_cast<std::size_t>(bezier.data().width());
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    Piece piece{ends[i], ends[i + 1], {}};
    const auto first = static_cast<std::size_t>(bezier.knots().find_span(ends[i]) - p);
    for (std::size_t k = first; k <= first + static_cast<std::size_t>(p); ++k) {
      piece.coordinates[0].push_back(x[k * width]);
      piece.coordinates[1].push_back(x[k * width + 1]);
      piece.coordinates[2].push_back(width == 3 ? x[k * width + 2] : 1.0);
    }
    out.push_back(std::move(piece));
  }
  return out;
}

/// Coefficients of x - w value.
Polynomial minus(const Polynomial& x, const Polynomial& w, double value) {
  Polynomial out = x;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] -= w[k] * value;
  return out;
}

/// The parameters at which the curve passes knot lines of the surface, inside its pieces.
std::vector<double> crossings(const BsplineSurface& surface, const std::vector<Piece>& pieces) {
  std::vector<double> out;
  for (const Piece& piece : pieces) {
    for (std::size_t d = 0; d < 2; ++d) {
      const KnotVector& knots = surface.knots(static_cast<int>(d));
      const double noise =
          kAtKnot * (std::abs(knots.domain_begin()) + std::abs(knots.domain_end()));
      for (const double knot : knots.breakpoints()) {
        if (knot == knots.domain_begin() || knot == knots.domain_end()) continue;
        const Polynomial f = minus(piece.coordinates[d], piece.coordinates[2], knot);
        for (const double t : bernstein_roots(f, noise).at) {
          const double at = piece.low + t * (piece.high - piece.low);
          constexpr double kInside = 1e-9;  // a knot at an end is there already
          if (t > kInside && t < 1 - kInside) out.push_back(at);
        }
      }
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// (w - n) a + n b, the step of de Casteljau's algorithm at n / w, degrees added.
Polynomial step(const Polynomial& a, const Polynomial& b, const Polynomial& n,
                const Polynomial& rest) {
  Polynomial out = bernstein_product(rest, a);
  const Polynomial other = bernstein_product(n, b);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] += other[k];
  return out;
}

/// Replaces `count` neighbours by the point that moves between them as n / w does.
MovingPoint de_casteljau(std::vector<MovingPoint> points, const Polynomial& n,
                         const Polynomial& rest) {
  for (std::size_t left = points.size(); left > 1; --left) {
    for (std::size_t i = 0; i + 1 < left; ++i) {
      for (std::size_t c = 0; c < 4; ++c) {
        points[i][c] = step(points[i][c], points[i + 1][c], n, rest);
      }
    }
  }
  return points[0];
}

/// The Bézier points of one patch of a surface, homogeneous, u fastest.
class Patches {
 public:
  explicit Patches(const BsplineSurface& surface) : surface_(surface) {}

  std::vector<std::array<double, 4>> net(int span_u, int span_v) const {
    const KnotVector& ku = surface_.knots(0);
    const KnotVector& kv = surface_.knots(1);
    const BezierShape shape{4, {ku.degree() + 1, kv.degree() + 1, 1}};
    std::vector<double> values;
    const auto width = static_cast<std::size_t>(surface_.data().width());
    for (int j = 0; j <= kv.degree(); ++j) {
      for (int i = 0; i <= ku.degree(); ++i) {
        const auto index = static_cast<std::size_t>(span_v - kv.degree() + j) *
                               static_cast<std::size_t>(ku.basis_count()) +
                           static_cast<std::size_t>(span_u - ku.degree() + i);
        for (std::size_t c = 0; c < width; ++c) {
          values.push_back(surface_.data().coordinates()[index * width + c]);
        }
        if (width == 3) values.push_back(1);
      }
    }
    map_along(shape, 0, bezier_extraction(ku, span_u), values);
    map_along(shape, 1, bezier_extraction(kv, span_v), values);
    std::vector<std::array<double, 4>> out(values.size() / 4);
    for (std::size_t i = 0; i < values.size(); ++i) out[i / 4][i % 4] = values[i];
    return out;
  }

 private:
  const BsplineSurface& surface_;
};

MovingPoint compose_piece(const BsplineSurface& surface, const Piece& piece) {
  // The patch under the piece's middle: its ends may lie on knot lines.
  std::array<int, 2> span{};
  std::array<Polynomial, 2> within;
  std::array<Polynomial, 2> rest;
  const Polynomial& w = piece.coordinates[2];
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots(static_cast<int>(d));
    const double middle = bernstein_value(piece.coordinates[d], 0.5) / bernstein_value(w, 0.5);
    span[d] = knots.find_span(std::clamp(middle, knots.domain_begin(), knots.domain_end()));
    const double low = knots.values()[static_cast<std::size_t>(span[d])];
    const double high = knots.values()[static_cast<std::size_t>(span[d]) + 1];
    within[d] = minus(piece.coordinates[d], w, low);
    for (double& x : within[d]) x /= high - low;
    rest[d] = w;
    for (std::size_t k = 0; k < w.size(); ++k) rest[d][k] -= within[d][k];
  }
  const auto net = Patches(surface).net(span[0], span[1]);
  const auto count_u = static_cast<std::size_t>(surface.knots(0).degree()) + 1;
  std::vector<MovingPoint> rows;
  for (std::size_t j = 0; j * count_u < net.size(); ++j) {
    std::vector<MovingPoint> row(count_u);
    for (std::size_t i = 0; i < count_u; ++i) {
      for (std::size_t c = 0; c < 4; ++c) row[i][c] = {net[j * count_u + i][c]};
    }
    rows.push_back(de_casteljau(std::move(row), within[0], rest[0]));
  }
  return de_casteljau(std::move(rows), within[1], rest[1]);
}

Expected<void> check_inside(const BsplineSurface& surface, const std::vector<Piece>& pieces) {
  for (const Piece& piece : pieces) {
    for (std::size_t d = 0; d < 2; ++d) {
      const KnotVector& knots = surface.knots(static_cast<int>(d));
      const double room = kAtKnot * (std::abs(knots.domain_begin()) + std::abs(knots.domain_end()));
      const Polynomial& w = piece.coordinates[2];
      for (const auto& [end, sign] :
           {std::pair(knots.domain_begin(), 1.0), {knots.domain_end(), -1.0}}) {
        // Inside unless it crosses the end or lies beyond it; the hull decides nearly always.
        Polynomial f = minus(piece.coordinates[d], w, end);
        for (double& x : f) x *= sign;
        if (std::all_of(f.begin(), f.end(), [room](double x) { return x >= -room; })) continue;
        std::vector<double> ends = bernstein_roots(f, room).at;
        ends.insert(ends.begin(), 0.0);
        ends.push_back(1.0);
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
          if (bernstein_value(f, 0.5 * (ends[i] + ends[i + 1])) >= -room) continue;
          return fail(ErrorCode::kOutOfRange, "curve near t = " + std::to_string(piece.low),
                      "it leaves the surface's domain", "trim the curve to the surface");
        }
      }
    }
  }
  return {};
}

}  // namespace

Expected<BsplineCurve<3>> compose(const BsplineSurface& surface, const BsplineCurve<2>& curve) {
  const int degree =
      curve.knots().degree() * (surface.knots(0).degree() + surface.knots(1).degree());
  if (degree > KnotVector::kMaxDegree) {
    return fail(ErrorCode::kLimit, "degree",
                "the exact curve has degree " + std::to_string(degree) + ", and " +
                    std::to_string(KnotVector::kMaxDegree) + " is the highest",
                "fit a curve to points of it instead");
  }
  auto bezier = to_bezier(curve, 0);
  if (!bezier) return tl::unexpected(std::move(bezier.error()));
  if (auto inside = check_inside(surface, pieces_of(*bezier)); !inside) {
    return tl::unexpected(std::move(inside.error()));
  }
  const auto added = crossings(surface, pieces_of(*bezier));
  std::vector<double> full;
  for (std::size_t i = 0; i < added.size(); ++i) {
    if (i > 0 && added[i] == added[i - 1]) continue;
    full.insert(full.end(), static_cast<std::size_t>(std::max(curve.knots().degree(), 1)),
                added[i]);
  }
  auto cut = insert_knots(*bezier, 0, full);
  if (!cut) return tl::unexpected(std::move(cut.error()));

  const bool rational = surface.is_rational() || curve.is_rational();
  const auto ends = cut->knots().breakpoints();
  std::vector<double> interior;
  std::vector<double> coordinates;
  for (const Piece& piece : pieces_of(*cut)) {
    const MovingPoint point = compose_piece(surface, piece);
    const bool breaks = curve.knots().multiplicity(piece.low) > curve.knots().degree();
    const bool first = piece.low == ends.front();
    // A shared end is one control point; where the curve breaks off, both are kept.
    for (std::size_t k = first || breaks ? 0 : 1; k < point[0].size(); ++k) {
      for (std::size_t c = 0; c < (rational ? 4 : 3); ++c) coordinates.push_back(point[c][k]);
    }
    if (!first) {
      interior.insert(interior.end(), static_cast<std::size_t>(degree + (breaks ? 1 : 0)),
                      piece.low);
    }
  }
  auto knots = KnotVector::make_clamped(degree, ends.front(), ends.back(), interior);
  if (!knots) return tl::unexpected(std::move(knots.error()));
  const KnotVector all[] = {*std::move(knots)};
  return BsplineCurve<3>::from(
      SplineData::make(all, 3, rational ? Form::kRational : Form::kPolynomial, coordinates));
}

}  // namespace limn
