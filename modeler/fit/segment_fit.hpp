#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "modeler/fit/knot_placement.hpp"
#include "modeler/fit/segment_spline.hpp"

namespace limn::fit_detail {

/// One smooth part of a stroke: its samples, where their parameters start from, how it ends.
template <int kDimension>
struct Segment {
  using Point = Eigen::Matrix<double, kDimension, 1>;
  std::span<const Point> points;   ///< at least two, neighbours distinct
  std::vector<double> parameters;  ///< smoothed chord length from 0, strictly ascending
  std::vector<double> chord;       ///< plain chord length from 0, strictly ascending
  double closing_leg = 0;          ///< periodic only: length from the last sample to the first
  SegmentEnds<kDimension> ends;
};

/// Fits one segment within a tolerance at every sample, with few spans:
///
///  1. plain least squares, failing spans halved until it is nearly there (initial_fit): few spans
///     average the noise out, which would otherwise ask for more of them;
///  2. parameters that advance more where the curve bends (follow_bends);
///  3. knots where the shape needs them, by the jumps of its third derivative (place_by_shape);
///  4. tangent distance minimisation, samples sliding, knots moved by measured errors until every
///     sample is within tolerance (reach_tolerance); where that loses its way, the same once more
///     from the first fit, with knots only added;
///  5. failing that, knots at the samples themselves, up to interpolation (interpolate);
///  6. windows of spans that can do with one span less lose it, and those that then fail get it
///     back (remove_knots).
///
/// Each pass is linear in samples and spans, and their number is bounded. All lengths and the
/// tolerance are in one unit; the caller scales them so that no square over- or underflows.
template <int kDimension>
class SegmentFitter {
 public:
  using Point = Eigen::Matrix<double, kDimension, 1>;
  using Spline = SegmentSpline<kDimension>;

  /// `least_gap`: nearest that two knots may lie.
  SegmentFitter(Segment<kDimension> segment, double tolerance, double least_gap)
      : samples_(segment.points, segment.parameters),
        smoothed_chord_(std::move(segment.parameters)),
        chord_(std::move(segment.chord)),
        closing_leg_(segment.closing_leg),
        chord_closing_leg_(segment.closing_leg),
        ends_(std::move(segment.ends)),
        tolerance_(tolerance),
        least_gap_(least_gap) {}

  /// False where no cubic C2 curve within tolerance was found, interpolation included: then double
  /// precision is at its end.
  bool run() {
    // Many ask for few knots but may lose the way; none only adds knots.
    for (const int redistributions : {4, 0}) {
      initial_fit();
      follow_bends();
      if (redistributions == 0 || place_by_shape()) reach_tolerance(redistributions);
      if (has_best_) break;
    }
    if (!has_best_ && !interpolate()) return false;
    remove_knots();
    return true;
  }

  const Spline& spline() const noexcept { return best_; }
  const std::vector<double>& parameters() const noexcept { return best_parameters_; }

 private:
  /// What a sample's error along the curve counts in solve(), once samples slide: small enough for
  /// the quadratic convergence of tangent distance minimisation, large enough to damp it.
  static constexpr double kSliding = 0.02;
  /// The same for the first solve after knots were placed anew, far from the solution.
  static constexpr double kCautious = 0.2;
  /// The more a fit is off (in tolerances), the less its tangents can be trusted.
  static constexpr double kDistrust = 0.05;

  int least_spans() const noexcept { return ends_.periodic ? kLeastPeriodicSpans : 1; }
  std::size_t sample_count() const noexcept { return samples_.points.size(); }

  /// Parameter of the curve's end: of the last sample, or of the first one a round later.
  double end_parameter(const std::vector<double>& parameters) const noexcept {
    return parameters.back() + (ends_.periodic ? closing_leg_ : 0.0);
  }

  bool solve(double tangential) {
    // A block row takes 4 d^2 doubles; beyond 64 MB plain distances do, at 4 a row.
    constexpr double kMostDoubles = 8e6;
    const double doubles =
        4.0 * kDimension * kDimension * static_cast<double>(spline_.control_count());
    return spline_.solve(samples_, ends_, doubles > kMostDoubles ? 1.0 : tangential);
  }

