#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "input/base/error.hpp"
#include "modeler/model/model.hpp"

namespace limn {

// Models as other CAD programs write and read them, through Open CASCADE. Units of files are turned
// into mm. Several threads may call these; one works at a time, since Open CASCADE's settings are
// shared. All give kMissing where limn was built without it (has_step(), sketch_step.hpp).

/// Application protocols of ISO 10303.
enum class StepSchema { kAp214, kAp242 };

/// A STEP file: a shell of trimmed faces a body (a solid where it is closed), free curves as edges.
/// Surfaces are B_SPLINE_SURFACE_WITH_KNOTS, rational where they are; periodic directions are
/// written clamped. Numbers have 17 digits. The same model gives the same bytes.
/// Errors: kOutOfRange for what STEP or Open CASCADE does not have (degree 0, breaks within a
/// surface), naming the body; kNumeric where Open CASCADE fails.
Expected<std::string> model_to_step(const Model& model, StepSchema schema = StepSchema::kAp214);

/// An IGES 5.3 file with the same contents: trimmed faces as entities of type 144, in mm.
Expected<std::string> model_to_iges(const Model& model);

/// What a file gave.
struct ReadModel {
  Model model;
  /// What was passed over, an entity a line: its kind and what was wrong.
  std::vector<std::string> skipped;
};

/// Solids, shells, faces and free curves of a STEP file as exact B-splines; planes, cylinders and
/// their like become rational ones. Edges' deviations are measured between spans' ends, not proved.
/// Errors: kSyntax for what is no STEP file; kMissing where nothing in it is geometry.
Expected<ReadModel> model_from_step(std::string_view bytes);

/// The same of an IGES file, which Open CASCADE opens itself.
Expected<ReadModel> model_from_iges(const std::string& path);

}  // namespace limn
