#include "modeler/view/ink.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace limn {
namespace {

using Eigen::Vector2d;

/// Allowed error of the simplified width, in parts of the range from thinnest to widest ink.
constexpr double kWidthError = 0.05;

/// Each halving of a span; more are never needed, for bars end the recursion at a fraction of the
/// width, but input may hold spans a million times longer than the ink is wide.
constexpr int kMostHalvings = 8;

/// Bars shorter than this part of the radius cannot be told from the round shape.
constexpr double kShortestBar = 0.3;

/// Distance from the ends of a quarter circle of radius 1 to its Bezier points.
constexpr double kQuarterCircle = 0.5522847498307936;  // 4/3 (sqrt(2) - 1)

Vector2d turned_left(const Vector2d& v) { return {-v.y(), v.x()}; }

/// A point of the curve with both edges of the ink there, and their derivatives in t (the piece's
/// own parameter, 0 to 1).
struct Section {
  Vector2d center;
  double radius = 0;
  Vector2d left, left_rate;
  Vector2d right, right_rate;
  bool regular = false;  ///< both edges advance the way the curve does
};

Section section_at(const BezierPiece& piece, const InkWidth& ink, double t) {
  const auto& p = piece.points;
  const double s = 1 - t;
  const Vector2d c =
      s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3];
  const Vector2d c1 =
      3 * (s * s * (p[1] - p[0]) + 2 * s * t * (p[2] - p[1]) + t * t * (p[3] - p[2]));
  const Vector2d c2 = 6 * (s * (p[2] - 2 * p[1] + p[0]) + t * (p[3] - 2 * p[2] + p[1]));
  const InkWidth::Value w = ink.at(piece.u0 + t * (piece.u1 - piece.u0));

  Section out;
  out.center = c;
  out.radius = 0.5 * w.width;
  const double speed = c1.norm();
  const double scale = (p[1] - p[0]).norm() + (p[2] - p[1]).norm() + (p[3] - p[2]).norm();
  if (!(speed > 1e-9 * scale)) return out;
  const Vector2d tangent = c1 / speed;
  const Vector2d normal = turned_left(tangent);
  const Vector2d normal_rate = turned_left((c2 - tangent * tangent.dot(c2)) / speed);
  const double radius_rate = 0.5 * w.slope * (piece.u1 - piece.u0);
  const Vector2d spread = radius_rate * normal + out.radius * normal_rate;
  out.left = c + out.radius * normal;
  out.left_rate = c1 + spread;
  out.right = c - out.radius * normal;
  out.right_rate = c1 - spread;
  // A little above 0: near a cusp of the edge Hermite pieces are poor.
  constexpr double kLeastAdvance = 0.05;
  out.regular = out.left_rate.dot(tangent) > kLeastAdvance * speed &&
                out.right_rate.dot(tangent) > kLeastAdvance * speed;
  return out;
}

/// The cubic with these ends and end derivatives, in [0, h], at h x.
Vector2d hermite(const Vector2d& a, const Vector2d& a_rate, const Vector2d& b,
                 const Vector2d& b_rate, double h, double x) {
  const double y = 1 - x;
  return (1 + 2 * x) * y * y * a + x * y * y * h * a_rate + (1 + 2 * y) * x * x * b -
         y * x * x * h * b_rate;
}

class Outliner {
 public:
  Outliner(const InkWidth& ink, double tolerance) : ink_(ink), tolerance_(tolerance) {}

  void add(const BezierPiece& piece) {
    piece_ = &piece;
    cover(0, section_at(piece, ink_, 0), 1, section_at(piece, ink_, 1), 0);
  }

  Path take() {
    end_ribbon();
    return std::move(path_);
  }

 private:
  struct Cubic {
    Vector2d c1, c2, end;
  };

