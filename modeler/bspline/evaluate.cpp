#include "modeler/bspline/evaluate.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "modeler/bspline/spline_data.hpp"

namespace limn {
namespace {

constexpr std::size_t kD = SplineData::kMostDirections;
constexpr int kMostBasis = KnotVector::kMaxDegree + 1;
/// Results that a rational spline keeps on the stack.
constexpr std::size_t kMostOnStack = 64;

/// Which results there are: all r with r_k <= orders[k], first direction fastest.
class OrderBox {
 public:
  OrderBox(int directions, const int* orders) {
    for (int d = 0; d < directions; ++d)
      count_[static_cast<std::size_t>(d)] = static_cast<std::size_t>(orders[d]) + 1;
  }
  std::size_t size() const { return count_[0] * count_[1] * count_[2]; }
  std::size_t count(std::size_t direction) const { return count_[direction]; }
  std::size_t index(const std::array<std::size_t, kD>& r) const {
    return r[0] + count_[0] * (r[1] + count_[1] * r[2]);
  }

 private:
  std::array<std::size_t, kD> count_ = {1, 1, 1};
};

/// The derivatives of the control points' own coordinates, kWidth of them, without division.
///
/// A direction that the spline has not counts as one of degree 0 with one control point.
template <std::size_t kWidth>
void derive_coordinates(const SplineData& spline, const int* spans, const double* u,
                        const int* orders, const OrderBox& box, double* out) noexcept {
  std::array<std::array<double, kMostBasis * kMostBasis>, kD> basis;
  std::array<int, kD> order{};  // computed; above the degree all is zero
  std::array<int, kD> degree{};
  std::array<std::size_t, kD> first{};
  std::array<std::size_t, kD> line_count{1, 1, 1};
  basis[1][0] = basis[2][0] = 1;
  for (int d = 0; d < spline.directions(); ++d) {
    const auto sd = static_cast<std::size_t>(d);
    const KnotVector& knots = spline.knots(d);
    const int span = spans[d];
    degree[sd] = knots.degree();
    order[sd] = std::min(orders[d], knots.degree());
    first[sd] = static_cast<std::size_t>(span - knots.degree());
    line_count[sd] = static_cast<std::size_t>(knots.basis_count());
    knots.basis_derivatives(span, u[d], order[sd], basis[sd]);
  }
  std::fill_n(out, box.size() * kWidth, 0.0);

  const auto run = static_cast<std::size_t>(degree[0] + 1);
  std::array<double, kMostBasis * kWidth + PagedArray::kPadding> scratch;
  for (int k2 = 0; k2 <= degree[2]; ++k2) {
    for (int k1 = 0; k1 <= degree[1]; ++k1) {
      const std::size_t at =
          first[0] + line_count[0] * (first[1] + static_cast<std::size_t>(k1) +
                                      line_count[1] * (first[2] + static_cast<std::size_t>(k2)));
      const double* line = spline.coordinates().run(at * kWidth, run * kWidth, scratch.data());
      for (int r0 = 0; r0 <= order[0]; ++r0) {
        const double* b = basis[0].data() + static_cast<std::size_t>(r0) * run;
        std::array<double, kWidth> sum{};
        for (std::size_t k = 0; k < run; ++k) {
          for (std::size_t c = 0; c < kWidth; ++c) sum[c] += b[k] * line[k * kWidth + c];
        }
        for (int r2 = 0; r2 <= order[2]; ++r2) {
          for (int r1 = 0; r1 <= order[1]; ++r1) {
            const double weight = basis[1][static_cast<std::size_t>(r1 * (degree[1] + 1) + k1)] *
                                  basis[2][static_cast<std::size_t>(r2 * (degree[2] + 1) + k2)];
            double* target = out + kWidth * box.index({static_cast<std::size_t>(r0),
                                                       static_cast<std::size_t>(r1),
                                                       static_cast<std::size_t>(r2)});
            for (std::size_t c = 0; c < kWidth; ++c) target[c] += weight * sum[c];
          }
        }
      }
    }
  }
}

double binomial(std::size_t n, std::size_t k) {
  double value = 1;
  for (std::size_t i = 1; i <= k; ++i)
    value = value * static_cast<double>(n - k + i) / static_cast<double>(i);
  return value;
}

/// C^(r) = (A^(r) - sum_{0 != s <= r} binom(r, s) w^(s) C^(r - s)) / w, where the homogeneous
/// coordinates are (A, w). In order of r, so that lower derivatives are there. [PT97 4.8, 4.20]
template <std::size_t kWidth>
void divide(const OrderBox& box, const double* homogeneous, double* out) noexcept {
  constexpr std::size_t kM = kWidth - 1;
  const double w = homogeneous[kM];
  std::array<std::size_t, kD> r{};
  for (r[2] = 0; r[2] < box.count(2); ++r[2]) {
    for (r[1] = 0; r[1] < box.count(1); ++r[1]) {
      for (r[0] = 0; r[0] < box.count(0); ++r[0]) {
        std::array<double, kM> sum;
        std::copy_n(homogeneous + kWidth * box.index(r), kM, sum.begin());
        std::array<std::size_t, kD> s{};
        for (s[2] = 0; s[2] <= r[2]; ++s[2]) {
          for (s[1] = 0; s[1] <= r[1]; ++s[1]) {
            for (s[0] = 0; s[0] <= r[0]; ++s[0]) {
              const std::size_t at = box.index(s);
              const double derived_w = homogeneous[kWidth * at + kM];
              if (at == 0 || derived_w == 0) continue;
              const double factor =
                  derived_w * binomial(r[0], s[0]) * binomial(r[1], s[1]) * binomial(r[2], s[2]);
              const double* lower = out + kM * box.index({r[0] - s[0], r[1] - s[1], r[2] - s[2]});
              for (std::size_t c = 0; c < kM; ++c) sum[c] -= factor * lower[c];
            }
          }
        }
        double* target = out + kM * box.index(r);
        for (std::size_t c = 0; c < kM; ++c) target[c] = sum[c] / w;
      }
    }
  }
}

template <std::size_t kDimension>
void evaluate_as(const SplineData& spline, const int* spans, const double* u, const int* orders,
                 double* out) noexcept {
  const OrderBox box(spline.directions(), orders);
  if (!spline.is_rational())
    return derive_coordinates<kDimension>(spline, spans, u, orders, box, out);
  constexpr std::size_t kWidth = kDimension + 1;
  std::array<double, kMostOnStack * kWidth> on_stack;
  std::vector<double> on_heap;
  double* homogeneous = on_stack.data();
  if (box.size() > kMostOnStack) {
    on_heap.resize(box.size() * kWidth);
    homogeneous = on_heap.data();
  }
  derive_coordinates<kWidth>(spline, spans, u, orders, box, homogeneous);
  divide<kWidth>(box, homogeneous, out);
}

}  // namespace

void evaluate_in_spans(const SplineData& spline, const int* spans, const double* u,
                       const int* orders, double* out) noexcept {
  switch (spline.dimension()) {
    case 1:
      return evaluate_as<1>(spline, spans, u, orders, out);
    case 2:
      return evaluate_as<2>(spline, spans, u, orders, out);
    case 3:
      return evaluate_as<3>(spline, spans, u, orders, out);
    case 4:
      return evaluate_as<4>(spline, spans, u, orders, out);
    case 5:
      return evaluate_as<5>(spline, spans, u, orders, out);
    case 6:
      return evaluate_as<6>(spline, spans, u, orders, out);
    case 7:
      return evaluate_as<7>(spline, spans, u, orders, out);
    case 8:
      return evaluate_as<8>(spline, spans, u, orders, out);
    case 9:
      return evaluate_as<9>(spline, spans, u, orders, out);
    default:
      return evaluate_as<10>(spline, spans, u, orders, out);
  }
}

void evaluate(const SplineData& spline, const double* u, const int* orders, double* out) noexcept {
  std::array<double, kD> inside;
  std::array<int, kD> spans;
  for (int d = 0; d < spline.directions(); ++d) {
    const auto sd = static_cast<std::size_t>(d);
    inside[sd] = spline.knots(d).clamp(u[d]);
    spans[sd] = spline.knots(d).find_span(inside[sd]);
  }
  evaluate_in_spans(spline, spans.data(), inside.data(), orders, out);
}

}  // namespace limn
