#include "modeler/bspline/control_point_map.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

namespace limn {
namespace {

constexpr std::size_t kMostBasis = KnotVector::kMaxDegree + 1;
using Row = std::array<double, kMostBasis>;

/// The polar form (blossom) of the polynomial piece on `span`, as weights of the p + 1 control
/// points P_{span-p} .. P_{span} that make it:
///
///     f(x_1, .., x_p) = sum_k row[k] P_{span-p+k}.    [Ramshaw89]
///
/// A control point on other knots is the polar form at them, so this gives refinement rows. The
/// recursion is the one of the basis functions with a different argument a step.
Row blossom(const KnotVector& knots, int span, std::span<const double> arguments) {
  const int p = knots.degree();
  const double* knot = knots.values().data() + span;
  Row row{};
  row[0] = 1;
  for (int j = 1; j <= p; ++j) {
    const double x = arguments[static_cast<std::size_t>(j - 1)];
    double saved = 0;
    for (int r = 0; r < j; ++r) {
      const auto sr = static_cast<std::size_t>(r);
      const double low = knot[r + 1 - j];
      const double high = knot[r + 1];
      const double share = row[sr] / (high - low);
      row[sr] = saved + (high - x) * share;
      saved = (x - low) * share;
    }
    row[static_cast<std::size_t>(j)] = saved;
  }
  return row;
}

/// Where to take the polar form for a new function of support [low, high], and in which order its
/// arguments, so that all steps are convex combinations: on the span where the support begins, with
/// ascending arguments (this is the Oslo algorithm, [CLR80]); if that lies before the domain, on
/// the one where it ends, with descending arguments. Any other span under the support gives the
/// same row in exact arithmetic only: the arguments would lie far outside it.
struct Place {
  int span;
  bool ascending;
};

Place place_of(const KnotVector& knots, double low, double high) {
  if (low >= knots.domain_begin()) return {knots.find_span(low), true};
  const int span = knots.find_span(high);  // the last non-empty one at and after the domain's end
  if (high >= knots.domain_end()) return {span, false};
  // The span that ends at `high` where that is a knot.
  int before = span;
  while (knots.values()[static_cast<std::size_t>(before)] >= high) --before;
  return {before, false};
}

/// Rows of a refinement, one a new control point, from `row_of(i)` for each new function i.
template <class RowOf>
ControlPointMap make_map(const KnotVector& from, const KnotVector& to, RowOf row_of) {
  const int width = from.degree() + 1;
  const int rows = to.basis_count();
  std::vector<int> first;
  first.reserve(static_cast<std::size_t>(rows));
  std::vector<double> coefficients;
  coefficients.reserve(static_cast<std::size_t>(rows) * static_cast<std::size_t>(width));
  for (int i = 0; i < rows; ++i) {
    const auto [span, row] = row_of(i);
    first.push_back(span - from.degree());
    coefficients.insert(coefficients.end(), row.begin(), row.begin() + width);
  }
  return ControlPointMap(from.basis_count(), width, std::move(first), std::move(coefficients));
}

/// The map to knots of the same degree that hold all old ones where both have a domain.
ControlPointMap refining_map(const KnotVector& from, const KnotVector& to) {
  const int p = from.degree();
  const double* knot = to.values().data();
  return make_map(from, to, [&](int i) {
    const Place place = place_of(from, knot[i], knot[i + p + 1]);
    std::array<double, kMostBasis> arguments;
    std::copy_n(knot + i + 1, p, arguments.begin());
    if (!place.ascending) std::reverse(arguments.begin(), arguments.begin() + p);
    return std::pair(place.span,
                     blossom(from, place.span, {arguments.data(), static_cast<std::size_t>(p)}));
  });
}

/// The knots of one period, [begin, end), the seam's all at the front.
std::vector<double> knots_of_round(const KnotVector& knots) {
  const auto& values = knots.values();
  const auto n = static_cast<std::ptrdiff_t>(knots.basis_count());
  const double begin = knots.domain_begin();
  std::vector<double> round(values.begin() + knots.degree(), values.begin() + n);
  const auto seam =
      static_cast<std::size_t>(std::count(values.begin(), values.begin() + knots.degree(), begin));
  // Copies of the seam knot stand before the domain at its begin, inside it at its end.
  round.resize(round.size() - seam);
  round.insert(round.begin(), seam, begin);
  return round;
}

Expected<KnotVector> with_knots(const KnotVector& knots, std::vector<double> added) {
  std::sort(added.begin(), added.end());
  if (knots.is_periodic()) {
    const auto round = knots_of_round(knots);
    for (double& u : added) {
      if (u == knots.domain_end()) u = knots.domain_begin();
    }
    std::sort(added.begin(), added.end());
    std::vector<double> merged(round.size() + added.size());
    std::merge(round.begin(), round.end(), added.begin(), added.end(), merged.begin());
    return KnotVector::make_periodic(knots.degree(), merged, knots.domain_end());
  }
  std::vector<double> merged(knots.values().size() + added.size());
  std::merge(knots.values().begin(), knots.values().end(), added.begin(), added.end(),
             merged.begin());
  return KnotVector::make(knots.degree(), std::move(merged));
}

Expected<KnotVector> elevated_knots(const KnotVector& knots) {
  const int degree = knots.degree() + 1;
  if (knots.is_periodic()) {
    auto round = knots_of_round(knots);
    std::vector<double> distinct = round;
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    std::vector<double> merged(round.size() + distinct.size());
    std::merge(round.begin(), round.end(), distinct.begin(), distinct.end(), merged.begin());
    return KnotVector::make_periodic(degree, merged, knots.domain_end());
  }
  // Knots outside the domain only shape the end functions; the old ones do, as many as there are.
  const auto& old = knots.values();
  const auto p = static_cast<std::ptrdiff_t>(knots.degree());
  const auto n = static_cast<std::ptrdiff_t>(knots.basis_count());
  std::vector<double> values(old.begin(), old.begin() + p);
  for (std::ptrdiff_t i = p; i <= n; ++i) {
    const double u = old[static_cast<std::size_t>(i)];
    if (i == p || u != old[static_cast<std::size_t>(i - 1)]) values.push_back(u);
    values.push_back(u);
  }
  values.insert(values.end(), old.begin() + n + 1, old.end());
  return KnotVector::make(degree, std::move(values));
}

KnotRefinement elevate_once(const KnotVector& from, const KnotVector& to) {
  const int p = from.degree();
  const double* knot = to.values().data();
  auto map = make_map(from, to, [&](int i) {
    const Place place = place_of(from, knot[i], knot[i + p + 2]);
    std::array<double, kMostBasis + 1> inner;  // the p + 1 knots inside the support
    std::copy_n(knot + i + 1, p + 1, inner.begin());
    if (!place.ascending) std::reverse(inner.begin(), inner.begin() + p + 1);
    Row sum{};
    std::array<double, kMostBasis> arguments;
    for (int left_out = 0; left_out <= p; ++left_out) {
      std::size_t count = 0;
      for (int k = 0; k <= p; ++k) {
        if (k != left_out) arguments[count++] = inner[static_cast<std::size_t>(k)];
      }
      const Row row = blossom(from, place.span, {arguments.data(), count});
      for (std::size_t k = 0; k < row.size(); ++k) sum[k] += row[k] / (p + 1);
    }
    return std::pair(place.span, sum);
  });
  return {to, std::move(map)};
}

ControlPointMap identity(int count) {
  std::vector<int> first(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) first[static_cast<std::size_t>(i)] = i;
  return ControlPointMap(count, 1, std::move(first),
                         std::vector<double>(static_cast<std::size_t>(count), 1.0));
}

}  // namespace

ControlPointMap::ControlPointMap(int columns, int width, std::vector<int> first,
                                 std::vector<double> coefficients)
    : columns_(columns),
      width_(width),
      first_(std::move(first)),
      coefficients_(std::move(coefficients)) {
  LIMN_EXPECT(coefficients_.size() == first_.size() * static_cast<std::size_t>(width_));
  parts_.reserve(first_.size());
  for (int r = 0; r < rows(); ++r) {
    const std::span<const double> a = row(r);
    std::size_t begin = 0;
    std::size_t end = a.size();
    while (end - begin > 1 && a[begin] == 0) ++begin;
    while (end - begin > 1 && a[end - 1] == 0) --end;
    const auto at = static_cast<std::ptrdiff_t>(begin);
    const Part part{this->first(r) + static_cast<int>(begin), static_cast<int>(end - begin),
                    std::ptrdiff_t{r} * width_ + at};
    parts_.push_back(part);
  }
}

ControlPointMap compose(const ControlPointMap& outer, const ControlPointMap& inner) {
  LIMN_EXPECT(outer.columns() == inner.rows());
  int width = 1;
  std::vector<int> first(static_cast<std::size_t>(outer.rows()));
  std::vector<int> last(first.size());
  for (int r = 0; r < outer.rows(); ++r) {
    int low = inner.columns();
    int high = 0;
    for (int k = 0; k < outer.width(); ++k) {
      low = std::min(low, inner.first(outer.first(r) + k));
      high = std::max(high, inner.first(outer.first(r) + k) + inner.width());
    }
    first[static_cast<std::size_t>(r)] = low;
    width = std::max(width, high - low);
  }
  std::vector<double> coefficients(first.size() * static_cast<std::size_t>(width));
  for (int r = 0; r < outer.rows(); ++r) {
    int& low = first[static_cast<std::size_t>(r)];
    low = std::min(low, inner.columns() - width);
    double* out = coefficients.data() + static_cast<std::ptrdiff_t>(r) * width;
    for (int k = 0; k < outer.width(); ++k) {
      const int middle = outer.first(r) + k;
      const auto row = inner.row(middle);
      for (std::size_t j = 0; j < row.size(); ++j) {
        out[static_cast<std::size_t>(inner.first(middle) - low) + j] +=
            outer.row(r)[static_cast<std::size_t>(k)] * row[j];
      }
    }
  }
  return ControlPointMap(inner.columns(), width, std::move(first), std::move(coefficients));
}

Expected<KnotRefinement> insert_knots(const KnotVector& knots, std::span<const double> added) {
  for (std::size_t i = 0; i < added.size(); ++i) {
    if (!(added[i] >= knots.domain_begin() && added[i] <= knots.domain_end())) {
      return fail(ErrorCode::kOutOfRange, "added knot " + std::to_string(i),
                  "the value lies outside the domain", "insert knots inside the domain only");
    }
  }
  auto to = with_knots(knots, {added.begin(), added.end()});
  if (!to) return tl::unexpected(std::move(to.error()));
  auto map = refining_map(knots, *to);
  return KnotRefinement{*std::move(to), std::move(map)};
}

Expected<KnotRefinement> elevate_degree(const KnotVector& knots, int by) {
  if (by < 0 || by > KnotVector::kMaxDegree - knots.degree()) {
    return fail(ErrorCode::kOutOfRange, "degree",
                "raising " + std::to_string(knots.degree()) + " by " + std::to_string(by) +
                    " leaves 0 to " + std::to_string(KnotVector::kMaxDegree),
                "raise the degree less");
  }
  KnotRefinement out{knots, identity(knots.basis_count())};
  for (int step = 0; step < by; ++step) {
    auto to = elevated_knots(out.knots);
    if (!to) return tl::unexpected(std::move(to.error()));
    KnotRefinement once = elevate_once(out.knots, *to);
    out = {std::move(once.knots), compose(once.map, out.map)};
  }
  return out;
}

Expected<KnotRefinement> segment_knots(const KnotVector& knots, double low, double high) {
  if (!(knots.domain_begin() <= low && low < high && high <= knots.domain_end())) {
    return fail(ErrorCode::kOutOfRange, "parameters",
                "a part must begin before it ends, and lie in the domain",
                "choose two parameters of the domain in ascending order");
  }
  std::vector<double> interior;
  for (const double u : knots.values()) {
    if (u > low && u < high) interior.push_back(u);
  }
  const int p = knots.degree();
  auto to = KnotVector::make_clamped(p, low, high, interior);
  if (!to) return tl::unexpected(std::move(to.error()));
  auto map = refining_map(knots, *to);
  return KnotRefinement{*std::move(to), std::move(map)};
}

KnotRefinement bezier_knots(const KnotVector& knots) {
  const int p = knots.degree();
  std::vector<double> interior;
  for (const double u : knots.breakpoints()) {
    if (u == knots.domain_begin() || u == knots.domain_end()) continue;
    const int times = std::max(knots.multiplicity(u), std::max(p, 1));
    interior.insert(interior.end(), static_cast<std::size_t>(times), u);
  }
  // More of the values that were legal stays legal.
  KnotVector to = *KnotVector::make_clamped(p, knots.domain_begin(), knots.domain_end(), interior);
  auto map = refining_map(knots, to);
  return {std::move(to), std::move(map)};
}

Expected<KnotRefinement> reverse_knots(const KnotVector& knots) {
  const double begin = knots.domain_begin();
  const double end = knots.domain_end();
  const double sum = begin + end;
  const auto turned = [&](double u) { return u == begin ? end : u == end ? begin : sum - u; };
  const int n = knots.basis_count();
  std::vector<double> values;
  // Function i of the turned direction is function last - i of this one; a periodic one counts from
  // the last of equal seam knots either way.
  int last = n - 1;
  Expected<KnotVector> to = knots;
  if (knots.is_periodic()) {
    const auto round = knots_of_round(knots);
    const auto seam = std::count(round.begin(), round.end(), begin);
    values.assign(static_cast<std::size_t>(seam), begin);
    for (std::size_t i = round.size(); i-- > static_cast<std::size_t>(seam);) {
      values.push_back(turned(round[i]));
    }
    last = n - static_cast<int>(seam);
    to = KnotVector::make_periodic(knots.degree(), values, end);
  } else {
    for (std::size_t i = knots.values().size(); i-- > 0;)
      values.push_back(turned(knots.values()[i]));
    to = KnotVector::make(knots.degree(), std::move(values));
  }
  if (!to) return tl::unexpected(std::move(to.error()));
  const int round_count = knots.is_periodic() ? n - knots.degree() : n;
  std::vector<int> first;
  for (int i = 0; i < n; ++i) {
    const int old = (last - i) % round_count;
    first.push_back(old < 0 ? old + round_count : old);
  }
  return KnotRefinement{*std::move(to),
                        ControlPointMap(n, 1, std::move(first),
                                        std::vector<double>(static_cast<std::size_t>(n), 1.0))};
}

std::vector<double> bezier_extraction(const KnotVector& knots, int span) {
  const int p = knots.degree();
  const double begin = knots.values()[static_cast<std::size_t>(span)];
  const double end = knots.values()[static_cast<std::size_t>(span) + 1];
  std::vector<double> out;
  out.reserve(static_cast<std::size_t>((p + 1) * (p + 1)));
  std::array<double, kMostBasis> arguments;
  for (int r = 0; r <= p; ++r) {
    std::fill_n(arguments.begin(), p - r, begin);
    std::fill_n(arguments.begin() + (p - r), r, end);
    const Row row = blossom(knots, span, {arguments.data(), static_cast<std::size_t>(p)});
    out.insert(out.end(), row.begin(), row.begin() + p + 1);
  }
  return out;
}

}  // namespace limn
