#pragma once

#include <span>
#include <vector>

namespace limn::fit_detail {

/// Breakpoints b_0 < .. < b_count with the same ends as `breaks` that each bound the same share of
/// `mass`, which is taken as spread evenly over each old span [deBoor73]. Fewer come back where two
/// would lie nearer than `least_gap`.
/// Precondition: mass.size() == breaks.size() - 1, count >= 1, mass > 0 throughout.
std::vector<double> equidistribute(std::span<const double> breaks, std::span<const double> mass,
                                   int count, double least_gap);

/// How many spans of error `target` the length of a span of error `error` is worth, when every span
/// may slide its samples: (error / target)^(1/5).
double span_mass(double error, double target) noexcept;

/// A run of spans [begin, end), by index.
struct SpanRange {
  int begin = 0;
  int end = 0;
};

/// Runs of spans that together hold every span whose error is above `tolerance`, each widened by
/// `reach` spans to both sides; runs do not overlap and ascend.
std::vector<SpanRange> failing_ranges(std::span<const double> errors, double tolerance, int reach);

/// Cuts [0, spans) into windows of `width` spans, the first one `offset % width` long (if not 0),
/// none shorter than 2 unless there is but one span.
std::vector<SpanRange> windows(int spans, int width, int offset);

}  // namespace limn::fit_detail
