#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "modeler/view/path.hpp"

namespace limn {

/// Opaque sRGB colour.
struct Color {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
};

/// Round-capped, round-joined line.
struct LineStyle {
  Color color;
  double width_mm = 0;
  double dash_mm = 0;  ///< length of dashes and gaps; 0: solid
};

/// How finely a canvas needs a path: a shape's outline at what the eye sees, a curve as it is.
enum class Precision { kVisible, kExact };

/// Where a drawing goes. Lengths and places are in the sketch's mm, y down the page; the canvas
/// knows its page and scale. Elements have ids and classes for formats that keep them.
class Canvas {
 public:
  virtual ~Canvas() = default;

  /// Layers follow each other, are not nested, and enclose everything drawn.
  virtual void begin_layer(std::string_view id, std::string_view label) = 0;
  virtual void end_layer() = 0;

  /// Fills by the non-zero winding rule.
  virtual void fill(std::string_view id, std::string_view css_class, const Path& path,
                    Color color) = 0;
  /// A segment of no length draws a round dot.
  virtual void stroke(std::string_view id, std::string_view css_class, const Path& path,
                      const LineStyle& style, Precision precision) = 0;
  /// Text that begins at `at` on its baseline, `size_mm` high (em); made smaller where the canvas
  /// can measure it and finds it wider than `most_width_mm`.
  virtual void text(const Eigen::Vector2d& at, double size_mm, double most_width_mm, Color color,
                    std::string_view utf8) = 0;
};

}  // namespace limn
