#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "input/base/error.hpp"
#include "modeler/view/plot_track.hpp"

namespace limn {

/// One channel of a device's track as a line.
struct PlotLine {
  std::string label;
  std::size_t channel = 0;
};

/// Lines over time with one scale.
struct PlotPanel {
  std::string title;  ///< with the unit: "velocity, mm/s"
  std::vector<PlotLine> lines;
  std::vector<double> levels;  ///< dashed lines at these values
  std::string level_label;     ///< what they are
  /// What is shown at least, as lowest and highest.
  std::optional<std::pair<double, double>> least;
};

/// A path in a plane, the same scale along both axes.
struct PlotWay {
  std::string title;  ///< "path from above, mm"
  std::string x_label;
  std::string y_label;
  std::vector<Eigen::Vector2d> points;  ///< y up; NaN: a gap, not first and not last
};

/// What one device did.
struct PlotDevice {
  std::string name;
  PlotTrack track;
  std::string shade_label;  ///< what the track's shaded stretches are
  std::string mark_label;   ///< and its marks
  std::vector<PlotPanel> panels;
  std::vector<PlotWay> ways;
};

/// Of a recording; texts are printable UTF-8. Devices follow each other down the page and share one
/// axis of time, on which 0 is.
struct Plot {
  std::string title;
  std::vector<PlotDevice> devices;
};

/// The plot as a picture, 250 mm wide and as high as it needs; the same plot gives the same bytes.
/// Errors: kMissing for a plot without devices, and for PDF and PNG where limn was built without
/// cairo; kOutOfRange for values beyond 1e12; kNumeric where cairo fails.
Expected<std::string> plot_to_svg(const Plot& plot);
Expected<std::string> plot_to_pdf(const Plot& plot);
/// 8 pixels a mm, fewer where the longer side would have more than 32,000.
Expected<std::string> plot_to_png(const Plot& plot);

}  // namespace limn
