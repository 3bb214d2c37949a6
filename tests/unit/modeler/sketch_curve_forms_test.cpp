#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "modeler/sketch/curve_forms.hpp"
#include "tests/unit/modeler/sketch_examples.hpp"

namespace limn {
namespace {

/// A few units in the last place of coordinates below 100 mm.
constexpr double kRounding = 1e-12;

Eigen::Vector2d point_of(const BezierPiece& piece, double u) {
  const double t = (u - piece.u0) / (piece.u1 - piece.u0);
  const double s = 1 - t;
  const auto& p = piece.points;
  return s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3];
}

/// Uneven knots whose ends are not clamped; on [2, 5].
BsplineCurve<2> unclamped() {
  return test::make_curve(KnotVector::make(3, {-1, 0, 1.5, 2, 3.25, 5, 6, 6.5, 9}),
                          {{0, 0}, {8, 30}, {25, 31}, {40, 2}, {55, 60}});
}

std::vector<BsplineCurve<2>> curves() {
  return {test::wave(), test::bent(), test::loop(), unclamped()};
}

TEST(BezierPieces, AreTheCurve) {
  for (const auto& curve : curves()) {
    const auto pieces = bezier_pieces(curve);
    ASSERT_TRUE(pieces.has_value());
    EXPECT_EQ(pieces->size(), curve.knots().breakpoints().size() - 1);
    for (const BezierPiece& piece : *pieces) {
      for (int i = 0; i <= 16; ++i) {
        const double u = piece.u0 + (piece.u1 - piece.u0) * i / 16;
        EXPECT_LE((point_of(piece, u) - curve.point(u)).norm(), kRounding) << "u = " << u;
      }
    }
  }
}

TEST(BezierPieces, MeetBitForBit) {
  for (const auto& curve : curves()) {
    const auto pieces = bezier_pieces(curve).value();
    for (std::size_t i = 1; i < pieces.size(); ++i) {
      EXPECT_EQ(pieces[i].points[0], pieces[i - 1].points[3]);
      EXPECT_EQ(pieces[i].u0, pieces[i - 1].u1);
    }
  }
  const auto round = bezier_pieces(test::loop()).value();
  EXPECT_EQ(round.back().points[3], round.front().points[0]);
}

TEST(BezierPieces, RaiseLowerDegrees) {
  const auto line = test::make_curve(KnotVector::make_clamped(1, 0, 3, std::vector<double>{1}),
                                     {{1, 2}, {20, 5}, {30, 40}});
  const auto parabolas = test::make_curve(KnotVector::make_clamped(2, 0, 3, std::vector<double>{1}),
                                          {{1, 2}, {20, 5}, {30, 40}, {7, 9}});
  for (const auto& curve : {line, parabolas}) {
    const auto pieces = bezier_pieces(curve).value();
    ASSERT_EQ(pieces.size(), 2U);
    for (const BezierPiece& piece : pieces) {
      for (int i = 0; i <= 8; ++i) {
        const double u = piece.u0 + (piece.u1 - piece.u0) * i / 8;
        EXPECT_LE((point_of(piece, u) - curve.point(u)).norm(), kRounding);
      }
    }
  }
}

TEST(BezierPieces, ADotHasNone) { EXPECT_TRUE(bezier_pieces(test::dot()).value().empty()); }

TEST(BezierPieces, ABreakStaysApart) {
  const auto broken =
      test::make_curve(KnotVector::make(1, {0, 0, 1, 1, 2, 2}), {{0, 0}, {1, 0}, {5, 5}, {6, 5}});
  const auto pieces = bezier_pieces(broken).value();
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].points[3], Eigen::Vector2d(1, 0));
  EXPECT_EQ(pieces[1].points[0], Eigen::Vector2d(5, 5));
}

TEST(BezierPieces, RefuseWhatCubicsCannotExpress) {
  const auto quartic =
      test::make_curve(KnotVector::make_clamped(4, 0, 1), {{0, 0}, {1, 1}, {2, 0}, {3, 1}, {4, 0}});
  const auto pieces = bezier_pieces(quartic);
  ASSERT_FALSE(pieces.has_value());
  EXPECT_EQ(pieces.error().code, ErrorCode::kLimit);
}

TEST(Clamped, IsTheCurveWithFullEndKnots) {
  for (const auto& curve : {test::loop(), unclamped()}) {
    const auto other = clamped(curve);
    const auto& knots = other.knots().values();
    const double begin = curve.knots().domain_begin();
    const double end = curve.knots().domain_end();
    EXPECT_FALSE(other.knots().is_periodic());
    EXPECT_EQ(other.knots().multiplicity(begin), 4);
    EXPECT_EQ(other.knots().multiplicity(end), 4);
    EXPECT_EQ(knots.front(), begin);
    EXPECT_EQ(knots.back(), end);
    EXPECT_EQ(other.knots().breakpoints(), curve.knots().breakpoints());
    for (int i = 0; i <= 100; ++i) {
      const double u = begin + (end - begin) * i / 100;
      EXPECT_LE((other.point(u) - curve.point(u)).norm(), kRounding) << "u = " << u;
    }
  }
}

TEST(Clamped, AClosedCurveEndsWhereItBegins) {
  const auto curve = clamped(test::loop());
  EXPECT_EQ(curve.control_points().front(), curve.control_points().back());
}

TEST(Clamped, LeavesAClampedCurveAndADotAlone) {
  EXPECT_EQ(clamped(test::wave()), test::wave());
  EXPECT_EQ(clamped(test::bent()), test::bent());
  EXPECT_EQ(clamped(test::dot()), test::dot());
}

TEST(Clamped, WorksForDegreesThatPicturesDoNotDraw) {
  const std::vector<double> round = {0, 0.5, 1, 2, 2.25, 3, 4};
  std::vector<Eigen::Vector2d> points = {{0, 0},  {9, 1},  {14, 8}, {10, 15},
                                         {3, 14}, {-4, 9}, {-5, 2}};
  for (std::size_t i = 0; i < 5; ++i) points.push_back(points[i]);
  const auto curve = test::make_curve(KnotVector::make_periodic(5, round, 5), points);
  const auto other = clamped(curve);
  EXPECT_EQ(other.knots().multiplicity(0), 6);
  for (int i = 0; i <= 100; ++i) {
    EXPECT_LE((other.point(0.05 * i) - curve.point(0.05 * i)).norm(), kRounding);
  }
}

}  // namespace
}  // namespace limn
