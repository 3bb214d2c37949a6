#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "input/base/error.hpp"
#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

/// How fit_curve() works.
struct FitOptions {
  /// Greatest allowed distance of any sample from the curve, in the samples' unit. More than 0.
  double tolerance_mm = 0.1;
  /// Whether to look for corners; without, the curve is C2 everywhere it can be.
  bool detect_corners = true;
  /// Turning of the path, between 0 and pi, from which a sharp bend is a corner where the pen
  /// slowed down for it, as pens do; where it did not, twice as much is asked for.
  double corner_angle_rad = 0.5;
  /// Whether a stroke whose end meets its beginning becomes a periodic curve.
  bool allow_closing = true;
};

/// A curve through samples, and what it achieved. The deviations are those of `curve` as returned.
template <int kDimension>
struct CurveFit {
  /// Cubic, C2 but for `corners`. A dot, whose samples all lie within tolerance of the middle of
  /// their bounding box, is degree 0 with that one control point. Periodic exactly if `closed`.
  BsplineCurve<kDimension> curve;
  /// For each sample the parameter it belongs to: non-decreasing, within the domain.
  std::vector<double> sample_parameters;
  /// Distances |curve(sample_parameters[i]) - sample i|: the largest, and the root of their mean
  /// square, every sample counted once (duplicates too).
  double deviation_max = 0;
  double deviation_rms = 0;
  /// Largest distance of the curve from the polyline of the samples, probed at three places between
  /// each two samples, order kept: from their leg and the two beside it. The fit keeps it within
  /// the tolerance and a quarter of the leg (a bend's rise over its chord) wherever it can; where
  /// samples are noise or stairs of a coarse grid against the tolerance it may not.
  double polyline_deviation_max = 0;
  /// Parameters where the curve is only C0, ascending: the corners found, and, should double
  /// precision come to its end, samples that nothing but straight legs meets.
  std::vector<double> corners;
  bool closed = false;
};

/// Fits a cubic B-spline curve within options.tolerance_mm of every sample, with few control
/// points.
///
/// `positions` in mm, at least one, any step from sample to sample. `times` in seconds,
/// non-decreasing, one a sample, or empty: they tell where the pen slowed down, as it does in
/// corners (samples are taken as evenly spaced in time without), and a stroke that is one cubic of
/// its time gets that cubic.
///
/// The parameter of the curve starts near arc length in mm and is the fit's own. It ascends with
/// the samples, so the curve makes every lap and every return that they make.
///
/// A stroke is closed if its ends are no further apart than the tolerance or 1.5 mean steps, and
/// there is something between them; where they meet at an angle there is a corner.
///
/// Time and memory are linear in the number of samples. A pure function, hence thread-safe.
///
/// Errors: kMissing without samples; kPointCount where `times` do not match; kOutOfRange for a
/// tolerance that is not positive and finite, a corner angle out of range, or a sample that is not
/// finite or whose time decreases (the error names it); kNumeric where double precision cannot
/// resolve the tolerance at these coordinates.
/// Instantiated for dimensions 1 to 10 (fastest for 2 and 3).
template <int kDimension>
Expected<CurveFit<kDimension>> fit_curve(
    std::span<const Eigen::Matrix<double, kDimension, 1>> positions, std::span<const double> times,
    const FitOptions& options);

}  // namespace limn
