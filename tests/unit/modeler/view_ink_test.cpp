#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "modeler/view/ink.hpp"
#include "tests/unit/modeler/sketch_examples.hpp"

namespace limn {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

/// The subpaths as polygons, each cubic in 12 chords.
std::vector<Polygon> flattened(const Path& path) {
  std::vector<Polygon> out;
  const Eigen::Vector2d* p = path.points().data();
  for (const Path::Verb verb : path.verbs()) {
    if (verb == Path::Verb::kMove) {
      out.push_back({*p++});
    } else if (verb == Path::Verb::kLine) {
      out.back().push_back(*p++);
    } else if (verb == Path::Verb::kCubic) {
      const Eigen::Vector2d a = out.back().back();
      for (int i = 1; i <= 12; ++i) {
        const double t = i / 12.0;
        const double s = 1 - t;
        out.back().push_back(s * s * s * a + 3 * s * s * t * p[0] + 3 * s * t * t * p[1] +
                             t * t * t * p[2]);
      }
      p += 3;
    }
  }
  return out;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double signed_area(const Polygon& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    sum += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  return 0.5 * sum;
}

int winding(const std::vector<Polygon>& polygons, const Eigen::Vector2d& at) {
  int turns = 0;
  for (const Polygon& polygon : polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d a = polygon[i] - at;
      const Eigen::Vector2d b = polygon[(i + 1) % polygon.size()] - at;
      if (a.y() <= 0 && b.y() > 0 && cross(a, b) > 0) ++turns;
      if (a.y() > 0 && b.y() <= 0 && cross(a, b) < 0) --turns;
    }
  }
  return turns;
}

/// How far `at` lies outside of the discs of diameter w(u) round the curve; negative inside.
double distance_from_ink(const std::vector<BezierPiece>& pieces, const InkWidth& width,
                         const Eigen::Vector2d& at) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const BezierPiece& piece : pieces) {
    constexpr int kSteps = 160;
    for (int i = 0; i <= kSteps; ++i) {
      const double t = static_cast<double>(i) / kSteps;
      const double s = 1 - t;
      const auto& p = piece.points;
      const Eigen::Vector2d c =
          s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3];
      const double u = piece.u0 + t * (piece.u1 - piece.u0);
      nearest = std::min(nearest, (at - c).norm() - 0.5 * width.at(u).width);
    }
  }
  return nearest;
}

/// The outline covers the round pen's area, everywhere to within `error`, on a grid around it.
void expect_covers(const BsplineCurve<2>& curve, const InkWidth& width, double error) {
  const auto pieces = bezier_pieces(curve).value();
  const auto polygons = flattened(ink_outline(pieces, width, 0.2 * error));
  Eigen::Vector2d low = curve.control_points().front();
  Eigen::Vector2d high = low;
  for (const auto& p : curve.control_points()) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector2d margin(4, 4);
  const Eigen::Vector2d step = (high - low + 2 * margin) / 40;
  int inside = 0;
  for (int i = 0; i <= 40; ++i) {
    for (int k = 0; k <= 40; ++k) {
      const Eigen::Vector2d at = low - margin + Eigen::Vector2d(i * step.x(), k * step.y());
      const double distance = distance_from_ink(pieces, width, at);
      if (std::abs(distance) < error) continue;
      inside += distance < 0;
      ASSERT_EQ(winding(polygons, at) != 0, distance < 0)
          << "at (" << at.x() << ", " << at.y() << "), " << distance << " mm from the ink";
    }
  }
  EXPECT_GT(inside, 5);
}

void expect_one_orientation(const BsplineCurve<2>& curve, const InkWidth& width) {
  const auto polygons = flattened(ink_outline(bezier_pieces(curve).value(), width, 0.01));
  ASSERT_FALSE(polygons.empty());
  for (const Polygon& polygon : polygons) EXPECT_LT(signed_area(polygon), 0);
}

/// Turns back within 0.2 mm, far less than the ink is wide.
BsplineCurve<2> hairpin() {
  return test::make_curve(KnotVector::make_clamped(3, 0, 1),
                          {{0, 0}, {30, 0.2}, {30, -0.2}, {0, 6}});
}

/// Stops and turns at u = 0.5: a cusp without a corner knot.
BsplineCurve<2> cusp() {
  return test::make_curve(KnotVector::make_clamped(3, 0, 1), {{0, 0}, {20, 20}, {0, 20}, {20, 0}});
}

TEST(InkOutline, CoversTheRoundPensArea) {
  const InkWidth even(2.0);
  expect_covers(test::wave(), even, 0.05);
  expect_covers(test::bent(), even, 0.05);
  expect_covers(test::loop(), even, 0.05);
}

TEST(InkOutline, HasNoHolesWhereTheCurveTurnsTighterThanItsWidth) {
  const InkWidth even(3.0);
  expect_covers(hairpin(), even, 0.08);
  expect_covers(cusp(), even, 0.08);
  // A whole turn of radius about 0.4 mm inside ink of half-width 1.5 mm.
  const auto curl = test::make_curve(
      KnotVector::make_periodic(3, std::vector<double>{0, 1, 2, 3, 4}, 5), {{0.6, 0},
                                                                            {0.2, 0.6},
                                                                            {-0.5, 0.4},
                                                                            {-0.5, -0.4},
                                                                            {0.2, -0.6},
                                                                            {0.6, 0},
                                                                            {0.2, 0.6},
                                                                            {-0.5, 0.4}});
  expect_covers(curl, even, 0.08);
}

