#include "input/stroke/stroke_sampler.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "input/base/expect.hpp"

namespace limn {
namespace {

StrokePoint to_point(const PenSample& sample) noexcept {
  return {sample.time,     sample.x_mm,       sample.y_mm,
          sample.pressure, sample.tilt_x_rad, sample.tilt_y_rad};
}

PenAxes drawn_axes(PenAxes axes) noexcept {
  PenAxes drawn;
  for (const PenAxis axis :
       {PenAxis::kX, PenAxis::kY, PenAxis::kPressure, PenAxis::kTiltX, PenAxis::kTiltY}) {
    if (axes.has(axis)) drawn.add(axis);
  }
  return drawn;
}

void keep_common(PenAxes& axes, PenAxes others) noexcept {
  for (const PenAxis axis : {PenAxis::kPressure, PenAxis::kTiltX, PenAxis::kTiltY}) {
    if (!others.has(axis)) axes.remove(axis);
  }
}

}  // namespace

StrokeSampler::StrokeSampler(StrokeSamplerOptions options) : options_(options) {
  LIMN_EXPECT(options.max_points >= 2);
  LIMN_EXPECT(options.max_open_strokes >= 1);
}

void StrokeSampler::reset() noexcept { open_.clear(); }

void StrokeSampler::push_to(const PenSample& sample, SinkRef sink) {
  const auto found = std::find_if(open_.begin(), open_.end(), [&](const Stroke& stroke) {
    return stroke.device == sample.device;
  });
  const auto index = static_cast<std::size_t>(found - open_.begin());
  const bool drawing = found != open_.end();
  if (!in_contact(sample.state) || sample.tool == Tool::kTabletMouse) {
    if (drawing) end(index, true, sink);
    return;
  }
  if (!sample.axes.has_position()) {
    ++samples_without_position_;
    return;
  }
  if (drawing && found->tool == sample.tool) {
    append(*found, sample, sink);
    return;
  }
  if (drawing) end(index, false, sink);
  begin(sample, sink);
}

void StrokeSampler::finish_to(SinkRef sink) {
  while (!open_.empty()) end(0, false, sink);
}

void StrokeSampler::begin(const PenSample& sample, SinkRef sink) {
  if (open_.size() >= options_.max_open_strokes) end(0, false, sink);
  Stroke stroke = std::exchange(spare_, Stroke{});
  stroke.points.clear();
  stroke.device = sample.device;
  stroke.tool = sample.tool;
  stroke.axes = drawn_axes(sample.axes);
  stroke.points.push_back(to_point(sample));
  open_.push_back(std::move(stroke));
}

void StrokeSampler::append(Stroke& stroke, const PenSample& sample, SinkRef sink) {
  StrokePoint point = to_point(sample);
  const StrokePoint last = stroke.points.back();
  if (point.time < last.time) {
    point.time = last.time;
    ++time_reversals_;
  }
  if (stroke.points.size() >= options_.max_points) {
    const auto [device, tool, axes] = std::tuple(stroke.device, stroke.tool, stroke.axes);
    give(stroke, false, sink);
    stroke.device = device;
    stroke.tool = tool;
    stroke.axes = axes;
    stroke.points.clear();
    stroke.points.push_back(last);
  }
  stroke.points.push_back(point);
  keep_common(stroke.axes, sample.axes);
}

void StrokeSampler::give(Stroke& stroke, bool closed_by_lift, SinkRef sink) {
  stroke.closed_by_lift = closed_by_lift;
  ++strokes_;
  sink(stroke);
}

void StrokeSampler::end(std::size_t index, bool closed_by_lift, SinkRef sink) {
  Stroke stroke = std::move(open_[index]);
  open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(index));
  give(stroke, closed_by_lift, sink);
  spare_ = std::move(stroke);
}

}  // namespace limn
