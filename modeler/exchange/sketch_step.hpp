#pragma once

#include <string>

#include "input/base/error.hpp"
#include "modeler/sketch/sketch.hpp"

namespace limn {

/// Whether this build can write STEP (it was made with Open CASCADE).
bool has_step() noexcept;

/// The sketch as a STEP file (ISO 10303-21, AP214), in mm, in the modeler's frame: x to the right,
/// y up, z = 0, so y = -y of the sketch.
///
///   - One part "sketch" with one GEOMETRIC_CURVE_SET; a sketch without strokes gives a valid file
///     whose part holds an axis placement and no curve.
///   - Each stroke is one B_SPLINE_CURVE_WITH_KNOTS of the stroke's degree, knots and control
///     points, named "stroke 1", "stroke 2", .. in the order of drawing (an eraser's "eraser 3").
///     Numbers have 17 digits, so they are the same doubles when read. A closed curve is written
///     clamped at its seam, marked closed; its interior keeps its knots.
///   - A dot is a CARTESIAN_POINT.
///
/// The same sketch gives the same bytes: the header's time stamp is 1970-01-01T00:00:00.
/// Errors: kMissing where limn was built without Open CASCADE; kNumeric where Open CASCADE fails.
/// Several threads may call this.
Expected<std::string> sketch_to_step(const Sketch& sketch);

}  // namespace limn
