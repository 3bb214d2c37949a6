#include "modeler/bspline/knot_vector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "input/base/expect.hpp"

namespace limn {
namespace {

/// Distinct knots nearer than this cannot be divided by: quotients of the basis would overflow.
constexpr double kSmallestSpan = 1e-200;

/// Rounding allowed between a periodic direction's knots and their images, relative to the largest
/// knot: a few units in the last place of sums like u + T.
constexpr double kPeriodRounding = 1e-14;

std::string knot_place(std::size_t i) { return "knot " + std::to_string(i); }

tl::unexpected<Error> dead_end_knots(std::size_t at) {
  return fail(ErrorCode::kOutOfRange, knot_place(at),
              "the domain's end leaves a basis function without support",
              "let the domain end with the last of its equal knots");
}

/// The conditions on the values alone: finite, ascending, not too close, multiplicity.
Expected<void> check_values(int degree, const std::vector<double>& values, Closure closure) {
  const int most = closure == Closure::kPeriodic ? degree : degree + 1;
  int multiplicity = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      return fail(ErrorCode::kOutOfRange, knot_place(i), "the value is not finite",
                  "give finite knots");
    }
    if (i > 0 && values[i] < values[i - 1]) {
      return fail(ErrorCode::kOutOfRange, knot_place(i), "the value is below the one before it",
                  "sort the knots");
    }
    if (i > 0 && values[i] != values[i - 1] && values[i] - values[i - 1] < kSmallestSpan) {
      return fail(ErrorCode::kOutOfRange, knot_place(i),
                  "the value is too close to the one before it to divide by",
                  "make the knots equal or move them apart");
    }
    multiplicity = i > 0 && values[i] == values[i - 1] ? multiplicity + 1 : 1;
    if (multiplicity > most) {
      return fail(ErrorCode::kOutOfRange, knot_place(i),
                  "the value occurs more than " + std::to_string(most) + " times",
                  "lower its multiplicity");
    }
  }
  if (!values.empty() && !std::isfinite(values.back() - values.front())) {
    return fail(ErrorCode::kOutOfRange, knot_place(values.size() - 1),
                "the knots span more than a double holds", "scale the knots down");
  }
  return {};
}

/// out[k] = N_{s-q+k,q}(u) for k <= q, where knot points at u_s. [PT97 A2.2]
void basis_of_degree(const double* knot, int q, double u, std::span<double> out) noexcept {
  std::array<double, KnotVector::kMaxDegree + 1> left;
  std::array<double, KnotVector::kMaxDegree + 1> right;
  out[0] = 1;
  for (int j = 1; j <= q; ++j) {
    const auto sj = static_cast<std::size_t>(j);
    left[sj] = u - knot[1 - j];
    right[sj] = knot[j] - u;
    double saved = 0;
    for (std::size_t r = 0; r < sj; ++r) {
      const double share = out[r] / (right[r + 1] + left[sj - r]);
      out[r] = saved + right[r + 1] * share;
      saved = left[sj - r] * share;
    }
    out[sj] = saved;
  }
}

}  // namespace

Expected<KnotVector> KnotVector::make(int degree, std::vector<double> values, Closure closure) {
  const int least_degree = closure == Closure::kPeriodic ? 1 : 0;
  if (degree < least_degree || degree > kMaxDegree) {
    return fail(ErrorCode::kOutOfRange, "degree",
                std::to_string(degree) + " is not " + std::to_string(least_degree) + " to " +
                    std::to_string(kMaxDegree),
                "choose a degree in that range");
  }
  const auto p = static_cast<std::size_t>(degree);
  if (values.size() < 2 * (p + 1) ||
      values.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    return fail(ErrorCode::kPointCount, "knots",
                std::to_string(values.size()) + " values are given; degree " +
                    std::to_string(degree) + " needs at least " + std::to_string(2 * (p + 1)),
                "give one knot a control point plus degree + 1");
  }
  if (auto checked = check_values(degree, values, closure); !checked) {
    return tl::unexpected(std::move(checked.error()));
  }
  const std::size_t n = values.size() - p - 1;
  if (values[p] == values[p + 1]) return dead_end_knots(p);
  if (closure == Closure::kOpen) {
    if (values[n - 1] == values[n]) return dead_end_knots(n);
    return KnotVector(degree, std::move(values), closure);
  }
  const double period = values[n] - values[p];
  const double rounding =
      kPeriodRounding * (std::abs(values.front()) + std::abs(values.back()) + period);
  for (std::size_t j = 0; j + (n - p) < values.size(); ++j) {
    if (std::abs(values[j + (n - p)] - values[j] - period) > rounding) {
      return fail(ErrorCode::kNumeric, knot_place(j + (n - p)),
                  "the value is not one period after knot " + std::to_string(j),
                  "repeat the spans next to the seam");
    }
  }
  return KnotVector(degree, std::move(values), closure);
}

Expected<KnotVector> KnotVector::make_clamped(int degree, double begin, double end,
                                              std::span<const double> interior) {
  const auto ends = static_cast<std::size_t>(std::clamp(degree, 0, kMaxDegree)) + 1;
  std::vector<double> values(ends, begin);
  values.insert(values.end(), interior.begin(), interior.end());
  values.insert(values.end(), ends, end);
  return make(degree, std::move(values));
}

