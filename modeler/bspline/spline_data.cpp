#include "modeler/bspline/spline_data.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "input/base/expect.hpp"
#include "modeler/bspline/denominator.hpp"
#include "modeler/bspline/lanes.hpp"

namespace limn {
namespace {

/// Whether the layers of control points repeat as a periodic direction must. `stride` doubles apart
/// lie neighbours of that direction, `count` of them a line.
bool repeats_along(const PagedArray& coordinates, std::size_t stride, std::size_t count,
                   std::size_t degree) {
  const std::size_t shift = (count - degree) * stride;
  for (std::size_t block = 0; block < coordinates.size(); block += count * stride) {
    for (std::size_t i = block; i < block + degree * stride; ++i) {
      if (coordinates[i] != coordinates[i + shift]) return false;
    }
  }
  return true;
}

/// Whether a value is infinite or no number: times 0 such a one is no number, others are 0. Four
/// sums, so that none waits for the one before.
LIMN_KERNEL void find_infinite(std::span<const double> values, bool& found) noexcept {
  using bspline_detail::Lanes;
  constexpr std::size_t kSums = 4;
  const Lanes zero = {0, 0, 0, 0};
  Lanes sums[kSums] = {zero, zero, zero, zero};
  std::size_t i = 0;
  for (; i + 4 * kSums <= values.size(); i += 4 * kSums) {
    for (std::size_t k = 0; k < kSums; ++k) {
      Lanes x;
      bspline_detail::load(values.data() + i + 4 * k, x);
      sums[k] += x * zero;
    }
  }
  const Lanes sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  double rest = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  for (; i < values.size(); ++i) rest += values[i] * 0;
  found = rest != 0;
}

LIMN_ON_EACH_PROCESSOR(has_infinite_in, (std::span<const double> values, bool& found),
                       (values, found), find_infinite(values, found))

bool all_finite(std::span<const double> values) noexcept {
  bool found = false;
  has_infinite_in(values, found);
  return !found;
}

/// Weights below are lost where they are multiplied.
constexpr double kLeastWeight = 1e-100;

/// Coordinate `first` of the spline is the first of them.
Expected<void> check_numbers(std::span<const double> coordinates, std::size_t width, Form form,
                             std::size_t first) {
  if (form == Form::kPolynomial && all_finite(coordinates)) return {};
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const std::size_t at = first + i;
    const bool is_weight = form == Form::kRational && at % width == width - 1;
    if (is_weight && coordinates[i] != 0 && std::abs(coordinates[i]) < kLeastWeight) {
      return fail(ErrorCode::kOutOfRange, "weight " + std::to_string(at / width), "it is nearly 0",
                  "scale all weights up");
    }
    if (!std::isfinite(coordinates[i])) {
      return fail(ErrorCode::kOutOfRange, "control point " + std::to_string(at / width),
                  "a coordinate is not finite", "give finite coordinates");
    }
  }
  return {};
}

}  // namespace

Expected<SplineData> SplineData::make(std::span<const KnotVector> knots, int dimension, Form form,
                                      std::span<const double> coordinates) {
  return make(knots, dimension, form, PagedArray(coordinates));
}

Expected<SplineData> SplineData::make(std::span<const KnotVector> knots, int dimension, Form form,
                                      PagedArray coordinates) {
  LIMN_EXPECT(!knots.empty() && knots.size() <= kMostDirections);
  LIMN_EXPECT(dimension >= 1 && dimension <= kMostDimension);
  SplineData data;
  data.directions_ = static_cast<int>(knots.size());
  data.dimension_ = dimension;
  data.form_ = form;
  std::copy(knots.begin(), knots.end(), data.knots_.begin());
  const auto width = static_cast<std::size_t>(data.width());
  std::size_t expected = 1;
  for (const KnotVector& k : knots) expected *= static_cast<std::size_t>(k.basis_count());
  if (coordinates.size() != expected * width) {
    return fail(ErrorCode::kPointCount, "control points",
                std::to_string(coordinates.size() / width) + " are given but the knots need " +
                    std::to_string(expected),
                "give one control point a basis function");
  }
  for (std::size_t i = 0; i < coordinates.size(); i += PagedArray::kPageSize) {
    if (auto finite = check_numbers(coordinates.rest_of_page(i), width, form, i); !finite) {
      return tl::unexpected(std::move(finite.error()));
    }
  }
  std::size_t stride = width;
  for (const KnotVector& k : knots) {
    const auto count = static_cast<std::size_t>(k.basis_count());
    if (k.is_periodic() &&
        !repeats_along(coordinates, stride, count, static_cast<std::size_t>(k.degree()))) {
      return fail(ErrorCode::kOutOfRange, "control points",
                  "a periodic direction does not end with its first points",
                  "repeat the first 'degree' control points at the end");
    }
    stride *= count;
  }
  data.coordinates_ = std::move(coordinates);
  if (form == Form::kRational) {
    for (std::size_t i = width - 1; i < data.coordinates_.size(); i += width) {
      if (!(data.coordinates_[i] > 0)) data.positive_weights_ = false;
    }
    if (!data.positive_weights_) {
      if (auto proved = prove_positive_denominator(data); !proved) {
        return tl::unexpected(std::move(proved.error()));
      }
    }
  }
  return data;
}

std::size_t SplineData::stride(int direction) const noexcept {
  std::size_t stride = 1;
  for (int d = 0; d < direction; ++d) stride *= static_cast<std::size_t>(knots(d).basis_count());
  return stride;
}

Expected<void> SplineData::set_control_point(std::size_t index,
                                             std::span<const double> coordinates) {
  const auto width = static_cast<std::size_t>(this->width());
  LIMN_EXPECT(index < count() && coordinates.size() == width);
  if (auto finite = check_numbers(coordinates, width, form_, index * width); !finite) return finite;
  const bool positive = !is_rational() || coordinates.back() > 0;
  const bool prove = !(positive && positive_weights_);
  const SplineData before = prove ? *this : SplineData();
  positive_weights_ = positive_weights_ && positive;

  // First and last layer of each direction that repeat this one, and how far apart they lie.
  std::array<std::size_t, kMostDirections> layer{};
  std::array<std::size_t, kMostDirections> step{};
  for (std::size_t d = 0; d < static_cast<std::size_t>(directions_); ++d) {
    const auto n = static_cast<std::size_t>(knots_[d].basis_count());
    const auto stride = this->stride(static_cast<int>(d));
    layer[d] = index / stride % n;
    step[d] = n;
    if (knots_[d].is_periodic()) step[d] -= static_cast<std::size_t>(knots_[d].degree());
    layer[d] %= step[d];
  }
  auto at = layer;
  for (;;) {
    std::size_t twin = 0;
    for (std::size_t d = static_cast<std::size_t>(directions_); d-- > 0;) {
      twin = twin * static_cast<std::size_t>(knots_[d].basis_count()) + at[d];
    }
    coordinates_.write(twin * width, coordinates);
    std::size_t d = 0;
    for (; d < static_cast<std::size_t>(directions_); ++d) {
      at[d] += step[d];
      if (at[d] < static_cast<std::size_t>(knots_[d].basis_count())) break;
      at[d] = layer[d];
    }
    if (d == static_cast<std::size_t>(directions_)) break;
  }
  if (!prove) return {};
  if (auto proved = prove_positive_denominator(*this); !proved) {
    *this = before;
    return proved;
  }
  return {};
}

}  // namespace limn
