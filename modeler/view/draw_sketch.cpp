#include "modeler/view/draw_sketch.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "modeler/sketch/curve_forms.hpp"
#include "modeler/view/ink.hpp"

namespace limn {
namespace {

constexpr Color kInk{0x1c, 0x26, 0x36};
constexpr Color kErased{0x9a, 0xa0, 0xa6};
constexpr Color kPolygon{0x9c, 0xc8, 0xec};
constexpr Color kControlPoint{0x3d, 0x8b, 0xd4};
constexpr Color kCorner{0xf0, 0x7d, 0x1a};
constexpr Color kText{0x4b, 0x55, 0x63};

/// Error of ink's outline in parts of its width: a fifth of a pixel in a PNG where ink is 6 wide.
constexpr double kOutlineError = 0.03;

/// A sketch with less pressure than this everywhere is drawn as if this were its largest.
constexpr double kLeastPressure = 0.05;

/// Width of ink where the device gives no pressure, in parts of the widest.
constexpr double kEvenInk = 0.6;

class Drawing {
 public:
  Drawing(const Sketch& sketch, const Page& page, Canvas& canvas,
          std::vector<std::vector<BezierPiece>> pieces)
      : sketch_(sketch), page_(page), canvas_(canvas), pieces_(std::move(pieces)) {
    for (const SketchStroke& stroke : sketch.strokes) {
      for (const PressureAt& p : stroke.pressure) {
        largest_pressure_ = std::max(largest_pressure_, p.pressure);
      }
    }
  }

  void control_polygons() {
    for (std::size_t i = 0; i < sketch_.strokes.size(); ++i) {
      const SketchStroke& stroke = sketch_.strokes[i];
      if (stroke.is_dot()) continue;
      Path path;
      const auto& points = stroke.curve.control_points();
      path.move_to(points.front());
      for (std::size_t k = 1; k < stroke.control_point_count(); ++k) path.line_to(points[k]);
      if (stroke.closed()) path.close();
      canvas_.stroke(id(i, "-polygon"), "control-polygon", path, {kPolygon, page_.polygon_width, 0},
                     Precision::kExact);
    }
  }

  void ink() {
    for (std::size_t i = 0; i < sketch_.strokes.size(); ++i) {
      const SketchStroke& stroke = sketch_.strokes[i];
      if (stroke.tool == Tool::kEraser) continue;
      const InkWidth width = ink_width(stroke);
      Path path;
      if (stroke.is_dot()) {
        add_disc(path, stroke.curve.control_points().front(), dot_radius(stroke));
      } else {
        path = ink_outline(pieces_[i], width, kOutlineError * page_.ink_width);
      }
      canvas_.fill(id(i, "-ink"), "ink", path, kInk);
    }
  }

  void curves() {
    for (std::size_t i = 0; i < sketch_.strokes.size(); ++i) {
      const bool erased = sketch_.strokes[i].tool == Tool::kEraser;
      const LineStyle style = erased
                                  ? LineStyle{kErased, 0.4 * page_.ink_width, 2 * page_.ink_width}
                                  : LineStyle{kInk, page_.thinnest_ink, 0};
      canvas_.stroke(id(i, ""), erased ? "curve eraser" : "curve", curve_path(i), style,
                     Precision::kExact);
    }
  }

  void control_points() {
    for (std::size_t i = 0; i < sketch_.strokes.size(); ++i) {
      const SketchStroke& stroke = sketch_.strokes[i];
      if (stroke.is_dot()) continue;  // its ink is its control point
      Path path;
      for (std::size_t k = 0; k < stroke.control_point_count(); ++k) {
        add_point(path, stroke.curve.control_points()[k]);
      }
      canvas_.stroke(id(i, "-control-points"), "control-points", path,
                     {kControlPoint, page_.marker_width, 0}, Precision::kVisible);
    }
  }

  void corners() {
    for (std::size_t i = 0; i < sketch_.strokes.size(); ++i) {
      const SketchStroke& stroke = sketch_.strokes[i];
      if (stroke.corners.empty()) continue;
      Path path;
      for (const double u : stroke.corners) add_point(path, stroke.curve.point(u));
      canvas_.stroke(id(i, "-corners"), "corners", path, {kCorner, 1.5 * page_.marker_width, 0},
                     Precision::kVisible);
    }
  }

