#pragma once

#include <string>
#include <string_view>

#include "input/base/error.hpp"
#include "modeler/model/model.hpp"

namespace limn {

/// The model as limn's own file, *.limn.json: UTF-8, an edge, face or curve a line, with a final
/// newline. A stable contract, version 1:
///
///     {"limn_model": 1,
///      "bodies": [{"name": "..", "vertices": [[x, y, z], ..],
///                  "edges": [{"vertices": [i, j], "deviation_mm": .., "curve": CURVE}, ..],
///                  "faces": [{"reversed": false, "surface": SURFACE,
///                             "loops": [[{"edge": i, "reversed": false, "curve": CURVE}, ..],
///                             ..]},
///                            ..]}, ..],
///      "curves": [{"name": "..", "curve": CURVE}, ..]}
///
///     CURVE    {"degree": p, "periodic": false, "rational": false, "knots": [..],
///               "control_points": [[x, y, z], ..]}; in (u, v) two coordinates a point
///     SURFACE  the same with "degree", "periodic" and "knots" each an array of two, u then v;
///              control points with u fastest
///
///   - mm, right-handed, z up. `knots` has control points + degree + 1 entries a direction; a
///     periodic direction repeats its first `degree` control points at its end.
///   - A rational one's control points have a coordinate more, the weight w, and the others times
///     w: [w x, w y, w z, w]. So every number reads back as the same double.
///   - Edges, trims and loops mean what Body says (modeler/model/body.hpp).
std::string model_to_json(const Model& model);

/// Reads what model_to_json() writes, and checks it: types, counts, knots, indices. Unknown keys
/// are passed over.
/// Errors: kSyntax (with the byte for broken JSON, else the place as /bodies/0/edges/3/curve),
/// kUnknown for another version, kPointCount, kOutOfRange, kNumeric.
Expected<Model> model_from_json(std::string_view json);

}  // namespace limn