  /// Covers t0 to t1 of the piece by a ribbon, a bar, or two halves.
  void cover(double t0, const Section& s0, double t1, const Section& s1, int halvings) {
    if (follows_edges(t0, s0, t1, s1)) return add_to_ribbon(t1 - t0, s0, s1);
    const double middle = 0.5 * (t0 + t1);
    const Section m = section_at(*piece_, ink_, middle);
    const double length = (m.center - s0.center).norm() + (s1.center - m.center).norm();
    const double radius = std::max({s0.radius, m.radius, s1.radius});
    if (halvings == kMostHalvings || length <= kShortestBar * radius) return add_bar(s0, s1);
    cover(t0, s0, middle, m, halvings + 1);
    cover(middle, m, t1, s1, halvings + 1);
  }

  bool follows_edges(double t0, const Section& s0, double t1, const Section& s1) const {
    if (!s0.regular || !s1.regular) return false;
    const double h = t1 - t0;
    for (const double x : {0.25, 0.5, 0.75}) {
      const Section s = section_at(*piece_, ink_, t0 + x * h);
      if (!s.regular) return false;
      const Vector2d left = hermite(s0.left, s0.left_rate, s1.left, s1.left_rate, h, x);
      const Vector2d right = hermite(s0.right, s0.right_rate, s1.right, s1.right_rate, h, x);
      if ((left - s.left).norm() > tolerance_ || (right - s.right).norm() > tolerance_)
        return false;
    }
    return true;
  }

  void add_to_ribbon(double h, const Section& s0, const Section& s1) {
    const bool continues = ribbon_end_ && (ribbon_end_->left - s0.left).norm() <= tolerance_ &&
                           (ribbon_end_->right - s0.right).norm() <= tolerance_;
    if (!continues) {
      end_ribbon();
      disc_unless_there(s0);
      ribbon_begin_ = s0;
    }
    left_.push_back({s0.left + h / 3 * s0.left_rate, s1.left - h / 3 * s1.left_rate, s1.left});
    // Kept backwards, as the outline comes back on this side.
    right_.push_back(
        {s1.right - h / 3 * s1.right_rate, s0.right + h / 3 * s0.right_rate, s0.right});
    ribbon_end_ = s1;
  }

  void end_ribbon() {
    if (!ribbon_end_) return;
    path_.move_to(ribbon_begin_.left);
    for (const Cubic& c : left_) path_.cubic_to(c.c1, c.c2, c.end);
    path_.line_to(ribbon_end_->right);
    for (auto c = right_.rbegin(); c != right_.rend(); ++c) path_.cubic_to(c->c1, c->c2, c->end);
    path_.close();
    left_.clear();
    right_.clear();
    const Section end = *ribbon_end_;
    ribbon_end_.reset();
    disc_unless_there(end);
  }

  void add_bar(const Section& s0, const Section& s1) {
    end_ribbon();
    disc_unless_there(s0);
    const Vector2d along = s1.center - s0.center;
    const double length = along.norm();
    if (length > 0) {
      const Vector2d normal = turned_left(along / length);
      path_.move_to(s0.center + s0.radius * normal);
      path_.line_to(s1.center + s1.radius * normal);
      path_.line_to(s1.center - s1.radius * normal);
      path_.line_to(s0.center - s0.radius * normal);
      path_.close();
    }
    disc_unless_there(s1);
  }

  void disc_unless_there(const Section& s) {
    if (disc_ && disc_->center == s.center && disc_->radius >= s.radius) return;
    add_disc(path_, s.center, s.radius);
    disc_ = s;
  }

  const InkWidth& ink_;
  double tolerance_;
  const BezierPiece* piece_ = nullptr;
  Path path_;
  Section ribbon_begin_;
  std::optional<Section> ribbon_end_;  ///< set while a ribbon is open
  std::vector<Cubic> left_;
  std::vector<Cubic> right_;
  std::optional<Section> disc_;  ///< the last one drawn
};

struct WidthAt {
  double u = 0;
  double width = 0;
};

