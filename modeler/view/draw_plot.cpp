#include "modeler/view/draw_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace limn {
namespace {

// Okabe and Ito's colours, which colour-blind people tell apart.
constexpr std::array kLineColors = {Color{0x00, 0x72, 0xb2}, Color{0xd5, 0x5e, 0x00},
                                    Color{0x00, 0x9e, 0x73}, Color{0xcc, 0x79, 0xa7},
                                    Color{0x56, 0xb4, 0xe9}, Color{0xe6, 0x9f, 0x00}};
constexpr Color kText{0x33, 0x3b, 0x47};
constexpr Color kFaintText{0x66, 0x6f, 0x7c};
constexpr Color kFrame{0x8a, 0x93, 0xa0};
constexpr Color kGrid{0xe3, 0xe6, 0xea};
constexpr Color kZero{0xb9, 0xbf, 0xc7};
constexpr Color kShade{0xe4, 0xe9, 0xf0};
constexpr Color kMark{0xb0, 0x1e, 0x5a};

constexpr double kTitleSize = 4.2;
constexpr double kNameSize = 3.6;
constexpr double kTextSize = 2.7;
constexpr double kTickSize = 2.4;
constexpr double kLegendRow = 4.2;
constexpr double kSample = 6;  // of a line in a legend
constexpr double kLineWidth = 0.28;
constexpr double kHairline = 0.15;
constexpr double kDash = 1.2;
constexpr double kThinnestShade = 0.15;

/// Width of a digit in em, of any sans-serif font and of cairo's own.
constexpr double kDigitWidth = 0.56;
/// Of a letter, more than the mean.
constexpr double kLetterWidth = 0.6;

double text_width(std::string_view text, double size) {
  return kDigitWidth * size * static_cast<double>(text.size());
}

/// Cut between characters of UTF-8 where it is longer than so many mm.
std::string fitting(std::string_view text, double size, double most_mm) {
  const auto most = static_cast<std::size_t>(std::max(4.0, most_mm / (kLetterWidth * size)));
  if (text.size() <= most) return std::string(text);
  std::size_t end = most - 2;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return std::string(text.substr(0, end)) + "..";
}

class PlotDrawing {
 public:
  PlotDrawing(const PlotLayout& layout, Canvas& canvas) : layout_(layout), canvas_(canvas) {}

  void draw(const Plot& plot) {
    canvas_.begin_layer("title", "title");
    text({layout_.left, layout_.title_y}, kTitleSize, layout_.width - 2 * layout_.left, kText,
         plot.title);
    canvas_.end_layer();
    for (std::size_t i = 0; i < plot.devices.size(); ++i) {
      prefix_ = "device-" + std::to_string(i + 1);
      canvas_.begin_layer(prefix_, prefix_);
      draw(plot.devices[i], layout_.devices[i]);
      canvas_.end_layer();
    }
  }

 private:
  void draw(const PlotDevice& device, const PlotDeviceLayout& layout) {
    text({layout_.left, layout.name_y}, kNameSize, layout_.width - 2 * layout_.left, kText,
         device.name);
    for (std::size_t i = 0; i < device.panels.size(); ++i) {
      draw(device, device.panels[i], layout.panels[i], "-panel-" + std::to_string(i + 1));
      draw_legend(device, device.panels[i], layout.panels[i], i == 0);
    }
    if (!layout.panels.empty()) {
      const PlotFrame& last = layout.panels.back();
      draw_x_numbers(last);
      text({last.x.from, last.y.from + 7.5}, kTextSize, 40, kFaintText, "time, s");
    }
    for (std::size_t i = 0; i < device.ways.size(); ++i) {
      draw(device.ways[i], layout.ways[i], "-way-" + std::to_string(i + 1));
    }
  }

  void draw(const PlotDevice& device, const PlotPanel& panel, const PlotFrame& frame,
            const std::string& id) {
    draw_shades(device.track, frame);
    draw_grid(frame, id);
    for (const double level : panel.levels) {
      line({frame.x.from, frame.y.at(level)}, {frame.x.to, frame.y.at(level)},
           {kFaintText, kHairline * 1.5, kDash}, "level");
    }
    draw_marks(device.track, frame);
    for (std::size_t i = 0; i < panel.lines.size(); ++i) {
      const Path path = path_of(device.track, panel.lines[i].channel, frame);
      if (path.verbs().empty()) continue;
      canvas_.stroke(prefix_ + id + "-line-" + std::to_string(i + 1), "line", path,
                     {color_of(i), kLineWidth, 0}, Precision::kVisible);
    }
    draw_frame(frame);
    draw_y_numbers(frame);
    text({frame.x.from, frame.y.to - 1.6}, kTextSize, frame.x.to - frame.x.from, kText,
         panel.title);
  }

