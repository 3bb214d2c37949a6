#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <set>
#include <span>
#include <vector>

namespace limn {

/// Values over time, of several channels, as a picture can show them: for each short stretch of
/// time what came first and last, and the lowest and highest, so that no spike is hidden however
/// long it goes on. Constant memory: at most kMostBins stretches, twice as long whenever there are
/// more; few samples stay what they are.
class PlotTrack {
 public:
  static constexpr std::size_t kMostBins = 4096;

  /// What is so at a sample besides its values.
  struct Flags {
    bool begins_anew = false;  ///< no line leads here from the sample before
    bool shaded = false;
    bool marked = false;
  };
  /// Of one channel; NaN: it had no value.
  struct Range {
    double first = 0;
    double low = 0;
    double high = 0;
    double last = 0;
  };
  struct Bin {
    double begin_s = 0;
    double end_s = 0;
    Flags flags;
  };

  /// Precondition: channels > 0.
  explicit PlotTrack(std::size_t channels) : channels_(channels) {}

  /// NaN: none. Times that go back count as that of the sample before. Precondition: as many values
  /// as channels.
  void push(double time_s, std::span<const double> values, Flags flags);
  void push(double time_s, std::span<const double> values) { push(time_s, values, Flags()); }

  std::size_t channels() const noexcept { return channels_; }
  const std::vector<Bin>& bins() const noexcept { return bins_; }
  const Range& range(std::size_t bin, std::size_t channel) const noexcept {
    return ranges_[bin * channels_ + channel];
  }
  /// Lowest and highest of all; NaN where the channel never had a value.
  Range extent(std::size_t channel) const noexcept;

 private:
  long long key(double time_s) const noexcept;
  void merge();

  std::size_t channels_;
  double width_s_ = 1e-6;
  std::vector<Bin> bins_;
  std::vector<Range> ranges_;  // by bin, then channel
};

/// A line in the plane, as a picture can show it: at most kMostPoints, however long it goes on.
/// When there are more, those closer together than 1/1000 of the longer side of its extent go, then
/// what leads again from a cell of a grid that fine to one that it led to already; where that is
/// not enough, the grid gets coarser. A line stands for one that was pushed, never for a gap.
class PlotPath {
 public:
  static constexpr std::size_t kMostPoints = 16'384;

  /// Precondition: finite.
  void push(const Eigen::Vector2d& point);
  /// From the first one pushed to the last; NaN between two that no line joins.
  std::vector<Eigen::Vector2d> points() const;

 private:
  using Cell = std::array<double, 2>;

  void add(const Eigen::Vector2d& point);
  bool is_new(const Eigen::Vector2d& from, const Eigen::Vector2d& to);
  void thin();

  std::vector<Eigen::Vector2d> points_;
  Eigen::AlignedBox2d box_;
  Eigen::Vector2d at_ = Eigen::Vector2d::Zero();    // the newest that counts, drawn or not
  Eigen::Vector2d last_ = Eigen::Vector2d::Zero();  // pushed
  double apart_ = 0;                                // at least, from one to the next
  double cell_ = 0;                                 // side; 0: everything is drawn
  std::set<std::array<Cell, 2>> drawn_;             // both ways
};

}  // namespace limn
