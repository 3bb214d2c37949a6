#include "modeler/view/plot_track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "input/base/expect.hpp"

namespace limn {
namespace {

/// Of both, the later one behind.
PlotTrack::Range joined(const PlotTrack::Range& a, const PlotTrack::Range& b) {
  if (std::isnan(a.first)) return b;
  if (std::isnan(b.first)) return a;
  return {a.first, std::min(a.low, b.low), std::max(a.high, b.high), b.last};
}

/// Of a path's extent: less than a line's width of the picture.
constexpr double kShare = 1e-3;

const Eigen::Vector2d kBreak = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

/// A break within a stretch shows no more.
PlotTrack::Flags joined(const PlotTrack::Flags& a, const PlotTrack::Flags& b) {
  return {a.begins_anew, a.shaded || b.shaded, a.marked || b.marked};
}

}  // namespace

void PlotTrack::push(double time_s, std::span<const double> values, Flags flags) {
  LIMN_EXPECT(values.size() == channels_);
  if (!bins_.empty()) time_s = std::max(time_s, bins_.back().end_s);
  const bool same = !bins_.empty() && key(bins_.back().begin_s) == key(time_s);
  if (!same) {
    bins_.push_back({time_s, time_s, flags});
    for (const double value : values) ranges_.push_back({value, value, value, value});
    if (bins_.size() > kMostBins) merge();
    return;
  }
  bins_.back().end_s = time_s;
  bins_.back().flags = joined(bins_.back().flags, flags);
  Range* const last = &ranges_[ranges_.size() - channels_];
  for (std::size_t i = 0; i < channels_; ++i) {
    last[i] = joined(last[i], {values[i], values[i], values[i], values[i]});
  }
}

PlotTrack::Range PlotTrack::extent(std::size_t channel) const noexcept {
  const double none = std::numeric_limits<double>::quiet_NaN();
  Range all{none, none, none, none};
  for (std::size_t i = 0; i < bins_.size(); ++i) all = joined(all, range(i, channel));
  return all;
}

long long PlotTrack::key(double time_s) const noexcept {
  return static_cast<long long>(std::floor(time_s / width_s_));
}

void PlotTrack::merge() {
  while (bins_.size() > kMostBins / 2) {
    width_s_ *= 2;
    std::size_t kept = 0;
    for (std::size_t i = 1; i < bins_.size(); ++i) {
      const bool same = key(bins_[kept].begin_s) == key(bins_[i].begin_s);
      if (same) {
        bins_[kept].end_s = bins_[i].end_s;
        bins_[kept].flags = joined(bins_[kept].flags, bins_[i].flags);
      } else {
        bins_[++kept] = bins_[i];
      }
      for (std::size_t c = 0; c < channels_; ++c) {
        Range& into = ranges_[kept * channels_ + c];
        const Range& from = ranges_[i * channels_ + c];
        into = same ? joined(into, from) : from;
      }
    }
    bins_.resize(kept + 1);
    ranges_.resize(bins_.size() * channels_);
  }
}

void PlotPath::push(const Eigen::Vector2d& point) {
  box_.extend(point);
  last_ = point;
  if (!points_.empty() && (point - at_).norm() <= apart_) return;
  add(point);
  constexpr std::size_t kEnd = 3;  // what points() may add
  std::size_t most = kMostPoints - kEnd;
  while (points_.size() > most) {
    most = kMostPoints / 2;  // the next time shall not be soon
    thin();
  }
}

void PlotPath::add(const Eigen::Vector2d& point) {
  const Eigen::Vector2d from = std::exchange(at_, point);
  if (points_.empty()) {
    points_.push_back(point);
    return;
  }
  if (!is_new(from, point)) return;
  if (points_.back() != from) {  // what leads there is drawn already
    points_.push_back(kBreak);
    points_.push_back(from);
  }
  points_.push_back(point);
}

/// Whether no line between the points' cells is drawn yet.
bool PlotPath::is_new(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  if (cell_ == 0) return true;
  std::array<double, 2> a = {std::floor(from.x() / cell_), std::floor(from.y() / cell_)};
  std::array<double, 2> b = {std::floor(to.x() / cell_), std::floor(to.y() / cell_)};
  if (b < a) std::swap(a, b);
  return drawn_.insert({a, b}).second;
}

void PlotPath::thin() {
  const double apart = kShare * box_.sizes().maxCoeff();
  if (apart_ < apart) {
    apart_ = apart;
  } else {
    cell_ = std::max({2 * cell_, apart_, std::numeric_limits<double>::min()});
  }
  const Eigen::Vector2d end = at_;
  const bool ends_drawn = points_.back() == end;
  const std::vector<Eigen::Vector2d> before = std::exchange(points_, {});
  drawn_.clear();
  bool breaks = false;
  for (const Eigen::Vector2d& point : before) {
    if (point.hasNaN()) {
      breaks = true;
    } else if (std::exchange(breaks, false)) {
      at_ = point;
    } else if (points_.empty() || (point - at_).norm() > apart_) {
      add(point);
    }
  }
  if (!ends_drawn) at_ = end;
}

std::vector<Eigen::Vector2d> PlotPath::points() const {
  std::vector<Eigen::Vector2d> all = points_;
  if (all.empty() || all.back() == last_) return all;
  if (all.back() != at_) {
    all.push_back(kBreak);
    if (at_ != last_) all.push_back(at_);
  }
  all.push_back(last_);
  return all;
}

}  // namespace limn
