#include "firmware_sim/devices/drawings.hpp"

#include <array>
#include <utility>

#include "firmware_sim/devices/path.hpp"
#include "firmware_sim/devices/portable_math.hpp"

namespace limn::firmware {
namespace {

constexpr PlanePoint kMiddle{105, 74};  // of the pen's active area

PenStroke dot(PlanePoint at) { return {{{at}}}; }

PenStroke smooth(Path path, double tempo = 1, double pressure = 0.5) {
  return {{std::move(path)}, PenEnd::kTip, tempo, pressure};
}

PlanePoint on_circle(double radius, double angle) {
  return {radius * portable_cos(angle), radius * portable_sin(angle)};
}

/// "limn" as one joined word with a flourish under it, and the dot on the i. One unit is the height
/// of the small letters; the base line is y = 0.
std::vector<PenStroke> signature() {
  const Placement place{{38, 80}, 16.5, 0.32};
  // clang-format off
  const Path word = through(place, {
      // l: up from the left into the tall loop
      {-0.75, 0.12}, {-0.35, 0.22}, {0.08, 0.72}, {0.42, 1.45}, {0.55, 2.10}, {0.42, 2.52},
      {0.16, 2.42}, {0.02, 1.85}, {-0.03, 1.15}, {-0.02, 0.50}, {0.13, 0.06}, {0.40, 0.05},
      {0.70, 0.44},
      // i
      {0.90, 0.90}, {0.98, 0.98}, {0.99, 0.80}, {0.99, 0.40}, {1.12, 0.05}, {1.36, 0.12},
      {1.58, 0.56},
      // m: three arches
      {1.78, 0.94}, {1.98, 0.96}, {2.06, 0.62}, {2.06, 0.20}, {2.07, 0.02}, {2.12, 0.22},
      {2.28, 0.66}, {2.50, 0.96}, {2.70, 0.94}, {2.78, 0.60}, {2.78, 0.20}, {2.79, 0.02},
      {2.84, 0.22}, {3.00, 0.66}, {3.22, 0.96}, {3.42, 0.94}, {3.50, 0.58}, {3.51, 0.26},
      {3.66, 0.03}, {3.92, 0.14}, {4.16, 0.60},
      // n: two arches
      {4.36, 0.94}, {4.56, 0.96}, {4.64, 0.62}, {4.64, 0.20}, {4.65, 0.02}, {4.70, 0.22},
      {4.86, 0.66}, {5.08, 0.96}, {5.28, 0.94}, {5.36, 0.58}, {5.38, 0.24}, {5.56, 0.02},
      {5.98, 0.10},
      // the flourish: a bow to the right, back under the word, and away to the right again
      {6.56, 0.42}, {7.22, 0.66}, {7.84, 0.56}, {7.98, 0.12}, {7.50, -0.32}, {6.50, -0.62},
      {5.10, -0.82}, {3.60, -0.94}, {2.20, -0.98}, {0.90, -0.92}, {0.14, -0.76}, {0.02, -0.56},
      {0.50, -0.44}, {1.60, -0.54}, {3.10, -0.76}, {4.70, -0.94}, {6.30, -0.96}, {7.70, -0.78}});
  // clang-format on
  return {smooth(word, 1.5), dot(place({0.98, 1.5}))};
}

/// An Archimedean spiral from the middle outwards.
std::vector<PenStroke> spiral() {
  constexpr int kPerTurn = 20;
  constexpr int kTurns = 6;
  constexpr double kRadiusMm = 60;
  const Placement place{kMiddle, 1};
  Path path;
  for (int i = 0; i <= kPerTurn * kTurns; ++i) {
    const double part = static_cast<double>(i) / (kPerTurn * kTurns);
    path.push_back(place(on_circle(2 + (kRadiusMm - 2) * part, 2 * kPi * kTurns * part)));
  }
  return {smooth(std::move(path), 1.2)};
}

/// A teapot from the side, after Martin Newell's of 1975: body, spout and handle have the Bezier
/// control points of his patches in the plane of symmetry, cut off where they meet; lid, knob and
/// mouth are freely drawn. In his units, y up.
std::vector<PenStroke> teapot() {
  const Placement place{{99, 108}, 20};
  constexpr int kSteps = 6;
  // From the left end of the rim down, along the bottom and up to the right end of the rim.
  Path left = through(place, {{-1.5, 2.4}});
  append_bezier(left, place, {-1.75, 1.875}, {-2, 1.35}, {-2, 0.9}, kSteps);
  append_bezier(left, place, {-2, 0.45}, {-1.5, 0.225}, {-1.5, 0.15}, kSteps);
  Path right = through(place, {{1.5, 0.15}});
  append_bezier(right, place, {1.5, 0.225}, {2, 0.45}, {2, 0.9}, kSteps);
  append_bezier(right, place, {2, 1.35}, {1.75, 1.875}, {1.5, 2.4}, kSteps);
  PenStroke body{{left, line(place, {-1.5, 0.15}, {1.5, 0.15}), right}};

  Path lip = through(place, {{-1.5, 2.4}});
  append_bezier(lip, place, {-1.44, 2.53}, {1.44, 2.53}, {1.5, 2.4}, 12);

  Path lid = through(place, {{-1.3, 2.49}});
  append_bezier(lid, place, {-1.2, 2.56}, {-0.4, 2.55}, {-0.2, 2.68}, kSteps);
  Path lid_right = through(place, {{0.2, 2.68}});
  append_bezier(lid_right, place, {0.4, 2.55}, {1.2, 2.56}, {1.3, 2.49}, kSteps);

  Path knob = through(place, {{-0.2, 2.68}});
  append_bezier(knob, place, {-0.1, 2.82}, {-0.4, 2.98}, {-0.3, 3.1}, 5);
  append_bezier(knob, place, {-0.22, 3.2}, {0.22, 3.2}, {0.3, 3.1}, 5);
  append_bezier(knob, place, {0.4, 2.98}, {0.1, 2.82}, {0.2, 2.68}, 5);

  Path spout_below = through(place, {{1.84, 0.5}});
  append_bezier(spout_below, place, {3.1, 0.825}, {2.4, 2.025}, {3.3, 2.4}, 10);
  Path spout_above = through(place, {{1.9, 1.42}});
  append_bezier(spout_above, place, {2.55, 1.45}, {2.3, 2.1}, {2.7, 2.4}, 8);
  Path mouth = through(place, {{2.7, 2.4}});
  append_bezier(mouth, place, {2.8, 2.52}, {3.45, 2.52}, {3.3, 2.4}, 8);

  Path handle_outside = through(place, {{-1.58, 2.22}});
  append_bezier(handle_outside, place, {-2.5, 2.27}, {-3, 2.25}, {-3, 1.8}, 8);
  append_bezier(handle_outside, place, {-3, 1.35}, {-2.65, 0.9375}, {-1.94, 0.62}, 8);
  Path handle_inside = through(place, {{-1.68, 2.01}});
  append_bezier(handle_inside, place, {-2.3, 2.025}, {-2.7, 2.05}, {-2.7, 1.8}, 7);
  append_bezier(handle_inside, place, {-2.7, 1.575}, {-2.5, 1.125}, {-2.0, 0.9}, 7);

  return {body,
          smooth(lip),
          {{lid}},
          smooth(knob, 0.9),
          {{lid_right}},
          {{spout_below}},
          {{spout_above, mouth}},
          smooth(handle_outside),
          smooth(handle_inside)};
}

/// A star of five points in one line with sharp corners.
std::vector<PenStroke> star() {
  constexpr double kRadiusMm = 50;
  const Placement place{{105, 79}, 1};
  PenStroke stroke{{}, PenEnd::kTip, 0.9, 0.5};
  const auto corner = [](int i) { return on_circle(kRadiusMm, kPi * (0.5 + 0.8 * (i % 5))); };
  for (int i = 0; i < 5; ++i) stroke.pieces.push_back(line(place, corner(i), corner(i + 1)));
  return {stroke};
}

/// One round in a single stroke that ends where it began.
std::vector<PenStroke> circle() {
  constexpr int kPoints = 32;
  constexpr double kRadiusMm = 45;
  const Placement place{kMiddle, 1};
  Path path;
  for (int i = 0; i < kPoints; ++i) {
    path.push_back(
        place(on_circle(kRadiusMm, 2 * kPi * (0.25 + static_cast<double>(i) / kPoints))));
  }
  path.push_back(path.front());
  return {smooth(std::move(path), 1.4)};
}

/// The seven stars of the Plough as dots, joined by lines; one line too many is rubbed out.
std::vector<PenStroke> constellation() {
  // In mm from the lower left corner of the sheet.
  const Placement place{{0, 148}, 1};
  constexpr PlanePoint kStars[] = {{30, 102}, {66, 108}, {88, 93}, {113, 82},
                                   {121, 49}, {165, 46}, {178, 86}};
  constexpr std::pair<int, int> kLines[] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 3}};
  constexpr std::pair<int, int> kMistake = {3, 5};

