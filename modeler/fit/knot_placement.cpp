#include "modeler/fit/knot_placement.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace limn::fit_detail {

std::vector<double> equidistribute(std::span<const double> breaks, std::span<const double> mass,
                                   int count, double least_gap) {
  const double total = std::accumulate(mass.begin(), mass.end(), 0.0);
  std::vector<double> out = {breaks.front()};
  out.reserve(static_cast<std::size_t>(count) + 1);
  double passed = 0;  // mass before span j
  std::size_t j = 0;
  for (int i = 1; i < count; ++i) {
    const double wanted = total * i / count;
    while (j + 1 < mass.size() && passed + mass[j] < wanted) passed += mass[j++];
    const double share = std::clamp((wanted - passed) / mass[j], 0.0, 1.0);
    const double u = breaks[j] + share * (breaks[j + 1] - breaks[j]);
    if (u >= out.back() + least_gap && u <= breaks.back() - least_gap) out.push_back(u);
  }
  out.push_back(breaks.back());
  return out;
}

double span_mass(double error, double target) noexcept {
  // Between the 4 of a cubic fit at given parameters and the 6 of one whose samples slide freely.
  constexpr double kOrder = 5;
  return std::pow(error / target, 1.0 / kOrder);
}

std::vector<SpanRange> failing_ranges(std::span<const double> errors, double tolerance, int reach) {
  std::vector<SpanRange> out;
  const int count = static_cast<int>(errors.size());
  for (int j = 0; j < count; ++j) {
    if (errors[static_cast<std::size_t>(j)] <= tolerance) continue;
    const int begin = std::max(0, j - reach);
    const int end = std::min(count, j + 1 + reach);
    if (!out.empty() && begin <= out.back().end) {
      out.back().end = end;
    } else {
      out.push_back({begin, end});
    }
  }
  return out;
}

std::vector<SpanRange> windows(int spans, int width, int offset) {
  std::vector<SpanRange> out;
  for (int begin = 0; begin < spans;) {
    const int first = offset % width;
    int end = begin + (begin == 0 && first > 1 ? first : width);
    if (spans - end < 2) end = spans;
    out.push_back({begin, end});
    begin = end;
  }
  return out;
}

}  // namespace limn::fit_detail
