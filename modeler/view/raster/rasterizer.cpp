#include "modeler/view/raster/rasterizer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "input/base/expect.hpp"

namespace limn {
namespace {

constexpr std::int32_t kHalf = kSubsamples / 2;
/// Triangles up to this wide and high, in samples, are tested sample by sample in 32 bits.
constexpr std::int32_t kSmallSize = 16;

/// The first sample whose centre is not before x.
std::int32_t first_sample(std::int32_t x) noexcept {
  return (x - kHalf + kSubsamples - 1) >> kSubsampleBits;
}
/// The last sample whose centre is not behind x.
std::int32_t last_sample(std::int32_t x) noexcept { return (x - kHalf) >> kSubsampleBits; }
std::int32_t centre(std::int32_t sample) noexcept { return sample * kSubsamples + kHalf; }

/// Nearer keys are larger: floats from 0 up are in the order of their bits.
std::uint64_t key_of(float nearness, std::uint32_t id) noexcept {
  const float at_least_0 = nearness > 0 ? nearness : 0.0F;
  return std::uint64_t{std::bit_cast<std::uint32_t>(at_least_0)} << 32 | std::uint32_t{~id};
}

std::int64_t floor_divide(std::int64_t a, std::int64_t b) noexcept {  // b > 0
  const std::int64_t q = a / b;
  return q - static_cast<std::int64_t>(a % b < 0);
}

/// Twice the signed area of (origin, to, p): above 0 inside, for corners clockwise on the raster,
/// whose y points down. Changes by `right` and `down` from sample to sample.
template <class Integer>
struct Edge {
  Edge(const RasterVertex& from, const RasterVertex& to, std::int32_t column, std::int32_t row) {
    const Integer dx = Integer{to.x} - from.x;
    const Integer dy = Integer{to.y} - from.y;
    right = -dy * kSubsamples;
    down = dx * kSubsamples;
    at = dx * (Integer{centre(row)} - from.y) - dy * (Integer{centre(column)} - from.x);
    // On the edge itself is inside for left and upper edges alone.
    bias = dy < 0 || (dy == 0 && dx > 0) ? 0 : -1;
  }
  Integer at;  ///< at the centre of (column, row)
  Integer right;
  Integer down;
  Integer bias;
};

}  // namespace

/// A triangle whose corners are clockwise on the raster, and the samples that it may cover.
struct RasterBand::Setup {
  RasterVertex a, b, c;
  std::int64_t area;
  std::int32_t left, right, top, bottom;  ///< all four may be covered
  std::uint32_t id;
};

RasterBand::RasterBand(int width) : width_(width) {
  LIMN_EXPECT(width > 0 && width < kRasterReach);
}

void RasterBand::restart(int first_row, int rows) {
  LIMN_EXPECT(first_row >= 0 && rows > 0 && first_row + rows < kRasterReach);
  first_row_ = first_row;
  rows_ = rows;
  keys_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(rows_), 0);
}

float RasterBand::nearness_of(std::uint64_t key) noexcept {
  return std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32));
}

std::span<const std::uint64_t> RasterBand::row(int y) const noexcept {
  LIMN_EXPECT(y >= first_row_ && y < end_row());
  const auto width = static_cast<std::size_t>(width_);
  return {keys_.data() + static_cast<std::size_t>(y - first_row_) * width, width};
}

std::uint64_t* RasterBand::row_of(int y) noexcept {
  return keys_.data() + static_cast<std::ptrdiff_t>(y - first_row_) * width_;
}

