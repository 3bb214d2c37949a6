#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "input/base/error.hpp"
#include "modeler/view/canvas.hpp"

namespace limn {

/// What a drawing is drawn on, in the drawing's mm.
struct Sheet {
  std::string title;  ///< of the file
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  double width = 0;
  double height = 0;
  double paper_scale = 1;  ///< mm of paper a mm of the drawing
};

/// Draws on a canvas that it is given.
using Drawing = std::function<Expected<void>(Canvas&)>;

/// The bytes of a file of each format; what is drawn is the same. Errors: the drawing's; kMissing
/// for PDF and PNG where limn was built without cairo; kNumeric where cairo fails. PNG:
/// `pixels` for the longer side.
Expected<std::string> draw_svg(const Sheet& sheet, const Drawing& drawing);
Expected<std::string> draw_pdf(const Sheet& sheet, const Drawing& drawing);
Expected<std::string> draw_png(const Sheet& sheet, double pixels, const Drawing& drawing);

}  // namespace limn
