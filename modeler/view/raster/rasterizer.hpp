#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "modeler/view/raster/raster_vertex.hpp"

namespace limn {

/// A segment that is drawn before the surfaces on which it lies: its nearness is n -> lift_factor n
/// + lift.
struct LineOnRaster {
  std::array<glm::dvec4, 2> ends;  ///< of clip_segment()
  double radius = 1;               ///< half its width, samples
  double lift_factor = 1;
  double lift = 0;
};

/// What is nearest at each sample of the rows [first_row, first_row + rows) of a raster: a depth
/// and ID buffer in one, so that drawing is a comparison. A sample is a square of unit size; what
/// covers its centre covers it. Of primitives that are equally near the one of the lowest number
/// stays, whatever the order in which they come.
///
/// 8 bytes a sample. Threads: one band is one thread's.
class RasterBand {
 public:
  static constexpr std::uint32_t kNothing = 0xffff'ffff;

  /// Of no rows yet. Precondition: width above 0, below kRasterReach.
  explicit RasterBand(int width);

  int width() const noexcept { return width_; }
  int first_row() const noexcept { return first_row_; }
  int end_row() const noexcept { return first_row_ + rows_; }

  /// Empties it, and makes it rows [first_row, first_row + rows). Precondition: first_row not below
  /// 0, rows above 0, all below kRasterReach.
  void restart(int first_row, int rows);

  /// Covers each sample whose centre is inside, or on a left or upper edge: triangles that share an
  /// edge leave no gap and cover nothing twice. From either side. Precondition: outside is 0 for
  /// all corners; id < kNothing.
  void draw_triangle(const RasterVertex& a, const RasterVertex& b, const RasterVertex& c,
                     std::uint32_t id) noexcept;

  /// Covers all that is within line.radius of the segment: a line with round ends, or a disc where
  /// both ends are the same place. Precondition: id < kNothing.
  void draw_line(const LineOnRaster& line, std::uint32_t id) noexcept;

  /// Number of what is nearest; kNothing where nothing is.
  static std::uint32_t id_of(std::uint64_t key) noexcept {
    return ~static_cast<std::uint32_t>(key);
  }
  /// 0 where nothing is.
  static float nearness_of(std::uint64_t key) noexcept;

  /// Keys of the samples of one row of the raster, from the left. Precondition: a row of the band.
  std::span<const std::uint64_t> row(int y) const noexcept;

 private:
  struct Setup;
  void fill_small(const Setup& setup) noexcept;
  void fill_by_spans(const Setup& setup) noexcept;
  std::uint64_t* row_of(int y) noexcept;

  int width_;
  int first_row_ = 0;
  int rows_ = 0;
  std::vector<std::uint64_t> keys_;
};

}  // namespace limn
