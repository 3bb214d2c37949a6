#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "modeler/fit/banded_system.hpp"
#include "modeler/fit/cubic_basis.hpp"

namespace limn::fit_detail {

/// Fewer spans would meet one control point twice in one span.
inline constexpr int kLeastPeriodicSpans = 4;

/// How a segment (a part of a stroke between corners) ends.
template <int kDimension>
struct SegmentEnds {
  using Point = Eigen::Matrix<double, kDimension, 1>;
  std::optional<Point> begin;  ///< the curve must start here
  std::optional<Point> end;    ///< the curve must end here
  bool periodic = false;       ///< the segment runs into itself, C2; begin and end are unused
};

/// Samples of a segment with what an iteration knows of each. Parameters ascend (not strictly).
template <int kDimension>
struct SegmentSamples {
  using Point = Eigen::Matrix<double, kDimension, 1>;
  explicit SegmentSamples(std::span<const Point> given, std::vector<double> parameters)
      : points(given),
        u(std::move(parameters)),
        weight(given.size(), 1.0),
        squared_error(given.size(), 0.0),
        tangent(given.size(), Point::Zero()) {}

  std::span<const Point> points;
  std::vector<double> u;
  std::vector<double> weight;
  std::vector<double> squared_error;  ///< distance from the curve, squared, as last measured
  std::vector<Point> tangent;  ///< unit tangent of the curve at u, zero where it stands still
};

/// The working curve of a fit: cubic, C2, on breakpoints u_0 < .. < u_N, either clamped (N + 3
/// control points) or periodic (N, wrapped to N + 3 as KnotVector does).
template <int kDimension>
class SegmentSpline {
 public:
  using Point = Eigen::Matrix<double, kDimension, 1>;
  using Samples = SegmentSamples<kDimension>;

  const std::vector<double>& breaks() const noexcept { return breaks_; }
  const std::vector<Point>& points() const noexcept { return points_; }
  Point third_derivative(int s) const noexcept { return 6.0 * span_curve(s).power[3]; }
  Point tangent_at_begin(int s) const noexcept {
    const auto c = span_curve(s);
    const double h = breaks_[static_cast<std::size_t>(s)] - middle(s);
    const Point first = c.power[1] + h * (2 * c.power[2] + 3 * h * c.power[3]);
    const double n = first.norm();
    return n > 0 ? Point(first / n) : Point(Point::Zero());
  }
  int spans() const noexcept { return static_cast<int>(breaks_.size()) - 1; }
  int control_count() const noexcept { return periodic_ ? spans() : spans() + 3; }

  /// Takes new breakpoints, strictly ascending; a periodic spline has at least kLeastPeriodicSpans.
  /// The control points wait for solve().
  void set_breaks(std::vector<double> breaks, bool periodic);

  /// Least squares over the samples at their parameters with their weights. The part of a residual
  /// along the sample's tangent counts only `tangential` (0 < tangential <= 1): a sample may slide
  /// along the curve, which project() then lets it do. 1 is plain distance minimisation; small
  /// values give tangent distance minimisation, damped, of quadratic convergence [WPL06].
  /// False (control points unchanged) where the system is singular in double precision.
  bool solve(const Samples& samples, const SegmentEnds<kDimension>& ends, double tangential);

  /// Moves every sample's parameter one damped Newton step towards its foot point, order kept, the
  /// first (and in an open segment the last) staying at the ends; stores errors (to second order in
  /// the step) and tangents. Returns the largest error.
  double project(Samples& samples) const;

  /// Stores the errors at the parameters as they are. Returns the largest.
  double measure(Samples& samples) const;

  /// Looks at the curve half-way between neighbouring samples. Where it strays from their leg by
  /// more than the tolerance and a quarter of the leg (a bend's rise over its chord, for a turn of
  /// up to two radians), raises the errors of both above the tolerance in proportion. Returns the
  /// largest such error, 0 if there is none.
  double measure_between(Samples& samples, double tolerance) const;

 private:
  using Coefficients = std::array<std::array<double, 4>, 4>;  // [power][function]

