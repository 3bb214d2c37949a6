#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace limn {

/// How the Bernstein coefficients of one Bézier piece lie: `width` doubles a control point, first
/// direction fastest, count[d] = degree + 1 of them along direction d (1 where there is none).
///
/// Source: [PT97] ch. 1.3; the same numbers are the piece's control points.
struct BezierShape {
  int width = 1;
  std::array<int, 3> count = {1, 1, 1};

  std::size_t size() const noexcept {
    return static_cast<std::size_t>(width * count[0] * count[1] * count[2]);
  }
  /// Doubles from one control point to the next along a direction.
  std::size_t stride(int direction) const noexcept {
    int stride = width;
    for (int d = 0; d < direction; ++d) stride *= count[static_cast<std::size_t>(d)];
    return static_cast<std::size_t>(stride);
  }
};

/// Replaces each line of control points along `direction` by `matrix` (row by row, square) times
/// the line. Precondition: values.size() == shape.size(), matrix as wide as the line is long, at
/// most 26.
void map_along(const BezierShape& shape, int direction, std::span<const double> matrix,
               std::span<double> values) noexcept;

/// Cuts the piece across `direction` at t in [0, 1] into its parts before and after, each with
/// parameters from 0 to 1 again; `values` becomes the part before. De Casteljau's algorithm, so the
/// parts stay within the hull. [PT97 A1.5] Precondition: both are of shape.size().
void cut_bezier(const BezierShape& shape, int direction, double t, std::span<double> values,
                std::span<double> after) noexcept;

/// Replaces the piece by its derivative along `direction`, in the same degree: on [0, 1], and times
/// `scale`.
void differentiate_bezier(const BezierShape& shape, int direction, double scale,
                          std::span<double> values) noexcept;

}  // namespace limn
