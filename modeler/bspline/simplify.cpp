#include "modeler/bspline/simplify.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace limn {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A row of a refinement is a copy of a control point if its coefficient is 1 to rounding.
constexpr double kUnitRounding = 1e-13;

/// A refinement's map with the repetitions of periodic directions folded away: what is linearly
/// independent of it.
Eigen::MatrixXd folded(const KnotVector& from, const KnotRefinement& to) {
  const auto independent = [](const KnotVector& k) {
    return k.basis_count() - (k.is_periodic() ? k.degree() : 0);
  };
  const int columns = independent(from);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(independent(to.knots), columns);
  for (int r = 0; r < out.rows(); ++r) {
    const auto row = to.map.row(r);
    for (std::size_t k = 0; k < row.size(); ++k) {
      out(r, (to.map.first(r) + static_cast<int>(k)) % columns) += row[k];
    }
  }
  return out;
}

/// The map that undoes `refined`, which was made from `knots`: exactly where it copies a control
/// point, by least squares for the rest.
ControlPointMap undo(const KnotVector& knots, const KnotRefinement& refined) {
  const Eigen::MatrixXd forward = folded(knots, refined);
  const Eigen::Index rows = forward.rows();
  const Eigen::Index columns = forward.cols();
  std::vector<std::vector<Eigen::Index>> copies(static_cast<std::size_t>(columns));
  std::vector<bool> is_copy(static_cast<std::size_t>(rows), false);
  for (Eigen::Index r = 0; r < rows; ++r) {
    Eigen::Index column = 0;
    const double largest = forward.row(r).cwiseAbs().maxCoeff(&column);
    const double rest = forward.row(r).cwiseAbs().sum() - largest;
    if (std::abs(largest - 1) < kUnitRounding && rest < kUnitRounding) {
      copies[static_cast<std::size_t>(column)].push_back(r);
      is_copy[static_cast<std::size_t>(r)] = true;
    }
  }
  std::vector<Eigen::Index> unknown;
  std::vector<Eigen::Index> equations;
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(columns, rows);
  for (Eigen::Index c = 0; c < columns; ++c) {
    const auto& of = copies[static_cast<std::size_t>(c)];
    if (of.size() == 1) {
      inverse(c, of.front()) = 1;
    } else {
      unknown.push_back(c);
      equations.insert(equations.end(), of.begin(), of.end());
    }
  }
  for (Eigen::Index r = 0; r < rows; ++r) {
    if (!is_copy[static_cast<std::size_t>(r)]) equations.push_back(r);
  }
  if (!unknown.empty()) {
    // forward_unknown x = (1 - forward_known inverse_known) q, in the equations.
    Eigen::MatrixXd right = -forward(equations, Eigen::all) * inverse;
    for (std::size_t i = 0; i < equations.size(); ++i) {
      right(static_cast<Eigen::Index>(i), equations[i]) += 1;
    }
    inverse(unknown, Eigen::all) =
        Eigen::MatrixXd(forward(equations, unknown)).colPivHouseholderQr().solve(right);
  }
  // Back to wrapped form; rows as wide as the widest.
  const int out_rows = knots.basis_count();
  int width = 1;
  std::vector<int> first(static_cast<std::size_t>(out_rows), 0);
  for (int r = 0; r < out_rows; ++r) {
    Eigen::Index low = 0;
    Eigen::Index high = rows - 1;
    const auto row = inverse.row(r % static_cast<int>(columns));
    while (low < high && row[low] == 0) ++low;
    while (high > low && row[high] == 0) --high;
    first[static_cast<std::size_t>(r)] = static_cast<int>(low);
    width = std::max(width, static_cast<int>(high - low) + 1);
  }
  std::vector<double> coefficients;
  for (int r = 0; r < out_rows; ++r) {
    int& low = first[static_cast<std::size_t>(r)];
    low = std::min(low, static_cast<int>(rows) - width);
    for (int k = 0; k < width; ++k)
      coefficients.push_back(inverse(r % static_cast<int>(columns), low + k));
  }
  return ControlPointMap(refined.knots.basis_count(), width, std::move(first),
                         std::move(coefficients));
}

/// The knots without one of those equal to u.
Expected<KnotVector> without(const KnotVector& knots, double u) {
  std::vector<double> values = knots.values();
  if (!knots.is_periodic()) {
    values.erase(std::find(values.begin(), values.end(), u));
    return KnotVector::make(knots.degree(), std::move(values));
  }
  std::vector<double> round;
  const auto seam = knots.multiplicity(knots.domain_begin());
  round.assign(static_cast<std::size_t>(seam), knots.domain_begin());
  for (const double x : values) {
    if (x > knots.domain_begin() && x < knots.domain_end()) round.push_back(x);
  }
  round.erase(std::find(round.begin(), round.end(), u));
  return KnotVector::make_periodic(knots.degree(), round, knots.domain_end());
}