  struct SpanCurve {  // the curve on a span as a polynomial in u - middle
    std::array<Point, 4> power;
  };

  double middle(int s) const noexcept {
    const auto i = static_cast<std::size_t>(s);
    return 0.5 * (breaks_[i] + breaks_[i + 1]);
  }
  SpanCurve span_curve(int s) const noexcept;
  template <class Visit>
  void for_each_in_span(const Samples& samples, Visit visit) const;
  template <int kBlock, int kRight>
  void regularize(BandedSystem<kBlock, kRight>& system) const;
  template <int kBlock, int kRight>
  void fix_ends(BandedSystem<kBlock, kRight>& system, const SegmentEnds<kDimension>& ends) const;
  template <int kBlock, int kRight>
  void read_points(BandedSystem<kBlock, kRight>& system);
  void assemble_distance(const Samples& samples);
  void assemble_tangent_distance(const Samples& samples, double tangential);
  int control(int span, int k) const noexcept {
    const int i = span + k;
    return periodic_ && i >= spans() ? (i - spans()) % spans() : i;
  }

  bool periodic_ = false;
  std::vector<double> breaks_;
  std::vector<double> knots_;
  std::vector<Coefficients> basis_;  // one a span, powers of u - middle
  std::vector<Point> points_;
  BandedSystem<1, kDimension> distance_;
  BandedSystem<kDimension, 1> tangent_distance_;
};

/// Weight of the second differences of control points beside a sample's weight of about 1: enough
/// to bridge spans without data, too little (a relative bias of 1e-9) to see elsewhere.
inline constexpr double kRegularization = 1e-9;

template <int kDimension>
void SegmentSpline<kDimension>::set_breaks(std::vector<double> breaks, bool periodic) {
  periodic_ = periodic;
  breaks_ = std::move(breaks);
  const auto n = breaks_.size() - 1;
  const double period = breaks_.back() - breaks_.front();
  knots_.resize(n + 7);
  for (std::size_t i = 0; i <= n; ++i) knots_[i + 3] = breaks_[i];
  for (std::size_t k = 1; k <= 3; ++k) {
    if (periodic) {
      knots_[3 - k] = breaks_[n - k] - period;
      knots_[n + 3 + k] = breaks_[k] + period;
    } else {
      knots_[3 - k] = breaks_.front();
      knots_[n + 3 + k] = breaks_.back();
    }
  }
  basis_.resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    const CubicBasis b = cubic_basis(knots_.data() + s + 3, middle(static_cast<int>(s)));
    // Third derivatives by differencing the second ones across the span: they are linear in it.
    const CubicBasis at_begin = cubic_basis(knots_.data() + s + 3, breaks_[s]);
    const double half = 0.5 * (breaks_[s + 1] - breaks_[s]);
    for (std::size_t k = 0; k < 4; ++k) {
      const double third = (b.second[k] - at_begin.second[k]) / half;
      basis_[s][0][k] = b.value[k];
      basis_[s][1][k] = b.first[k];
      basis_[s][2][k] = 0.5 * b.second[k];
      basis_[s][3][k] = third / 6.0;
    }
  }
}

template <int kDimension>
typename SegmentSpline<kDimension>::SpanCurve SegmentSpline<kDimension>::span_curve(
    int s) const noexcept {
  SpanCurve out;
  const auto& b = basis_[static_cast<std::size_t>(s)];
  const Point* p = points_.data() + s;
  for (std::size_t power = 0; power < 4; ++power) {
    out.power[power] =
        b[power][0] * p[0] + b[power][1] * p[1] + b[power][2] * p[2] + b[power][3] * p[3];
  }
  return out;
}

/// visit(span, begin, end) for each span that holds samples [begin, end).
template <int kDimension>
template <class Visit>
void SegmentSpline<kDimension>::for_each_in_span(const Samples& samples, Visit visit) const {
  std::size_t i = 0;
  for (int s = 0; s < spans(); ++s) {
    const std::size_t begin = i;
    if (s + 1 == spans()) {
      i = samples.u.size();
    } else {
      while (i < samples.u.size() && samples.u[i] < breaks_[static_cast<std::size_t>(s + 1)]) ++i;
    }
    if (i > begin) visit(s, begin, i);
  }
}