  /// Slides the samples, and weights them for the next solve: p-norms with growing p pull a least
  /// squares fit towards the least maximum.
  void project() {
    constexpr double kLeastWeight = 0.3;
    constexpr double kMostWeight = 4.0;
    worst_ = spline_.project(samples_);
    const double scale = 1.0 / (tolerance_ * tolerance_);
    for (std::size_t i = 0; i < sample_count(); ++i) {
      const double x2 = samples_.squared_error[i] * scale;
      samples_.weight[i] = kLeastWeight + std::min(x2, kMostWeight);
    }
  }

  bool iterate(double tangential) {
    if (!solve(tangential)) return false;
    project();
    return true;
  }

  bool fails_at(std::size_t i) const noexcept {
    return samples_.squared_error[i] > tolerance_ * tolerance_;
  }

  double trusted_sliding() const noexcept {
    return std::clamp(kDistrust * worst_ / tolerance_, kSliding, 0.5);
  }

  /// Keeps the curve if it is within tolerance and has fewer spans than the best so far. Returns
  /// whether it is within tolerance.
  bool keep_if_within() {
    if (!(worst_ <= tolerance_)) return false;
    worst_ = spline_.measure(samples_);  // what project() gave was an estimate
    if (!(worst_ <= tolerance_)) return false;
    worst_ = std::max(worst_, spline_.measure_between(samples_, tolerance_));
    if (!(worst_ <= tolerance_)) return false;
    return (has_best_ && spline_.spans() >= best_.spans()) || keep();
  }
  bool keep() {
    best_ = spline_;
    best_parameters_ = samples_.u;
    has_best_ = true;
    return true;
  }

  std::vector<double> span_errors() const {
    const auto& breaks = spline_.breaks();
    std::vector<double> errors(breaks.size() - 1, 0.0);
    std::size_t s = 0;
    for (std::size_t i = 0; i < sample_count(); ++i) {
      while (s + 2 < breaks.size() && samples_.u[i] >= breaks[s + 1]) ++s;
      errors[s] = std::max(errors[s], samples_.squared_error[i]);
    }
    for (double& e : errors) e = std::sqrt(e);
    return errors;
  }

  /// span_mass() of what the error has above the noise, relative to what the target has.
  double mass_above_noise(double error, double target) const noexcept {
    constexpr double kLeastShare = 0.05;  // of the error: below the noise all errors look alike
    return span_mass(std::max(error - noise_, kLeastShare * error), target - noise_);
  }

  /// What follow_bends() changes.
  struct State {
    SegmentSamples<kDimension> samples;
    Spline spline;
    double worst;
    double closing_leg;
  };

  static double total_mass(const std::vector<double>& mass) {
    return std::accumulate(mass.begin(), mass.end(), 0.0);
  }

  void initial_fit();
  void set_breaks_at(const std::vector<std::size_t>& sites, const std::vector<double>& parameters);
  bool split_failing_sites(std::vector<std::size_t>& sites) const;
  void follow_bends();
  /// Turning of the curve between neighbouring samples, radians.
  double turning(std::size_t i, std::size_t next) const noexcept {
    return std::acos(std::clamp(samples_.tangent[i].dot(samples_.tangent[next]), -1.0, 1.0));
  }
  std::vector<double> bends() const;
  void estimate_noise();
  std::vector<double> masses_by_shape() const;
  bool place_by_shape();
  void reach_tolerance(int redistributions);
  bool redistribute_all(bool within);
  void grow_failing_ranges();
  bool interpolate();
  void remove_knots();
  struct Removal;
  bool plan_removal(int width, int offset, Removal& removal) const;
  std::vector<double> join(const Removal& removal) const;
  bool restore_failing(Removal& removal) const;

