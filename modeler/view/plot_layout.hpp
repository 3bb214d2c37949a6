#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "input/base/error.hpp"
#include "modeler/view/plot.hpp"

namespace limn {

/// A place on an axis that has a number.
struct PlotTick {
  double value = 0;
  std::string label;
};

/// Multiples of 1, 2 or 5 times a power of ten within [low, high], as many as there may be up to
/// `most`. Precondition: low < high, both finite; most >= 2.
std::vector<PlotTick> round_ticks(double low, double high, int most);

/// Values from low to high along a line of the page, from `from` mm on.
struct PlotAxis {
  double low = 0;
  double high = 1;
  double from = 0;
  double to = 1;
  std::vector<PlotTick> ticks;

  double at(double value) const noexcept {
    return from + (value - low) / (high - low) * (to - from);
  }
};

/// The rectangle of a panel or a way: x to the right, y up.
struct PlotFrame {
  PlotAxis x;
  PlotAxis y;
};

struct PlotDeviceLayout {
  double name_y = 0;  ///< baseline of the device's name
  std::vector<PlotFrame> panels;
  std::vector<PlotFrame> ways;
};

/// Where everything goes, in mm, y down the page.
struct PlotLayout {
  double width = 0;
  double height = 0;
  double left = 0;     ///< of titles
  double legend = 0;   ///< left end of the legends
  double title_y = 0;  ///< baseline
  std::vector<PlotDeviceLayout> devices;
};

/// PDF's user space ends at 14,400 points.
inline constexpr double kLongestPlotMm = 5000;

/// Error: kMissing for no devices; kOutOfRange for values beyond 1e12.
Expected<PlotLayout> lay_out_plot(const Plot& plot);

}  // namespace limn
