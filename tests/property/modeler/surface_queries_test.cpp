// Closest points and ray hits on random surfaces, against sampling and other libraries; on shapes
// whose answers are known.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "modeler/surface/primitives.hpp"
#include "modeler/surface/surface_index.hpp"
#include "tests/peers/known_surfaces.hpp"
#include "tests/peers/random_surfaces.hpp"
#include "tests/support/for_all.hpp"
#include "tests/support/peer_conversion.hpp"

namespace limn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::Rng;

constexpr double kSame = 1e-9;  // mm: kGeometric
constexpr double kSlack = 1.001 * kSame;

BsplineSurface any_surface(Rng& rng) { return test::limn_surface(peers::random_surface(rng)); }

Vector2d any_place(Rng& rng, const BsplineSurface& s) {
  return {rng.uniform(s.knots(0).domain_begin(), s.knots(0).domain_end()),
          rng.uniform(s.knots(1).domain_begin(), s.knots(1).domain_end())};
}

Vector3d any_point(Rng& rng, double size) {
  return {rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
}

/// Every bound holds at random places of every leaf.
TEST(SurfaceIndexLaw, BoundsHold) {
  test::for_all(10, [](Rng& rng) {
    const SurfaceIndex index(any_surface(rng));
    for (const PatchBound& b : index.leaves()) {
      const Vector3d n = b.frame.col(2);
      const auto part = [&n](const Vector3d& x, const Vector3d& middle) {
        const double off = n.dot(x - middle);
        return Vector2d((x - middle - off * n).norm(), std::abs(off));
      };
      for (int i = 0; i < 4; ++i) {
        const Vector2d at(rng.uniform(b.box.low.x(), b.box.high.x()),
                          rng.uniform(b.box.low.y(), b.box.high.y()));
        const SurfaceJet jet = index.evaluator().jet(at.x(), at.y());
        const double room = 1e-9 * (1 + b.reach);
        EXPECT_TRUE(((jet.point - b.low).array() >= -room).all());
        EXPECT_TRUE(((b.high - jet.point).array() >= -room).all());
        const Vector3d local = b.frame.transpose() * (jet.point - b.jet.point);
        EXPECT_TRUE(((local - b.frame_low).array() >= -room).all());
        EXPECT_TRUE(((b.frame_high - local).array() >= -room).all());
        EXPECT_LE(local.norm(), b.reach + room);
        const auto within = [&](const Vector3d& x, const Vector3d& middle, double along,
                                double off) {
          const double rounding = 1e-9 * (1 + x.norm());
          EXPECT_LE(part(x, middle).x(), along + rounding);
          EXPECT_LE(part(x, middle).y(), off + rounding);
        };
        within(jet.point, b.jet.point, b.along.point, b.off.point);
        within(jet.du, b.jet.du, b.along.du, b.off.du);
        within(jet.dv, b.jet.dv, b.along.dv, b.off.dv);
        within(jet.duu, b.jet.duu, b.along.duu, b.off.duu);
        within(jet.duv, b.jet.duv, b.along.duv, b.off.duv);
        within(jet.dvv, b.jet.dvv, b.along.dvv, b.off.dvv);
      }
    }
  });
}

/// Whatever lies in a leaf lies in the boxes of all nodes over it, as queries see them.
TEST(SurfaceIndexLaw, BoxesHoldTheLeavesBelow) {
  test::for_all(10, [](Rng& rng) {
    const SurfaceIndex index(any_surface(rng));
    std::vector<int> seen(index.leaves().size());
    struct Step {
      const BoxNode* node;
      std::size_t child;
    };
    const auto check = [&](const std::vector<Step>& way, const PatchBound& leaf) {
      const Vector2d at(rng.uniform(leaf.box.low.x(), leaf.box.high.x()),
                        rng.uniform(leaf.box.low.y(), leaf.box.high.y()));
      const Vector3d x = index.jet(leaf, at).point;
      const Vector3d p = any_point(rng, 8);
      const double room = 1e-9;
      for (const Step& step : way) {
        EXPECT_LE(step.node->child_box(step.child).exteriorDistance(x), room);
        std::array<double, BoxNode::kWidth> square;
        std::array<double, BoxNode::kWidth> first;
        const double most = (x - p).squaredNorm() + room;
        EXPECT_TRUE(step.node->square_distances(p, most, square.data()) >> step.child & 1U);
        EXPECT_LT(square[step.child], most);
        EXPECT_TRUE(step.node->passages(p, x - p, 1, first.data()) >> step.child & 1U);
        EXPECT_LE(first[step.child], 1);
      }
    };
    const auto visit = [&](const auto& self, std::vector<Step>& way, std::int32_t number) -> void {
      if (number < 0) {
        ++seen[static_cast<std::size_t>(~number)];
        return check(way, index.leaves()[static_cast<std::size_t>(~number)]);
      }
      const BoxNode& node = index.nodes()[static_cast<std::size_t>(number)];
      for (std::size_t i = 0; i < BoxNode::kWidth; ++i) {
        if (!node.has_child(i)) continue;
        way.push_back({&node, i});
        self(self, way, node.child[i]);
        way.pop_back();
      }
    };
    std::vector<Step> way;
    visit(visit, way, index.nodes().empty() ? ~0 : 0);
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
  });
}

TEST(ClosestPointLaw, NothingSampledIsNearer) {
  test::for_all(30, [](Rng& rng) {
    const auto surface = any_surface(rng);
    const SurfaceIndex index(surface);
    constexpr std::size_t kSide = 60;
    std::array<std::vector<double>, 2> along;
    for (int d = 0; d < 2; ++d) {
      const KnotVector& knots = surface.knots(d);
      for (std::size_t i = 0; i < kSide; ++i) {
        along[d].push_back(knots.domain_begin() + (knots.domain_end() - knots.domain_begin()) *
                                                      static_cast<double>(i) / (kSide - 1));
      }
    }
    std::vector<SurfaceFrame> sampled(kSide * kSide);
    index.evaluator().grid(along[0], along[1], sampled);
    for (int i = 0; i < 20; ++i) {
      const Vector3d p = any_point(rng, 8);
      const ClosestPoint found = index.closest_point(p);
      EXPECT_LT((surface.point({found.parameter.x(), found.parameter.y()}) - found.point).norm(),
                kSame);
      EXPECT_NEAR((found.point - p).norm(), found.distance, kSame);
      EXPECT_LE(found.slack, kSlack);
      double least = 1e300;
      for (const auto& frame : sampled) least = std::min(least, (frame.point - p).norm());
      EXPECT_GE(least, found.distance - kSame);
    }
  });
}

TEST(ClosestPointLaw, APointOfTheSurfaceIsItsOwn) {
  test::for_all(40, [](Rng& rng) {
    const auto surface = any_surface(rng);
    const SurfaceIndex index(surface);
    for (int i = 0; i < 10; ++i) {
      const Vector2d at = any_place(rng, surface);
      const Vector3d p = surface.point({at.x(), at.y()});
      EXPECT_LT(index.closest_point(p).distance, kSame);
    }
  });
}

TEST(RayLaw, ARayThroughAPointOfTheSurfaceHitsIt) {
  test::for_all(60, [](Rng& rng) {
    const auto surface = any_surface(rng);
    const SurfaceIndex index(surface);
    for (int i = 0; i < 20; ++i) {
      const Vector2d at = any_place(rng, surface);
      const Vector3d to = surface.point({at.x(), at.y()});
      const Vector3d from = any_point(rng, 20);
      const Ray ray{from, to - from};
      const auto first = index.first_hit(ray);
      ASSERT_TRUE(first);
      EXPECT_LE(first->t, 1 + kSame);
      EXPECT_LT((ray.origin + first->t * ray.direction - first->point).norm(), kSame);
      const RayHits all = index.all_hits(ray);
      EXPECT_TRUE(all.complete);
      ASSERT_FALSE(all.hits.empty());
      EXPECT_NEAR(all.hits.front().t, first->t, kSame);
      EXPECT_TRUE(std::any_of(all.hits.begin(), all.hits.end(), [&](const RayHit& hit) {
        return (hit.point - to).norm() < 1e-8 + 1.5 * hit.run;
      }));
      EXPECT_TRUE(std::is_sorted(all.hits.begin(), all.hits.end(),
                                 [](const RayHit& a, const RayHit& b) { return a.t < b.t; }));
    }
  });
}

/// A closed surface is passed an even number of times, and a ray back meets the same places.
TEST(RayLaw, AClosedSurfaceIsEnteredAndLeft) {
  const SurfaceIndex torus(test::limn_surface(peers::torus(5, 2)));
  test::for_all(300, [&torus](Rng& rng) {
    const Vector3d from = 30 * any_point(rng, 1).normalized();
    const Vector3d to = any_point(rng, 6);
    const Ray ray{from, to - from, 10};
    const RayHits hits = torus.all_hits(ray);
    EXPECT_TRUE(hits.complete);
    EXPECT_EQ(hits.hits.size() % 2, 0U);
    for (const RayHit& hit : hits.hits) {
      const double round = std::hypot(hit.point.x(), hit.point.y()) - 5;
      EXPECT_NEAR(std::hypot(round, hit.point.z()), 2, kSame);
    }
    const Ray back{from + 10 * ray.direction, -ray.direction, 10};
    EXPECT_EQ(torus.all_hits(back).hits.size(), hits.hits.size());
  });
}

TEST(ClosestPoint, OfASphere) {
  const SurfaceIndex sphere(test::limn_surface(peers::sphere(3)));
  test::for_all(200, [&sphere](Rng& rng) {
    const Vector3d p = any_point(rng, 6);
    const ClosestPoint found = sphere.closest_point(p);
    EXPECT_NEAR(found.distance, std::abs(p.norm() - 3), kSame);
    EXPECT_LE(found.slack, kSlack);
  });
  for (const double z : {-5.0, -3.0, -1.0, 2.0, 3.0, 9.0}) {  // at and over the poles
    EXPECT_NEAR(sphere.closest_point({0, 0, z}).distance, std::abs(std::abs(z) - 3), kSame);
  }
}

TEST(ClosestPoint, AtTheCentreOfASphereIsAnyAndAlwaysTheSame) {
  const auto surface = test::limn_surface(peers::sphere(3));
  const ClosestPoint found = SurfaceIndex(surface).closest_point({0, 0, 0});
  EXPECT_NEAR(found.distance, 3, kSame);
  EXPECT_LE(found.slack, kSlack);
  const ClosestPoint again = SurfaceIndex(surface).closest_point({0, 0, 0});
  EXPECT_EQ(found.parameter, again.parameter);
  EXPECT_EQ(found.point, again.point);
}

TEST(ClosestPoint, OnTheAxisOfATorusHasARingOfAnswers) {
  const SurfaceIndex torus(test::limn_surface(peers::torus(5, 2)));
  EXPECT_NEAR(torus.closest_point({0, 0, 0}).distance, 3, kSame);
  EXPECT_NEAR(torus.closest_point({0, 0, 4}).distance, std::hypot(5, 4) - 2, kSame);
  const ClosestPoint in_the_tube = torus.closest_point({5, 0, 0});
  EXPECT_NEAR(in_the_tube.distance, 2, kSame);
  for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(0, 0, 4), Vector3d(5, 0, 0)}) {
    EXPECT_LE(torus.closest_point(p).slack, 1e-6) << "cut off after a bounded number of halves";
  }
}

