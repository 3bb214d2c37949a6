// Open CASCADE and SISL share no code: where they agree, both adapters hand over the same surface
// and read the answers rightly.

#include <gtest/gtest.h>

#include "tests/peers/known_surfaces.hpp"
#include "tests/peers/occt_peer.hpp"
#include "tests/peers/random_surfaces.hpp"
#include "tests/peers/sisl_peer.hpp"
#include "tests/peers/witness_table.hpp"
#include "tests/support/rng.hpp"
#include "tests/unit/peers/distance.hpp"

namespace limn::peers {
namespace {

constexpr double kPosition = 1e-12;   // of the bounding box: some hundred roundings
constexpr double kDerivative = 1e-9;  // of that derivative's greatest length on the surface

struct Deviation {
  void add(const PeerPoint& a, const PeerPoint& b) {
    length = std::max({length, norm(a), norm(b)});
    greatest = std::max(greatest, distance(a, b));
  }
  double relative() const { return length > 0.0 ? greatest / length : greatest; }

  double length = 0.0, greatest = 0.0;
};

struct JetDeviation {
  void add(const PeerJet& a, const PeerJet& b) {
    point = std::max(point, distance(a.point, b.point));
    du.add(a.du, b.du);
    dv.add(a.dv, b.dv);
    duu.add(a.duu, b.duu);
    duv.add(a.duv, b.duv);
    dvv.add(a.dvv, b.dvv);
  }
  double first() const { return std::max(du.relative(), dv.relative()); }
  double second() const { return std::max({duu.relative(), duv.relative(), dvv.relative()}); }

