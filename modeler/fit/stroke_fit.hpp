#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "modeler/bspline/refine.hpp"
#include "modeler/fit/closing.hpp"
#include "modeler/fit/corner_detection.hpp"
#include "modeler/fit/cubic_basis.hpp"
#include "modeler/fit/fit_curve.hpp"
#include "modeler/fit/polyline.hpp"
#include "modeler/fit/segment_fit.hpp"

namespace limn::fit_detail {

/// Fits one stroke: brings it into a frame of unit size, cuts it at its corners, fits the segments
/// and joins them into one B-spline, whose deviations it measures.
template <int kDimension>
class StrokeFitter {
 public:
  using Point = Eigen::Matrix<double, kDimension, 1>;
  using Curve = BsplineCurve<kDimension>;

  StrokeFitter(std::span<const Point> positions, std::span<const double> times,
               const FitOptions& options)
      : positions_(positions), times_(times), options_(options) {}

  Expected<CurveFit<kDimension>> fit() {
    if (auto checked = check_input(); !checked) return tl::unexpected(checked.error());
    choose_frame();
    if (tolerance_ < kResolution) {
      return fail(ErrorCode::kNumeric, "tolerance",
                  "it is below what double precision resolves at these coordinates",
                  "raise the tolerance or move the samples nearer to the origin");
    }
    if (auto fitted = dot()) return *std::move(fitted);
    merge_duplicates();
    closed_ = options_.allow_closing && is_closed(line_, tolerance_);
    find_corners();
    fit_segments();
    auto curve = closed_ ? closed_curve() : open_curve();
    if (!curve) {
      return fail(ErrorCode::kNumeric, "samples",
                  "their distances differ by more than double precision holds",
                  "remove the outlying samples");
    }
    return measured(*std::move(curve));
  }

 private:
  /// In units of the frame, where coordinates are at most 1: rounding of one evaluation, with room.
  static constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
  /// Tolerances below this cannot be told from rounding.
  static constexpr double kResolution = 4 * kRounding;
  /// In mm; its square is still far from overflow.
  static constexpr double kLargestCoordinate = 1e100;
  /// Nearest two parameters may lie, as a share of the stroke's length: far enough apart that
  /// rounding of sums over the stroke leaves them distinct.
  static constexpr double kParameterGap = 1e-12;

  /// A fitted segment, or a leg of the polygon where fitting came to double precision's end.
  struct Piece {
    std::vector<double> breaks;  // from 0
    std::vector<Point> points;   // breaks.size() + 2
  };

  Expected<void> check_input() const;
  void choose_frame();
  void merge_duplicates();
  std::optional<CurveFit<kDimension>> dot() const;
  void find_corners();
  void fit_segments();
  void fit_segment(std::size_t begin, std::size_t end);
  bool follows_one_cubic_in_time(std::size_t begin, std::size_t end);
  void add_polygon(std::size_t begin, std::size_t end);
  std::vector<double> lengths_along(std::span<const Point> points) const;
  void store_parameters(std::size_t begin, const std::vector<double>& parameters);
  Expected<Curve> open_curve();
  Expected<Curve> closed_curve();
  Expected<Curve> rotated_to_first_sample(Curve curve);
  std::vector<Point> joined_points() const;
  std::vector<double> joined_breaks(int multiplicity) const;
  std::vector<Point> in_user_frame(std::vector<Point> points) const;
  Expected<CurveFit<kDimension>> measured(Curve curve) const;
  double polyline_deviation(const Curve& curve) const;

  /// Points of a closed stroke go round: index size() is the first point again.
  const Point& point_at(std::size_t i) const noexcept { return line_.points[i % line_.size()]; }

