#include "modeler/bspline/bernstein.hpp"

#include "input/base/expect.hpp"
#include "modeler/bspline/knot_vector.hpp"

namespace limn {
namespace {

constexpr std::size_t kMostCount = KnotVector::kMaxDegree + 1;

/// Calls visit(line) for the first double of each line along `direction`, every coordinate by
/// itself; its neighbours lie shape.stride(direction) on.
template <class Visit>
void for_each_line(const BezierShape& shape, int direction, Visit visit) {
  const std::size_t stride = shape.stride(direction);
  const std::size_t block =
      stride * static_cast<std::size_t>(shape.count[static_cast<std::size_t>(direction)]);
  for (std::size_t b = 0; b < shape.size(); b += block) {
    for (std::size_t i = 0; i < stride; ++i) visit(b + i);
  }
}

}  // namespace

void map_along(const BezierShape& shape, int direction, std::span<const double> matrix,
               std::span<double> values) noexcept {
  LIMN_EXPECT(values.size() == shape.size());
  const auto n = static_cast<std::size_t>(shape.count[static_cast<std::size_t>(direction)]);
  LIMN_EXPECT(matrix.size() >= n * n);
  const std::size_t stride = shape.stride(direction);
  for_each_line(shape, direction, [&](std::size_t first) {
    std::array<double, kMostCount> line;
    for (std::size_t k = 0; k < n; ++k) line[k] = values[first + k * stride];
    for (std::size_t r = 0; r < n; ++r) {
      double sum = 0;
      for (std::size_t k = 0; k < n; ++k) sum += matrix[r * n + k] * line[k];
      values[first + r * stride] = sum;
    }
  });
}

void cut_bezier(const BezierShape& shape, int direction, double t, std::span<double> values,
                std::span<double> after) noexcept {
  LIMN_EXPECT(values.size() == shape.size() && after.size() == shape.size());
  const auto n = static_cast<std::size_t>(shape.count[static_cast<std::size_t>(direction)]);
  const std::size_t stride = shape.stride(direction);
  for_each_line(shape, direction, [&](std::size_t first) {
    std::array<double, kMostCount> line;
    for (std::size_t k = 0; k < n; ++k) line[k] = values[first + k * stride];
    for (std::size_t level = 1; level <= n; ++level) {
      values[first + (level - 1) * stride] = line[0];
      after[first + (n - level) * stride] = line[n - level];
      for (std::size_t k = 0; k + level < n; ++k) line[k] += t * (line[k + 1] - line[k]);
    }
  });
}

void differentiate_bezier(const BezierShape& shape, int direction, double scale,
                          std::span<double> values) noexcept {
  LIMN_EXPECT(values.size() == shape.size());
  const auto n = static_cast<std::size_t>(shape.count[static_cast<std::size_t>(direction)]);
  const std::size_t stride = shape.stride(direction);
  for_each_line(shape, direction, [&](std::size_t first) {
    std::array<double, kMostCount> line;
    for (std::size_t k = 0; k < n; ++k) line[k] = values[first + k * stride];
    for (std::size_t k = 0; k < n; ++k) {  // of degree p - 1, raised to p
      double sum = 0;
      if (k + 1 < n) sum += static_cast<double>(n - 1 - k) * (line[k + 1] - line[k]);
      if (k > 0) sum += static_cast<double>(k) * (line[k] - line[k - 1]);
      values[first + k * stride] = scale * sum;
    }
  });
}

}  // namespace limn
