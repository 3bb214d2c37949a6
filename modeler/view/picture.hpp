#pragma once

#include <string>

#include "input/base/error.hpp"
#include "modeler/sketch/sketch.hpp"

namespace limn {

/// What a picture shows besides the ink, and how large it may be.
struct PictureOptions {
  bool control_polygons = true;  ///< thin lines, and a dot at each control point
  bool corners = true;           ///< marks where a curve is only C0
  bool scale_bar = true;
  bool caption = true;  ///< strokes, control points, tolerance, largest deviation
  /// PNG only: the longer side is 1,200 pixels to this many. Precondition: 16 to 32,000.
  int most_pixels = 2000;
};

/// Whether this build can write PDF and PNG (it was made with cairo).
bool has_cairo() noexcept;

/// Pictures of a sketch on a white page that fits it, with margins: three formats from one drawing
/// routine. The frame is the sketch's: mm, y down the page. In SVG and PDF 1 mm is 1 mm, unless the
/// page would be longer than 5 m (PDF allows no more): then it is drawn at 1:n, n round, and the
/// caption says so. The scale bar is right at any scale.
///
/// Ink is as wide as the pressure says, relative to the sketch's largest, or even where the device
/// gives none. An eraser's strokes are dashed grey curves. A sketch without strokes gives a small
/// page with scale bar and caption.
///
/// The same sketch gives the same bytes: no file holds a date, and the letters in PDF and PNG are
/// cairo's own, not a font of the system. No display is needed.
///
/// Errors: kOutOfRange where the coordinates span more than 1e12 mm; kLimit for curves above degree
/// 3; kMissing for PDF and PNG where limn was built without cairo; kNumeric where cairo fails.
Expected<std::string> sketch_to_pdf(const Sketch& sketch, const PictureOptions& options = {});
Expected<std::string> sketch_to_png(const Sketch& sketch, const PictureOptions& options = {});

/// The same as SVG 1.1, for drawing programs rather than only for show: its layers are
///
///     control-polygons, ink, curves, control-points, corners, annotation
///
/// Layer "curves" has the exact curves as cubic Bezier paths of class "curve", id "stroke-1", ..
/// (coordinates to 1e-6 mm or finer), as thin as the finest ink so that the ink hides them; layer
/// "ink" has the outlines with the pressure, class "ink", id "stroke-1-ink". User units are the
/// sketch's own millimetres, whatever the page's scale. Text is text.
Expected<std::string> sketch_to_svg(const Sketch& sketch, const PictureOptions& options = {});

}  // namespace limn