Expected<KnotVector> KnotVector::make_periodic(int degree, std::span<const double> round,
                                               double end) {
  if (round.empty()) {
    return fail(ErrorCode::kPointCount, "knots", "a period without knots is given",
                "give at least its first knot");
  }
  if (degree < 1 || degree > kMaxDegree) return make(degree, {}, Closure::kPeriodic);
  const double begin = round.front();
  const double period = end - begin;
  const auto count = static_cast<std::ptrdiff_t>(round.size());
  std::ptrdiff_t seam = 0;  // index of the last knot equal to the first
  while (seam + 1 < count && round[static_cast<std::size_t>(seam + 1)] == begin) ++seam;
  // value(i) of the endless periodic sequence, value(0) being the domain's begin.
  std::vector<double> values;
  for (std::ptrdiff_t i = -degree; i <= count + degree; ++i) {
    std::ptrdiff_t in_round = (i + seam) % count;
    if (in_round < 0) in_round += count;
    const std::ptrdiff_t turn = (i + seam - in_round) / count;
    const double base = round[static_cast<std::size_t>(in_round)];
    // The seam's image must equal `end` bit for bit: begin + (end - begin) may not.
    values.push_back(turn == 1 && base == begin ? end : base + static_cast<double>(turn) * period);
  }
  return make(degree, std::move(values), Closure::kPeriodic);
}

Expected<KnotVector> KnotVector::rotated(int shift) const {
  const int round = basis_count() - degree_;
  LIMN_EXPECT(is_periodic() && shift >= 0 && shift < round);
  const double period = domain_end() - domain_begin();
  std::vector<double> values;
  values.reserve(values_.size());
  const int count = static_cast<int>(values_.size());
  for (int i = 0; i < count; ++i) {
    const int turns = i + shift < count ? 0 : 1 + (i + shift - count) / round;
    values.push_back(values_[static_cast<std::size_t>(i + shift - turns * round)] + turns * period);
  }
  return make(degree_, std::move(values), Closure::kPeriodic);
}

double KnotVector::clamp(double u) const noexcept {
  const double begin = domain_begin();
  const double end = domain_end();
  if (is_periodic() && (u < begin || u > end)) {
    const double period = end - begin;
    u = begin + std::fmod(u - begin, period);
    if (u < begin) u += period;
  }
  return std::clamp(u, begin, end);
}

int KnotVector::find_span(double u) const noexcept {
  const auto begin = values_.begin() + degree_;
  const auto end = values_.begin() + basis_count();
  if (!(u < *end)) {  // the last non-empty span, for the left-hand limit; NaN lands here too
    return static_cast<int>(std::lower_bound(begin, end, *end) - values_.begin()) - 1;
  }
  const auto above = std::upper_bound(begin + 1, end, u);
  return static_cast<int>(above - values_.begin()) - 1;
}

void KnotVector::basis(int span, double u, std::span<double> out) const noexcept {
  LIMN_EXPECT(out.size() > static_cast<std::size_t>(degree_));
  basis_of_degree(values_.data() + span, degree_, u, out);
}

void KnotVector::basis_derivatives(int span, double u, int order,
                                   std::span<double> out) const noexcept {
  const int p = degree_;
  const auto width = static_cast<std::size_t>(p + 1);
  LIMN_EXPECT(order >= 0 && out.size() >= width * static_cast<std::size_t>(order + 1));
  basis(span, u, out);
  const double* knot = values_.data() + span;
  // The r-th derivative of N_{.,p} comes from N_{.,p-r} by r steps of
  // N'_{i,q} = q (N_{i,q-1} / (u_{i+q} - u_i) - N_{i+1,q-1} / (u_{i+q+1} - u_{i+1})).
  std::array<double, kMaxDegree + 2> lower;
  for (int r = 1; r <= order; ++r) {
    const std::span<double> row = out.subspan(width * static_cast<std::size_t>(r), width);
    if (r > p) {
      std::fill(row.begin(), row.end(), 0.0);
      continue;
    }
    const int q0 = p - r;
    lower.fill(0);  // lower[k] = N_{span-q+k,q} while q grows from q0 to p
    basis_of_degree(knot, q0, u, lower);
    for (int q = q0 + 1; q <= p; ++q) {
      for (int k = q; k >= 0; --k) {  // downwards, so that lower[k - 1] is still of degree q - 1
        const auto sk = static_cast<std::size_t>(k);
        const double from_left = k > 0 ? lower[sk - 1] / (knot[k] - knot[k - q]) : 0.0;
        const double from_right = k < q ? lower[sk] / (knot[k + 1] - knot[k + 1 - q]) : 0.0;
        lower[sk] = q * (from_left - from_right);
      }
    }
    std::copy_n(lower.begin(), width, row.begin());
  }
}

double KnotVector::greville(int i) const noexcept {
  const auto at = values_.begin() + i;
  if (degree_ == 0) return 0.5 * (at[0] + at[1]);
  double sum = 0;
  for (int k = 1; k <= degree_; ++k) sum += at[k] / degree_;  // no overflow for huge knots
  return sum;
}

int KnotVector::multiplicity(double u) const noexcept {
  const auto [first, last] = std::equal_range(values_.begin(), values_.end(), u);
  return static_cast<int>(last - first);
}

std::vector<double> KnotVector::breakpoints() const {
  std::vector<double> out(values_.begin() + degree_, values_.begin() + basis_count() + 1);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace limn
