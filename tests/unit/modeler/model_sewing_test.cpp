#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "modeler/model/sewing.hpp"
#include "modeler/surface/primitives.hpp"

namespace limn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTolerance = 1e-6;  // mm, of sewing
constexpr double kRounding = 1e-12;  // of coordinates of some mm

/// What a body promises of its trims: they run with their edges, and its loops close.
void expect_trims_hold(const Body& body) {
  for (const Face& face : body.faces) {
    for (const Loop& loop : face.loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const auto ends = [&](std::size_t k) {
          const Trim& trim = loop[k % loop.size()];
          const Vector2d first = trim.curve.point(trim.curve.knots().domain_begin());
          const Vector2d last = trim.curve.point(trim.curve.knots().domain_end());
          return trim.reversed ? std::pair(last, first) : std::pair(first, last);
        };
        EXPECT_EQ(ends(i).second, ends(i + 1).first);
        const Edge& edge = body.edges[loop[i].edge];
        for (double x = 0; x <= 1; x += 0.0625) {
          const KnotVector& on_edge = edge.curve.knots();
          const KnotVector& on_trim = loop[i].curve.knots();
          const auto at = [x](const KnotVector& k) {
            return k.domain_begin() + x * (k.domain_end() - k.domain_begin());
          };
          const Vector2d uv = loop[i].curve.point(at(on_trim));
          const Vector3d gap = face.surface.point({uv.x(), uv.y()}) - edge.curve.point(at(on_edge));
          EXPECT_LE(gap.norm(), edge.deviation + kRounding);
        }
      }
    }
  }
  for (const Edge& edge : body.edges) {
    const KnotVector& knots = edge.curve.knots();
    EXPECT_LE((edge.curve.point(knots.domain_begin()) - body.vertices[edge.vertices[0]]).norm(),
              kTolerance);
    EXPECT_LE((edge.curve.point(knots.domain_end()) - body.vertices[edge.vertices[1]]).norm(),
              kTolerance);
  }
}

TEST(Sew, ABoxHasTwelveEdges) {
  const auto faces = *make_box({}, {10, 20, 30});
  const auto body = sew("box", {faces.begin(), faces.end()}, kTolerance);
  ASSERT_TRUE(body.has_value()) << body.error().what;
  EXPECT_EQ(body->faces.size(), 6U);
  EXPECT_EQ(body->edges.size(), 12U);
  EXPECT_EQ(body->vertices.size(), 8U);
  EXPECT_TRUE(is_closed(*body));
  expect_trims_hold(*body);
}

TEST(Sew, ASphereHasASeamAndTwoPoles) {
  const auto body = sew("sphere", {*make_sphere({}, 7)}, kTolerance);
  ASSERT_TRUE(body.has_value()) << body.error().what;
  EXPECT_EQ(body->edges.size(), 3U);
  EXPECT_EQ(body->vertices.size(), 2U);
  EXPECT_TRUE(is_closed(*body));
  EXPECT_EQ(body->edges[0].curve.knots().degree(), 0) << "a pole";
  expect_trims_hold(*body);
}

TEST(Sew, ATorusHasTwoSeamsThatMeet) {
  const auto body = sew("torus", {*make_torus({}, 10, 3)}, kTolerance);
  ASSERT_TRUE(body.has_value()) << body.error().what;
  EXPECT_EQ(body->edges.size(), 2U);
  EXPECT_EQ(body->vertices.size(), 1U);
  EXPECT_TRUE(is_closed(*body));
  expect_trims_hold(*body);
}

TEST(Sew, ACylinderIsClosedWithItsLids) {
  Frame top;
  top.origin = {0, 0, 12};
  const auto wall = *make_cylinder({}, 5, 12);
  const auto open = sew("tube", {wall}, kTolerance);
  ASSERT_TRUE(open.has_value());
  EXPECT_EQ(open->edges.size(), 3U) << "a seam and two rims";
  EXPECT_FALSE(is_closed(*open));
  const auto closed = sew("can", {wall, *make_disc({}, 5), *make_disc(top, 5)}, kTolerance);
  ASSERT_TRUE(closed.has_value());
  EXPECT_TRUE(is_closed(*closed));
  EXPECT_EQ(closed->edges.size(), 7U) << "three seams, two rims, two centres";
  expect_trims_hold(*closed);
}

TEST(Sew, BordersJoinAtOtherSpeedsAndDirections) {
  const auto plane = *make_plane({}, 10, 5);
  Frame beside;  // its x axis runs along the first one's right border, backwards
  beside.origin = {10, 5, 0};
  beside.x = -Vector3d::UnitY();
  beside.y = Vector3d::UnitX();
  beside.z = Vector3d::UnitZ();
  const auto other = *make_plane(beside, 5, 3);
  const auto body = sew("strip", {plane, other}, kTolerance);
  ASSERT_TRUE(body.has_value());
  EXPECT_EQ(body->edges.size(), 7U);
  EXPECT_EQ(body->vertices.size(), 6U);
  expect_trims_hold(*body);
}

TEST(Sew, WhatIsFurtherApartStaysApart) {
  Frame beside;
  beside.origin = {10, 0, 1e-3};
  const auto surfaces = {*make_plane({}, 10, 5), *make_plane(beside, 10, 5)};
  EXPECT_EQ(sew("", surfaces, 1e-6)->edges.size(), 8U);
  const auto joined = *sew("", surfaces, 1e-2);
  EXPECT_EQ(joined.edges.size(), 7U);
  double deviation = 0;
  for (const Edge& edge : joined.edges) deviation = std::max(deviation, edge.deviation);
  EXPECT_NEAR(deviation, 1e-3, 1e-12) << "told at the edge";
}

TEST(Sew, RefusesPiecesThatAreNotJoined) {
  const auto lines =
      *BsplineSurface::make({*KnotVector::make(0, {0, 1, 2}), *KnotVector::make_clamped(1, 0, 1)},
                            {{0, 0, -1}, {3, 0, -1}, {0, 0, 1}, {3, 0, 1}});
  const auto body = sew("lines", {*make_plane({}, 1, 1), lines}, kTolerance);
  ASSERT_FALSE(body.has_value());
  EXPECT_EQ(body.error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(body.error().at, "surface 2");
}

TEST(Sew, RefusesNothingAndNoTolerance) {
  EXPECT_FALSE(sew("", {}, 1).has_value());
  EXPECT_FALSE(sew("", {*make_plane({}, 1, 1)}, 0).has_value());
  EXPECT_FALSE(sew("", {*make_plane({}, 1, 1)}, std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace limn
