#include "modeler/view/plot.hpp"

#include <algorithm>

#include "modeler/view/draw_plot.hpp"
#include "modeler/view/plot_layout.hpp"
#include "modeler/view/sheet.hpp"

namespace limn {
namespace {

constexpr double kPixelsPerMm = 8;
constexpr double kMostPixels = 32'000;

Sheet sheet_of(const Plot& plot, const PlotLayout& layout) {
  const double longer = std::max(layout.width, layout.height);
  Sheet sheet{plot.title, Eigen::Vector2d::Zero(), layout.width, layout.height};
  sheet.paper_scale = std::min(1.0, kLongestPlotMm / longer);
  return sheet;
}

Drawing drawing_of(const Plot& plot, const PlotLayout& layout) {
  return [&](Canvas& canvas) {
    draw_plot(plot, layout, canvas);
    return Expected<void>();
  };
}

}  // namespace

Expected<std::string> plot_to_svg(const Plot& plot) {
  const auto layout = lay_out_plot(plot);
  if (!layout) return tl::unexpected(layout.error());
  return draw_svg(sheet_of(plot, *layout), drawing_of(plot, *layout));
}

Expected<std::string> plot_to_pdf(const Plot& plot) {
  const auto layout = lay_out_plot(plot);
  if (!layout) return tl::unexpected(layout.error());
  return draw_pdf(sheet_of(plot, *layout), drawing_of(plot, *layout));
}

Expected<std::string> plot_to_png(const Plot& plot) {
  const auto layout = lay_out_plot(plot);
  if (!layout) return tl::unexpected(layout.error());
  const double longer = std::max(layout->width, layout->height);
  return draw_png(sheet_of(plot, *layout), std::min(kMostPixels, kPixelsPerMm * longer),
                  drawing_of(plot, *layout));
}

}  // namespace limn