Expected<Simplified<SplineData>> with_deviation(const SplineData& before, int direction,
                                                const KnotRefinement& simpler,
                                                const KnotRefinement& back) {
  auto after = refine(before, direction, simpler);
  if (!after) return tl::unexpected(std::move(after.error()));
  auto again = refine(*after, direction, back);
  if (!again) return tl::unexpected(std::move(again.error()));
  const double deviation = largest_difference(*again, before);
  return Simplified<SplineData>{*std::move(after), deviation};
}

}  // namespace

double largest_difference(const SplineData& a, const SplineData& b) {
  const auto width = static_cast<std::size_t>(a.width());
  const auto dimension = static_cast<std::size_t>(a.dimension());
  const std::vector<double> x = a.coordinates().to_vector();
  const std::vector<double> y = b.coordinates().to_vector();
  // With b's points near an origin o, C_a - C_b = ((A_a - w_a o) - (A_b - w_b o)
  //   - (C_b - o) (w_a - w_b)) / w_a.
  std::vector<double> origin(dimension, 0.0);
  double least_weight = 1;
  double reach = 0;
  if (a.is_rational()) {
    least_weight = kInfinity;
    for (std::size_t i = 0; i < x.size(); i += width) {
      const double w = y[i + dimension];
      least_weight = std::min({least_weight, x[i + dimension], w});
      for (std::size_t c = 0; c < dimension; ++c) {
        origin[c] += y[i + c] / w / static_cast<double>(a.count());
      }
    }
    if (!(least_weight > 0)) return kInfinity;
    for (std::size_t i = 0; i < x.size(); i += width) {
      double square = 0;
      for (std::size_t c = 0; c < dimension; ++c) {
        square += std::pow(y[i + c] / y[i + dimension] - origin[c], 2);
      }
      reach = std::max(reach, std::sqrt(square));
    }
  }
  double largest = 0;
  for (std::size_t i = 0; i < x.size(); i += width) {
    const double by_weight = a.is_rational() ? x[i + dimension] - y[i + dimension] : 0.0;
    double square = 0;
    for (std::size_t c = 0; c < dimension; ++c) {
      square += std::pow(x[i + c] - y[i + c] - by_weight * origin[c], 2);
    }
    largest = std::max(largest, (std::sqrt(square) + reach * std::abs(by_weight)) / least_weight);
  }
  return largest;
}

Expected<KnotRefinement> remove_knot(const KnotVector& knots, double u) {
  if (!(u > knots.domain_begin() && u < knots.domain_end()) || knots.multiplicity(u) == 0) {
    return fail(ErrorCode::kMissing, "knots", "there is no such knot inside the domain",
                "name one of the interior knots");
  }
  auto to = without(knots, u);
  if (!to) return tl::unexpected(std::move(to.error()));
  const double added[] = {u};
  auto back = insert_knots(*to, added);
  if (!back) return tl::unexpected(std::move(back.error()));
  auto map = undo(*to, *back);
  return KnotRefinement{*std::move(to), std::move(map)};
}

Expected<Simplified<SplineData>> remove_knot(const SplineData& spline, int direction, double u) {
  auto simpler = remove_knot(spline.knots(direction), u);
  if (!simpler) return tl::unexpected(std::move(simpler.error()));
  const double added[] = {u};
  auto back = insert_knots(simpler->knots, added);
  if (!back) return tl::unexpected(std::move(back.error()));
  return with_deviation(spline, direction, *simpler, *back);
}

Simplified<SplineData> remove_knots(const SplineData& spline, int direction, double tolerance) {
  Simplified<SplineData> best{spline, 0};
  for (;;) {
    // The knot that costs least now.
    std::optional<Simplified<SplineData>> least;
    for (const double u : best.spline.knots(direction).breakpoints()) {
      auto candidate = remove_knot(best.spline, direction, u);
      if (candidate && (!least || candidate->deviation < least->deviation)) {
        least = *std::move(candidate);
      }
    }
    if (!least || !(best.deviation + least->deviation <= tolerance)) return best;
    best = {std::move(least->spline), best.deviation + least->deviation};
  }
}