  std::span<const Point> positions_;
  std::span<const double> times_;
  const FitOptions& options_;
  int exponent_ = 0;  // frame unit = 2^exponent_ mm
  Point origin_;      // of the frame, in frame units
  double tolerance_ = 0;
  double length_ = 0;
  Polyline<kDimension> line_;
  bool closed_ = false;
  std::vector<std::size_t> cuts_;  // point indices where segments meet; may exceed size() once
  std::vector<Piece> pieces_;
  std::vector<double> offsets_ = {0};  // parameter where each piece begins, and the last one's end
  std::vector<double> corners_;        // parameters
  std::vector<double> parameters_;     // a point of line_
};

template <int kDimension>
Expected<void> StrokeFitter<kDimension>::check_input() const {
  if (positions_.empty()) {
    return fail(ErrorCode::kMissing, "samples", "there are none", "give at least one sample");
  }
  if (!times_.empty() && times_.size() != positions_.size()) {
    return fail(ErrorCode::kPointCount, "times",
                std::to_string(times_.size()) + " are given for " +
                    std::to_string(positions_.size()) + " samples",
                "give one time a sample or none");
  }
  if (!(options_.tolerance_mm > 0) || !std::isfinite(options_.tolerance_mm)) {
    return fail(ErrorCode::kOutOfRange, "tolerance", "it is not a positive number",
                "give a tolerance above 0 mm");
  }
  if (!(options_.corner_angle_rad > 0) || !(options_.corner_angle_rad < 3.14159265358979)) {
    return fail(ErrorCode::kOutOfRange, "corner angle", "it is not between 0 and pi",
                "give the turning of a corner in radians");
  }
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const bool finite = positions_[i].allFinite() && (times_.empty() || std::isfinite(times_[i]));
    if (!finite || positions_[i].cwiseAbs().maxCoeff() > kLargestCoordinate) {
      return fail(
          ErrorCode::kOutOfRange, "sample " + std::to_string(i),
          finite ? "a coordinate is beyond 1e100 mm" : "a coordinate or its time is not finite",
          "remove the sample");
    }
    if (!times_.empty() && i > 0 && times_[i] < times_[i - 1]) {
      return fail(ErrorCode::kOutOfRange, "sample " + std::to_string(i),
                  "its time is before that of the sample before it", "sort the samples by time");
    }
  }
  return {};
}

template <int kDimension>
void StrokeFitter<kDimension>::choose_frame() {
  double largest = 0;
  for (const Point& p : positions_) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  // Smaller strokes keep a frame that can still be scaled by a power of two and its inverse.
  constexpr int kLeastExponent = -400;
  std::frexp(largest, &exponent_);
  exponent_ = std::max(exponent_, kLeastExponent);
  origin_ = positions_[0] * std::ldexp(1.0, -exponent_);
  constexpr double kFrameSize = 8;  // beyond the largest distance (sqrt(10) * 2) all are alike
  tolerance_ = std::min(kFrameSize, std::ldexp(options_.tolerance_mm, -exponent_));
  if (tolerance_ >= kResolution) tolerance_ -= kRounding;
}

template <int kDimension>
void StrokeFitter<kDimension>::merge_duplicates() {
  const double scale = std::ldexp(1.0, -exponent_);
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    if (i > 0 && positions_[i] == positions_[i - 1]) continue;
    const Point p = positions_[i] * scale - origin_;
    if (!line_.points.empty() && p == line_.points.back()) continue;
    line_.points.push_back(p);
    line_.first.push_back(i);
    line_.clock.push_back(times_.empty() ? static_cast<double>(i) : times_[i]);
  }
  line_.noise = estimate_noise(line_.points);
  line_.smoothed = smooth(line_.points, kSmoothingReach * line_.noise);
  for (std::size_t i = 1; i < line_.size(); ++i) {
    length_ += (line_.points[i] - line_.points[i - 1]).norm();
  }
  parameters_.assign(line_.size(), 0.0);
}