template <int kDimension>
template <int kBlock, int kRight>
void SegmentSpline<kDimension>::regularize(BandedSystem<kBlock, kRight>& system) const {
  const auto greville = [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return (knots_[k + 1] + knots_[k + 2] + knots_[k + 3]) / 3.0;
  };
  const int count = spans() + (periodic_ ? 0 : 1);
  for (int i = 0; i < count; ++i) {
    const double h1 = greville(i + 1) - greville(i);
    const double h2 = greville(i + 2) - greville(i + 1);
    const std::array<double, 3> difference = {h2 / (h1 + h2), -1.0, h1 / (h1 + h2)};
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b <= a; ++b) {
        const double value = kRegularization * difference[static_cast<std::size_t>(a)] *
                             difference[static_cast<std::size_t>(b)];
        for (int d = 0; d < kBlock; ++d) {
          system.at(control(i, a) * kBlock + d, control(i, b) * kBlock + d) += value;
        }
      }
    }
  }
}

/// Replaces the first and last unknown by their wanted values, symmetrically.
template <int kDimension>
template <int kBlock, int kRight>
void SegmentSpline<kDimension>::fix_ends(BandedSystem<kBlock, kRight>& system,
                                         const SegmentEnds<kDimension>& ends) const {
  if (periodic_) return;
  const int rows = control_count() * kBlock;
  const auto fix = [&](int control_point, const Point& value) {
    for (int b = 0; b < kBlock; ++b) {
      const int row = control_point * kBlock + b;
      const int low = std::max(0, (control_point - 3) * kBlock);
      const int high = std::min(rows, (control_point + 4) * kBlock);
      for (int other = low; other < high; ++other) {
        if (other == row) continue;
        double& coupling = system.at(other, row);
        for (int q = 0; q < kRight; ++q) system.right(other, q) -= coupling * value[b + q];
        coupling = 0;
      }
      system.at(row, row) = 1;
      for (int q = 0; q < kRight; ++q) system.right(row, q) = value[b + q];
    }
  };
  if (ends.begin) fix(0, *ends.begin);
  if (ends.end) fix(control_count() - 1, *ends.end);
}

template <int kDimension>
template <int kBlock, int kRight>
void SegmentSpline<kDimension>::read_points(BandedSystem<kBlock, kRight>& system) {
  points_.resize(static_cast<std::size_t>(spans()) + 3);
  for (int i = 0; i < spans() + 3; ++i) {
    for (int d = 0; d < kDimension; ++d) {
      const int row = control(0, i) * kBlock + (kBlock == 1 ? 0 : d);
      points_[static_cast<std::size_t>(i)][d] = system.right(row, kBlock == 1 ? d : 0);
    }
  }
}

template <int kDimension>
void SegmentSpline<kDimension>::assemble_distance(const Samples& samples) {
  distance_.reset(control_count(), periodic_);
  for_each_in_span(samples, [&](int s, std::size_t begin, std::size_t end) {
    const auto& b = basis_[static_cast<std::size_t>(s)];
    const double mid = middle(s);
    std::array<std::array<double, 4>, 4> matrix{};
    std::array<Point, 4> right;
    right.fill(Point::Zero());
    for (std::size_t i = begin; i < end; ++i) {
      const double h = samples.u[i] - mid;
      std::array<double, 4> value;
      for (std::size_t k = 0; k < 4; ++k) {
        value[k] = b[0][k] + h * (b[1][k] + h * (b[2][k] + h * b[3][k]));
      }
      for (std::size_t k = 0; k < 4; ++k) {
        const double weighted = samples.weight[i] * value[k];
        for (std::size_t j = 0; j <= k; ++j) matrix[k][j] += weighted * value[j];
        right[k] += weighted * samples.points[i];
      }
    }
    for (int k = 0; k < 4; ++k) {
      const int row = control(s, k);
      for (int j = 0; j <= k; ++j) {
        distance_.at(row, control(s, j)) +=
            matrix[static_cast<std::size_t>(k)][static_cast<std::size_t>(j)];
      }
      for (int d = 0; d < kDimension; ++d) {
        distance_.right(row, d) += right[static_cast<std::size_t>(k)][d];
      }
    }
  });
}