  std::vector<PenStroke> strokes;
  for (const PlanePoint& star : kStars) strokes.push_back(dot(place(star)));
  const auto join = [&](std::pair<int, int> ends) {
    strokes.push_back(smooth(line(place, kStars[ends.first], kStars[ends.second]), 0.9, 0.4));
  };
  for (const auto& ends : kLines) join(ends);
  join(kMistake);
  // The eraser goes to and fro across the wrong line, clear of the stars at its ends.
  constexpr int kRubs = 22;
  constexpr double kAcross = 0.045;
  const PlanePoint from = kStars[kMistake.first];
  const PlanePoint way = kStars[kMistake.second] - from;
  Path rubbing;
  for (int i = 0; i <= kRubs; ++i) {
    const double along = 0.1 + 0.78 * i / kRubs;
    const double across = i % 2 == 0 ? kAcross : -kAcross;
    rubbing.push_back(place(from + along * way + across * PlanePoint{-way.y, way.x}));
  }
  strokes.push_back({{std::move(rubbing)}, PenEnd::kEraser, 1.5, 0.6});
  return strokes;
}

struct Entry {
  DrawingInfo info;
  std::vector<PenStroke> (*strokes)();
};

constexpr Entry kEntries[] = {
    {{"signature", "the word limn in joined letters, with a flourish and the dot on the i"},
     signature},
    {{"spiral", "six turns from the middle outwards"}, spiral},
    {{"teapot", "a teapot from the side: body, lid, knob, spout and handle"}, teapot},
    {{"star", "a star of five points in one line, with sharp corners"}, star},
    {{"circle", "one round in a single closed stroke"}, circle},
    {{"constellation", "the Plough as dots and lines, one line rubbed out with the eraser"},
     constellation},
};

constexpr auto kInfos = [] {
  std::array<DrawingInfo, std::size(kEntries)> infos;
  for (std::size_t i = 0; i < infos.size(); ++i) infos[i] = kEntries[i].info;
  return infos;
}();

}  // namespace

std::span<const DrawingInfo> drawings() noexcept { return kInfos; }

std::optional<Drawing> find_drawing(std::string_view name) {
  for (const Entry& entry : kEntries) {
    if (entry.info.name == name) return Drawing{entry.info, entry.strokes()};
  }
  return std::nullopt;
}

}  // namespace limn::firmware
