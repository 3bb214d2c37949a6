#pragma once

#include "modeler/view/canvas.hpp"
#include "modeler/view/plot.hpp"
#include "modeler/view/plot_layout.hpp"

namespace limn {

/// Draws the plot's layers: device-1, device-2, .. The one routine behind all formats.
/// Precondition: lay_out_plot() gave the layout of this plot.
void draw_plot(const Plot& plot, const PlotLayout& layout, Canvas& canvas);

}  // namespace limn