void RasterBand::draw_triangle(const RasterVertex& a, const RasterVertex& b, const RasterVertex& c,
                               std::uint32_t id) noexcept {
  const std::int32_t low_x = std::min({a.x, b.x, c.x});
  const std::int32_t high_x = std::max({a.x, b.x, c.x});
  const std::int32_t low_y = std::min({a.y, b.y, c.y});
  const std::int32_t high_y = std::max({a.y, b.y, c.y});
  Setup setup;
  setup.left = std::max(first_sample(low_x), 0);
  setup.right = std::min(last_sample(high_x), width_ - 1);
  setup.top = std::max(first_sample(low_y), first_row_);
  setup.bottom = std::min(last_sample(high_y), end_row() - 1);
  // Most small triangles end here: no sample is within their bounds.
  if (setup.left > setup.right || setup.top > setup.bottom) return;
  setup.area = (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) -
               (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
  if (setup.area == 0) return;
  setup.a = a;
  setup.b = setup.area > 0 ? b : c;
  setup.c = setup.area > 0 ? c : b;
  setup.area = std::abs(setup.area);
  setup.id = id;
  // By the triangle's own size, not by what the band shows of it: depths must not depend on bands.
  const bool is_small = std::max(high_x - low_x, high_y - low_y) < kSmallSize * kSubsamples;
  is_small ? fill_small(setup) : fill_by_spans(setup);
}

void RasterBand::fill_small(const Setup& s) noexcept {
  const Edge<std::int32_t> ab(s.a, s.b, s.left, s.top);
  const Edge<std::int32_t> bc(s.b, s.c, s.left, s.top);
  const Edge<std::int32_t> ca(s.c, s.a, s.left, s.top);
  const float part = 1.0F / static_cast<float>(s.area);
  const float to_b = (s.b.nearness - s.a.nearness) * part;
  const float to_c = (s.c.nearness - s.a.nearness) * part;
  std::int32_t row_ab = ab.at + ab.bias;
  std::int32_t row_bc = bc.at + bc.bias;
  std::int32_t row_ca = ca.at + ca.bias;
  std::uint64_t* keys = row_of(s.top);
  for (std::int32_t y = s.top; y <= s.bottom; ++y) {
    std::int32_t at_ab = row_ab;
    std::int32_t at_bc = row_bc;
    std::int32_t at_ca = row_ca;
    for (std::int32_t x = s.left; x <= s.right; ++x) {
      // Without a branch, which no processor would foresee: a key of 0 is below all others.
      const float nearness = s.a.nearness + static_cast<float>(at_ca - ca.bias) * to_b +
                             static_cast<float>(at_ab - ab.bias) * to_c;
      const std::uint64_t inside = (at_ab | at_bc | at_ca) >= 0 ? ~std::uint64_t{0} : 0;
      keys[x] = std::max(keys[x], key_of(nearness, s.id) & inside);
      at_ab += ab.right;
      at_bc += bc.right;
      at_ca += ca.right;
    }
    row_ab += ab.down;
    row_bc += bc.down;
    row_ca += ca.down;
    keys += width_;
  }
}

void RasterBand::fill_by_spans(const Setup& s) noexcept {
  const std::array<Edge<std::int64_t>, 3> edges = {Edge<std::int64_t>(s.a, s.b, 0, s.top),
                                                   Edge<std::int64_t>(s.b, s.c, 0, s.top),
                                                   Edge<std::int64_t>(s.c, s.a, 0, s.top)};
  const double part = 1 / static_cast<double>(s.area);
  const double to_b =
      (static_cast<double>(s.b.nearness) - static_cast<double>(s.a.nearness)) * part;
  const double to_c =
      (static_cast<double>(s.c.nearness) - static_cast<double>(s.a.nearness)) * part;
  const double right =
      static_cast<double>(edges[2].right) * to_b + static_cast<double>(edges[0].right) * to_c;
  const float least = std::min({s.a.nearness, s.b.nearness, s.c.nearness});
  const float most = std::max({s.a.nearness, s.b.nearness, s.c.nearness});
  for (std::int32_t y = s.top; y <= s.bottom; ++y) {
    // Where all three are inside; each is linear along the row.
    std::int64_t first = s.left;
    std::int64_t last = s.right;
    std::array<std::int64_t, 3> at;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const Edge<std::int64_t>& edge = edges[k];
      at[k] = edge.at + edge.down * (y - s.top);
      const std::int64_t inside = at[k] + edge.bias;
      if (edge.right > 0) {
        first = std::max(first, -floor_divide(inside, edge.right));
      } else if (edge.right < 0) {
        last = std::min(last, floor_divide(inside, -edge.right));
      } else if (inside < 0) {
        last = -1;
      }
    }
    if (first > last) continue;
    const auto at_first = [&](std::size_t k) {
      return static_cast<double>(at[k] + edges[k].right * first);
    };
    const double begin =
        static_cast<double>(s.a.nearness) + at_first(2) * to_b + at_first(0) * to_c;
    std::uint64_t* const keys = row_of(y);
    for (std::int64_t x = first; x <= last; ++x) {
      const auto nearness = static_cast<float>(begin + static_cast<double>(x - first) * right);
      keys[x] = std::max(keys[x], key_of(std::clamp(nearness, least, most), s.id));
    }
  }
}

void RasterBand::draw_line(const LineOnRaster& line, std::uint32_t id) noexcept {
  const auto& [a, b] = line.ends;
  const double radius = line.radius;
  const double ax = a.x / a.w;
  const double ay = a.y / a.w;
  const double dx = b.x / b.w - ax;
  const double dy = b.y / b.w - ay;
  const double near_a = line.lift_factor * a.z / a.w + line.lift;
  const double towards_b = line.lift_factor * b.z / b.w + line.lift - near_a;
  const double length2 = dx * dx + dy * dy;
  const auto sample = [](double x) { return static_cast<std::int32_t>(std::floor(x)); };
  const std::int32_t top = std::max(sample(std::min(ay, ay + dy) - radius), first_row_);
  const std::int32_t bottom = std::min(sample(std::max(ay, ay + dy) + radius), end_row() - 1);
  const double low_x = std::min(ax, ax + dx) - radius;
  const double high_x = std::max(ax, ax + dx) + radius;
  for (std::int32_t y = top; y <= bottom; ++y) {
    const double py = y + 0.5 - ay;
    double low = low_x;
    double high = high_x;
    // Along a row the strip beside the segment is 2 radius |d| / |dy| long.
    if (dy * dy > length2 / 16) {
      const double middle = ax + py * dx / dy;
      const double reach = radius * std::sqrt(length2) / std::abs(dy);
      low = std::max(low, middle - reach);
      high = std::min(high, middle + reach);
    }
    const std::int32_t first = std::max(sample(low), 0);
    const std::int32_t last = std::min(sample(high), width_ - 1);
    std::uint64_t* const keys = row_of(y);
    for (std::int32_t x = first; x <= last; ++x) {
      const double px = x + 0.5 - ax;
      const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
      const double off_x = px - t * dx;
      const double off_y = py - t * dy;
      if (off_x * off_x + off_y * off_y > radius * radius) continue;
      const auto nearness = static_cast<float>(near_a + t * towards_b);
      keys[x] = std::max(keys[x], key_of(nearness, id));
    }
  }
}

}  // namespace limn