  SegmentSamples<kDimension> samples_;
  std::vector<double> smoothed_chord_;
  std::vector<double> chord_;
  double closing_leg_;  // in terms of samples_.u
  double chord_closing_leg_;
  SegmentEnds<kDimension> ends_;
  double tolerance_;
  double least_gap_;
  double worst_ = 0;  // error of spline_, as of the last project() or measure()
  double noise_ = 0;  // what of an error more knots would not take away
  Spline spline_;
  Spline best_;
  std::vector<double> best_parameters_;
  bool has_best_ = false;
};

/// Breakpoints at the parameters of the samples `sites` (ascending; sample_count() means the end of
/// a periodic segment), as far as they stay apart.
template <int kDimension>
void SegmentFitter<kDimension>::set_breaks_at(const std::vector<std::size_t>& sites,
                                              const std::vector<double>& parameters) {
  const double end = end_parameter(parameters);
  std::vector<double> breaks = {parameters.front()};
  for (const std::size_t site : sites) {
    if (site == 0 || site >= sample_count()) continue;
    const double u = parameters[site];
    if (u >= breaks.back() + least_gap_ && u <= end - least_gap_) breaks.push_back(u);
  }
  breaks.push_back(end);
  // A periodic spline needs a few spans even where samples are fewer.
  while (static_cast<int>(breaks.size()) <= least_spans()) {
    const std::vector<double> even(breaks.size() - 1, 1.0);
    breaks = equidistribute(breaks, even, 2 * static_cast<int>(even.size()), 0.0);
  }
  spline_.set_breaks(std::move(breaks), ends_.periodic);
}

/// Adds a site in the middle of each gap that holds a sample out of tolerance; false where none
/// can.
template <int kDimension>
bool SegmentFitter<kDimension>::split_failing_sites(std::vector<std::size_t>& sites) const {
  std::vector<std::size_t> next = {sites.front()};
  for (std::size_t j = 0; j + 1 < sites.size(); ++j) {
    const std::size_t last = std::min(sites[j + 1], sample_count() - 1);
    bool fails = false;
    for (std::size_t i = sites[j]; i <= last; ++i) fails |= fails_at(i);
    if (fails && sites[j + 1] - sites[j] > 1) next.push_back((sites[j] + sites[j + 1]) / 2);
    next.push_back(sites[j + 1]);
  }
  const bool more = next.size() > sites.size();
  sites = std::move(next);
  return more;
}

template <int kDimension>
void SegmentFitter<kDimension>::initial_fit() {
  constexpr double kNearly = 2;                // in tolerances: sliding takes care of the rest
  constexpr std::size_t kSamplesPerSpan = 10;  // with fewer, a span may follow noise
  std::vector<std::size_t> sites = {0, sample_count() - (ends_.periodic ? 0 : 1)};
  closing_leg_ = chord_closing_leg_;
  std::fill(samples_.weight.begin(), samples_.weight.end(), 1.0);
  for (;;) {  // each round halves the spans that fail
    set_breaks_at(sites, smoothed_chord_);
    samples_.u = smoothed_chord_;
    if (!solve(1.0)) {
      worst_ = std::numeric_limits<double>::infinity();
      return;
    }
    project();
    if (worst_ <= kNearly * tolerance_ || sites.size() * kSamplesPerSpan > sample_count()) break;
    if (!split_failing_sites(sites)) break;
  }
  estimate_noise();
  keep_if_within();
}

/// Turning of the curve over each leg between samples (over the closing one, too, where periodic),
/// per unit of parameter, averaged over a few legs.
template <int kDimension>
std::vector<double> SegmentFitter<kDimension>::bends() const {
  constexpr std::size_t kReach = 2;  // legs either side
  const std::size_t legs = sample_count() - (ends_.periodic ? 0 : 1);
  std::vector<double> turned = {0.0};  // up to each leg's begin
  std::vector<double> passed = {0.0};
  for (std::size_t i = 0; i < legs; ++i) {
    const std::size_t next = i + 1 < sample_count() ? i + 1 : 0;
    turned.push_back(turned.back() + turning(i, next));
    const double leg = next == 0 ? end_parameter(samples_.u) : samples_.u[next];
    passed.push_back(passed.back() + leg - samples_.u[i]);
  }
  std::vector<double> out(legs);
  for (std::size_t i = 0; i < legs; ++i) {
    const std::size_t low = i - std::min(i, kReach);
    const std::size_t high = std::min(legs, i + 1 + kReach);
    const double length = passed[high] - passed[low];
    out[i] = length > 0 ? (turned[high] - turned[low]) / length : 0.0;
  }
  return out;
}

/// Gives each leg a share of the parameter in proportion to length times curvature^(1/3), as affine
/// arc length does: on it a parabola is a polynomial and an ellipse turns evenly, and pens (whose
/// speed falls with the same power of curvature [LTV83]) move about evenly. A floor keeps straight
/// parts going by length. Taken back where the shape then needs no fewer spans: along a straight
/// stroke the bends are noise.
template <int kDimension>
void SegmentFitter<kDimension>::follow_bends() {
  constexpr double kPower = 1.0 / 3;
  constexpr double kFloor = 0.2;       // of the mean curvature
  constexpr double kLeastTurning = 1;  // radians, below which the mean says little
  constexpr double kTrusted = 3;       // in tolerances: a worse fit's tangents are no guide
  constexpr std::size_t kLeastSamples = 6;
  if (sample_count() < kLeastSamples || !(worst_ <= kTrusted * tolerance_)) return;
  const auto curvature = bends();
  const std::vector<double> old = samples_.u;
  const double length = end_parameter(old);
  const auto leg_end = [&](std::size_t i) { return i + 1 < old.size() ? old[i + 1] : length; };
  double turned = kLeastTurning;
  for (std::size_t i = 0; i < curvature.size(); ++i) turned += curvature[i] * (leg_end(i) - old[i]);
  std::vector<double> mapped = {0.0};
  for (std::size_t i = 0; i < curvature.size(); ++i) {
    const double relative = curvature[i] * length / turned;
    const double leg = leg_end(i) - old[i];
    mapped.push_back(mapped.back() +
                     std::max(std::pow(relative + kFloor, kPower) * leg, least_gap_));
  }
  const double scale = length / mapped.back();
  for (double& u : mapped) u *= scale;

  std::vector<double> breaks = {0.0};
  std::size_t i = 0;
  for (const double u : std::span(spline_.breaks()).subspan(1)) {
    while (i + 1 < curvature.size() && leg_end(i) < u) ++i;
    const double leg = leg_end(i) - old[i];
    const double share = leg > 0 ? std::clamp((u - old[i]) / leg, 0.0, 1.0) : 0.0;
    const double to = mapped[i] + share * (mapped[i + 1] - mapped[i]);
    if (to >= breaks.back() + least_gap_ && to <= mapped.back() - least_gap_) breaks.push_back(to);
  }
  breaks.push_back(mapped.back());
  if (static_cast<int>(breaks.size()) <= least_spans()) return;
  const double old_closing_leg = closing_leg_;
  if (ends_.periodic) closing_leg_ = mapped.back() - mapped[old.size() - 1];
  mapped.resize(old.size());
  const State before{samples_, spline_, worst_, old_closing_leg};
  const double cost = total_mass(masses_by_shape());
  samples_.u = std::move(mapped);
  spline_.set_breaks(std::move(breaks), ends_.periodic);
  if (solve(1.0)) {
    project();
    if (total_mass(masses_by_shape()) < cost) {
      keep_if_within();
      return;
    }
  }
  samples_ = before.samples;
  spline_ = before.spline;
  worst_ = before.worst;
  closing_leg_ = before.closing_leg;
}

template <int kDimension>
void SegmentFitter<kDimension>::estimate_noise() {
  constexpr double kDeviations = 2.5;  // a span's largest error is some 2 or 3 of them
  constexpr double kMostShare = 0.5;   // of the tolerance; above, one fits noise in any case
  double sum = 0;
  for (const double e2 : samples_.squared_error) sum += e2;
  const double rms = std::sqrt(sum / static_cast<double>(sample_count()));
  noise_ = std::min(kDeviations * rms, kMostShare * tolerance_);
}

/// How many spans each span of the initial fit is worth, from the fourth derivative across the
/// curve (a sample may slide along it), which the jumps of the third one tell, and from the
/// turning.
template <int kDimension>
std::vector<double> SegmentFitter<kDimension>::masses_by_shape() const {
  // Fitting error of a cubic over a span of length h is about h^4 |C''''| / 100 (between the 1/384
  // of the best interpolant and what the end spans do).
  constexpr double kErrorQuotient = 100;
  // Turning that one span takes at most, radians: about two full circles of a gentle curve.
  constexpr double kMostTurning = 6;
  constexpr double kLeastMass = 1e-3;
  const auto& breaks = spline_.breaks();
  const auto count = static_cast<std::size_t>(spline_.spans());
  std::vector<double> fourth(count + 1, 0.0);  // |C''''| across the curve, at the breakpoints
  for (std::size_t j = 1; j < count; ++j) {
    const auto s = static_cast<int>(j);
    Point jump = spline_.third_derivative(s) - spline_.third_derivative(s - 1);
    const Point tangent = spline_.tangent_at_begin(s);
    jump -= jump.dot(tangent) * tangent;
    fourth[j] = jump.norm() / (0.5 * (breaks[j + 1] - breaks[j - 1]));
  }
  if (count > 1) {
    fourth[0] = fourth[1];
    fourth[count] = fourth[count - 1];
  }
  std::vector<double> mass(count, kLeastMass);
  std::size_t s = 0;
  for (std::size_t i = 0; i + 1 < sample_count(); ++i) {
    while (s + 1 < count && samples_.u[i] >= breaks[s + 1]) ++s;
    mass[s] += turning(i, i + 1) / kMostTurning;
  }
  for (std::size_t j = 0; j < count; ++j) {
    const double h = breaks[j + 1] - breaks[j];
    const double error = 0.5 * std::max(fourth[j], fourth[j + 1]) * h * h * h * h / kErrorQuotient;
    mass[j] += span_mass(error, tolerance_ - noise_);
  }
  return mass;
}

template <int kDimension>
bool SegmentFitter<kDimension>::place_by_shape() {
  constexpr double kRoundingDown = 0.3;  // of the last, partial span
  const auto mass = masses_by_shape();
  const double total = total_mass(mass);
  const double wanted = std::ceil(total - kRoundingDown);
  if (!(wanted < spline_.spans())) return true;
  const int count = std::max(least_spans(), static_cast<int>(wanted));
  spline_.set_breaks(equidistribute(spline_.breaks(), mass, count, least_gap_), ends_.periodic);
  return iterate(kCautious) && iterate(trusted_sliding());
}

/// Iterates until a curve is within tolerance, or a bounded number of rounds. The first
/// `redistributions` rounds spread all knots, if that takes fewer of them; the others only add.
template <int kDimension>
void SegmentFitter<kDimension>::reach_tolerance(int redistributions) {
  constexpr int kAdditions = 8;
  constexpr double kNearly = 2;      // in tolerances: near enough that iterating may do
  constexpr double kProgress = 0.9;  // an iteration that gains less is not worth repeating
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < redistributions + kAdditions; ++round) {
    const bool within = keep_if_within();
    if (round < redistributions) {
      if (!redistribute_all(within) || !iterate(kSliding)) return;
      continue;
    }
    if (has_best_) return;  // perhaps with more spans than hoped for: remove_knots() goes on
    const bool converging = worst_ < kNearly * tolerance_ && worst_ < kProgress * last;
    last = worst_;
    if (!converging) grow_failing_ranges();
    if (!iterate(converging ? trusted_sliding() : kSliding)) return;
  }
  keep_if_within();
}