  void draw(const PlotWay& way, const PlotFrame& frame, const std::string& id) {
    draw_grid(frame, id);
    Path path;
    bool begins = true;
    for (const Eigen::Vector2d& point : way.points) {
      if (point.hasNaN()) {
        begins = true;
        continue;
      }
      const Eigen::Vector2d at(frame.x.at(point.x()), frame.y.at(point.y()));
      std::exchange(begins, false) ? path.move_to(at) : path.line_to(at);
    }
    if (!way.points.empty()) {
      canvas_.stroke(prefix_ + id + "-line", "line", path, {kLineColors[0], kLineWidth, 0},
                     Precision::kVisible);
      dot(path.points().front(), kLineColors[2]);
      dot(path.points().back(), kLineColors[1]);
    }
    draw_frame(frame);
    draw_x_numbers(frame);
    draw_y_numbers(frame);
    text({frame.x.from, frame.y.to - 1.6}, kTextSize, frame.x.to - frame.x.from, kText, way.title);
    text({frame.x.from, frame.y.from + 7.5}, kTextSize, 60, kFaintText,
         way.x_label + " to the right, " + way.y_label + " up");
  }

  static Color color_of(std::size_t line) { return kLineColors[line % kLineColors.size()]; }

  void draw_grid(const PlotFrame& frame, const std::string& id) {
    Path grid;
    for (const PlotTick& tick : frame.x.ticks) {
      grid.move_to({frame.x.at(tick.value), frame.y.from});
      grid.line_to({frame.x.at(tick.value), frame.y.to});
    }
    for (const PlotTick& tick : frame.y.ticks) {
      grid.move_to({frame.x.from, frame.y.at(tick.value)});
      grid.line_to({frame.x.to, frame.y.at(tick.value)});
    }
    canvas_.stroke(prefix_ + id + "-grid", "grid", grid, {kGrid, kHairline, 0},
                   Precision::kVisible);
    if (frame.y.low < 0 && frame.y.high > 0) {
      line({frame.x.from, frame.y.at(0)}, {frame.x.to, frame.y.at(0)}, {kZero, kHairline, 0},
           "zero");
    }
  }

  void draw_frame(const PlotFrame& frame) {
    Path outline;
    outline.move_to({frame.x.from, frame.y.from});
    outline.line_to({frame.x.to, frame.y.from});
    outline.line_to({frame.x.to, frame.y.to});
    outline.line_to({frame.x.from, frame.y.to});
    outline.close();
    canvas_.stroke(next_id(), "frame", outline, {kFrame, kHairline, 0}, Precision::kVisible);
  }

  void draw_x_numbers(const PlotFrame& frame) {
    for (const PlotTick& tick : frame.x.ticks) {
      const double width = text_width(tick.label, kTickSize);
      text({frame.x.at(tick.value) - 0.5 * width, frame.y.from + 3.4}, kTickSize, 2 * width,
           kFaintText, tick.label);
    }
  }

  void draw_y_numbers(const PlotFrame& frame) {
    for (const PlotTick& tick : frame.y.ticks) {
      const double width = text_width(tick.label, kTickSize);
      text({frame.x.from - 1.2 - width, frame.y.at(tick.value) + 0.36 * kTickSize}, kTickSize,
           2 * width, kFaintText, tick.label);
    }
  }

  /// The stretches from a shaded bin to the next one that is not: until then it was so.
  void draw_shades(const PlotTrack& track, const PlotFrame& frame) {
    const auto& bins = track.bins();
    Path shades;
    for (std::size_t i = 0; i < bins.size(); ++i) {
      if (!bins[i].flags.shaded) continue;
      const double left = frame.x.at(bins[i].begin_s);
      const auto goes_on = [&bins](std::size_t next) {
        return next < bins.size() && !bins[next].flags.begins_anew;
      };
      while (goes_on(i + 1) && bins[i + 1].flags.shaded) ++i;
      const double end = goes_on(i + 1) ? bins[i + 1].begin_s : bins[i].end_s;
      const double right = std::max(frame.x.at(end), left + kThinnestShade);
      shades.move_to({left, frame.y.from});
      shades.line_to({right, frame.y.from});
      shades.line_to({right, frame.y.to});
      shades.line_to({left, frame.y.to});
      shades.close();
    }
    if (!shades.verbs().empty()) canvas_.fill(next_id(), "shade", shades, kShade);
  }

