#pragma once

#include <span>
#include <vector>

#include "modeler/sketch/curve_forms.hpp"
#include "modeler/sketch/sketch.hpp"
#include "modeler/view/path.hpp"

namespace limn {

/// Width of ink along a curve: w(u), a monotone piecewise cubic (C1, no overshoot) through a
/// simplified pressure profile. Outside its knots it stays constant.
/// Source: [FC80].
class InkWidth {
 public:
  /// The same width everywhere.
  explicit InkWidth(double width) : knots_{{0, width, 0}} {}

  /// `thinnest` at pressure 0 to `widest` at `largest_pressure`.
  /// Precondition: `pressure` is not empty, its u non-decreasing; largest_pressure > 0.
  InkWidth(std::span<const PressureAt> pressure, double largest_pressure, double thinnest,
           double widest);

  struct Value {
    double width = 0;
    double slope = 0;  ///< dw/du
  };
  Value at(double u) const noexcept;

 private:
  struct Knot {
    double u = 0;
    double width = 0;
    double slope = 0;
  };
  std::vector<Knot> knots_;
};

/// The area that a round pen of diameter w(u) covers, as one path for the non-zero rule whose
/// subpaths all turn the same way, so that no overlap makes a hole: ribbons between the two offset
/// curves, by cubic Hermite pieces within `tolerance_mm` of them; a disc at each end and where the
/// direction jumps; and where the curve turns more tightly than its own half-width, so that the
/// inner offset would turn back, short bars between discs.
/// Precondition: tolerance_mm > 0.
Path ink_outline(std::span<const BezierPiece> pieces, const InkWidth& width, double tolerance_mm);

/// A disc, turning the way ink_outline()'s subpaths do.
void add_disc(Path& path, const Eigen::Vector2d& center, double radius);

}  // namespace limn