/// Spreads all knots anew, by measured errors. False if the curve is within tolerance and its knots
/// would not get fewer.
template <int kDimension>
bool SegmentFitter<kDimension>::redistribute_all(bool within) {
  constexpr double kTarget = 0.8;          // of the tolerance: what spans are to come to
  constexpr double kNeighbourShare = 0.5;  // a span's error speaks for its neighbours too
  constexpr double kLeastMass = 0.8;       // damping
  constexpr double kMostMass = 3;
  constexpr double kRoundingDown = 0.3;
  const auto errors = span_errors();
  std::vector<double> mass(errors.size());
  for (std::size_t j = 0; j < errors.size(); ++j) {
    double e = errors[j];
    if (j > 0) e = std::max(e, kNeighbourShare * errors[j - 1]);
    if (j + 1 < errors.size()) e = std::max(e, kNeighbourShare * errors[j + 1]);
    mass[j] = std::clamp(mass_above_noise(e, kTarget * tolerance_), kLeastMass, kMostMass);
  }
  const double total = std::accumulate(mass.begin(), mass.end(), 0.0);
  const int count = std::max(least_spans(), static_cast<int>(std::ceil(total - kRoundingDown)));
  if (within && count >= spline_.spans()) return false;
  spline_.set_breaks(equidistribute(spline_.breaks(), mass, count, least_gap_), ends_.periodic);
  return true;
}