template <int kDimension>
void SegmentSpline<kDimension>::assemble_tangent_distance(const Samples& samples,
                                                          double tangential) {
  // Per sample the metric M = w (I - (1 - tangential) t t^T); block (k, j) gains N_k N_j M, of
  // which the lower triangle is enough because M is symmetric.
  constexpr std::size_t kTriangle = static_cast<std::size_t>(kDimension * (kDimension + 1) / 2);
  tangent_distance_.reset(control_count(), periodic_);
  for_each_in_span(samples, [&](int s, std::size_t begin, std::size_t end) {
    const auto& b = basis_[static_cast<std::size_t>(s)];
    const double mid = middle(s);
    // [entry of M][pair (k, j), j <= k]: long inner loops, which compilers vectorise.
    std::array<std::array<double, 10>, kTriangle> matrix{};
    std::array<std::array<double, 4>, static_cast<std::size_t>(kDimension)> right{};
    for (std::size_t i = begin; i < end; ++i) {
      const double h = samples.u[i] - mid;
      std::array<double, 4> value;
      for (std::size_t k = 0; k < 4; ++k) {
        value[k] = b[0][k] + h * (b[1][k] + h * (b[2][k] + h * b[3][k]));
      }
      std::array<double, 10> product;
      for (std::size_t k = 0, pair = 0; k < 4; ++k) {
        for (std::size_t j = 0; j <= k; ++j) product[pair++] = value[k] * value[j];
      }
      const Point& t = samples.tangent[i];
      const double w = samples.weight[i];
      const double slide = w * (1 - tangential);
      const Point pulled = w * samples.points[i] - slide * t.dot(samples.points[i]) * t;
      std::size_t entry = 0;
      for (int d = 0; d < kDimension; ++d) {
        for (int e = 0; e <= d; ++e, ++entry) {
          const double metric = (d == e ? w : 0.0) - slide * t[d] * t[e];
          for (std::size_t pair = 0; pair < 10; ++pair)
            matrix[entry][pair] += metric * product[pair];
        }
        for (std::size_t k = 0; k < 4; ++k) {
          right[static_cast<std::size_t>(d)][k] += value[k] * pulled[d];
        }
      }
    }
    std::size_t pair = 0;
    for (int k = 0; k < 4; ++k) {
      const int row = control(s, k) * kDimension;
      for (int j = 0; j <= k; ++j, ++pair) {
        const int column = control(s, j) * kDimension;
        std::size_t entry = 0;
        for (int d = 0; d < kDimension; ++d) {
          for (int e = 0; e <= d; ++e, ++entry) {
            tangent_distance_.at(row + d, column + e) += matrix[entry][pair];
            if (d != e && j != k) tangent_distance_.at(row + e, column + d) += matrix[entry][pair];
          }
        }
      }
      for (int d = 0; d < kDimension; ++d) {
        tangent_distance_.right(row + d, 0) +=
            right[static_cast<std::size_t>(d)][static_cast<std::size_t>(k)];
      }
    }
  });
}

template <int kDimension>
bool SegmentSpline<kDimension>::solve(const Samples& samples, const SegmentEnds<kDimension>& ends,
                                      double tangential) {
  const auto finish = [&](auto& system) {
    regularize(system);
    fix_ends(system, ends);
    if (!system.solve()) return false;
    read_points(system);
    return true;
  };
  if (tangential >= 1) {
    assemble_distance(samples);
    return finish(distance_);
  }
  assemble_tangent_distance(samples, tangential);
  return finish(tangent_distance_);
}