/// The widths of the profile, equal parameters (a pen that dwells) averaged.
std::vector<WidthAt> merged_widths(std::span<const PressureAt> pressure, double largest,
                                   double thinnest, double widest) {
  std::vector<WidthAt> out;
  std::size_t i = 0;
  while (i < pressure.size()) {
    const double u = pressure[i].u;
    double sum = 0;
    std::size_t count = 0;
    for (; i < pressure.size() && pressure[i].u == u; ++i, ++count) sum += pressure[i].pressure;
    const double share = std::clamp(sum / static_cast<double>(count) / largest, 0.0, 1.0);
    out.push_back({u, thinnest + share * (widest - thinnest)});
  }
  return out;
}

/// A part of `all`, ends included, whose polyline is within `error` of every one, in one pass: from
/// the last point kept, the cone of slopes that pass near enough to all since; a point outside the
/// cone makes the one before it kept.
std::vector<WidthAt> simplified(const std::vector<WidthAt>& all, double error) {
  std::vector<WidthAt> out{all.front()};
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < all.size(); ++i) {
    double du = all[i].u - out.back().u;
    double dw = all[i].width - out.back().width;
    if (dw / du < low || dw / du > high) {
      out.push_back(all[i - 1]);
      low = -std::numeric_limits<double>::infinity();
      high = std::numeric_limits<double>::infinity();
      du = all[i].u - out.back().u;
      dw = all[i].width - out.back().width;
    }
    low = std::max(low, (dw - error) / du);
    high = std::min(high, (dw + error) / du);
  }
  if (out.back().u != all.back().u) out.push_back(all.back());
  return out;
}

}  // namespace

InkWidth::InkWidth(std::span<const PressureAt> pressure, double largest_pressure, double thinnest,
                   double widest) {
  const auto all = merged_widths(pressure, largest_pressure, thinnest, widest);
  const auto kept = simplified(all, kWidthError * (widest - thinnest));
  knots_.reserve(kept.size());
  for (const WidthAt& w : kept) knots_.push_back({w.u, w.width, 0});
  // Harmonic means of neighbouring slopes, zero at extrema: monotone between knots.
  for (std::size_t i = 1; i + 1 < knots_.size(); ++i) {
    const double before = (knots_[i].width - knots_[i - 1].width) / (knots_[i].u - knots_[i - 1].u);
    const double after = (knots_[i + 1].width - knots_[i].width) / (knots_[i + 1].u - knots_[i].u);
    if (before * after > 0) knots_[i].slope = 2 * before * after / (before + after);
  }
}

InkWidth::Value InkWidth::at(double u) const noexcept {
  if (u <= knots_.front().u) return {knots_.front().width, 0};
  if (u >= knots_.back().u) return {knots_.back().width, 0};
  const auto above = std::upper_bound(knots_.begin(), knots_.end(), u,
                                      [](double x, const Knot& k) { return x < k.u; });
  const Knot& a = *(above - 1);
  const Knot& b = *above;
  const double h = b.u - a.u;
  const double x = (u - a.u) / h;
  const double y = 1 - x;
  const double width = (1 + 2 * x) * y * y * a.width + x * y * y * h * a.slope +
                       (1 + 2 * y) * x * x * b.width - y * x * x * h * b.slope;
  const double slope =
      6 * x * y * (b.width - a.width) / h + y * (1 - 3 * x) * a.slope + x * (1 - 3 * y) * b.slope;
  return {width, slope};
}

void add_disc(Path& path, const Vector2d& center, double radius) {
  const Vector2d x(radius, 0);
  const Vector2d y(0, radius);
  const double k = kQuarterCircle;
  path.move_to(center + x);
  path.cubic_to(center + x - k * y, center + k * x - y, center - y);
  path.cubic_to(center - k * x - y, center - x - k * y, center - x);
  path.cubic_to(center - x + k * y, center - k * x + y, center + y);
  path.cubic_to(center + k * x + y, center + x + k * y, center + x);
  path.close();
}

Path ink_outline(std::span<const BezierPiece> pieces, const InkWidth& width, double tolerance_mm) {
  Outliner outliner(width, tolerance_mm);
  for (const BezierPiece& piece : pieces) outliner.add(piece);
  return outliner.take();
}

}  // namespace limn