/// Around spans out of tolerance, spreads knots anew with at least one more.
template <int kDimension>
void SegmentFitter<kDimension>::grow_failing_ranges() {
  constexpr int kReach = 2;
  constexpr double kTarget = 0.8;
  constexpr double kLeastMass = 0.5;
  constexpr double kMostMass = 3;
  const std::vector<double> old = spline_.breaks();
  const auto errors = span_errors();
  std::vector<double> breaks = {old.front()};
  int done = 0;
  const auto copy_until = [&](int end) {
    for (; done < end; ++done) breaks.push_back(old[static_cast<std::size_t>(done) + 1]);
  };
  for (const SpanRange range : failing_ranges(errors, tolerance_, kReach)) {
    copy_until(range.begin);
    const auto begin = static_cast<std::size_t>(range.begin);
    const auto size = static_cast<std::size_t>(range.end - range.begin);
    std::vector<double> mass;
    int failing = 0;
    for (std::size_t j = begin; j < begin + size; ++j) {
      mass.push_back(
          std::clamp(mass_above_noise(errors[j], kTarget * tolerance_), kLeastMass, kMostMass));
      failing += errors[j] > tolerance_ ? 1 : 0;
    }
    const double total = std::accumulate(mass.begin(), mass.end(), 0.0);
    const int now = static_cast<int>(size);
    const int count = std::clamp(static_cast<int>(std::ceil(total)), now + 1, now + 2 * failing);
    const auto part = equidistribute({old.data() + begin, size + 1}, mass, count, least_gap_);
    breaks.insert(breaks.end(), part.begin() + 1, part.end());
    done = range.end;
  }
  copy_until(static_cast<int>(errors.size()));
  spline_.set_breaks(std::move(breaks), ends_.periodic);
}