TEST(InkOutline, FollowsThePressure) {
  std::vector<PressureAt> pressure;
  for (int i = 0; i <= 30; ++i) pressure.push_back({0.1 * i, 0.5 - 0.4 * std::cos(0.2 * i)});
  const InkWidth width(pressure, 0.9, 0.4, 3.0);
  expect_covers(test::wave(), width, 0.08);
}

TEST(InkOutline, AllSubpathsTurnTheSameWay) {
  for (const auto& curve : {test::wave(), test::bent(), test::loop(), hairpin(), cusp()}) {
    expect_one_orientation(curve, InkWidth(0.5));
    expect_one_orientation(curve, InkWidth(3.0));
  }
}

TEST(InkOutline, ASmoothStrokeIsOneRibbonWithRoundEnds) {
  const auto pieces = bezier_pieces(test::wave()).value();
  const Path path = ink_outline(pieces, InkWidth(0.5), 0.005);
  EXPECT_EQ(std::ranges::count(path.verbs(), Path::Verb::kMove), 3);  // a ribbon, two discs
}

TEST(InkOutline, StaysSmallForCurvesMuchLongerThanTheirInk) {
  const auto far = test::make_curve(KnotVector::make_clamped(3, 0, 1),
                                    {{0, 0}, {1e9, 1e9}, {-1e9, 1e9}, {1, 0}});
  const Path path = ink_outline(bezier_pieces(far).value(), InkWidth(1e-6), 1e-8);
  // 2^8 pieces at most, each a bar and a disc of 17 points.
  EXPECT_LE(path.points().size(), 257U * 17U);
}

TEST(InkOutline, PiecesWithoutLengthDrawADisc) {
  const auto still =
      test::make_curve(KnotVector::make_clamped(3, 0, 1), {{5, 5}, {5, 5}, {5, 5}, {5, 5}});
  const auto polygons = flattened(ink_outline(bezier_pieces(still).value(), InkWidth(2), 0.01));
  EXPECT_NE(winding(polygons, {5.9, 5}), 0);
  EXPECT_EQ(winding(polygons, {6.1, 5}), 0);
}

TEST(InkWidth, IsConstantWithoutPressure) {
  const InkWidth width(0.75);
  for (const double u : {-1.0, 0.0, 0.3, 7.0}) {
    EXPECT_EQ(width.at(u).width, 0.75);
    EXPECT_EQ(width.at(u).slope, 0);
  }
}

TEST(InkWidth, StaysNearTheProfileAndWithinIt) {
  std::vector<PressureAt> pressure;
  for (int i = 0; i <= 200; ++i) pressure.push_back({0.01 * i, 0.5 + 0.4 * std::sin(0.05 * i)});
  const InkWidth width(pressure, 1.0, 0.2, 1.2);
  for (const PressureAt& p : pressure) {
    // The simplified polyline is within 0.05 of the range; the cubic through it a little off that.
    EXPECT_NEAR(width.at(p.u).width, 0.2 + p.pressure, 0.08);
    EXPECT_LE(width.at(p.u).width, 1.1 + 1e-12);
    EXPECT_GE(width.at(p.u).width, 0.3 - 1e-12);
  }
}

TEST(InkWidth, SlopeIsTheDerivative) {
  const std::vector<PressureAt> pressure = {{0, 0.1}, {0.5, 0.2}, {1, 0.8}, {2, 1.0}, {3, 0.1}};
  const InkWidth width(pressure, 1.0, 0.0, 1.0);
  constexpr double kStep = 1e-6;
  for (int i = 1; i < 60; ++i) {
    const double u = 0.05 * i + 0.01;
    const double difference = (width.at(u + kStep).width - width.at(u - kStep).width) / (2 * kStep);
    EXPECT_NEAR(width.at(u).slope, difference, 1e-6) << "u = " << u;
  }
}

TEST(InkWidth, AveragesADwellAndHoldsTheEnds) {
  const std::vector<PressureAt> pressure = {{1, 0.2}, {1, 0.4}, {2, 0.9}};
  const InkWidth width(pressure, 1.0, 0.0, 1.0);
  EXPECT_NEAR(width.at(0).width, 0.3, 1e-15);
  EXPECT_NEAR(width.at(1).width, 0.3, 1e-15);
  EXPECT_NEAR(width.at(5).width, 0.9, 1e-15);
}

TEST(InkWidth, SimplifiesALineToItsEnds) {
  std::vector<PressureAt> pressure;
  for (int i = 0; i <= 1000; ++i) pressure.push_back({static_cast<double>(i), i / 1000.0});
  const InkWidth width(pressure, 1.0, 0.0, 1.0);
  // With end slopes of zero a cubic between two knots: smoothstep, not the line.
  EXPECT_NEAR(width.at(500).width, 0.5, 1e-9);
}

}  // namespace
}  // namespace limn
