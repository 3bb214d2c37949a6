#pragma once

#include <utility>
#include <vector>

#include "modeler/sketch/sketch.hpp"
#include "modeler/surface/measures.hpp"

namespace limn::test {

/// A stroke around `curve`, as a fit would return it.
inline SketchStroke stroke_of(BsplineCurve<2> curve, std::vector<double> corners = {}) {
  SketchStroke out;
  out.samples = 40;
  out.t0 = std::chrono::milliseconds(1250);
  out.t1 = std::chrono::milliseconds(1450);
  out.corners = std::move(corners);
  out.deviation_max_mm = 0.04;
  out.deviation_rms_mm = 0.015625;
  out.length_mm = arc_length(curve).value;
  out.curve = std::move(curve);
  return out;
}

inline BsplineCurve<2> make_curve(const Expected<KnotVector>& knots,
                                  std::vector<Eigen::Vector2d> points) {
  return BsplineCurve<2>::make(knots.value(), std::move(points)).value();
}

/// Cubic, clamped, on [0, 3], uneven inner knots, 60 x 30 mm.
inline BsplineCurve<2> wave() {
  return make_curve(KnotVector::make_clamped(3, 0, 3, std::vector{0.7, 1.9}),
                    {{10, 20}, {20, 40}, {35, 10}, {50, 35}, {60, 40}, {70, 12}});
}

/// Cubic with a corner at u = 1, where (30, 40) is reached.
inline BsplineCurve<2> bent() {
  return make_curve(KnotVector::make_clamped(3, 0, 2, std::vector<double>{1, 1, 1}),
                    {{10, 40}, {15, 41}, {22, 38}, {30, 40}, {31, 30}, {29, 20}, {30, 10}});
}

/// Cubic, periodic on [0, 5], uneven knots, about a circle round (40, 30) of radius 16.
inline BsplineCurve<2> loop() {
  return make_curve(
      KnotVector::make_periodic(3, std::vector<double>{0, 1, 1.75, 3, 4.5}, 5),
      {{60, 30}, {46, 49}, {24, 42}, {24, 18}, {46, 11}, {60, 30}, {46, 49}, {24, 42}});
}

inline BsplineCurve<2> dot(double x = 30, double y = 20) {
  return BsplineCurve<2>::make(KnotVector(), {{x, y}}).value();
}

/// One of each: a curve, a corner, a closed curve, a dot.
inline Sketch four_strokes() {
  Sketch sketch;
  sketch.tolerance_mm = 0.05;
  sketch.strokes = {stroke_of(wave()), stroke_of(bent(), {1.0}), stroke_of(loop()),
                    stroke_of(dot())};
  return sketch;
}

}  // namespace limn::test