Expected<Simplified<SplineData>> reduce_degree(const SplineData& spline, int direction) {
  const KnotVector& old = spline.knots(direction);
  const int degree = old.degree() - 1;
  if (degree < (old.is_periodic() ? 1 : 0)) {
    return fail(ErrorCode::kOutOfRange, "degree",
                "degree " + std::to_string(old.degree()) + " cannot be lowered", "leave it");
  }
  // Fewer of each knot, and the same knots twice: raised again, and the old ones refined to those.
  std::vector<double> lower;
  std::vector<double> added;
  const bool periodic = old.is_periodic();
  for (const double u : old.breakpoints()) {
    if (u == old.domain_end() || (u == old.domain_begin() && !periodic)) continue;
    const int times = periodic && u == old.domain_begin()
                          ? std::min(old.multiplicity(u), old.degree())
                          : old.multiplicity(u);
    lower.insert(lower.end(), static_cast<std::size_t>(std::clamp(times - 1, 1, degree + 1)), u);
    if (times == 1) added.push_back(u);
  }
  auto clamped = periodic ? Expected<SplineData>(spline)
                          : segment(spline, direction, old.domain_begin(), old.domain_end());
  if (!clamped) return tl::unexpected(std::move(clamped.error()));
  auto fine = insert_knots(*clamped, direction, added);
  if (!fine) return tl::unexpected(std::move(fine.error()));
  auto to = periodic
                ? KnotVector::make_periodic(degree, lower, old.domain_end())
                : KnotVector::make_clamped(degree, old.domain_begin(), old.domain_end(), lower);
  if (!to) return tl::unexpected(std::move(to.error()));
  auto back = elevate_degree(*to, 1);
  if (!back) return tl::unexpected(std::move(back.error()));
  const KnotRefinement simpler{*to, undo(*to, *back)};
  return with_deviation(*fine, direction, simpler, *back);
}

Expected<std::pair<SplineData, SplineData>> make_compatible(const SplineData& a,
                                                            const SplineData& b, int direction) {
  const KnotVector& ka = a.knots(direction);
  const KnotVector& kb = b.knots(direction);
  if (ka.is_periodic() != kb.is_periodic()) {
    return fail(ErrorCode::kOutOfRange, "knots", "one direction is periodic and the other is not",
                "open the periodic one");
  }
  if (ka.domain_begin() != kb.domain_begin() || ka.domain_end() != kb.domain_end()) {
    return fail(ErrorCode::kNumeric, "knots", "the domains are not the same",
                "give both the same first and last parameter");
  }
  const int degree = std::max(ka.degree(), kb.degree());
  const auto raise = [&](const SplineData& s) -> Expected<SplineData> {
    auto raised = elevate_degree(s, direction, degree - s.knots(direction).degree());
    if (!raised || s.knots(direction).is_periodic()) return raised;
    return segment(*raised, direction, ka.domain_begin(), ka.domain_end());
  };
  auto one = raise(a);
  if (!one) return tl::unexpected(std::move(one.error()));
  auto other = raise(b);
  if (!other) return tl::unexpected(std::move(other.error()));
  const auto missing = [](const KnotVector& from, const KnotVector& in) {
    std::vector<double> out;
    for (const double u : in.breakpoints()) {
      if (u == in.domain_end()) continue;
      const int more = in.multiplicity(u) - from.multiplicity(u);
      if (more > 0) out.insert(out.end(), static_cast<std::size_t>(more), u);
    }
    return out;
  };
  const auto to_one = missing(one->knots(direction), other->knots(direction));
  const auto to_other = missing(other->knots(direction), one->knots(direction));
  auto fine_one = insert_knots(*one, direction, to_one);
  if (!fine_one) return tl::unexpected(std::move(fine_one.error()));
  auto fine_other = insert_knots(*other, direction, to_other);
  if (!fine_other) return tl::unexpected(std::move(fine_other.error()));
  return std::pair(*std::move(fine_one), *std::move(fine_other));
}

namespace {

/// Layers of control points across a direction, to be put one after another.
struct Stack {
  std::size_t layer;  ///< doubles
  std::size_t count;  ///< layers a block
  std::size_t blocks;
  std::vector<double> values;
};

Stack stack_of(const SplineData& s, int direction) {
  Stack out{s.stride(direction) * static_cast<std::size_t>(s.width()),
            static_cast<std::size_t>(s.knots(direction).basis_count()), 0,
            s.coordinates().to_vector()};
  out.blocks = out.values.size() / (out.layer * out.count);
  return out;
}

/// The spline in homogeneous coordinates with weights of 1 where it has none.
Expected<SplineData> as_rational(const SplineData& s) {
  if (s.is_rational()) return s;
  const std::vector<double> from = s.coordinates().to_vector();
  const auto width = static_cast<std::size_t>(s.width());
  std::vector<double> to;
  for (std::size_t i = 0; i < from.size(); i += width) {
    to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(i),
              from.begin() + static_cast<std::ptrdiff_t>(i + width));
    to.push_back(1);
  }
  return SplineData::make(s.knots(), s.dimension(), Form::kRational, to);
}

