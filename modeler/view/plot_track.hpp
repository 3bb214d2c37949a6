#pragma once

#include <Eigen/Core>
#include <cstddef>
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

/// A line in the plane without its points that nobody could tell apart: at most kMostPoints.
class PlotPath {
 public:
  static constexpr std::size_t kMostPoints = 16'384;

  void push(const Eigen::Vector2d& point);
  /// The last one pushed is among them.
  std::vector<Eigen::Vector2d> points() const;

 private:
  std::vector<Eigen::Vector2d> points_;
  Eigen::Vector2d last_ = Eigen::Vector2d::Zero();
  double apart_ = 0;  // at least, from one to the next
};

}  // namespace limn