  void scale_bar() {
    const Eigen::Vector2d left = page_.scale_bar_at;
    const Eigen::Vector2d right = left + Eigen::Vector2d(page_.scale_bar.length_mm, 0);
    const Eigen::Vector2d tick(0, 0.3 * page_.text_size);
    Path path;
    path.move_to(left - tick);
    path.line_to(left + tick);
    path.move_to(left);
    path.line_to(right);
    path.move_to(right - tick);
    path.line_to(right + tick);
    canvas_.stroke("scale-bar", "scale-bar", path, {kText, 0.1 * page_.text_size, 0},
                   Precision::kExact);
    const Eigen::Vector2d label = right + Eigen::Vector2d(0.6, 0.36) * page_.text_size;
    canvas_.text(label, page_.text_size, page_.text_width - page_.scale_bar.length_mm, kText,
                 page_.scale_bar.label);
  }

  void caption() {
    canvas_.text(page_.caption_at, page_.text_size, page_.text_width, kText,
                 picture_caption(sketch_, page_.paper_scale));
  }

 private:
  static std::string id(std::size_t stroke, const char* part) {
    return "stroke-" + std::to_string(stroke + 1) + part;
  }

  /// Round caps make a dot of a segment without length.
  static void add_point(Path& path, const Eigen::Vector2d& p) {
    path.move_to(p);
    path.line_to(p);
  }

  InkWidth ink_width(const SketchStroke& stroke) const {
    if (stroke.pressure.empty()) return InkWidth(kEvenInk * page_.ink_width);
    return InkWidth(stroke.pressure, largest_pressure_, page_.thinnest_ink, page_.ink_width);
  }

  /// A dot's samples share one parameter; its ink is that of its hardest moment.
  double dot_radius(const SketchStroke& stroke) const {
    if (stroke.pressure.empty()) return 0.5 * page_.ink_width;
    double largest = 0;
    for (const PressureAt& p : stroke.pressure) largest = std::max(largest, p.pressure);
    const double share = std::clamp(largest / largest_pressure_, 0.0, 1.0);
    return 0.5 * (page_.thinnest_ink + share * (page_.ink_width - page_.thinnest_ink));
  }

  Path curve_path(std::size_t stroke) const {
    Path path;
    const std::vector<BezierPiece>& pieces = pieces_[stroke];
    if (pieces.empty()) add_point(path, sketch_.strokes[stroke].curve.control_points().front());
    const Eigen::Vector2d* at = nullptr;
    for (const BezierPiece& piece : pieces) {
      if (!at || *at != piece.points[0]) path.move_to(piece.points[0]);
      path.cubic_to(piece.points[1], piece.points[2], piece.points[3]);
      at = &piece.points[3];
    }
    if (sketch_.strokes[stroke].closed()) path.close();
    return path;
  }

  const Sketch& sketch_;
  const Page& page_;
  Canvas& canvas_;
  std::vector<std::vector<BezierPiece>> pieces_;
  double largest_pressure_ = kLeastPressure;
};

}  // namespace

Expected<void> draw_sketch(const Sketch& sketch, const Page& page, const PictureOptions& options,
                           Canvas& canvas) {
  std::vector<std::vector<BezierPiece>> pieces;
  pieces.reserve(sketch.strokes.size());
  for (std::size_t i = 0; i < sketch.strokes.size(); ++i) {
    auto made = bezier_pieces(sketch.strokes[i].curve);
    if (!made) {
      made.error().at = "stroke " + std::to_string(i + 1);
      return tl::unexpected(std::move(made.error()));
    }
    pieces.push_back(*std::move(made));
  }

  Drawing drawing(sketch, page, canvas, std::move(pieces));
  const auto layer = [&](bool wanted, const char* id, const char* label, auto draw) {
    if (!wanted) return;
    canvas.begin_layer(id, label);
    draw();
    canvas.end_layer();
  };
  layer(options.control_polygons, "control-polygons", "Control polygons",
        [&] { drawing.control_polygons(); });
  layer(true, "ink", "Ink", [&] { drawing.ink(); });
  layer(true, "curves", "Curves", [&] { drawing.curves(); });
  layer(options.control_polygons, "control-points", "Control points",
        [&] { drawing.control_points(); });
  layer(options.corners, "corners", "Corners", [&] { drawing.corners(); });
  layer(options.scale_bar || options.caption, "annotation", "Scale and caption", [&] {
    if (options.scale_bar) drawing.scale_bar();
    if (options.caption) drawing.caption();
  });
  return {};
}

}  // namespace limn