template <int kDimension>
bool SegmentFitter<kDimension>::interpolate() {
  constexpr std::size_t kSamplesPerSpan = 4;
  const std::size_t last = sample_count() - (ends_.periodic ? 0 : 1);
  samples_.u = chord_;
  closing_leg_ = chord_closing_leg_;
  std::fill(samples_.weight.begin(), samples_.weight.end(), 1.0);
  std::vector<std::size_t> sites;
  for (std::size_t i = 0; i < last; i += kSamplesPerSpan) sites.push_back(i);
  sites.push_back(last);
  for (;;) {  // each round adds sites, of which there are at most as many as samples
    set_breaks_at(sites, chord_);
    if (!solve(1.0)) return false;
    worst_ = spline_.measure(samples_);
    if (keep_if_within()) return true;
    if (split_failing_sites(sites)) continue;
    if (sites.size() <= last) {
      sites.resize(last + 1);
      std::iota(sites.begin(), sites.end(), std::size_t{0});
      continue;
    }
    // Every sample is met. That is what was asked for, wherever the curve goes between them.
    return spline_.measure(samples_) <= tolerance_ && keep();
  }
}

/// A round of remove_knots(): windows of the best curve's spans, each with its new breakpoints.
template <int kDimension>
struct SegmentFitter<kDimension>::Removal {
  struct Window {
    SpanRange range;
    std::vector<double> breaks;  // ends included
    bool shortened = false;
  };
  std::vector<double> old;
  std::vector<Window> windows;
};

