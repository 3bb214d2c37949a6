// Laws of B-splines, on random knots, degrees and dimensions.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "modeler/bspline/refine.hpp"
#include "modeler/bspline/surface_evaluator.hpp"
#include "modeler/bspline/tensor_spline.hpp"
#include "tests/property/modeler/random_splines.hpp"
#include "tests/support/for_all.hpp"

namespace limn {
namespace {

using test::any_curve;
using test::any_knots;
using test::any_parameter;
using test::any_spline;
using test::Rng;

constexpr int kCases = 200;
constexpr double kSize = 100;  // of the random control points
/// Refinement moves no point by more than this: 1e-12 of the size.
constexpr double kRefined = 1e-12 * kSize;

TEST(BsplineLaw, PartitionOfUnityAndPositivity) {
  test::for_all(kCases, [](Rng& rng) {
    const auto knots =
        any_knots(rng, static_cast<int>(rng.integer(0, KnotVector::kMaxDegree)), true);
    std::array<double, KnotVector::kMaxDegree + 1> basis;
    for (int i = 0; i < 20; ++i) {
      const double u = any_parameter(rng, knots);
      knots.basis(knots.find_span(u), u, basis);
      double sum = 0;
      for (int k = 0; k <= knots.degree(); ++k) {
        EXPECT_GE(basis[k], 0);
        sum += basis[k];
      }
      EXPECT_NEAR(sum, 1, 1e-14);  // some p roundings of terms below 1
    }
  });
}

TEST(BsplineLaw, GrevilleAbscissaeReproduceTheParameter) {
  test::for_all(kCases, [](Rng& rng) {
    const auto knots = any_knots(rng, static_cast<int>(rng.integer(1, 12)), true);
    if (knots.is_periodic()) return;  // u itself is not periodic
    std::vector<Eigen::Matrix<double, 1, 1>> points;
    for (int i = 0; i < knots.basis_count(); ++i) points.emplace_back(knots.greville(i));
    const auto identity = *BsplineCurve<1>::make(knots, points);
    const double u = any_parameter(rng, knots);
    EXPECT_NEAR(identity.point(u)[0], u, 1e-12);  // parameters up to about 100
  });
}

TEST(BsplineLaw, DerivativesAgreeWithCentralDifferences) {
  test::for_all(kCases, [](Rng& rng) {
    const auto curve = any_curve<2>(rng, 6);
    const auto breaks = curve.knots().breakpoints();
    // In the middle of a span, where the polynomial goes on; a step of eps^(1/3) of the span.
    const auto s = static_cast<std::size_t>(rng.integer(0, static_cast<int>(breaks.size()) - 2));
    const double width = breaks[s + 1] - breaks[s];
    const double u = breaks[s] + width * rng.uniform(0.3, 0.7);
    const double step = 6e-6 * width;
    std::array<Eigen::Vector2d, 8> here;
    std::array<Eigen::Vector2d, 8> ahead;
    std::array<Eigen::Vector2d, 8> behind;
    curve.derivatives(u, here);
    curve.derivatives(u + step, ahead);
    curve.derivatives(u - step, behind);
    for (int r = 0; r + 1 < 8; ++r) {
      const Eigen::Vector2d difference = (ahead[r] - behind[r]) / (2 * step);
      // Truncation step^2 / 6 of the third derivative on, rounding eps / step of the value:
      // relative to the largest derivative in the span's own unit some 1e-9.
      double scale = kSize;
      for (int k = 0; k < 8; ++k) scale = std::max(scale, here[k].norm() * std::pow(width, k));
      EXPECT_LE((here[r + 1] - difference).norm() * std::pow(width, r + 1), 1e-8 * scale) << r;
    }
  });
}

TEST(BsplineLaw, MixedDerivativesAgreeWithCentralDifferences) {
  test::for_all(kCases / 4, [](Rng& rng) {
    const auto surface =
        any_spline<2, 3>(rng, {any_knots(rng, static_cast<int>(rng.integer(1, 4))),
                               any_knots(rng, static_cast<int>(rng.integer(1, 4)))});
    std::array<double, 2> u{};
    std::array<double, 2> width{};
    for (int d = 0; d < 2; ++d) {
      const auto breaks = surface.knots(d).breakpoints();
      const auto s = static_cast<std::size_t>(rng.integer(0, static_cast<int>(breaks.size()) - 2));
      width[d] = breaks[s + 1] - breaks[s];
      u[d] = breaks[s] + width[d] * rng.uniform(0.3, 0.7);
    }
    std::array<Eigen::Vector3d, 4> here;  // value, d/du, d/dv, d2/du dv
    surface.derivatives(u, {1, 1}, here);
    const double step = 6e-6 * width[1];
    std::array<Eigen::Vector3d, 4> ahead;
    std::array<Eigen::Vector3d, 4> behind;
    surface.derivatives({u[0], u[1] + step}, {1, 1}, ahead);
    surface.derivatives({u[0], u[1] - step}, {1, 1}, behind);
    for (int r = 0; r < 2; ++r) {
      const Eigen::Vector3d difference = (ahead[r] - behind[r]) / (2 * step);
      const double unit = std::pow(width[0], r) * width[1];
      EXPECT_LE((here[r + 2] - difference).norm() * unit, 1e-6 * kSize);
    }
  });
}

TEST(BsplineLaw, PreparedSurfacesAgreeWithTheRecursion) {
  test::for_all(kCases, [](Rng& rng) {
    const auto degree = [&] { return static_cast<int>(rng.integer(0, 11)); };  // 9 have tables
    const auto surface = any_spline<2, 3>(
        rng, {any_knots(rng, degree(), true), any_knots(rng, degree(), true)}, rng.chance(0.5));
    const SurfaceEvaluator prepared(surface);
    std::array<std::vector<double>, 2> at;
    std::array<double, 2> span{};
    for (int d = 0; d < 2; ++d) {
      const KnotVector& knots = surface.knots(d);
      at[d] = {knots.domain_begin(), knots.domain_end(), any_parameter(rng, knots),
               knots.breakpoints()[knots.breakpoints().size() / 2]};
      span[d] = 1e300;
      for (std::size_t i = 1; i < knots.breakpoints().size(); ++i) {
        span[d] = std::min(span[d], knots.breakpoints()[i] - knots.breakpoints()[i - 1]);
      }
    }
    std::vector<SurfaceFrame> grid(16);
    prepared.grid(at[0], at[1], grid);
    for (std::size_t i = 0; i < 16; ++i) {
      const double u = at[0][i % 4];
      const double v = at[1][i / 4];
      std::array<Eigen::Vector3d, 9> expected;
      surface.derivatives({u, v}, {2, 2}, expected);
      const SurfaceJet jet = prepared.jet(u, v);
      // Powers of t lose up to 2^p of the digits; a derivative is as large as one over the span.
      constexpr double kRounding = 1e-10 * kSize;
      EXPECT_LE((jet.point - expected[0]).norm(), 1e-12 * kSize);
      EXPECT_LE((jet.du - expected[1]).norm() * span[0], kRounding);
      EXPECT_LE((jet.dv - expected[3]).norm() * span[1], kRounding);
      EXPECT_LE((jet.duu - expected[2]).norm() * span[0] * span[0], kRounding);
      EXPECT_LE((jet.duv - expected[4]).norm() * span[0] * span[1], kRounding);
      EXPECT_LE((jet.dvv - expected[6]).norm() * span[1] * span[1], kRounding);
      EXPECT_LE((grid[i].point - expected[0]).norm(), 1e-12 * kSize);
      EXPECT_LE((grid[i].du - expected[1]).norm() * span[0], kRounding);
      EXPECT_LE((grid[i].dv - expected[3]).norm() * span[1], kRounding);
    }
  });
}

TEST(BsplineLaw, InsertionLeavesTheShape) {
  test::for_all(kCases, [](Rng& rng) {
    const auto curve = any_curve<3>(rng, 10);
    const auto& knots = curve.knots();
    std::vector<double> added;
    for (int i = static_cast<int>(rng.integer(1, 6)); i > 0; --i) {
      added.push_back(any_parameter(rng, knots));
    }
    if (knots.degree() > 1) added.push_back(added.front());  // a double knot
    const auto refined = insert_knots(curve, 0, added);
    ASSERT_TRUE(refined.has_value()) << refined.error().what;
    EXPECT_EQ(refined->control_points().size(), curve.control_points().size() + added.size());
    for (int i = 0; i < 20; ++i) {
      const double u = any_parameter(rng, knots);
      EXPECT_LE((refined->point(u) - curve.point(u)).norm(), kRefined);
    }
  });
}

TEST(BsplineLaw, ElevationLeavesTheShape) {
  test::for_all(kCases, [](Rng& rng) {
    const auto curve = any_curve<3>(rng, 8, true);
    const auto by = static_cast<int>(rng.integer(1, 3));
    const auto raised = elevate_degree(curve, 0, by);
    ASSERT_TRUE(raised.has_value()) << raised.error().what;
    EXPECT_EQ(raised->knots().degree(), curve.knots().degree() + by);
    EXPECT_EQ(raised->knots().breakpoints(), curve.knots().breakpoints());
    for (int i = 0; i < 20; ++i) {
      const double u = any_parameter(rng, curve.knots());
      EXPECT_LE((raised->point(u) - curve.point(u)).norm(), kRefined);
    }
  });
}

TEST(BsplineLaw, ElevationIsABandOfConvexCombinations) {
  test::for_all(kCases, [](Rng& rng) {
    const auto knots = any_knots(rng, static_cast<int>(rng.integer(1, 8)));
    const auto raised = elevate_degree(knots, 2);
    ASSERT_TRUE(raised.has_value());
    EXPECT_LE(raised->map.width(), 3 * (knots.degree() + 2));
    // Where end functions reach beyond the domain, their rows extrapolate.
    if (knots.multiplicity(knots.domain_begin()) <= knots.degree()) return;
    for (int r = 0; r < raised->map.rows(); ++r) {
      double sum = 0;
      for (const double a : raised->map.row(r)) {
        EXPECT_GE(a, -1e-15);
        sum += a;
      }
      EXPECT_NEAR(sum, 1, 1e-14);
    }
  });
}

TEST(BsplineLaw, RefinementOfVolumesLeavesTheShapeInEachDirection) {
  test::for_all(kCases / 10, [](Rng& rng) {
    using Volume = TensorSpline<3, 2>;
    Volume::Knots knots;
    for (auto& k : knots) k = any_knots(rng, static_cast<int>(rng.integer(1, 3)));
    const auto volume = any_spline<3, 2>(rng, knots);
    const auto direction = static_cast<int>(rng.integer(0, 2));
    const std::array added = {any_parameter(rng, volume.knots(direction))};
    const auto inserted = insert_knots(volume, direction, added);
    const auto raised = elevate_degree(volume, direction, 1);
    ASSERT_TRUE(inserted.has_value() && raised.has_value());
    for (int i = 0; i < 10; ++i) {
      const Volume::Parameter u = {any_parameter(rng, knots[0]), any_parameter(rng, knots[1]),
                                   any_parameter(rng, knots[2])};
      EXPECT_LE((inserted->point(u) - volume.point(u)).norm(), kRefined);
      EXPECT_LE((raised->point(u) - volume.point(u)).norm(), kRefined);
    }
  });
}

template <int kDirections, int kDimension>
void insert_in_all_directions(Rng& rng) {
  using Spline = TensorSpline<kDirections, kDimension>;
  typename Spline::Knots knots;
  for (auto& k : knots) k = any_knots(rng, static_cast<int>(rng.integer(1, 4)));
  const auto spline = any_spline<kDirections, kDimension>(rng, knots, rng.chance(0.5));
  std::array<std::vector<double>, kDirections> added;
  std::array<std::span<const double>, kDirections> at;
  auto in_turn = spline;
  for (int d = 0; d < kDirections; ++d) {
    const auto sd = static_cast<std::size_t>(d);
    for (auto i = rng.integer(0, 40); i > 0; --i)
      added[sd].push_back(any_parameter(rng, knots[sd]));
    at[sd] = added[sd];
    auto next = insert_knots(in_turn, d, at[sd]);
    ASSERT_TRUE(next.has_value()) << next.error().what;
    in_turn = *std::move(next);
  }
  const auto at_once = insert_knots(spline, at);
  ASSERT_TRUE(at_once.has_value()) << at_once.error().what;
  EXPECT_TRUE(*at_once == in_turn) << "bit for bit";
}

TEST(BsplineLaw, InsertionInAllDirectionsIsThatInTurn) {
  test::for_all(kCases / 4, [](Rng& rng) {
    insert_in_all_directions<1, 3>(rng);
    insert_in_all_directions<2, 3>(rng);
    insert_in_all_directions<2, 10>(rng);
    insert_in_all_directions<3, 2>(rng);
  });
}

TEST(BsplineLaw, AffineInvariance) {
  test::for_all(kCases, [](Rng& rng) {
    const auto curve = any_curve<3>(rng, 7, true);
    Eigen::Matrix3d linear;
    Eigen::Vector3d shift;
    for (int i = 0; i < 9; ++i) linear(i / 3, i % 3) = rng.uniform(-2, 2);
    for (int i = 0; i < 3; ++i) shift[i] = rng.uniform(-50, 50);
    std::vector<Eigen::Vector3d> points;
    for (const auto& p : curve.control_points()) points.push_back(linear * p + shift);
    // A periodic curve's repeated points stay equal: the same numbers go through the same sums.
    const auto mapped = *BsplineCurve<3>::make(curve.knots(), points);
    const double u = any_parameter(rng, curve.knots());
    EXPECT_LE((mapped.point(u) - (linear * curve.point(u) + shift)).norm(), 1e-12 * 6 * kSize);
  });
}

TEST(BsplineLaw, PeriodicCurvesAreSmoothAtTheSeam) {
  test::for_all(kCases, [](Rng& rng) {
    const auto degree = static_cast<int>(rng.integer(1, 8));
    std::vector<double> round = {0.0};
    for (int i = 0; i < 5; ++i) round.push_back(round.back() + rng.uniform(0.5, 2));
    const double end = round.back();
    round.pop_back();
    const auto curve = any_spline<1, 2>(rng, {*KnotVector::make_periodic(degree, round, end)});
    std::array<Eigen::Vector2d, 10> begin;
    std::array<Eigen::Vector2d, 10> finish;
    curve.derivatives(0.0, begin);
    curve.derivatives(end, finish);
    for (int r = 0; r < degree; ++r) {
      // The r-th derivative is of the size of p^r / h^r control points, h at least 0.5.
      const double scale = kSize * std::pow(2.0 * degree, r);
      EXPECT_LE((begin[r] - finish[r]).norm(), 1e-13 * scale) << "C" << r << " degree " << degree;
    }
  });
}

TEST(BsplineLaw, MovingTheSeamLeavesTheShape) {
  test::for_all(kCases, [](Rng& rng) {
    BsplineCurve<2> curve;
    while (!curve.knots().is_periodic()) curve = any_curve<2>(rng, 6);
    const auto moved = move_seam(curve, 0, any_parameter(rng, curve.knots()));
    ASSERT_TRUE(moved.has_value()) << moved.error().what;
    for (int i = 0; i < 20; ++i) {
      const double u = any_parameter(rng, moved->knots());
      EXPECT_LE((moved->point(u) - curve.point(u)).norm(), 10 * kRefined)
          << "wrapping u into the domain rounds it, too";
    }
  });
}

TEST(BsplineLaw, PolynomialsAreReproduced) {
  // The polar form of u^m at the knots of a function is its control point for u^m; for m = 2 the
  // mean of all products of two of them. [Ramshaw89]
  test::for_all(kCases, [](Rng& rng) {
    const auto knots = any_knots(rng, static_cast<int>(rng.integer(2, 8)), true);
    if (knots.is_periodic()) return;
    const int p = knots.degree();
    std::vector<Eigen::Matrix<double, 1, 1>> points;
    for (int i = 0; i < knots.basis_count(); ++i) {
      double sum = 0;
      for (int a = 1; a <= p; ++a) {
        for (int b = 1; b < a; ++b) sum += knots.values()[i + a] * knots.values()[i + b];
      }
      points.emplace_back(sum / (p * (p - 1) / 2));
    }
    const auto square = *BsplineCurve<1>::make(knots, points);
    const double u = any_parameter(rng, knots);
    EXPECT_NEAR(square.point(u)[0], u * u, 1e-10);  // parameters up to about 100, squared
  });
}

}  // namespace
}  // namespace limn
