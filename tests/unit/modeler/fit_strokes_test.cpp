// Fits of recorded and synthetic strokes: the tolerance at every sample, and how many control
// points it took. Goals as in ../shared/strokes.md.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "modeler/fit/fit_curve.hpp"
#include "tests/support/recordings.hpp"

namespace limn {
namespace {

struct Samples {
  std::vector<Eigen::Vector2d> positions;
  std::vector<double> times;
};

Samples read_stroke(const std::filesystem::path& path) {
  Samples samples;
  std::istringstream lines(test::read_file(path));
  std::string line;
  while (std::getline(lines, line)) {
    double t = 0;
    double x = 0;
    double y = 0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &t, &x, &y) != 3) continue;
    samples.times.push_back(t);
    samples.positions.emplace_back(x, y);
  }
  return samples;
}

/// Fits and compares every sample with the curve, evaluated by the spline itself.
CurveFit<2> fit_checked(const std::filesystem::path& path, double tolerance_mm) {
  const Samples samples = read_stroke(path);
  FitOptions options;
  options.tolerance_mm = tolerance_mm;
  const auto fitted = fit_curve<2>(samples.positions, samples.times, options);
  EXPECT_TRUE(fitted.has_value()) << path << (fitted ? "" : ": " + fitted.error().what);
  if (!fitted) return {};
  double before = fitted->curve.knots().domain_begin();
  for (std::size_t i = 0; i < samples.positions.size(); ++i) {
    const double u = fitted->sample_parameters[i];
    EXPECT_GE(u, before) << path << " sample " << i;
    before = u;
    EXPECT_LE((fitted->curve.point(u) - samples.positions[i]).norm(), tolerance_mm)
        << path << " sample " << i;
  }
  EXPECT_LE(before, fitted->curve.knots().domain_end());
  EXPECT_LE(fitted->deviation_max, tolerance_mm) << path;
  return *fitted;
}

struct Total {
  std::size_t samples = 0;
  std::size_t control_points = 0;
};

/// Every `step`-th real stroke whose name begins with `kind`, from the `begin`-th on.
Total fit_real(char kind, std::size_t begin, std::size_t step, double tolerance_mm) {
  Total total;
  std::size_t index = 0;
  for (const auto& path : test::recordings("strokes/real", ".csv")) {
    if (path.filename().string().front() != kind || index++ % step != begin) continue;
    const auto fitted = fit_checked(path, tolerance_mm);
    total.samples += fitted.sample_parameters.size();
    total.control_points += fitted.curve.control_points().size();
  }
  EXPECT_GT(total.samples, 0u);
  return total;
}

class RealStrokes : public testing::TestWithParam<double> {};

TEST_P(RealStrokes, OfAProfessionalTabletAreWithinTolerance) {
  LIMN_NEEDS_RECORDINGS();
  const Total total = fit_real('w', 0, 1, GetParam());
  const double per_100 =
      100.0 * static_cast<double>(total.control_points) / static_cast<double>(total.samples);
  RecordProperty("control_points_per_100_samples", std::to_string(per_100));
  // The goals at 0.1 and 0.02 mm; what is measured at the other two, and a tenth.
  const double goal = GetParam() == 0.1    ? 11.0
                      : GetParam() == 0.02 ? 18.0
                      : GetParam() == 0.05 ? 13.7
                                           : 11.0;
  EXPECT_LE(per_100, goal);
}

TEST_P(RealStrokes, OfACheapTabletAreWithinTolerance) {
  LIMN_NEEDS_RECORDINGS();
  fit_real('s', 0, 2, GetParam());
}

TEST_P(RealStrokes, OfACheapTabletAreWithinToleranceSecondHalf) {
  LIMN_NEEDS_RECORDINGS();
  fit_real('s', 1, 2, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Tolerances, RealStrokes, testing::Values(0.02, 0.05, 0.1, 0.2));

struct Shape {
  const char* name;
  double tolerance_mm;
  std::size_t most_control_points;
  std::size_t least_corners;
  std::size_t most_corners;
};

class SyntheticStrokes : public testing::TestWithParam<Shape> {};

TEST_P(SyntheticStrokes, NeedFewControlPoints) {
  LIMN_NEEDS_RECORDINGS();
  const Shape& shape = GetParam();
  const auto path =
      test::shared_folder() / "strokes/synthetic" / (std::string(shape.name) + ".csv");
  const auto fitted = fit_checked(path, shape.tolerance_mm);
  EXPECT_LE(fitted.curve.control_points().size(), shape.most_control_points);
  EXPECT_GE(fitted.corners.size(), shape.least_corners);
  EXPECT_LE(fitted.corners.size(), shape.most_corners);
}

INSTANTIATE_TEST_SUITE_P(
    Goals, SyntheticStrokes,
    testing::Values(Shape{"liss_1k_j01", 0.1, 48, 0, 0}, Shape{"spiral_1k_j01", 0.1, 31, 0, 0},
                    Shape{"cursive_1k_j01", 0.1, 105, 0, 0},
                    Shape{"corners_1k_j01", 0.1, 85, 23, 24}, Shape{"liss_1k_j0", 0.02, 65, 0, 0},
                    Shape{"spiral_1k_j0", 0.02, 42, 0, 0}, Shape{"cursive_1k_j0", 0.02, 165, 0, 0},
                    Shape{"corners_1k_j0", 0.02, 85, 23, 24},
                    // Noise of half the tolerance: few are not to be had, but none false either.
                    Shape{"liss_1k_j05", 0.1, 580, 0, 0}, Shape{"spiral_1k_j05", 0.1, 580, 0, 0},
                    Shape{"corners_1k_j05", 0.1, 580, 23, 24}),
    [](const testing::TestParamInfo<Shape>& shape) {
      return std::string(shape.param.name) + "_at_" +
             std::to_string(static_cast<int>(1000 * shape.param.tolerance_mm)) + "_um";
    });

}  // namespace
}  // namespace limn