/// One control point amid the samples, if it is within tolerance of them all.
template <int kDimension>
std::optional<CurveFit<kDimension>> StrokeFitter<kDimension>::dot() const {
  Point low = positions_[0];
  Point high = positions_[0];
  for (const Point& p : positions_) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Point amid = low + 0.5 * (high - low);
  CurveFit<kDimension> out;
  double squares = 0;
  for (const Point& p : positions_) {
    const double deviation2 = (p - amid).squaredNorm();
    out.deviation_max = std::max(out.deviation_max, std::sqrt(deviation2));
    if (out.deviation_max > options_.tolerance_mm) return std::nullopt;
    squares += deviation2;
  }
  out.deviation_rms = std::sqrt(squares / static_cast<double>(positions_.size()));
  out.polyline_deviation_max = out.deviation_max;
  auto curve = Curve::make(KnotVector(), {amid});
  if (!curve) return std::nullopt;
  out.curve = *std::move(curve);
  out.sample_parameters.assign(positions_.size(), out.curve.knots().domain_begin());
  return out;
}

template <int kDimension>
void StrokeFitter<kDimension>::find_corners() {
  std::vector<std::size_t> corners;
  if (options_.detect_corners) {
    if (closed_) {
      std::size_t lead = 0;
      const auto around = unrolled(line_, lead);
      const std::size_t round = around.size() - 2 * lead;
      for (const std::size_t at :
           CornerDetector(around, tolerance_, options_.corner_angle_rad).find()) {
        if (at >= lead && at < lead + round) corners.push_back(at - lead);
      }
    } else {
      corners = CornerDetector(line_, tolerance_, options_.corner_angle_rad).find();
    }
  }
  if (!closed_) {
    cuts_ = {0};
    cuts_.insert(cuts_.end(), corners.begin(), corners.end());
    cuts_.push_back(line_.size() - 1);
    return;
  }
  // Where a closed stroke ends exactly where it began, a corner at the end is one at the beginning.
  if (!corners.empty() && corners.back() + 1 == line_.size() &&
      line_.points.back() == line_.points.front()) {
    corners.pop_back();
    if (corners.empty() || corners.front() != 0) corners.insert(corners.begin(), 0);
  }
  cuts_ = corners;
  if (!corners.empty()) cuts_.push_back(corners.front() + line_.size());
}

template <int kDimension>
std::vector<double> StrokeFitter<kDimension>::lengths_along(std::span<const Point> points) const {
  const double least = kParameterGap * length_;
  std::vector<double> out = {0.0};
  out.reserve(points.size());
  for (std::size_t i = 1; i < points.size(); ++i) {
    out.push_back(out.back() + std::max((points[i] - points[i - 1]).norm(), least));
  }
  return out;
}

template <int kDimension>
void StrokeFitter<kDimension>::store_parameters(std::size_t begin,
                                                const std::vector<double>& parameters) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    // A closed stroke's first point stays where its segment begins, not where the last one ends.
    if (begin + i >= line_.size() && (begin + i) % line_.size() == cuts_.front()) continue;
    parameters_[(begin + i) % line_.size()] = offsets_.back() + parameters[i];
  }
}

template <int kDimension>
void StrokeFitter<kDimension>::fit_segments() {
  if (closed_ && cuts_.empty()) {
    Segment<kDimension> whole;
    whole.points = line_.points;
    whole.parameters = lengths_along(smooth(line_.points, kSmoothingReach * line_.noise));
    whole.chord = lengths_along(line_.points);
    whole.closing_leg =
        std::max((line_.points.front() - line_.points.back()).norm(), kParameterGap * length_);
    whole.ends.periodic = true;
    SegmentFitter<kDimension> fitter(std::move(whole), tolerance_, kParameterGap * length_);
    if (fitter.run()) {
      parameters_ = fitter.parameters();
      pieces_.push_back({fitter.spline().breaks(), fitter.spline().points()});
      offsets_.push_back(pieces_[0].breaks.back());
      return;
    }
    closed_ = false;
    cuts_ = {0, line_.size() - 1};
  }
  for (std::size_t c = 0; c + 1 < cuts_.size(); ++c) fit_segment(cuts_[c], cuts_[c + 1]);
}

