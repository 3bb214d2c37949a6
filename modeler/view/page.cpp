#include "modeler/view/page.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

namespace limn {
namespace {

/// A drawing smaller than this lies on a page as for one of this extent.
constexpr double kSmallestExtentMm = 20;

/// All lengths of the page are multiples of a hundredth of the drawing's longer side.
constexpr double kMargin = 5;
constexpr double kLeastContentWidth = 60;
constexpr double kLeastContentHeight = 15;
constexpr double kFooterGap = 4;
constexpr double kFooterRow = 3.6;
constexpr double kTextSize = 2.2;
constexpr double kMostBar = 0.3;  // of the page's content width

/// Width of a letter in em: more than the mean of any sans-serif text, so that captions fit where
/// nothing can measure them (SVG).
constexpr double kLetterWidth = 0.6;

struct Extent {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
};

/// Of the control points, so of the curves as well.
Expected<Extent> extent_of(const Sketch& sketch) {
  Extent out;
  bool first = true;
  for (std::size_t i = 0; i < sketch.strokes.size(); ++i) {
    for (const Eigen::Vector2d& p : sketch.strokes[i].curve.control_points()) {
      if (!(p.cwiseAbs().maxCoeff() <= 0.5 * kWidestSketchMm)) {
        return fail(ErrorCode::kOutOfRange, "stroke " + std::to_string(i + 1),
                    "a coordinate is beyond 5e11 mm, too far to draw",
                    "scale the recording, or correct the device's physical range");
      }
      out.low = first ? p : Eigen::Vector2d(out.low.cwiseMin(p));
      out.high = first ? p : Eigen::Vector2d(out.high.cwiseMax(p));
      first = false;
    }
  }
  return out;
}

/// Median length of the control polygons' legs: how fine the drawing's detail is. Infinite where
/// there are none.
double median_leg(const Sketch& sketch) {
  std::vector<double> legs;
  for (const SketchStroke& stroke : sketch.strokes) {
    const auto& points = stroke.curve.control_points();
    for (std::size_t i = 1; i < points.size(); ++i)
      legs.push_back((points[i] - points[i - 1]).norm());
  }
  if (legs.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = legs.begin() + static_cast<std::ptrdiff_t>(legs.size() / 2);
  std::nth_element(legs.begin(), middle, legs.end());
  return *middle;
}

std::string fixed_text(double value) {
  std::array<char, 64> buffer;
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed);
  return std::string(buffer.data(), end.ptr);
}

std::string text_of_digits(double value, int digits) {
  std::array<char, 64> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, digits);
  return std::string(buffer.data(), end.ptr);
}

std::string counted(std::size_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// 1, or 1/n with n = 1, 2 or 5 times a power of ten.
double paper_scale(double longer_mm) {
  if (longer_mm <= kLongestPaperMm) return 1;
  const double most = kLongestPaperMm / longer_mm;
  const double power = std::pow(10, std::ceil(-std::log10(most)));
  for (const double n : {0.1, 0.2, 0.5}) {
    if (n * power * most >= 1) return 1 / (n * power);
  }
  return 1 / power;
}

void choose_widths(double leg, double extent, Page& page) {
  page.ink_width = std::clamp(0.25 * leg, extent / 500, extent / 140);
  page.thinnest_ink = page.ink_width / 5;
  page.marker_width = std::clamp(0.18 * leg, extent / 800, extent / 140);
  page.polygon_width = page.marker_width / 4;
}

}  // namespace

ScaleBar scale_bar_within(double most_mm) {
  const int exponent = static_cast<int>(std::floor(std::log10(most_mm)));
  // One power further down for where log10 rounds up to a whole number.
  for (int power = exponent; power >= exponent - 1; --power) {
    for (const double digit : {5.0, 2.0, 1.0}) {
      // Division, since a negative power of ten has no exact double.
      const double length = power < 0 ? digit / std::pow(10, -power) : digit * std::pow(10, power);
      if (length <= most_mm) return {length, fixed_text(length) + " mm"};
    }
  }
  return {most_mm, fixed_text(most_mm) + " mm"};
}

std::string picture_caption(const Sketch& sketch, double paper_scale) {
  std::size_t control_points = 0;
  double deviation = 0;
  for (const SketchStroke& stroke : sketch.strokes) {
    control_points += stroke.control_point_count();
    deviation = std::max(deviation, stroke.deviation_max_mm);
  }
  std::string out = counted(sketch.strokes.size(), "stroke") + ", " +
                    counted(control_points, "control point") + ", tolerance " +
                    text_of_digits(sketch.tolerance_mm, 6) + " mm";
  if (!sketch.strokes.empty()) {
    // What is far below the tolerance is rounding, and its digits say nothing.
    const double least = 0.01 * sketch.tolerance_mm;
    out += ", largest deviation " + std::string(deviation < least ? "below " : "") +
           text_of_digits(std::max(deviation, least), 3) + " mm";
  }
  if (paper_scale != 1) out += ", drawn 1:" + text_of_digits(1 / paper_scale, 12);
  return out;
}

Expected<Page> lay_out_page(const Sketch& sketch, const PictureOptions& options) {
  const auto extent = extent_of(sketch);
  if (!extent) return tl::unexpected(extent.error());
  const Eigen::Vector2d size = extent->high - extent->low;
  const double longer = std::max({size.x(), size.y(), kSmallestExtentMm});
  const double unit = longer / 100;
  const double content_width = std::max(size.x(), kLeastContentWidth * unit);
  const double content_height = std::max(size.y(), kLeastContentHeight * unit);
  const int rows = int{options.scale_bar} + int{options.caption};
  const double footer = rows == 0 ? 0 : (kFooterGap + kFooterRow * rows) * unit;

  Page page;
  page.width = content_width + 2 * kMargin * unit;
  page.height = content_height + footer + 2 * kMargin * unit;
  const Eigen::Vector2d middle = extent->low + 0.5 * size;
  page.origin = {middle.x() - 0.5 * page.width, middle.y() - 0.5 * content_height - kMargin * unit};
  page.paper_scale = paper_scale(std::max(page.width, page.height));
  choose_widths(median_leg(sketch), longer, page);

  const double left = page.origin.x() + kMargin * unit;
  const double footer_top = page.origin.y() + kMargin * unit + content_height + kFooterGap * unit;
  page.scale_bar = scale_bar_within(kMostBar * content_width);
  page.scale_bar_at = {left, footer_top + 0.5 * kFooterRow * unit};
  page.caption_at = {left, footer_top + (options.scale_bar ? 2 : 1) * kFooterRow * unit};
  page.text_width = content_width;
  const double letters = static_cast<double>(picture_caption(sketch, page.paper_scale).size());
  page.text_size = std::min(kTextSize * unit, content_width / (kLetterWidth * letters));
  return page;
}

}  // namespace limn
