#include "modeler/bspline/denominator.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "modeler/bspline/bernstein.hpp"
#include "modeler/bspline/control_point_map.hpp"
#include "modeler/bspline/spline_data.hpp"

namespace limn {
namespace {

/// Halvings of one span before the proof is given up, and cells looked at in all.
constexpr int kMostHalvings = 40;
constexpr int kMostCells = 1 << 16;

/// A box of the domain and the Bernstein coefficients of w on it, first direction fastest.
struct Cell {
  std::array<double, 3> low{};
  std::array<double, 3> high{};
  std::vector<double> coefficients;
  int halvings = 0;
};

tl::unexpected<Error> refused(const char* why, const std::array<double, 3>& u, int directions) {
  std::string place = "weights near u = ";
  for (int d = 0; d < directions; ++d) {
    char text[32];
    std::snprintf(text, sizeof text, "%s%.6g", d > 0 ? ", " : "", u[static_cast<std::size_t>(d)]);
    place += text;
  }
  return fail(ErrorCode::kNumeric, place, why, "raise the weights that are not positive");
}

class Prover {
 public:
  explicit Prover(const SplineData& spline) : spline_(spline) {
    for (int d = 0; d < spline.directions(); ++d) {
      shape_.count[static_cast<std::size_t>(d)] = spline.knots(d).degree() + 1;
    }
  }

  Expected<void> run() {
    const auto directions = static_cast<std::size_t>(spline_.directions());
    std::array<int, 3> span{};
    for (std::size_t d = 0; d < directions; ++d)
      span[d] = spline_.knots(static_cast<int>(d)).degree();
    for (;;) {  // over all spans
      if (auto cell = cell_of(span)) {
        if (auto proved = prove(*std::move(cell)); !proved) return proved;
      }
      std::size_t d = 0;
      for (; d < directions; ++d) {
        const KnotVector& knots = spline_.knots(static_cast<int>(d));
        if (++span[d] < knots.basis_count()) break;
        span[d] = knots.degree();
      }
      if (d == directions) return {};
    }
  }

 private:
  /// None for an empty span, and where the weights are positive.
  std::optional<Cell> cell_of(const std::array<int, 3>& span) const {
    Cell cell;
    const auto directions = static_cast<std::size_t>(spline_.directions());
    for (std::size_t d = 0; d < directions; ++d) {
      const auto& values = spline_.knots(static_cast<int>(d)).values();
      cell.low[d] = values[static_cast<std::size_t>(span[d])];
      cell.high[d] = values[static_cast<std::size_t>(span[d]) + 1];
      if (!(cell.low[d] < cell.high[d])) return std::nullopt;
    }
    const auto width = static_cast<std::size_t>(spline_.width());
    bool positive = true;
    std::array<int, 3> at{};
    for (std::size_t total = shape_.size(); total > 0; --total) {
      std::size_t index = 0;
      for (std::size_t d = directions; d-- > 0;) {
        const KnotVector& knots = spline_.knots(static_cast<int>(d));
        index = index * static_cast<std::size_t>(knots.basis_count()) +
                static_cast<std::size_t>(span[d] - knots.degree() + at[d]);
      }
      cell.coefficients.push_back(spline_.coordinates()[index * width + width - 1]);
      positive = positive && cell.coefficients.back() > 0;
      for (std::size_t d = 0; d < 3 && ++at[d] == shape_.count[d]; ++d) at[d] = 0;
    }
    if (positive) return std::nullopt;
    for (int d = 0; d < spline_.directions(); ++d) {
      map_along(shape_, d, bezier_extraction(spline_.knots(d), span[static_cast<std::size_t>(d)]),
                cell.coefficients);
    }
    return cell;
  }

  Expected<void> prove(Cell whole) {
    std::vector<Cell> open;
    open.push_back(std::move(whole));
    while (!open.empty()) {
      const Cell cell = std::move(open.back());
      open.pop_back();
      const auto& c = cell.coefficients;
      if (std::all_of(c.begin(), c.end(), [](double x) { return x > 0; })) continue;
      if (const auto corner = corner_that_is_not_positive(cell)) {
        return refused("the denominator is not positive", *corner, spline_.directions());
      }
      if (cell.halvings == kMostHalvings * spline_.directions() || ++cells_ > kMostCells) {
        return refused("the denominator cannot be proved positive", cell.low, spline_.directions());
      }
      const int d = cell.halvings % spline_.directions();
      Cell left = cell;
      Cell right = cell;
      left.halvings = ++right.halvings;
      const auto sd = static_cast<std::size_t>(d);
      left.high[sd] = right.low[sd] = 0.5 * (cell.low[sd] + cell.high[sd]);
      cut_bezier(shape_, d, 0.5, left.coefficients, right.coefficients);
      open.push_back(std::move(right));
      open.push_back(std::move(left));
    }
    return {};
  }

  /// At corners the coefficients are values.
  std::optional<std::array<double, 3>> corner_that_is_not_positive(const Cell& cell) const {
    for (int corner = 0; corner < 8; ++corner) {
      std::size_t index = 0;
      std::array<double, 3> u = cell.low;
      for (std::size_t d = 3; d-- > 0;) {
        const auto n = static_cast<std::size_t>(shape_.count[d]);
        const bool high = (corner >> d & 1) != 0;
        if (high) u[d] = cell.high[d];
        index = index * n + (high ? n - 1 : 0);
      }
      if (!(cell.coefficients[index] > 0)) return u;
    }
    return std::nullopt;
  }

  const SplineData& spline_;
  BezierShape shape_;
  int cells_ = 0;
};

}  // namespace

Expected<void> prove_positive_denominator(const SplineData& spline) { return Prover(spline).run(); }

}  // namespace limn