template <int kDimension>
void StrokeFitter<kDimension>::fit_segment(std::size_t begin, std::size_t end) {
  const bool first = pieces_.empty();
  if (closed_ || !first) corners_.push_back(offsets_.back());
  if (!closed_ && begin == 0 && end + 1 == line_.size() && follows_one_cubic_in_time(begin, end)) {
    return;
  }
  std::vector<Point> points;
  for (std::size_t i = begin; i <= end; ++i) points.push_back(point_at(i));
  Segment<kDimension> segment;
  segment.points = points;
  segment.parameters = lengths_along(smooth(points, kSmoothingReach * line_.noise));
  segment.chord = lengths_along(points);
  if (closed_ || begin > 0) segment.ends.begin = points.front();
  if (closed_ || end + 1 < line_.size()) segment.ends.end = points.back();
  SegmentFitter<kDimension> fitter(std::move(segment), tolerance_, kParameterGap * length_);
  if (!fitter.run()) {
    add_polygon(begin, end);
    return;
  }
  store_parameters(begin, fitter.parameters());
  pieces_.push_back({fitter.spline().breaks(), fitter.spline().points()});
  offsets_.push_back(offsets_.back() + pieces_.back().breaks.back());
}

/// Straight legs from sample to sample, each sample a corner: exact where nothing else is.
template <int kDimension>
void StrokeFitter<kDimension>::add_polygon(std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    if (i > begin) corners_.push_back(offsets_.back());
    const Point& a = point_at(i);
    const Point& b = point_at(i + 1);
    const double leg = std::max((b - a).norm(), kParameterGap * length_);
    store_parameters(i, {0.0, leg});
    pieces_.push_back({{0.0, leg}, {a, a + (b - a) / 3, a + (b - a) * (2.0 / 3), b}});
    offsets_.push_back(offsets_.back() + leg);
  }
}

/// A stroke that is one cubic of its own time keeps that time as its parameter (scaled to its
/// length), so that samples of a cubic give that cubic back.
template <int kDimension>
bool StrokeFitter<kDimension>::follows_one_cubic_in_time(std::size_t begin, std::size_t end) {
  if (times_.empty()) return false;
  const double t0 = line_.clock[begin];
  const double span = line_.clock[end] - t0;
  std::vector<double> parameters;
  for (std::size_t i = begin; i <= end; ++i) {
    parameters.push_back((line_.clock[i] - t0) / span * length_);
    const double least = i > begin ? parameters[i - begin - 1] + kParameterGap * length_ : 0.0;
    if (!(parameters.back() >= least)) return false;
  }
  SegmentSamples<kDimension> samples(line_.points, std::move(parameters));
  SegmentSpline<kDimension> cubic;
  cubic.set_breaks({0.0, samples.u.back()}, false);
  if (!cubic.solve(samples, {}, 1.0) || !(cubic.measure(samples) <= tolerance_)) return false;
  store_parameters(begin, samples.u);
  pieces_.push_back({cubic.breaks(), cubic.points()});
  offsets_.push_back(offsets_.back() + cubic.breaks().back());
  return true;
}

template <int kDimension>
std::vector<typename StrokeFitter<kDimension>::Point> StrokeFitter<kDimension>::joined_points()
    const {
  std::vector<Point> points = {pieces_.front().points.front()};
  for (const Piece& piece : pieces_) {
    points.insert(points.end(), piece.points.begin() + 1, piece.points.end());
  }
  return points;
}

/// All breakpoints, those between pieces `multiplicity` times, the two ends once.
template <int kDimension>
std::vector<double> StrokeFitter<kDimension>::joined_breaks(int multiplicity) const {
  std::vector<double> breaks = {0.0};
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    const auto& own = pieces_[k].breaks;
    for (std::size_t i = 1; i + 1 < own.size(); ++i) breaks.push_back(offsets_[k] + own[i]);
    const int times = k + 1 < pieces_.size() ? multiplicity : 1;
    breaks.insert(breaks.end(), static_cast<std::size_t>(times), offsets_[k + 1]);
  }
  return breaks;
}