/// Weights of layers that are to meet, in one proportion: the factor of the second's, none where
/// there is none.
std::optional<double> weight_ratio(const double* one, const double* other, std::size_t layer,
                                   std::size_t width) {
  constexpr double kProportional = 1e-12;
  const double ratio = one[width - 1] / other[width - 1];
  for (std::size_t i = width - 1; i < layer; i += width) {
    if (!(std::abs(one[i] - ratio * other[i]) <= kProportional * std::abs(one[i])))
      return std::nullopt;
  }
  return ratio;
}

}  // namespace

Expected<Simplified<SplineData>> join(const SplineData& first, const SplineData& second,
                                      int direction) {
  LIMN_EXPECT(first.directions() == second.directions() && first.dimension() == second.dimension());
  if (first.knots(direction).is_periodic() || second.knots(direction).is_periodic()) {
    return fail(ErrorCode::kOutOfRange, "knots", "a periodic direction has no end to join",
                "take a part of it first");
  }
  const bool rational = first.is_rational() || second.is_rational();
  auto a = rational ? as_rational(first) : Expected<SplineData>(first);
  auto b = rational ? as_rational(second) : Expected<SplineData>(second);
  for (int d = 0; a && b && d < first.directions(); ++d) {
    if (d == direction) {
      const int degree = std::max(a->knots(d).degree(), b->knots(d).degree());
      for (Expected<SplineData>* s : {&a, &b}) {
        *s = elevate_degree(**s, d, degree - (*s)->knots(d).degree());
        if (!*s) break;
        *s = segment(**s, d, (*s)->knots(d).domain_begin(), (*s)->knots(d).domain_end());
        if (!*s) break;
      }
    } else {
      auto both = make_compatible(*a, *b, d);
      if (!both) return tl::unexpected(std::move(both.error()));
      a = std::move(both->first);
      b = std::move(both->second);
    }
  }
  if (!a) return tl::unexpected(std::move(a.error()));
  if (!b) return tl::unexpected(std::move(b.error()));

  Stack one = stack_of(*a, direction);
  Stack other = stack_of(*b, direction);
  const auto width = static_cast<std::size_t>(a->width());
  std::vector<double> joined;
  double gap = 0;
  std::optional<double> scale = 1.0;
  for (std::size_t block = 0; block < one.blocks; ++block) {
    double* end = one.values.data() + ((block + 1) * one.count - 1) * one.layer;
    double* begin = other.values.data() + block * other.count * other.layer;
    if (rational) {
      const auto ratio = weight_ratio(end, begin, one.layer, width);
      if (block == 0) scale = ratio;
      if (!ratio || !scale || std::abs(*ratio - *scale) > 1e-12 * std::abs(*scale)) {
        return fail(ErrorCode::kNumeric, "weights", "those at the joint are not proportional",
                    "insert knots or refit one side so that its edge has the other's weights");
      }
      for (std::size_t i = 0; i < other.count * other.layer; ++i) begin[i] *= *scale;
    }
    for (std::size_t i = 0; i < one.layer; i += width) {
      const double w = rational ? end[i + width - 1] : 1.0;
      double square = 0;
      for (std::size_t c = 0; c < static_cast<std::size_t>(a->dimension()); ++c) {
        square += std::pow((end[i + c] - begin[i + c]) / w, 2);
        end[i + c] = 0.5 * (end[i + c] + begin[i + c]);
      }
      gap = std::max(gap, std::sqrt(square));
    }
    const double* from = one.values.data() + block * one.count * one.layer;
    joined.insert(joined.end(), from, from + one.count * one.layer);
    joined.insert(joined.end(), begin + other.layer, begin + other.count * other.layer);
  }

  const KnotVector& ka = a->knots(direction);
  const KnotVector& kb = b->knots(direction);
  const double shift = ka.domain_end() - kb.domain_begin();
  std::vector<double> values(ka.values().begin(), ka.values().end() - 1);
  for (std::size_t i = static_cast<std::size_t>(kb.degree()) + 1; i < kb.values().size(); ++i) {
    values.push_back(kb.values()[i] + shift);
  }
  auto knots = KnotVector::make(ka.degree(), std::move(values));
  if (!knots) return tl::unexpected(std::move(knots.error()));
  std::vector<KnotVector> all(a->knots().begin(), a->knots().end());
  all[static_cast<std::size_t>(direction)] = *std::move(knots);
  auto made = SplineData::make(all, a->dimension(), a->form(), joined);
  if (!made) return tl::unexpected(std::move(made.error()));
  return Simplified<SplineData>{*std::move(made), gap / 2};
}

}  // namespace limn
