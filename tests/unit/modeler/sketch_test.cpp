#include "modeler/sketch/sketch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/modeler/sketch_examples.hpp"

namespace limn {
namespace {

using std::chrono::milliseconds;

/// Half a turn of radius 20 mm in 0.5 s, pressure rising from 0.2 to 0.7, from t = 2 s on.
Stroke arc_stroke() {
  Stroke stroke;
  stroke.device = 3;
  stroke.axes.add(PenAxis::kX);
  stroke.axes.add(PenAxis::kY);
  stroke.axes.add(PenAxis::kPressure);
  for (int i = 0; i <= 100; ++i) {
    const double share = i / 100.0;
    const double angle = std::numbers::pi * share;
    stroke.points.push_back({milliseconds(2000 + 5 * i), 50 - 20 * std::cos(angle),
                             40 - 20 * std::sin(angle), 0.2 + 0.5 * share, 0, 0});
  }
  return stroke;
}

SketchOptions options_from(Timestamp zero) {
  SketchOptions options;
  options.fit.tolerance_mm = 0.02;
  options.time_zero = zero;
  return options;
}

TEST(SketchStroke, HoldsTheCurveAndWhatTheStrokeWas) {
  const auto stroke = sketch_stroke(arc_stroke(), options_from(milliseconds(1500)));
  ASSERT_TRUE(stroke.has_value()) << stroke.error().what;
  EXPECT_EQ(stroke->device, 3U);
  EXPECT_EQ(stroke->tool, Tool::kPen);
  EXPECT_EQ(stroke->samples, 101U);
  EXPECT_EQ(stroke->t0, milliseconds(500));
  EXPECT_EQ(stroke->t1, milliseconds(1000));
  EXPECT_EQ(stroke->curve.knots().degree(), 3);
  EXPECT_LE(stroke->deviation_max_mm, 0.02);
  EXPECT_LE(stroke->deviation_rms_mm, stroke->deviation_max_mm);
  EXPECT_FALSE(stroke->closed());
  EXPECT_FALSE(stroke->is_dot());
  // A curve within 0.02 mm of the arc may be a little longer or shorter than it.
  EXPECT_NEAR(stroke->length_mm, 20 * std::numbers::pi, 0.1);
}

TEST(SketchStroke, KeepsPressureAtTheSamplesParameters) {
  const Stroke arc = arc_stroke();
  const auto stroke = sketch_stroke(arc, options_from({}));
  ASSERT_TRUE(stroke.has_value());
  ASSERT_EQ(stroke->pressure.size(), arc.points.size());
  for (std::size_t i = 0; i < arc.points.size(); ++i) {
    EXPECT_EQ(stroke->pressure[i].pressure, arc.points[i].pressure);
    const Eigen::Vector2d sample(arc.points[i].x_mm, arc.points[i].y_mm);
    EXPECT_LE((stroke->curve.point(stroke->pressure[i].u) - sample).norm(), 0.02);
  }
}

TEST(SketchStroke, HasNoPressureWhereTheDeviceGivesNone) {
  Stroke arc = arc_stroke();
  arc.axes.remove(PenAxis::kPressure);
  const auto stroke = sketch_stroke(arc, options_from({}));
  ASSERT_TRUE(stroke.has_value());
  EXPECT_TRUE(stroke->pressure.empty());
}

TEST(SketchStroke, OneSampleIsADot) {
  Stroke tap = arc_stroke();
  tap.tool = Tool::kEraser;
  tap.points.resize(1);
  const auto stroke = sketch_stroke(tap, options_from({}));
  ASSERT_TRUE(stroke.has_value());
  EXPECT_TRUE(stroke->is_dot());
  EXPECT_EQ(stroke->tool, Tool::kEraser);
  EXPECT_EQ(stroke->control_point_count(), 1U);
  EXPECT_EQ(stroke->curve.control_points().front(), Eigen::Vector2d(30, 40));
  EXPECT_EQ(stroke->length_mm, 0);
  EXPECT_EQ(stroke->t0, stroke->t1);
}

TEST(SketchStroke, PassesOnWhatTheFitRefuses) {
  Stroke broken = arc_stroke();
  broken.points[7].x_mm = std::nan("");
  const auto not_finite = sketch_stroke(broken, options_from({}));
  ASSERT_FALSE(not_finite.has_value());
  EXPECT_EQ(not_finite.error().code, ErrorCode::kOutOfRange);
  EXPECT_FALSE(sketch_stroke(Stroke{}, options_from({})).has_value());
}

TEST(SketchStroke, CountsTheControlPointsOfAClosedCurveOnce) {
  EXPECT_EQ(test::stroke_of(test::loop()).control_point_count(), 5U);
  EXPECT_EQ(test::stroke_of(test::wave()).control_point_count(), 6U);
}

TEST(ArcLength, IsThatOfTheChordsOfAFineSubdivision) {
  for (const auto& curve : {test::wave(), test::bent(), test::loop()}) {
    constexpr int kChords = 100'000;
    const double begin = curve.knots().domain_begin();
    const double step = (curve.knots().domain_end() - begin) / kChords;
    double sum = 0;
    Eigen::Vector2d before = curve.point(begin);
    for (int i = 1; i <= kChords; ++i) {
      const Eigen::Vector2d next = curve.point(begin + i * step);
      sum += (next - before).norm();
      before = next;
    }
    // Chords of 1e-3 mm fall short by (chord * curvature)^2 / 24 of the length.
    EXPECT_NEAR(arc_length(curve).value, sum, 1e-7 * sum);
  }
  EXPECT_EQ(arc_length(test::dot()).value, 0);
}

}  // namespace
}  // namespace limn
