// Curves through strokes: processor time, control points and deviation, beside Open CASCADE and
// SISL on the same strokes.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "modeler/fit/fit_curve.hpp"
#include "tests/bench/areas.hpp"
#include "tests/bench/fit_peers.hpp"
#include "tests/bench/measure.hpp"
#include "tests/bench/strokes.hpp"

namespace limn::bench {

namespace {

using Eigen::Vector2d;

constexpr double kSigmaMm = 0.01;
constexpr double kToleranceMm = 0.1;

std::optional<CurveFit<2>> fit(const SampledStroke& stroke, double tolerance_mm) {
  FitOptions options;
  options.tolerance_mm = tolerance_mm;
  auto result = fit_curve<2>(stroke.positions, stroke.times, options);
  if (!result) return std::nullopt;
  return *std::move(result);
}

/// Control points that may be chosen: a closed curve repeats its first ones.
int count_points(const CurveFit<2>& fit) {
  const int repeated = fit.closed ? fit.curve.knots().degree() : 0;
  return static_cast<int>(fit.curve.control_points().size()) - repeated;
}

/// Number of control points as the peers give it, 0 where the fit fails.
int fit_with_limn(const SampledStroke& stroke, double tolerance_mm) {
  const auto result = fit(stroke, tolerance_mm);
  return result ? count_points(*result) : 0;
}

double distance_to_leg(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d leg = b - a;
  const double length2 = leg.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(leg) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * leg).norm();
}

/// Largest distance of a sample from the curve, whatever its parameter.
double deviation(const SampledStroke& stroke, const BsplineCurve<2>& curve) {
  // A cubic span departs from the polyline of its probes by at most 1/1000 of what it departs from
  // its own chord.
  constexpr int kProbesPerSpan = 32;
  std::vector<Vector2d> along;
  const auto ends = curve.knots().breakpoints();
  for (std::size_t span = 0; span + 1 < ends.size(); ++span)
    for (int i = 0; i <= kProbesPerSpan; ++i)
      along.push_back(curve.point(ends[span] + (ends[span + 1] - ends[span]) * i / kProbesPerSpan));
  double largest = 0;
  for (const auto& sample : stroke.positions) {
    double nearest = (sample - along.front()).norm();
    for (std::size_t i = 1; i < along.size() && nearest > largest; ++i)
      nearest = std::min(nearest, distance_to_leg(sample, along[i - 1], along[i]));
    largest = std::max(largest, nearest);
  }
  return largest;
}

struct Fitter {
  const char* name;
  int (*fit)(const SampledStroke&, double tolerance_mm);
  Effort effort;
};

constexpr const char* kOcct = "Open CASCADE";

/// limn first, then the peers that this build has.
std::vector<Fitter> fitters() {
  return {
      {"limn", fit_with_limn, {0.02, 10}},
#ifdef LIMN_BENCH_OCCT
      {kOcct, fit_with_occt, {0.001, 1}},  // seconds a fit, so once is exact enough
#endif
#ifdef LIMN_BENCH_SISL
      {"SISL, chord length", fit_with_sisl_by_length, {0.02, 5}},
      {"SISL, time", fit_with_sisl_by_time, {0.02, 5}},
#endif
  };
}

/// Goals of the rows for one stroke: of limn alone, and against Open CASCADE.
struct StrokeGoals {
  std::optional<Goal> time;
  std::optional<Goal> time_against_occt;
  std::optional<Goal> points_against_occt;
};

/// Time, deviation and control points for one stroke, beside each peer.
void compare(const SampledStroke& stroke, const StrokeGoals& goals, const RowSink& sink) {
  std::vector<Job> jobs;
  std::vector<int> points;  // 0 where a peer fails
  for (const auto& fitter : fitters()) {
    points.push_back(fitter.fit(stroke, kToleranceMm));
    jobs.push_back({fitter.name, [&stroke, fitter] { keep(fitter.fit(stroke, kToleranceMm)); },
                    fitter.effort});
  }
  const auto result = fit(stroke, kToleranceMm);
  if (!result) {
    std::fprintf(stderr, "limn-bench: limn does not fit %s\n", stroke.name.c_str());
    std::exit(2);
  }
  const auto seconds = measure(jobs);
  const std::string name = "fit/" + stroke.name + " " + std::to_string(stroke.positions.size());
  sink({name + ", time", seconds[0] * 1e3, "ms", std::nullopt, goals.time});
  sink({name + ", deviation", deviation(stroke, result->curve), "mm", std::nullopt,
        at_most(kToleranceMm)});
  for (std::size_t i = 1; i < jobs.size(); ++i) {
    if (points[i] == 0) continue;
    const bool occt = jobs[i].name == kOcct;
    sink({name + ", time", seconds[0] * 1e3, "ms", Peer{seconds[i] * 1e3, jobs[i].name},
          occt ? goals.time_against_occt : std::nullopt});
    sink({name + ", control points", static_cast<double>(points[0]), "points",
          Peer{static_cast<double>(points[i]), jobs[i].name},
          occt ? goals.points_against_occt : std::nullopt});
  }
}

/// Control points for the recorded shapes, beside the best of the tools that were once measured.
void recorded_shapes(const RowSink& sink) {
  struct Case {
    const char* part;
    double goal;
    Peer best;
  };
  const Case cases[] = {
      {"liss_1k_j01", 48, {51, "FITPACK", true}},
      {"spiral_1k_j01", 31, {31, "FITPACK", true}},
      {"cursive_1k_j01", 105, {103, "Open CASCADE", true}},
      {"corners_1k_j01", 85, {95, "SISL s1961", true}},
  };
  for (const auto& c : cases) {
    for (const auto& stroke : recorded_strokes("synthetic", c.part)) {
      sink({"fit/" + stroke.name + ", control points",
            static_cast<double>(fit_with_limn(stroke, kToleranceMm)), "points", c.best,
            at_most(c.goal)});
    }
  }
}

/// Time and control points for strokes of real pens.
void recorded_pens(const RowSink& sink) {
  struct Case {
    double tolerance_mm;
    double goal;
    Peer best;
  };
  const Case cases[] = {{0.1, 11.0, {10.8, "Open CASCADE, degree 8", true}},
                        {0.02, 18.0, {20.7, "Open CASCADE, degree 8", true}}};
  const auto strokes = recorded_strokes("real", "w");
  if (strokes.empty()) return;
  std::size_t samples = 0;
  for (const auto& stroke : strokes) samples += stroke.positions.size();
  for (const auto& c : cases) {
    int points = 0;
    const auto fit_all = [&strokes, &points, &c] {
      points = 0;
      for (const auto& stroke : strokes) points += fit_with_limn(stroke, c.tolerance_mm);
    };
    const double seconds = measure({{"real", fit_all, {0.5, 3}}})[0];
    char name[64];
    std::snprintf(name, sizeof name, "fit/real pens at %.2f mm", c.tolerance_mm);
    const auto count = static_cast<double>(samples);
    sink({name + std::string(", control points"), 100 * points / count, "per 100 samples", c.best,
          at_most(c.goal)});
    sink({name + std::string(", time"), seconds / count * 1e6, "us/sample",
          Peer{107, "Open CASCADE, degree 8", true}, at_most(2.0)});
  }
}

}  // namespace

void fit_area(const RowSink& sink) {
  for (const auto& stroke : drawn_strokes(1000, kSigmaMm))
    compare(stroke, {at_most(2.0), {}, {}}, sink);
  // A stroke of usual length: at least 50 times Open CASCADE's speed with 1.2 times its points.
  const auto usual = drawn_strokes(500, kSigmaMm);
  compare(usual[2], {{}, at_least_ratio(50), at_least_ratio(1 / 1.2)}, sink);
  recorded_shapes(sink);
  recorded_pens(sink);
}

}  // namespace limn::bench