template <int kDimension>
std::vector<typename StrokeFitter<kDimension>::Point> StrokeFitter<kDimension>::in_user_frame(
    std::vector<Point> points) const {
  for (Point& p : points) {
    for (int d = 0; d < kDimension; ++d) p[d] = std::ldexp(p[d] + origin_[d], exponent_);
  }
  return points;
}

template <int kDimension>
Expected<BsplineCurve<kDimension>> StrokeFitter<kDimension>::open_curve() {
  constexpr int kCorner = 3;  // multiplicity of a knot where a cubic is only C0
  auto breaks = joined_breaks(kCorner);
  for (double& u : breaks) u = std::ldexp(u, exponent_);
  for (double& u : corners_) u = std::ldexp(u, exponent_);
  for (double& u : parameters_) u = std::ldexp(u, exponent_);
  auto knots = KnotVector::make_clamped(3, breaks.front(), breaks.back(),
                                        std::span(breaks).subspan(1, breaks.size() - 2));
  if (!knots) return tl::unexpected(std::move(knots.error()));
  return Curve::make(*std::move(knots), in_user_frame(joined_points()));
}

template <int kDimension>
Expected<BsplineCurve<kDimension>> StrokeFitter<kDimension>::closed_curve() {
  constexpr int kCorner = 3;
  const bool smooth_seam = cuts_.empty();
  auto breaks = joined_breaks(kCorner);
  for (double& u : breaks) u = std::ldexp(u, exponent_);
  for (double& u : corners_) u = std::ldexp(u, exponent_);
  for (double& u : parameters_) u = std::ldexp(u, exponent_);
  const double end = breaks.back();
  breaks.pop_back();
  std::vector<Point> points = smooth_seam ? pieces_[0].points : joined_points();
  if (!smooth_seam) {
    breaks.insert(breaks.begin(), kCorner - 1, 0.0);
    points.pop_back();  // the corner at the seam, which is also the first one
    for (std::size_t i = 0; i < 3; ++i) points.push_back(points[i]);
  }
  auto knots = KnotVector::make_periodic(3, breaks, end);
  if (!knots) return tl::unexpected(std::move(knots.error()));
  auto curve = Curve::make(*std::move(knots), in_user_frame(std::move(points)));
  if (!curve || smooth_seam || cuts_.front() == 0) return curve;
  return rotated_to_first_sample(*std::move(curve));
}

/// Moves the seam from the first corner, where the pieces begin, to the first sample.
template <int kDimension>
Expected<BsplineCurve<kDimension>> StrokeFitter<kDimension>::rotated_to_first_sample(Curve curve) {
  const double seam = parameters_[0];
  if (seam >= curve.knots().domain_end()) {
    // The first samples rest in the corner where the pieces begin: the seam is there already.
    std::fill_n(parameters_.begin(), cuts_.front(), curve.knots().domain_begin());
    return curve;
  }
  const double period = curve.knots().domain_end() - curve.knots().domain_begin();
  auto moved = move_seam(curve, 0, seam);
  if (!moved) return moved;
  // move_seam() keeps parameters: the domain now is [seam, seam + period].
  // Samples from the first corner on come before the seam, so a round later.
  for (std::size_t i = cuts_.front(); i < parameters_.size(); ++i) parameters_[i] += period;
  for (double& u : corners_) u = u < seam ? u + period : u;
  std::sort(corners_.begin(), corners_.end());
  return moved;
}

/// Points of a cubic curve at ascending parameters, each in time that does not depend on the
/// curve's size.
template <int kDimension>
class AscendingEvaluator {
 public:
  explicit AscendingEvaluator(const BsplineCurve<kDimension>& curve)
      : knots_(curve.knots().values()),
        points_(curve.control_points().begin(), curve.control_points().end()) {}