template <int kDimension>
double SegmentSpline<kDimension>::project(Samples& samples) const {
  // A step longer than a quarter of a span may leave the basin of its foot point (another lap).
  constexpr double kLongestStep = 0.25;
  // Curvature may change the Newton step against the Gauss-Newton one by this factor at most.
  constexpr double kMostCurvature = 4.0;
  double floor = breaks_.front();  // keeps the order
  double worst = 0;                // squared
  const std::size_t last = periodic_ ? samples.u.size() : samples.u.size() - 1;
  for_each_in_span(samples, [&](int s, std::size_t begin, std::size_t end) {
    const SpanCurve c = span_curve(s);
    const double mid = middle(s);
    const auto at = static_cast<std::size_t>(s);
    const double longest = kLongestStep * (breaks_[at + 1] - breaks_[at]);
    for (std::size_t i = begin; i < end; ++i) {
      const double h = samples.u[i] - mid;
      const Point value = c.power[0] + h * (c.power[1] + h * (c.power[2] + h * c.power[3]));
      const Point first = c.power[1] + h * (2 * c.power[2] + 3 * h * c.power[3]);
      const Point second = 2 * c.power[2] + 6 * h * c.power[3];
      const Point residual = value - samples.points[i];
      const double speed2 = first.squaredNorm();
      double step = 0;
      if (speed2 > 0) {
        samples.tangent[i] = first * (1.0 / std::sqrt(speed2));
        double slope = speed2 + residual.dot(second);
        if (!(slope * kMostCurvature > speed2 && slope < kMostCurvature * speed2)) slope = speed2;
        step = std::clamp(-residual.dot(first) / slope, -longest, longest);
      } else {
        samples.tangent[i] = Point::Zero();
      }
      if (i == 0 || i >= last) step = 0;
      const double moved = std::clamp(samples.u[i] + step, floor, breaks_.back());
      step = moved - samples.u[i];
      samples.u[i] = floor = moved;
      const double error2 = (residual + step * (first + 0.5 * step * second)).squaredNorm();
      samples.squared_error[i] = error2;
      worst = std::max(worst, error2);
    }
  });
  return std::sqrt(worst);
}

template <int kDimension>
double SegmentSpline<kDimension>::measure(Samples& samples) const {
  double worst = 0;  // squared
  for_each_in_span(samples, [&](int s, std::size_t begin, std::size_t end) {
    const SpanCurve c = span_curve(s);
    const double mid = middle(s);
    for (std::size_t i = begin; i < end; ++i) {
      const double h = samples.u[i] - mid;
      const Point value = c.power[0] + h * (c.power[1] + h * (c.power[2] + h * c.power[3]));
      samples.squared_error[i] = (value - samples.points[i]).squaredNorm();
      worst = std::max(worst, samples.squared_error[i]);
    }
  });
  return std::sqrt(worst);
}

template <int kDimension>
double SegmentSpline<kDimension>::measure_between(Samples& samples, double tolerance) const {
  constexpr double kRise = 0.25;
  double worst = 0;  // squared
  int span = 0;
  SpanCurve c = span_curve(span);
  const std::size_t legs = samples.u.size() - (periodic_ ? 0 : 1);
  for (std::size_t i = 0; i < legs; ++i) {
    const bool closing = i + 1 == samples.u.size();
    const std::size_t next = closing ? 0 : i + 1;
    const Point leg = samples.points[next] - samples.points[i];
    const double length2 = leg.squaredNorm();
    if (!(length2 > 0)) continue;
    const double allowed = tolerance + kRise * std::sqrt(length2);
    const double u = 0.5 * (samples.u[i] + (closing ? breaks_.back() : samples.u[next]));
    while (span + 1 < spans() && u >= breaks_[static_cast<std::size_t>(span) + 1]) {
      c = span_curve(++span);
    }
    const double h = u - middle(span);
    const Point off =
        c.power[0] + h * (c.power[1] + h * (c.power[2] + h * c.power[3])) - samples.points[i];
    const double share = std::clamp(leg.dot(off) / length2, 0.0, 1.0);
    const double distance2 = (off - share * leg).squaredNorm();
    if (distance2 <= allowed * allowed) continue;
    const double error2 = tolerance * tolerance * distance2 / (allowed * allowed);
    samples.squared_error[i] = std::max(samples.squared_error[i], error2);
    samples.squared_error[next] = std::max(samples.squared_error[next], error2);
    worst = std::max(worst, error2);
  }
  return std::sqrt(worst);
}

}  // namespace limn::fit_detail
