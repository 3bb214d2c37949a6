#include "modeler/view/plot_layout.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "input/base/expect.hpp"

namespace limn {
namespace {

constexpr double kWidth = 250;
constexpr double kMargin = 8;
constexpr double kTickRoom = 14;    // left of a frame, for its numbers
constexpr double kLegendRoom = 34;  // right of it
constexpr double kLegendGap = 3;
constexpr double kTitleRoom = 9;
constexpr double kNameRoom = 9;
constexpr double kPanelTitleRoom = 6;
constexpr double kPanelHeight = 32;
constexpr double kTimeRoom = 10;  // below the last panel
constexpr double kWaySide = 75;
constexpr double kWayGap = 14;
constexpr double kDeviceGap = 6;
constexpr double kMarginShare = 0.06;  // of a range, beyond its values
constexpr double kMost = 1e12;

struct Interval {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  /// NaN is none.
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool is_drawable() const { return std::abs(low) <= kMost && std::abs(high) <= kMost; }
};

/// With room on both sides; around values that never change as much as they are, or 1.
Interval with_room(Interval values) {
  if (values.low > values.high) values = {0, 1};
  const double size = std::max(std::abs(values.low), std::abs(values.high));
  const double range = values.high - values.low;
  const double room = range > 1e-9 * size ? kMarginShare * range : (size > 0 ? size : 1);
  return {values.low - room, values.high + room};
}

tl::unexpected<Error> too_far(const std::string& where) {
  return fail(ErrorCode::kOutOfRange, where, "a value is beyond 1e12, too far to draw",
              "correct the recording or the options that scale it");
}

PlotAxis axis_over(Interval values, double from, double to, int most_ticks) {
  return {values.low, values.high, from, to, round_ticks(values.low, values.high, most_ticks)};
}

Expected<PlotAxis> value_axis(const PlotDevice& device, const PlotPanel& panel, double top) {
  Interval values;
  for (const PlotLine& line : panel.lines) {
    const PlotTrack::Range range = device.track.extent(line.channel);
    if (std::isnan(range.first)) continue;
    values.add(range.low);
    values.add(range.high);
  }
  if (panel.least) {
    values.add(panel.least->first);
    values.add(panel.least->second);
  }
  for (const double level : panel.levels) values.add(level);
  if (values.low <= values.high && !values.is_drawable()) return too_far(panel.title);
  return axis_over(with_room(values), top + kPanelHeight, top, 5);
}

/// A square whose axes have one scale.
Expected<PlotFrame> way_frame(const PlotWay& way, double left, double top) {
  Interval x;
  Interval y;
  for (const Eigen::Vector2d& point : way.points) {
    x.add(point.x());
    y.add(point.y());
  }
  if (way.points.empty()) {
    x.add(0);
    y.add(0);
  }
  if (!x.is_drawable() || !y.is_drawable()) return too_far(way.title);
  // A way of no extent lies in a frame of 1.
  const double longer = std::max(x.high - x.low, y.high - y.low);
  const double half = longer > 0 ? (0.5 + kMarginShare) * longer : 0.5;
  const auto around = [half](const Interval& values) {
    const double middle = 0.5 * (values.low + values.high);
    return with_room({middle - half, middle + half});
  };
  return PlotFrame{axis_over(around(x), left, left + kWaySide, 6),
                   axis_over(around(y), top + kWaySide, top, 6)};
}

}  // namespace

std::vector<PlotTick> round_ticks(double low, double high, int most) {
  LIMN_EXPECT(low < high && most >= 2);
  const int exponent = static_cast<int>(std::floor(std::log10((high - low) / most)));
  std::vector<PlotTick> ticks;
  for (int power = exponent; power <= exponent + 2; ++power) {
    for (const int digit : {1, 2, 5}) {
      // Division, since a negative power of ten has no exact double.
      const double tens = std::pow(10, std::abs(power));
      const auto value_of = [&](double count) {
        return power < 0 ? count * digit / tens : count * digit * tens;
      };
      const double step = value_of(1);
      const double first = std::ceil(low / step);
      const double last = std::floor(high / step);
      if (last - first + 1 > most) continue;
      for (int i = 0; first + i <= last; ++i) {
        std::array<char, 64> text;
        const double value = value_of(first + i) + 0.0;  // no -0
        const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                       std::chars_format::fixed, std::max(0, -power));
        ticks.push_back({value, std::string(text.data(), end.ptr)});
      }
      return ticks;
    }
  }
  return ticks;
}

Expected<PlotLayout> lay_out_plot(const Plot& plot) {
  if (plot.devices.empty()) {
    return fail(ErrorCode::kMissing, "", "there is nothing to plot",
                "give a recording of a device");
  }
  PlotLayout layout;
  layout.width = kWidth;
  layout.left = kMargin;
  layout.title_y = kMargin + 4;
  const double frame_left = kMargin + kTickRoom;
  const double frame_right = kWidth - kMargin - kLegendRoom;
  layout.legend = frame_right + kLegendGap;

  Interval time;
  time.add(0);
  for (const PlotDevice& device : plot.devices) {
    if (device.track.bins().empty()) continue;
    time.add(device.track.bins().front().begin_s);
    time.add(device.track.bins().back().end_s);
  }
  if (!(time.high > time.low)) time.high = time.low + 1;

  double y = kMargin + kTitleRoom;
  for (const PlotDevice& device : plot.devices) {
    PlotDeviceLayout out;
    out.name_y = y + kNameRoom - 4;
    y += kNameRoom;
    for (const PlotPanel& panel : device.panels) {
      y += kPanelTitleRoom;
      auto values = value_axis(device, panel, y);
      if (!values) return tl::unexpected(std::move(values.error()));
      out.panels.push_back({axis_over(time, frame_left, frame_right, 12), *std::move(values)});
      y += kPanelHeight;
    }
    if (!device.panels.empty()) y += kTimeRoom;
    if (!device.ways.empty()) {
      y += kPanelTitleRoom;
      double left = frame_left;
      for (const PlotWay& way : device.ways) {
        auto frame = way_frame(way, left, y);
        if (!frame) return tl::unexpected(std::move(frame.error()));
        out.ways.push_back(*std::move(frame));
        left += kWaySide + kTickRoom + kWayGap;
      }
      y += kWaySide + kTimeRoom;
    }
    y += kDeviceGap;
    layout.devices.push_back(std::move(out));
  }
  layout.height = y - kDeviceGap + kMargin;
  return layout;
}

}  // namespace limn