TEST(Ray, AlongAFlatSurfaceSaysSo) {
  const auto knots = *KnotVector::make_clamped(1, 0, 1);
  const SurfaceIndex square(
      *BsplineSurface::make({knots, knots}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  const RayHits along = square.all_hits({{-1, 0.3, 0}, {1, 0, 0}});
  EXPECT_TRUE(along.complete);
  ASSERT_EQ(along.hits.size(), 1U);
  EXPECT_NEAR(along.hits[0].t, 1, kSame);
  EXPECT_NEAR(along.hits[0].run, 1, kSame);
  const auto first = square.first_hit({{-1, 0.3, 0}, {1, 0, 0}});
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->t, 1, 1e-6);
  EXPECT_FALSE(square.first_hit({{-1, 0.3, 1e-6}, {1, 0, 0}})) << "beside it";
}

TEST(Ray, TouchesASphere) {
  const SurfaceIndex sphere(test::limn_surface(peers::sphere(3)));
  const RayHits touching = sphere.all_hits({{-9, 3, 0}, {1, 0, 0}});
  EXPECT_TRUE(touching.complete);
  ASSERT_EQ(touching.hits.size(), 1U);
  EXPECT_GT(touching.hits[0].run, 0);
  EXPECT_LT((touching.hits[0].point - Vector3d(0, 3, 0)).norm(), 1e-3) << "1e-9 off is 8e-5 along";
  EXPECT_TRUE(sphere.all_hits({{-9, 3 + 1e-6, 0}, {1, 0, 0}}).hits.empty());
  const RayHits crossing = sphere.all_hits({{-9, 3 - 1e-6, 0}, {1, 0, 0}});
  EXPECT_EQ(crossing.hits.size(), 2U);
}

TEST(Ray, ThroughAPoleHitsItOnce) {
  const SurfaceIndex sphere(test::limn_surface(peers::sphere(3)));
  const RayHits hits = sphere.all_hits({{0, 0, 9}, {0, 0, -1}});
  ASSERT_EQ(hits.hits.size(), 2U);
  EXPECT_NEAR(hits.hits[0].t, 6, kSame);
  EXPECT_NEAR(hits.hits[1].t, 12, kSame);
}

TEST(Ray, ThroughADiscNearItsPole) {
  const SurfaceIndex disc(*make_disc(Frame(), 3));
  for (const Vector3d& at :
       {Vector3d(0, 0, 0), Vector3d(1e-3, 0, 0), Vector3d(2e-6, 1e-6, 0), Vector3d(-0.3, 0.4, 0)}) {
    for (const Vector3d& direction :
         {Vector3d(0, 0, -1), Vector3d(0.5, 0.2, -1), Vector3d(3, 1, -0.2)}) {
      const RayHits hits = disc.all_hits({at - 2 * direction, direction});
      ASSERT_EQ(hits.hits.size(), 1U);
      EXPECT_NEAR(hits.hits[0].t, 2, 1e-8);
      EXPECT_LT((hits.hits[0].point - at).norm(), 1e-7);
    }
  }
}

/// Flat, but with parameters that bend: what is thin need not be even.
TEST(Ray, AtASmallAngleToAnUnevenPlane) {
  const auto knots = *KnotVector::make_clamped(3, 0, 1);
  std::vector<Vector3d> points;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      points.emplace_back(i + 0.4 * (i % 2) * (j - 1.5), j + 0.5 * (j % 2) * (i - 1.5), 0);
    }
  }
  const SurfaceIndex plane(*BsplineSurface::make({knots, knots}, points));
  test::for_all(100, [&plane](Rng& rng) {
    const Vector3d at = plane.evaluator().point(rng.uniform(0.1, 0.9), rng.uniform(0.1, 0.9));
    const Vector3d direction(rng.uniform(-1, 1), rng.uniform(-1, 1), -rng.uniform(0.01, 0.2));
    const RayHits hits = plane.all_hits({at - 3 * direction, direction});
    ASSERT_EQ(hits.hits.size(), 1U);
    EXPECT_NEAR(hits.hits[0].t, 3, kSame / direction.norm() * 200);
    EXPECT_LT((hits.hits[0].point - at).norm(), 1e-7);
    EXPECT_TRUE(hits.hits[0].certain);
  });
}