  void draw_marks(const PlotTrack& track, const PlotFrame& frame) {
    Path marks;
    for (const PlotTrack::Bin& bin : track.bins()) {
      if (!bin.flags.marked) continue;
      marks.move_to({frame.x.at(bin.begin_s), frame.y.from});
      marks.line_to({frame.x.at(bin.begin_s), frame.y.to});
    }
    if (marks.verbs().empty()) return;
    canvas_.stroke(next_id(), "mark", marks, {kMark, kHairline, kDash / 2}, Precision::kVisible);
  }

  static Path path_of(const PlotTrack& track, std::size_t channel, const PlotFrame& frame) {
    Path path;
    bool is_open = false;
    for (std::size_t i = 0; i < track.bins().size(); ++i) {
      const PlotTrack::Bin& bin = track.bins()[i];
      const PlotTrack::Range& range = track.range(i, channel);
      if (std::isnan(range.first)) {
        is_open = false;
        continue;
      }
      const double begin = frame.x.at(bin.begin_s);
      const double end = frame.x.at(bin.end_s);
      const Eigen::Vector2d first(begin, frame.y.at(range.first));
      is_open &= !bin.flags.begins_anew;
      if (is_open) {
        path.line_to(first);
      } else {
        path.move_to(first);
        path.line_to(first);  // alone it is a dot
      }
      is_open = true;
      if (begin == end && range.low == range.high) continue;
      const double middle = 0.5 * (begin + end);
      if (range.low < std::min(range.first, range.last)) {
        path.line_to({middle, frame.y.at(range.low)});
      }
      if (range.high > std::max(range.first, range.last)) {
        path.line_to({middle, frame.y.at(range.high)});
      }
      path.line_to({end, frame.y.at(range.last)});
    }
    return path;
  }

  void draw_legend(const PlotDevice& device, const PlotPanel& panel, const PlotFrame& frame,
                   bool tells_shades) {
    double y = frame.y.to + 3;
    const double text_x = layout_.legend + kSample + 1.5;
    const double room = layout_.width - 4 - text_x;
    const auto label = [&](const std::string& words) {
      text({text_x, y + 0.36 * kTextSize}, kTextSize, room, kText, words);
      y += kLegendRow;
    };
    for (std::size_t i = 0; i < panel.lines.size(); ++i) {
      line({layout_.legend, y}, {layout_.legend + kSample, y}, {color_of(i), 2 * kLineWidth, 0},
           "legend");
      label(panel.lines[i].label);
    }
    if (!panel.levels.empty()) {
      line({layout_.legend, y}, {layout_.legend + kSample, y}, {kFaintText, 1.5 * kHairline, kDash},
           "legend");
      label(panel.level_label);
    }
    if (!tells_shades) return;
    const auto& bins = device.track.bins();
    const auto any = [&bins](bool PlotTrack::Flags::*flag) {
      return std::any_of(bins.begin(), bins.end(),
                         [flag](const PlotTrack::Bin& bin) { return bin.flags.*flag; });
    };
    if (any(&PlotTrack::Flags::shaded)) {
      Path box;
      box.move_to({layout_.legend, y - 1.3});
      box.line_to({layout_.legend + kSample, y - 1.3});
      box.line_to({layout_.legend + kSample, y + 1.3});
      box.line_to({layout_.legend, y + 1.3});
      box.close();
      canvas_.fill(next_id(), "legend", box, kShade);
      canvas_.stroke(next_id(), "legend", box, {kZero, kHairline, 0}, Precision::kVisible);
      label(device.shade_label);
    }
    if (any(&PlotTrack::Flags::marked)) {
      const double x = layout_.legend + 0.5 * kSample;
      line({x, y - 1.5}, {x, y + 1.5}, {kMark, 2 * kHairline, kDash / 2}, "legend");
      label(device.mark_label);
    }
  }

  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const LineStyle& style,
            std::string_view css_class) {
    Path path;
    path.move_to(a);
    path.line_to(b);
    canvas_.stroke(next_id(), css_class, path, style, Precision::kVisible);
  }

  void dot(const Eigen::Vector2d& at, Color color) { line(at, at, {color, 1.4, 0}, "end"); }

  void text(const Eigen::Vector2d& at, double size, double most_width, Color color,
            std::string_view words) {
    canvas_.text(at, size, most_width, color, fitting(words, size, most_width));
  }

  std::string next_id() { return prefix_ + "-part-" + std::to_string(++parts_); }

  const PlotLayout& layout_;
  Canvas& canvas_;
  std::string prefix_;
  std::size_t parts_ = 0;
};

}  // namespace

void draw_plot(const Plot& plot, const PlotLayout& layout, Canvas& canvas) {
  PlotDrawing(layout, canvas).draw(plot);
}

}  // namespace limn
