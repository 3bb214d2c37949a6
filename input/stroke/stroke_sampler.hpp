#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "input/sample/pen_sample.hpp"
#include "input/stroke/stroke.hpp"

namespace limn {

struct StrokeSamplerOptions {
  /// A contact of more samples is cut: the stroke ends with closed_by_lift = false, and the next
  /// one begins with its last point. At least 2.
  std::size_t max_points = std::size_t{1} << 20;
  /// Devices that may draw at the same time; one more, and the stroke that began first is cut.
  /// At least 1.
  std::size_t max_open_strokes = 16;
};

/// Gathers samples into strokes, contact to lift, each device by itself.
///
///   - A stroke has the tool and all samples of one contact; pens and erasers draw, tablet mice do
///     not. A device that changes its tool in contact ends one stroke (closed_by_lift = false) and
///     begins another.
///   - Samples without position are skipped: they neither draw nor, in contact, end a stroke.
///   - Times never run back within a stroke: a sample before its predecessor gets that one's time,
///     and is counted in time_reversals().
///   - Stroke::axes holds the axes among position, pressure and tilt that every point has.
///
/// Memory: at most (max_open_strokes + 1) * max_points points, none allocated once strokes have
/// reached their usual length and the sink leaves them their memory. Not thread-safe.
class StrokeSampler {
 public:
  explicit StrokeSampler(StrokeSamplerOptions options = {});

  /// Calls `sink(Stroke&)` for each stroke that `sample` completes (none to two). The sink may move
  /// from it; where it does not, the points' memory is used again.
  template <class Sink>
  void push(const PenSample& sample, Sink&& sink) {
    push_to(sample, SinkRef(sink));
  }

  /// Ends all open strokes, in the order in which they began, with closed_by_lift = false.
  template <class Sink>
  void finish(Sink&& sink) {
    finish_to(SinkRef(sink));
  }

  /// Forgets all open strokes; keeps the counts.
  void reset() noexcept;

  std::uint64_t strokes() const noexcept { return strokes_; }
  std::uint64_t time_reversals() const noexcept { return time_reversals_; }
  std::uint64_t samples_without_position() const noexcept { return samples_without_position_; }

 private:
  // A borrowed callable: the sampler's work lies in one translation unit, the sink's in the
  // caller's.
  class SinkRef {
   public:
    template <class Sink>
    explicit SinkRef(Sink& sink) noexcept
        : object_(const_cast<void*>(static_cast<const void*>(std::addressof(sink)))),
          call_([](void* object, Stroke& stroke) { (*static_cast<Sink*>(object))(stroke); }) {}
    void operator()(Stroke& stroke) const { call_(object_, stroke); }

   private:
    void* object_;
    void (*call_)(void*, Stroke&);
  };

  StrokeSamplerOptions options_;
  std::vector<Stroke> open_;  // by beginning; never empty strokes
  Stroke spare_;              // the last given one: its memory serves the next contact
  std::uint64_t strokes_ = 0;
  std::uint64_t time_reversals_ = 0;
  std::uint64_t samples_without_position_ = 0;

  void push_to(const PenSample& sample, SinkRef sink);
  void finish_to(SinkRef sink);
  void begin(const PenSample& sample, SinkRef sink);
  void append(Stroke& stroke, const PenSample& sample, SinkRef sink);
  void give(Stroke& stroke, bool closed_by_lift, SinkRef sink);
  void end(std::size_t index, bool closed_by_lift, SinkRef sink);
};

}  // namespace limn
