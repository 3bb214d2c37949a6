// Prepared evaluation of curves and volumes, against the recursion.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "modeler/bspline/curve_evaluator.hpp"
#include "modeler/bspline/volume_evaluator.hpp"
#include "tests/property/modeler/random_splines.hpp"
#include "tests/support/alloc_guard.hpp"
#include "tests/support/for_all.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;
using test::any_knots;
using test::any_parameter;
using test::any_spline;
using test::Rng;

constexpr int kCases = 200;
constexpr double kSize = 100;  // of the random control points
/// Powers of t lose up to 2^p of the digits; a derivative is as large as one over the span.
constexpr double kRounding = 1e-10 * kSize;
/// Third derivatives of degree 9 are some p^3 times as large again.
constexpr double kRoundingOfThird = 1e-8 * kSize;

/// The ends of the domain, a knot, and places anywhere.
std::vector<double> places(Rng& rng, const KnotVector& knots, int more) {
  std::vector<double> out = {knots.domain_begin(), knots.domain_end(),
                             knots.breakpoints()[knots.breakpoints().size() / 2]};
  for (int i = 0; i < more; ++i) out.push_back(any_parameter(rng, knots));
  return out;
}

double least_span(const KnotVector& knots) {
  const std::vector<double> at = knots.breakpoints();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < at.size(); ++i) least = std::min(least, at[i] - at[i - 1]);
  return least;
}

template <int kDimension>
void expect_curves_agree(Rng& rng) {
  const auto degree = static_cast<int>(rng.integer(0, 11));  // up to 9 there are tables
  const auto curve =
      any_spline<1, kDimension>(rng, {any_knots(rng, degree, true)}, rng.chance(0.5));
  const CurveEvaluator<kDimension> prepared(curve);
  const std::vector<double> us = places(rng, curve.knots(), 5);
  const double span = least_span(curve.knots());
  std::vector<CurveJet<kDimension>> jets(us.size());
  {
    const test::AllocGuard guard;
    prepared.jets(us, jets);
    EXPECT_EQ(guard.count(), 0U);
  }
  for (std::size_t i = 0; i < us.size(); ++i) {
    std::array<typename BsplineCurve<kDimension>::Point, 4> expected;
    curve.derivatives(us[i], expected);
    EXPECT_LE((jets[i].point - expected[0]).norm(), 1e-12 * kSize);
    EXPECT_LE((jets[i].d1 - expected[1]).norm() * span, kRounding);
    EXPECT_LE((jets[i].d2 - expected[2]).norm() * span * span, kRounding);
    EXPECT_LE((jets[i].d3 - expected[3]).norm() * span * span * span, kRoundingOfThird);
    const CurveJet<kDimension> alone = prepared.jet(us[i]);
    EXPECT_EQ(alone.point, jets[i].point) << "bit for bit";
    EXPECT_EQ(alone.d1, jets[i].d1);
    EXPECT_EQ(alone.d2, jets[i].d2);
    EXPECT_EQ(alone.d3, jets[i].d3);
  }
}

TEST(EvaluatorLaw, PreparedCurvesAgreeWithTheRecursion) {
  test::for_all(kCases, [](Rng& rng) {
    expect_curves_agree<1>(rng);
    expect_curves_agree<2>(rng);
    expect_curves_agree<3>(rng);
    expect_curves_agree<4>(rng);
    expect_curves_agree<7>(rng);
    expect_curves_agree<10>(rng);
  });
}

TEST(EvaluatorLaw, PreparedVolumesAgreeWithTheRecursion) {
  test::for_all(kCases, [](Rng& rng) {
    BsplineVolume::Knots knots;
    const auto most = rng.chance(0.1) ? 10 : 5;  // up to 9 there are tables
    for (auto& k : knots) k = any_knots(rng, static_cast<int>(rng.integer(0, most)), true);
    const BsplineVolume volume = any_spline<3, 3>(rng, knots, rng.chance(0.5));
    const VolumeEvaluator prepared(volume);
    std::array<std::vector<double>, 3> along;
    std::array<double, 3> span{};
    for (std::size_t d = 0; d < 3; ++d) {
      along[d] = places(rng, knots[d], d == 0 ? 1 : 0);
      span[d] = least_span(knots[d]);
    }
    std::vector<Vector3d> at;
    for (const double w : along[2]) {
      for (const double v : along[1]) {
        for (const double u : along[0]) at.emplace_back(u, v, w);
      }
    }
    std::vector<VolumeJet> jets(at.size());
    std::vector<VolumeJet> grid(at.size());
    {
      const test::AllocGuard guard;
      prepared.jets(at, jets);
      if (std::all_of(knots.begin(), knots.end(),
                      [](const KnotVector& k) { return k.degree() <= BasisTable::kMostDegree; })) {
        EXPECT_EQ(guard.count(), 0U);
      }
    }
    prepared.grid(along[0], along[1], along[2], grid);
    for (std::size_t i = 0; i < at.size(); ++i) {
      std::array<Vector3d, 8> expected;
      volume.derivatives({at[i].x(), at[i].y(), at[i].z()}, {1, 1, 1}, expected);
      for (const VolumeJet* jet : {&jets[i], &grid[i]}) {
        EXPECT_LE((jet->point - expected[0]).norm(), 1e-12 * kSize);
        EXPECT_LE((jet->du - expected[1]).norm() * span[0], kRounding);
        EXPECT_LE((jet->dv - expected[2]).norm() * span[1], kRounding);
        EXPECT_LE((jet->dw - expected[4]).norm() * span[2], kRounding);
      }
      const VolumeJet alone = prepared.jet(at[i]);
      EXPECT_EQ(alone.point, jets[i].point) << "bit for bit";
      EXPECT_EQ(alone.dw, jets[i].dw);
    }
  });
}

TEST(EvaluatorLaw, ParametersComeIntoTheDomain) {
  Rng rng(3);
  const auto ring = *KnotVector::make_periodic(3, std::vector{0.0, 1.0, 2.0, 3.0}, 4.0);
  const CurveEvaluator<3> closed(any_spline<1, 3>(rng, {ring}));
  EXPECT_LE((closed.jet(4.5).point - closed.jet(0.5).point).norm(), 1e-12 * kSize);
  const auto open = *KnotVector::make_clamped(2, 0, 1, {});
  const VolumeEvaluator volume(any_spline<3, 3>(rng, {open, open, open}));
  EXPECT_EQ(volume.jet({-1, 2, 0.5}).point, volume.jet({0, 1, 0.5}).point);
}

}  // namespace
}  // namespace limn