  double point = 0.0;
  Deviation du, dv, duu, duv, dvv;
};

/// Random ones, and corners and knots, where derivatives are those from the right.
std::vector<PeerParameters> some_places(test::Rng& rng, const PeerSurface& s) {
  std::vector<PeerParameters> out = {{s.low(0), s.low(1)}, {s.high(0), s.high(1)}};
  for (int i = 0; i < 20; ++i)
    out.push_back({rng.uniform(s.low(0), s.high(0)), rng.uniform(s.low(1), s.high(1))});
  const auto at_knot = [&](std::size_t d) {
    return s.knots[d][static_cast<std::size_t>(rng.integer(0, std::ssize(s.knots[d]) - 1))];
  };
  for (int i = 0; i < 5; ++i) out.push_back({at_knot(0), at_knot(1)});
  return out;
}

TEST(PeersAgree, OnJetsOfRandomSurfaces) {
  test::Rng rng(0x5eed1);
  for (int k = 0; k < 500; ++k) {
    const PeerSurface surface = random_surface(rng);
    const OcctSurface occt(surface);
    const SislSurface sisl(surface);
    JetDeviation deviation;
    for (const auto& [u, v] : some_places(rng, surface))
      deviation.add(occt.jet(u, v), sisl.jet(u, v));
    EXPECT_LE(deviation.point, kPosition * box_diagonal(surface)) << "surface " << k;
    EXPECT_LE(deviation.first(), kDerivative) << "surface " << k;
    EXPECT_LE(deviation.second(), kDerivative) << "surface " << k;
  }
}

TEST(PeersAgree, OnThirdAndMixedDerivatives) {
  test::Rng rng(0x5eed2);
  for (int k = 0; k < 100; ++k) {
    const PeerSurface surface = random_surface(rng);
    const OcctSurface occt(surface);
    const SislSurface sisl(surface);
    for (const auto& [i, j] : {std::pair(3, 0), {2, 1}, {1, 2}, {0, 3}, {2, 2}}) {
      Deviation deviation;
      for (const auto& [u, v] : some_places(rng, surface))
        deviation.add(occt.derivative(u, v, i, j), sisl.derivative(u, v, i, j));
      // A derivative that is zero throughout is rounding of what cancels in it.
      if (deviation.length > kDerivative) {
        EXPECT_LE(deviation.relative(), kDerivative) << "surface " << k << ", " << i << j;
      }
    }
  }
}

TEST(PeersAgree, OnJetsByTheSpanCache) {
  test::Rng rng(0x5eed3);
  for (int k = 0; k < 100; ++k) {
    const PeerSurface surface = random_surface(rng);
    const OcctSurface occt(surface);
    JetDeviation deviation;
    for (const auto& [u, v] : some_places(rng, surface))
      deviation.add(occt.jet(u, v), occt.jet_by_adaptor(u, v));
    EXPECT_LE(deviation.point, kPosition * box_diagonal(surface)) << "surface " << k;
    EXPECT_LE(deviation.first(), kDerivative) << "surface " << k;
    EXPECT_LE(deviation.second(), kDerivative) << "surface " << k;
  }
}

TEST(PeersAgree, OnGrids) {
  test::Rng rng(0x5eed4);
  for (int k = 0; k < 50; ++k) {
    const PeerSurface surface = random_surface(rng);
    std::array<std::vector<double>, 2> at;
    for (std::size_t d = 0; d < 2; ++d)
      for (int i = 0; i <= 10; ++i)
        at[d].push_back(surface.low(d) + (surface.high(d) - surface.low(d)) * 0.099 * i);
    PeerGrid a, b;
    OcctSurface(surface).grid(at[0], at[1], a);
    SislSurface(surface).grid(at[0], at[1], b);
    ASSERT_EQ(a.jets.size(), 9U * 121U);
    ASSERT_EQ(b.jets.size(), a.jets.size());
    std::array<Deviation, 3> jets;
    for (std::size_t i = 0; i < a.jets.size(); i += 3)
      jets[i / 3 % 3].add(triple(a.jets, i), triple(b.jets, i));
    EXPECT_LE(jets[0].greatest, kDerivative * box_diagonal(surface));
    EXPECT_LE(jets[1].relative(), kDerivative);
    EXPECT_LE(jets[2].relative(), kDerivative);
    for (std::size_t i = 0; i < a.normals.size(); i += 3) {
      const PeerPoint normal = triple(b.normals, i);  // not of unit length
      EXPECT_GT(dot(triple(a.normals, i), normal), (1.0 - kDerivative) * norm(normal));
    }
  }
}

TEST(PeersAgree, OnKnotsInserted) {
  test::Rng rng(0x5eed5);
  for (int k = 0; k < 100; ++k) {
    const PeerSurface surface = random_surface(rng);
    std::array<std::vector<double>, 2> knots;
    for (std::size_t d = 0; d < 2; ++d) {
      for (int i = 0; i < 5; ++i) knots[d].push_back(rng.uniform(surface.low(d), surface.high(d)));
      std::sort(knots[d].begin(), knots[d].end());
    }
    const PeerSurface a = OcctSurface(surface).with_knots(knots[0], knots[1]).data();
    const PeerSurface b = SislSurface(surface).with_knots(knots[0], knots[1]).data();
    ASSERT_EQ(a.count, b.count);
    EXPECT_EQ(a.count[0], surface.count[0] + 5);
    EXPECT_EQ(a.count[1], surface.count[1] + 5);
    EXPECT_EQ(a.knots, b.knots);
    double deviation = 0.0;
    for (std::size_t i = 0; i < a.points.size(); i += 3)
      deviation = std::max(deviation, distance(triple(a.points, i), triple(b.points, i)));
    EXPECT_LE(deviation, kPosition * box_diagonal(surface)) << "surface " << k;
  }
}

TEST(PeersAgree, OnDegreesRaised) {
  test::Rng rng(0x5eed6);
  for (int k = 0; k < 30; ++k) {
    const PeerSurface surface = random_surface(rng, {.max_degree = 4});
    const int u = surface.degree[0] + 1;
    const int v = surface.degree[1] + 2;
    const PeerSurface a = OcctSurface(surface).with_degrees(u, v).data();
    const PeerSurface b = SislSurface(surface).with_degrees(u, v).data();
    EXPECT_EQ(a.degree, (std::array{u, v}));
    ASSERT_EQ(a.count, b.count);
    double deviation = 0.0;
    for (std::size_t i = 0; i < a.points.size(); i += 3)
      deviation = std::max(deviation, distance(triple(a.points, i), triple(b.points, i)));
    EXPECT_LE(deviation, kDerivative * box_diagonal(surface)) << "surface " << k;
  }
}

TEST(PeersAgree, OnCurves) {
  test::Rng rng(0x5eed7);
  for (int k = 0; k < 200; ++k) {
    const PeerCurve curve = random_curve(rng, 2 + k % 2);
    const OcctCurve occt(curve);
    const SislCurve sisl(curve);
    Deviation point, first, second;
    for (int i = 0; i < 20; ++i) {
      const double t = rng.uniform(curve.knots.front(), curve.knots.back());
      const PeerCurveJet a = occt.jet(t);
      const PeerCurveJet b = sisl.jet(t);
      point.add(a.point, b.point);
      first.add(a.first, b.first);
      second.add(a.second, b.second);
    }
    EXPECT_LE(point.relative(), 1e-12) << "curve " << k;
    EXPECT_LE(first.relative(), kDerivative) << "curve " << k;
    EXPECT_LE(second.relative(), kDerivative) << "curve " << k;
  }
}

// Closest points over the middle of the sheet that a benchmark asks for.
TEST(PeersAgree, OnClosestPointsOfASheet) {
  constexpr double kSame_mm = 1e-5;
  const PeerSurface surface = wavy_sheet(13);
  const OcctSurface occt(surface);
  const SislSurface sisl(surface);
  test::Rng rng(0x5eed8);
  int count = 0;
  for (int k = 0; k < 100; ++k) {
    const PeerPoint point = {rng.uniform(20, 80), rng.uniform(20, 80), rng.uniform(-30, 30)};
    const auto a = occt.closest(point);
    const auto b = sisl.closest(point, 1e-9);
    if (!a || !b) continue;
    ++count;
    const double by_occt = distance(occt.jet(a->u, a->v).point, point);
    const double by_sisl = distance(occt.jet(b->u, b->v).point, point);
    EXPECT_NEAR(by_occt, by_sisl, kSame_mm) << "point " << k;
    const auto c = occt.closest_near(point, *b);
    const auto d = sisl.closest_near(point, *a, 1e-9);
    ASSERT_TRUE(c && d);
    EXPECT_NEAR(distance(occt.jet(c->u, c->v).point, point), by_occt, kSame_mm);
    EXPECT_NEAR(distance(occt.jet(d->u, d->v).point, point), by_occt, kSame_mm);
  }
  EXPECT_EQ(count, 100);
}

TEST(PeersAgree, OnRaysThroughASheet) {
  constexpr double kSame_mm = 1e-5;
  const PeerSurface surface = wavy_sheet(13);
  const OcctSurface occt(surface);
  const SislSurface sisl(surface);
  test::Rng rng(0x5eed9);
  for (int k = 0; k < 100; ++k) {
    const PeerPoint from = {rng.uniform(20, 80), rng.uniform(20, 80), 50};
    const PeerRay ray = {from, {rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), -2.0}};
    const auto a = occt.first_hit(ray);
    const auto b = sisl.first_hit(ray, 1e-9);
    ASSERT_TRUE(a && b) << "ray " << k;
    EXPECT_NEAR(a->t, b->t, kSame_mm) << "ray " << k;
    EXPECT_LE(distance(sisl.jet(a->u, a->v).point, along(ray, a->t)), kSame_mm);
    EXPECT_LE(distance(sisl.jet(b->u, b->v).point, along(ray, b->t)), kSame_mm);
  }
}

TEST(PeersAgree, OnBranchesOfMostCrossingPairs) {
  // Each misses, or tears, a branch now and then: of 200 pairs
  // they differ on 21, of these on one.
  constexpr double kGap = 1e-6;  // what is asked for
  test::Rng rng(0x5eed);
  int same = 0;
  for (int k = 0; k < 10; ++k) {
    const auto [first, second] = random_crossing_pair(rng);
    const OcctSurface occt_first(first), occt_second(second);
    const SislSurface sisl_first(first), sisl_second(second);
    const auto a = occt_first.intersection_with(occt_second, kGap);
    const auto b = sisl_first.intersection_with(sisl_second, kGap);
    ASSERT_TRUE(a && b) << "pair " << k;
    same += a->branches.size() == b->branches.size() ? 1 : 0;
    for (const auto* found : {&*a, &*b}) {
      double gap = 0.0;
      for (const auto& branch : found->branches)
        for (const auto& [on_first, on_second] : branch.places)
          gap = std::max(gap, distance(sisl_first.jet(on_first.u, on_first.v).point,
                                       sisl_second.jet(on_second.u, on_second.v).point));
      EXPECT_LE(gap, kGap) << "pair " << k;
    }
  }
  EXPECT_GE(same, 8);
}

TEST(PeersAgree, WithTheRecordedWitness) {
  const auto table = read_witness_table(LIMN_SOURCE_DIR "/tests/golden/kernel/rhino3dm.json");
  ASSERT_EQ(table.size(), 200U);
  for (std::size_t k = 0; k < table.size(); ++k) {
    const auto& [surface, places] = table[k];
    const OcctSurface occt(surface);
    const SislSurface sisl(surface);
    Deviation point, normal;
    std::array<Deviation, 3> by_u, by_v;
    for (const auto& place : places) {
      const auto [u, v] = place.at;
      const PeerJet jet = sisl.jet(u, v);
      point.add(place.point, jet.point);
      normal.add(place.normal, unit(cross(jet.du, jet.dv)));
      for (int i = 0; i < 3; ++i) {
        by_u[i].add(place.u_derivatives[i], occt.derivative(u, v, i + 1, 0));
        by_v[i].add(place.v_derivatives[i], occt.derivative(u, v, 0, i + 1));
      }
    }
    EXPECT_LE(point.greatest, kPosition * box_diagonal(surface)) << "surface " << k;
    EXPECT_LE(normal.greatest, kDerivative) << "surface " << k;
    for (int i = 0; i < 3; ++i) {
      for (const auto* deviation : {&by_u[i], &by_v[i]}) {
        if (deviation->length > kDerivative) {
          EXPECT_LE(deviation->relative(), kDerivative) << "surface " << k << ", order " << i + 1;
        }
      }
    }
  }
}

}  // namespace
}  // namespace limn::peers
