#pragma once

#include <cstddef>
#include <vector>

#include "input/base/error.hpp"
#include "input/base/time.hpp"
#include "input/sample/pen_sample.hpp"
#include "input/stroke/stroke.hpp"
#include "modeler/bspline/tensor_spline.hpp"
#include "modeler/fit/fit_curve.hpp"

namespace limn {

/// Pen pressure where the curve has parameter u.
struct PressureAt {
  double u = 0;
  double pressure = 0;  ///< 0 (none) to 1 (the device's maximum)
  friend bool operator==(const PressureAt&, const PressureAt&) = default;
};

/// One stroke as a curve, in mm in the frame of PenSample: x to the right, y towards the user,
/// which is down the page.
///
/// The eraser's strokes are strokes like others, told by `tool`: a sketch records what the hand
/// did, and removes no ink. Pictures draw them as dashed grey curves without ink.
struct SketchStroke {
  DeviceIndex device = 0;
  Tool tool = Tool::kPen;
  std::size_t samples = 0;  ///< of the stroke as recorded, duplicates included
  Timestamp t0{};           ///< first sample, since SketchOptions::time_zero
  Timestamp t1{};           ///< last sample
  double length_mm = 0;     ///< arc length of `curve`

  /// Cubic, or a dot: degree 0 with one control point. Periodic exactly if the stroke is closed.
  BsplineCurve<2> curve;
  std::vector<double> corners;  ///< parameters where the curve is only C0, ascending
  double deviation_max_mm = 0;  ///< of the samples from the curve, at most the tolerance
  double deviation_rms_mm = 0;

  /// One entry a sample, u non-decreasing; empty where the device gives no pressure.
  std::vector<PressureAt> pressure;

  bool closed() const noexcept { return curve.knots().is_periodic(); }
  bool is_dot() const noexcept { return curve.knots().degree() == 0; }
  /// Control points that may be moved: without the repeated ones of a closed curve.
  std::size_t control_point_count() const noexcept;
};

/// A flat drawing: its strokes in the order of drawing.
struct Sketch {
  double tolerance_mm = 0;  ///< what was asked of every stroke
  std::vector<SketchStroke> strokes;
};

struct SketchOptions {
  FitOptions fit;
  /// Where the sketch's time begins, e.g. a trace's first event.
  Timestamp time_zero{};
};

/// Fits one stroke; the strokes of a trace go through here one at a time, so memory holds the
/// drawing and never the trace. Linear in the samples for a bounded number of corners.
/// Errors: those of fit_curve(), which name the sample.
Expected<SketchStroke> sketch_stroke(const Stroke& stroke, const SketchOptions& options);

}  // namespace limn
