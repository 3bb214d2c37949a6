#include "tests/bench/growth_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace limn::bench {
namespace {

using Eigen::Vector2d;

constexpr Color kInk = {40, 40, 40};
constexpr Color kGrid = {215, 215, 215};
/// Told apart by the colour-blind, too (Okabe and Ito's palette).
constexpr std::array<Color, 7> kColors = {{{0, 114, 178},
                                           {213, 94, 0},
                                           {0, 158, 115},
                                           {204, 121, 167},
                                           {86, 180, 233},
                                           {230, 159, 0},
                                           {0, 0, 0}}};

constexpr double kWidth = 160;  // mm
constexpr double kHeight = 110;
constexpr double kLeft = 18;
constexpr double kRight = 52;  // for the names
constexpr double kTop = 14;
constexpr double kBottom = 16;
constexpr double kText = 3.6;

/// From value to mm of the page, logarithmic.
struct Axis {
  double low;
  double high;
  double from;
  double to;
  double at(double value) const {
    return from + std::log(value / low) / std::log(high / low) * (to - from);
  }
};

void draw_line(Canvas& canvas, const char* css_class, const Vector2d& from, const Vector2d& to,
               const LineStyle& style) {
  Path path;
  path.move_to(from);
  path.line_to(to);
  canvas.stroke("", css_class, path, style, Precision::kExact);
}

std::string in_words(double value, const char* unit) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), value < 1 ? "%.1f%s" : "%.0f%s", value, unit);
  return text.data();
}

void draw_axes(Canvas& canvas, const Axis& x, const Axis& y) {
  canvas.begin_layer("axes", "axes");
  for (double value = x.low; value < 1.01 * x.high; value *= 10) {
    draw_line(canvas, "grid", {x.at(value), y.from}, {x.at(value), y.to}, {kGrid, 0.2, 0});
    canvas.text({x.at(value) - 2, y.from + 5}, kText, 30, kInk, in_words(value, ""));
  }
  for (double value = y.low; value < 1.01 * y.high; value *= 2) {
    draw_line(canvas, "grid", {x.from, y.at(value)}, {x.to, y.at(value)}, {kGrid, 0.2, 0});
    canvas.text({kLeft - 12, y.at(value) + 1.2}, kText, 11, kInk, in_words(value, "x"));
  }
  canvas.text({x.from, y.from + 11}, kText, 100, kInk, "control points");
  canvas.text({kLeft - 12, 7}, kText, 140, kInk,
              "cost of one, against that on the smallest surface");
  canvas.end_layer();
}

}  // namespace

Picture draw_growth(const std::vector<GrowthCurve>& curves) {
  double most = 4;
  Axis x{1e300, 0, kLeft, kWidth - kRight};
  for (const GrowthCurve& curve : curves) {
    x.low = std::min(x.low, curve.control_points.front());
    x.high = std::max(x.high, curve.control_points.back());
    for (const double cost : curve.cost) most = std::max(most, cost / curve.cost.front());
  }
  x.low = std::pow(10, std::floor(std::log10(x.low)));
  x.high = std::pow(10, std::ceil(std::log10(0.9 * x.high)));
  const Axis y{0.5, std::pow(2, std::ceil(std::log2(most))), kHeight - kBottom, kTop};
  const Sheet sheet{"growth", {0, 0}, kWidth, kHeight, 1};
  return {
      sheet, [=](Canvas& canvas) -> Expected<void> {
        draw_axes(canvas, x, y);
        canvas.begin_layer("curves", "curves");
        double name_y = kTop + 4;
        for (std::size_t i = 0; i < curves.size(); ++i) {
          const GrowthCurve& curve = curves[i];
          const Color color = kColors[i % kColors.size()];
          Path path;
          for (std::size_t k = 0; k < curve.cost.size(); ++k) {
            const Vector2d p(x.at(curve.control_points[k]),
                             y.at(curve.cost[k] / curve.cost.front()));
            k == 0 ? path.move_to(p) : path.line_to(p);
            draw_line(canvas, "place", p, p, {color, 1.6, 0});
          }
          canvas.stroke("", "curve", path, {color, 0.5, 0}, Precision::kExact);
          const double left = kWidth - kRight + 5;
          draw_line(canvas, "key", {left, name_y - 1.2}, {left + 5, name_y - 1.2}, {color, 0.8, 0});
          canvas.text({left + 7, name_y}, kText, kRight - 13, kInk, curve.name);
          name_y += 6;
        }
        canvas.end_layer();
        return {};
      }};
}

}  // namespace limn::bench