TEST(Ray, AlongAnAxisThroughKnotLines) {
  const auto knots = *KnotVector::make_clamped(2, 0, 7, std::array{1.0, 2.1, 3.3, 4.7, 5.1, 6.0});
  std::vector<Vector3d> points;
  for (int j = 0; j < 9; ++j) {
    for (int i = 0; i < 9; ++i)
      points.emplace_back(knots.greville(i), knots.greville(j), std::sin(i + 2 * j));
  }
  const SurfaceIndex sheet(*BsplineSurface::make({knots, knots}, points));
  for (const double u : knots.breakpoints()) {
    for (const double v : knots.breakpoints()) {
      const auto hit = sheet.first_hit({{u, v, 5}, {0, 0, -1}});
      ASSERT_TRUE(hit) << u << ", " << v;
      EXPECT_LT((hit->parameter - Vector2d(u, v)).norm(), 1e-9);
    }
  }
}

TEST(Ray, EndsWhereItIsToldTo) {
  const SurfaceIndex sphere(test::limn_surface(peers::sphere(3)));
  EXPECT_FALSE(sphere.first_hit({{-9, 0.1, 0.2}, {1, 0, 0}, 5.9}));
  EXPECT_TRUE(sphere.first_hit({{-9, 0.1, 0.2}, {1, 0, 0}, 6.1}));
  EXPECT_EQ(sphere.all_hits({{0.1, 0.2, 0.3}, {1, 0, 0}}).hits.size(), 1U) << "from inside";
  EXPECT_FALSE(sphere.first_hit({{9, 0.1, 0.2}, {1, 0, 0}})) << "it lies behind";
}

}  // namespace
}  // namespace limn
