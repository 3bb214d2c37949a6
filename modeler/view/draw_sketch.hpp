#pragma once

#include "input/base/error.hpp"
#include "modeler/sketch/sketch.hpp"
#include "modeler/view/canvas.hpp"
#include "modeler/view/page.hpp"
#include "modeler/view/picture.hpp"

namespace limn {

/// Draws the sketch's layers, from the bottom: control polygons, ink, curves, control points,
/// corners, annotation. The one routine behind all formats.
/// Error: kLimit for curves above degree 3 (before anything is drawn).
Expected<void> draw_sketch(const Sketch& sketch, const Page& page, const PictureOptions& options,
                           Canvas& canvas);

}  // namespace limn
