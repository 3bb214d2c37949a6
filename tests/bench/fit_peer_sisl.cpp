// SISL is under the AGPL: limn-bench links it where it is installed, nothing else of limn does.

#include <sisl.h>

#include <memory>

#include "tests/bench/fit_peers.hpp"

namespace limn::bench {

namespace {

// Values of s1961's `ipar`.
constexpr int kByLength = 1;
constexpr int kByNumber = 2;

int fit(const SampledStroke& stroke, double tolerance_mm, int parametrization) {
  constexpr int kOpen = 1;
  constexpr int kFixedAtEnds = 1;      // of the derivatives, the first: the place itself
  constexpr double kFirstStage = 0.1;  // share of the tolerance; 0.0 to 0.2 give the fewest points
  constexpr int kIterations = 10;
  constexpr int kOrder = 4;  // cubic
  std::vector<double> points;
  for (const auto& p : stroke.positions) points.insert(points.end(), {p.x(), p.y()});
  double tolerances[2] = {tolerance_mm, tolerance_mm};
  double deviations[2] = {};
  SISLCurve* made = nullptr;
  int status = 0;
  s1961(points.data(), static_cast<int>(stroke.positions.size()), 2, parametrization, nullptr,
        tolerances, kFixedAtEnds, kFixedAtEnds, kOpen, kFirstStage, kIterations, kOrder, &made,
        deviations, &status);
  const std::unique_ptr<SISLCurve, void (*)(SISLCurve*)> curve(made, freeCurve);
  return status < 0 || curve == nullptr ? 0 : curve->in;
}

}  // namespace

int fit_with_sisl_by_length(const SampledStroke& stroke, double tolerance_mm) {
  return fit(stroke, tolerance_mm, kByLength);
}

int fit_with_sisl_by_time(const SampledStroke& stroke, double tolerance_mm) {
  return fit(stroke, tolerance_mm, kByNumber);
}

}  // namespace limn::bench
