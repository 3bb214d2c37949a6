#include "modeler/sketch/curve_forms.hpp"

#include <algorithm>
#include <string>
#include <utility>

// Both forms come from the blossom of a span's polynomial: the symmetric function b(x_1 .. x_p),
// affine in each argument, with b(u, .., u) = C(u). For control points on knots t,
//
//     P_i = b(t_{i+1}, .., t_{i+p})
//
// where b belongs to any span that P_i takes part in: so the control points of the same polynomial
// on other knots are blossom values at those knots. [Ramshaw89]

namespace limn {
namespace {

constexpr std::size_t kMostPoints = static_cast<std::size_t>(KnotVector::kMaxDegree) + 1;

/// b(x_1 .. x_p) of the polynomial on `span`: de Boor's algorithm with an argument of its own in
/// each round. Precondition: arguments.size() == degree; the span is not empty.
Eigen::Vector2d blossom(const BsplineCurve<2>& curve, int span, std::span<const double> arguments) {
  const std::vector<double>& t = curve.knots().values();
  const auto p = static_cast<std::size_t>(curve.knots().degree());
  const std::size_t first = static_cast<std::size_t>(span) - p;
  std::array<Eigen::Vector2d, kMostPoints> d;
  for (std::size_t k = 0; k <= p; ++k) d[k] = curve.control_points()[first + k];
  for (std::size_t round = 1; round <= p; ++round) {
    for (std::size_t k = p; k >= round; --k) {
      const double lower = t[first + k];
      const double upper = t[first + k + p + 1 - round];
      const double a = (arguments[round - 1] - lower) / (upper - lower);
      d[k] = (1 - a) * d[k - 1] + a * d[k];
    }
  }
  return d[p];
}

/// Writes the Bezier points of a piece of degree 1 to 3 as those of a cubic.
void raise_to_cubic(int degree, std::array<Eigen::Vector2d, 4>& q) {
  if (degree == 1) {
    q[3] = q[1];
    q[1] = (2 * q[0] + q[3]) / 3;
    q[2] = (q[0] + 2 * q[3]) / 3;
  } else if (degree == 2) {
    const Eigen::Vector2d middle = q[1];
    q[3] = q[2];
    q[1] = (q[0] + 2 * middle) / 3;
    q[2] = (2 * middle + q[3]) / 3;
  }
}

bool has_clamped_ends(const std::vector<double>& t, std::size_t p) {
  return t.front() == t[p] && t.back() == t[t.size() - 1 - p];
}

}  // namespace

Expected<std::vector<BezierPiece>> bezier_pieces(const BsplineCurve<2>& curve) {
  const KnotVector& knots = curve.knots();
  const int p = knots.degree();
  std::vector<BezierPiece> pieces;
  if (p == 0) return pieces;
  if (p > 3) {
    return fail(ErrorCode::kLimit, "curve", "its degree is " + std::to_string(p),
                "give a curve of degree 3 or less to draw it by cubic pieces");
  }
  const std::vector<double>& t = knots.values();
  for (int span = p; span < knots.basis_count(); ++span) {
    const double u0 = t[static_cast<std::size_t>(span)];
    const double u1 = t[static_cast<std::size_t>(span) + 1];
    if (u0 == u1) continue;
    BezierPiece piece{u0, u1, {}};
    for (int i = 0; i <= p; ++i) {
      std::array<double, 3> arguments{};
      for (int k = 0; k < p; ++k) arguments[static_cast<std::size_t>(k)] = k < i ? u1 : u0;
      piece.points[static_cast<std::size_t>(i)] =
          blossom(curve, span, std::span(arguments).first(static_cast<std::size_t>(p)));
    }
    raise_to_cubic(p, piece.points);
    // Two spans give their common point with different rounding; at a break (multiplicity p + 1)
    // they give two points, which stay apart.
    if (!pieces.empty() && knots.multiplicity(u0) <= p) piece.points[0] = pieces.back().points[3];
    pieces.push_back(piece);
  }
  if (knots.is_periodic()) pieces.back().points[3] = pieces.front().points[0];
  return pieces;
}

BsplineCurve<2> clamped(const BsplineCurve<2>& curve) {
  const KnotVector& knots = curve.knots();
  const auto p = static_cast<std::size_t>(knots.degree());
  const std::vector<double>& old = knots.values();
  if (p == 0 || (!knots.is_periodic() && has_clamped_ends(old, p))) return curve;

  const double begin = knots.domain_begin();
  const double end = knots.domain_end();
  std::vector<double> interior;
  std::copy_if(old.begin(), old.end(), std::back_inserter(interior),
               [&](double u) { return begin < u && u < end; });
  auto made = KnotVector::make_clamped(knots.degree(), begin, end, interior);
  LIMN_EXPECT(made.has_value());  // a part of a valid knot vector

  const std::vector<double>& t = made->values();
  std::vector<Eigen::Vector2d> points(static_cast<std::size_t>(made->basis_count()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Some span [t_j, t_j+1], i <= j <= i + p, is not empty: KnotVector allows no dead function.
    std::size_t j = std::max(i, p);
    while (t[j] == t[j + 1]) ++j;
    const int span = knots.find_span(0.5 * (t[j] + t[j + 1]));
    points[i] = blossom(curve, span, std::span(t).subspan(i + 1, p));
  }
  if (knots.is_periodic()) points.back() = points.front();
  auto out = BsplineCurve<2>::make(*std::move(made), points);
  LIMN_EXPECT(out.has_value());  // finite points on finite knots, one a basis function
  return *std::move(out);
}

}  // namespace limn
