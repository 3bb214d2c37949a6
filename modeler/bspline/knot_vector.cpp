#include "modeler/bspline/knot_vector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "input/base/expect.hpp"
#include "modeler/bspline/basis.hpp"

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

}  // namespace

std::shared_ptr<const KnotVector::Table> KnotVector::make_table(int degree,
                                                                std::vector<double> values) {
  auto table = std::make_shared<Table>();
  table->values = std::move(values);
  const double* knot = table->values.data();
  const int end = static_cast<int>(table->values.size()) - degree - 1;
  int spans = 0;
  for (int s = degree; s < end; ++s) spans += knot[s] < knot[s + 1] ? 1 : 0;
  const double length = knot[end] - knot[degree];
  table->cells_per_unit = spans / length;
  if (!std::isfinite(table->cells_per_unit)) table->cells_per_unit = 0;
  table->last_span.assign(static_cast<std::size_t>(spans) + 1, -1);
  for (int s = degree; s < end; ++s) {
    if (!(knot[s] < knot[s + 1])) continue;
    const auto cell = static_cast<std::size_t>((knot[s] - knot[degree]) * table->cells_per_unit);
    const std::size_t next = std::min(cell, static_cast<std::size_t>(spans) - 1) + 1;
    table->last_span[next] = s;  // ascending: the last one in the cell stays
    if (table->last_span[0] < 0) table->last_span[0] = s;
  }
  for (std::size_t c = 1; c < table->last_span.size(); ++c) {
    table->last_span[c] = std::max(table->last_span[c], table->last_span[c - 1]);
  }
  return table;
}

KnotVector::KnotVector() {
  static const std::shared_ptr<const Table> kConstant = make_table(0, {0.0, 1.0});
  table_ = kConstant;
}

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
  const std::vector<double>& old = values();
  std::vector<double> rotated;
  rotated.reserve(old.size());
  const int count = static_cast<int>(old.size());
  for (int i = 0; i < count; ++i) {
    const int turns = i + shift < count ? 0 : 1 + (i + shift - count) / round;
    rotated.push_back(old[static_cast<std::size_t>(i + shift - turns * round)] + turns * period);
  }
  return make(degree_, std::move(rotated), Closure::kPeriodic);
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
  const double* knot = values().data();
  const double begin = domain_begin();
  const Table& table = *table_;
  if (!(u < domain_end()))
    return table.last_span.back();  // the left-hand limit; NaN lands here too
  // Rounding cannot put a parameter into another cell than its knots expect: subtraction and
  // multiplication are monotone.
  const auto cell = u > begin ? static_cast<std::size_t>((u - begin) * table.cells_per_unit) : 0;
  const std::size_t low = std::min(cell, table.last_span.size() - 2);
  int first = table.last_span[low];
  int last = table.last_span[low + 1];
  while (first < last) {  // the last knot <= u of u_first .. u_last
    const int middle = first + (last - first + 1) / 2;
    if (knot[middle] <= u) {
      first = middle;
    } else {
      last = middle - 1;
    }
  }
  return first;
}

void KnotVector::basis(int span, double u, std::span<double> out) const noexcept {
  LIMN_EXPECT(out.size() > static_cast<std::size_t>(degree_));
  bspline_detail::basis(values().data() + span, degree_, u, out.data());
}

void KnotVector::basis_derivatives(int span, double u, int order,
                                   std::span<double> out) const noexcept {
  LIMN_EXPECT(order >= 0 && out.size() >= static_cast<std::size_t>((degree_ + 1) * (order + 1)));
  bspline_detail::basis_derivatives(values().data() + span, degree_, u, order, out.data());
}

double KnotVector::greville(int i) const noexcept {
  const auto at = values().begin() + i;
  if (degree_ == 0) return 0.5 * (at[0] + at[1]);
  double sum = 0;
  for (int k = 1; k <= degree_; ++k) sum += at[k] / degree_;  // no overflow for huge knots
  return sum;
}

int KnotVector::multiplicity(double u) const noexcept {
  const auto [first, last] = std::equal_range(values().begin(), values().end(), u);
  return static_cast<int>(last - first);
}

std::vector<double> KnotVector::breakpoints() const {
  std::vector<double> out(values().begin() + degree_, values().begin() + basis_count() + 1);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace limn
