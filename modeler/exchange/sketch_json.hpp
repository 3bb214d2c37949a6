#pragma once

#include <string>
#include <string_view>

#include "input/base/error.hpp"
#include "modeler/sketch/sketch.hpp"

namespace limn {

/// The sketch as JSON, UTF-8, a line a stroke, with a final newline. A stable contract:
///
///     {"tolerance_mm": 0.05,
///      "strokes": [{"samples": n, "t0": s, "t1": s, "degree": 3, "knots": [..],
///                   "control_points": [[x, y], ..], "closed": false, "corners": [u, ..],
///                   "deviation_max_mm": .., "deviation_rms_mm": ..}]}
///
///   - t0, t1: first and last sample in seconds since the sketch's time zero.
///   - `knots` has control points + degree + 1 entries; with n control points the domain is
///     knots[degree] .. knots[n].
///   - `closed`: the curve is periodic; it repeats its first `degree` control points at the end.
///   - A dot has degree 0, one control point and two knots.
///   - mm; x to the right, y down the page. Every number reads back as the same double.
///   - An eraser's stroke has "tool": "eraser" besides; a reader should pass over keys it does not
///     know.
std::string sketch_to_json(const Sketch& sketch);

/// Reads what sketch_to_json() writes, and checks it: types, counts, knots, corners inside the
/// domain. Unknown keys are passed over. Pressure and device are not in the file, so they stay
/// empty; arc lengths are computed anew.
/// Errors: kSyntax (with the byte for broken JSON, else the place as /strokes/3/knots),
/// kPointCount, kOutOfRange.
Expected<Sketch> sketch_from_json(std::string_view json);

}  // namespace limn