/// Gives every window that can afford it one span less. False if none can.
template <int kDimension>
bool SegmentFitter<kDimension>::plan_removal(int width, int offset, Removal& removal) const {
  constexpr double kLeastMass = 0.3;
  constexpr double kMostMass = 3;
  // Mass that one of the remaining spans may hold. On few spans a failure costs little: try more.
  constexpr double kAffordable = 1.0;
  constexpr double kFewAffordable = 1.4;
  constexpr int kFewSpans = 3;
  const auto errors = span_errors();
  const int spans = spline_.spans();
  const double affordable = spans <= kFewSpans ? kFewAffordable : kAffordable;
  removal.old = spline_.breaks();
  bool any = false;
  int left = spans;
  for (const SpanRange range : windows(spans, width, offset)) {
    const auto begin = static_cast<std::size_t>(range.begin);
    const auto size = static_cast<std::size_t>(range.end - range.begin);
    std::vector<double> mass;
    for (std::size_t j = begin; j < begin + size; ++j) {
      mass.push_back(std::clamp(mass_above_noise(errors[j], tolerance_), kLeastMass, kMostMass));
    }
    const double total = std::accumulate(mass.begin(), mass.end(), 0.0);
    const std::span<const double> old(removal.old.data() + begin, size + 1);
    typename Removal::Window window{range, {old.begin(), old.end()}, false};
    if (size >= 2 && left > least_spans() && total <= affordable * static_cast<double>(size - 1)) {
      window.breaks = equidistribute(old, mass, static_cast<int>(size) - 1, least_gap_);
      window.shortened = any = true;
      --left;
    }
    removal.windows.push_back(std::move(window));
  }
  return any;
}

template <int kDimension>
std::vector<double> SegmentFitter<kDimension>::join(const Removal& removal) const {
  std::vector<double> breaks = {removal.old.front()};
  for (const auto& window : removal.windows) {
    breaks.insert(breaks.end(), window.breaks.begin() + 1, window.breaks.end());
  }
  return breaks;
}

/// Gives shortened windows that hold a sample out of tolerance their old breakpoints back. Returns
/// whether some window stays shortened.
template <int kDimension>
bool SegmentFitter<kDimension>::restore_failing(Removal& removal) const {
  std::size_t i = 0;
  bool any = false;
  for (auto& window : removal.windows) {
    const double end = removal.old[static_cast<std::size_t>(window.range.end)];
    const bool last = &window == &removal.windows.back();
    bool fails = false;
    for (; i < sample_count() && (last || samples_.u[i] < end); ++i) {
      fails |= fails_at(i);
    }
    if (window.shortened && fails) {
      window.breaks.assign(removal.old.begin() + window.range.begin,
                           removal.old.begin() + window.range.end + 1);
      window.shortened = false;
    }
    any |= window.shortened;
  }
  return any;
}

template <int kDimension>
void SegmentFitter<kDimension>::remove_knots() {
  // Windows of changing widths, straddling the borders of those of the round before. Short segments
  // can afford all of them.
  struct Cut {
    int width;
    int offset;
  };
  constexpr std::array<Cut, 8> kCuts = {
      {{6, 0}, {4, 0}, {5, 2}, {7, 0}, {6, 3}, {4, 2}, {5, 0}, {8, 4}}};
  constexpr std::size_t kShortSegment = 300;  // samples
  constexpr std::size_t kLongRounds = 2;
  constexpr std::size_t kMostRounds = 24;
  constexpr int kRestorations = 2;
  constexpr int kWorthwhile = 12;  // one span in so many: beyond the rounds above, on with it
  constexpr double kNearly = 1.3;  // in tolerances: one more iteration may do
  const std::size_t rounds = sample_count() < kShortSegment ? kCuts.size() : kLongRounds;
  int before = best_.spans() * 2;
  for (std::size_t round = 0; round < kMostRounds; ++round) {
    const bool worthwhile = (before - best_.spans()) * kWorthwhile > before;
    if (round >= rounds && !worthwhile) return;
    before = best_.spans();
    const Cut cut = kCuts[round % kCuts.size()];
    spline_ = best_;
    samples_.u = best_parameters_;
    project();
    Removal removal;
    if (!plan_removal(cut.width, cut.offset, removal)) continue;
    spline_.set_breaks(join(removal), ends_.periodic);
    if (!iterate(kSliding) || !iterate(trusted_sliding())) return;
    if (keep_if_within()) continue;
    if (worst_ < kNearly * tolerance_) {
      if (!iterate(kSliding)) return;
      if (keep_if_within()) continue;
    }
    for (int k = 0; k < kRestorations && restore_failing(removal); ++k) {
      spline_.set_breaks(join(removal), ends_.periodic);
      if (!iterate(kSliding)) return;
      if (keep_if_within()) break;
      if (!iterate(kSliding)) return;
      if (keep_if_within()) break;
    }
  }
}

}  // namespace limn::fit_detail
