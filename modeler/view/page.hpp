#pragma once

#include <Eigen/Core>
#include <string>

#include "input/base/error.hpp"
#include "modeler/sketch/sketch.hpp"
#include "modeler/view/picture.hpp"

namespace limn {

/// A length that people read easily, 1, 2 or 5 times a power of ten, and its text ("20 mm").
struct ScaleBar {
  double length_mm = 0;
  std::string label;
};

/// Where everything goes, in the sketch's mm (y down the page), and how large it is drawn. All
/// sizes follow from the extent of the drawing and the distances of its control points, so that a
/// signature and a sheet of writing are both legible.
struct Page {
  Eigen::Vector2d origin;  ///< upper left corner
  double width = 0;
  double height = 0;
  double paper_scale =
      1;  ///< paper mm a sketch mm: 1, or 1/n for pages longer than kLongestPaperMm

  double ink_width = 0;      ///< at the largest pressure
  double thinnest_ink = 0;   ///< at none
  double marker_width = 0;   ///< diameter of control points
  double polygon_width = 0;  ///< line width of control polygons
  double text_size = 0;

  ScaleBar scale_bar;
  Eigen::Vector2d scale_bar_at;  ///< left end of the bar
  Eigen::Vector2d caption_at;    ///< left end of the caption's baseline
  double text_width = 0;         ///< room for the caption
};

/// PDF's user space ends at 14,400 points.
inline constexpr double kLongestPaperMm = 5000;

/// Widest extent that is drawn. Far beyond any tablet, far below what overflows.
inline constexpr double kWidestSketchMm = 1e12;

/// The largest 1, 2 or 5 times a power of ten up to `most_mm`. Precondition: most_mm > 0, finite.
ScaleBar scale_bar_within(double most_mm);

/// Lays out the page. Error: kOutOfRange beyond kWidestSketchMm.
Expected<Page> lay_out_page(const Sketch& sketch, const PictureOptions& options);

/// "12 strokes, 143 control points, tolerance 0.05 mm, largest deviation 0.0432 mm", and
/// ", drawn 1:200" where the paper's scale is not 1.
std::string picture_caption(const Sketch& sketch, double paper_scale);

}  // namespace limn