  Eigen::Matrix<double, kDimension, 1> operator()(double u) noexcept {
    while (span_ + 1 < points_.size() && u >= knots_[span_ + 1]) ++span_;
    std::size_t s = span_;
    while (knots_[s] == knots_[s + 1]) --s;  // the last non-empty span, at the end of the domain
    const auto basis = cubic_values(knots_.data() + s, u);
    const auto* p = points_.data() + (s - 3);
    return basis[0] * p[0] + basis[1] * p[1] + basis[2] * p[2] + basis[3] * p[3];
  }

 private:
  const std::vector<double>& knots_;
  std::vector<Eigen::Matrix<double, kDimension, 1>> points_;
  std::size_t span_ = 3;
};

template <class Point>
double distance_to_leg(const Point& p, const Point& a, const Point& b) {
  const Point leg = b - a;
  const double length2 = leg.squaredNorm();
  const double share = length2 > 0 ? std::clamp(leg.dot(p - a) / length2, 0.0, 1.0) : 0.0;
  return (a + share * leg - p).norm();
}

template <int kDimension>
Expected<CurveFit<kDimension>> StrokeFitter<kDimension>::measured(Curve curve) const {
  CurveFit<kDimension> out;
  out.sample_parameters.resize(positions_.size());
  double squares = 0;
  AscendingEvaluator<kDimension> at(curve);
  for (std::size_t i = 0; i < line_.size(); ++i) {
    const std::size_t end = i + 1 < line_.size() ? line_.first[i + 1] : positions_.size();
    const double u =
        std::clamp(parameters_[i], curve.knots().domain_begin(), curve.knots().domain_end());
    const Point on_curve = at(u);
    for (std::size_t k = line_.first[i]; k < end; ++k) {
      out.sample_parameters[k] = u;
      const double deviation = (on_curve - positions_[k]).norm();
      out.deviation_max = std::max(out.deviation_max, deviation);
      squares += deviation * deviation;
    }
  }
  out.deviation_rms = std::sqrt(squares / static_cast<double>(positions_.size()));
  if (!(out.deviation_max <= options_.tolerance_mm)) {
    return fail(ErrorCode::kNumeric, "tolerance",
                "rounding keeps the curve from staying within it at these coordinates",
                "raise the tolerance or move the samples nearer to the origin");
  }
  out.polyline_deviation_max = polyline_deviation(curve);
  out.corners = corners_;
  out.closed = closed_;
  out.curve = std::move(curve);
  return out;
}

/// Probes the curve between each two samples and measures to their leg and its neighbours.
template <int kDimension>
double StrokeFitter<kDimension>::polyline_deviation(const Curve& curve) const {
  constexpr int kProbes = 3;
  const std::size_t legs = closed_ ? line_.size() : line_.size() - 1;
  const auto position = [&](std::size_t i) { return positions_[line_.first[i % line_.size()]]; };
  AscendingEvaluator<kDimension> at(curve);
  double worst = 0;
  for (std::size_t i = 0; i < legs; ++i) {
    const double a = parameters_[i];
    const double b = i + 1 < line_.size() ? parameters_[i + 1] : curve.knots().domain_end();
    for (int k = 1; k <= kProbes; ++k) {
      const Point p = at(std::min(a + (b - a) * k / (kProbes + 1), curve.knots().domain_end()));
      double nearest = distance_to_leg(p, position(i), position(i + 1));
      if (nearest <= worst) continue;
      if (i > 0) nearest = std::min(nearest, distance_to_leg(p, position(i - 1), position(i)));
      if (i + 1 < legs) {
        nearest = std::min(nearest, distance_to_leg(p, position(i + 1), position(i + 2)));
      }
      worst = std::max(worst, nearest);
    }
  }
  return worst;
}

template <int kDimension>
Expected<CurveFit<kDimension>> fit_stroke(
    std::span<const Eigen::Matrix<double, kDimension, 1>> positions, std::span<const double> times,
    const FitOptions& options) {
  return StrokeFitter<kDimension>(positions, times, options).fit();
}

}  // namespace limn::fit_detail
