#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <set>
#include <sstream>

#include "modeler/sketch/curve_forms.hpp"
#include "modeler/view/picture.hpp"
#include "tests/support/golden.hpp"
#include "tests/unit/modeler/sketch_examples.hpp"

namespace limn {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string svg_of(const Sketch& sketch, const PictureOptions& options = {}) {
  auto svg = sketch_to_svg(sketch, options);
  EXPECT_TRUE(svg.has_value()) << svg.error().what;
  return svg.value_or("");
}

/// The element with this id, up to its '>'.
std::string element(const std::string& svg, const std::string& id) {
  const auto at = svg.find(" id=\"" + id + "\"");
  if (at == std::string::npos) return "";
  const auto begin = svg.rfind('<', at);
  return svg.substr(begin, svg.find('>', at) + 1 - begin);
}

std::string attribute(const std::string& of, const std::string& name) {
  const auto at = of.find(" " + name + "=\"");
  if (at == std::string::npos) return "";
  const auto begin = at + name.size() + 3;
  return of.substr(begin, of.find('"', begin) - begin);
}

/// The numbers of path data, commands left out.
std::vector<double> numbers(std::string data) {
  for (char& c : data) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) c = ' ';
  }
  std::istringstream in(data);
  std::vector<double> out;
  for (double x = 0; in >> x;) out.push_back(x);
  return out;
}

std::vector<std::string> ids(const std::string& svg) {
  const std::string key = " id=\"";
  std::vector<std::string> out;
  for (auto at = svg.find(key); at != std::string::npos; at = svg.find(key, at + 1)) {
    const auto begin = at + key.size();
    out.push_back(svg.substr(begin, svg.find('"', begin) - begin));
  }
  return out;
}

TEST(SketchSvg, OneMillimetreIsOneMillimetre) {
  const std::string svg = svg_of(test::four_strokes());
  const std::string root = svg.substr(svg.find("<svg"));
  EXPECT_EQ(attribute(root, "width"), "66mm");
  EXPECT_EQ(attribute(root, "height"), "51.72mm");
  EXPECT_EQ(attribute(root, "viewBox"), "7 7 66 51.72");
}

TEST(SketchSvg, ScaleBarIsAsLongAsItsLabelSays) {
  const std::string svg = svg_of(test::four_strokes());
  const auto bar = numbers(attribute(element(svg, "scale-bar"), "d"));
  ASSERT_EQ(bar.size(), 12U);  // left tick, bar, right tick
  EXPECT_NEAR(bar[6] - bar[4], 10, 1e-6);
  EXPECT_EQ(bar[7], bar[5]);
  EXPECT_THAT(svg, HasSubstr(">10 mm</text>"));
}

TEST(SketchSvg, CurvesAreTheExactBezierPieces) {
  const Sketch sketch = test::four_strokes();
  const std::string svg = svg_of(sketch);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& curve = sketch.strokes[i].curve;
    const std::string path = element(svg, "stroke-" + std::to_string(i + 1));
    EXPECT_EQ(attribute(path, "class"), "curve");
    EXPECT_EQ(attribute(path, "fill"), "none");
    const auto xy = numbers(attribute(path, "d"));
    const auto breakpoints = curve.knots().breakpoints();
    ASSERT_EQ(xy.size(), 2 + 6 * (breakpoints.size() - 1));
    for (std::size_t k = 0; k < breakpoints.size(); ++k) {
      // Ends of the pieces are points of the curve, the control points next to them a third of the
      // span along its derivatives.
      const Eigen::Vector2d written(xy[6 * k], xy[6 * k + 1]);
      EXPECT_LE((written - curve.point(breakpoints[k])).norm(), 1e-6);
      if (k + 1 == breakpoints.size()) continue;
      std::array<Eigen::Vector2d, 2> d;
      curve.derivatives(breakpoints[k], d);
      const Eigen::Vector2d next(xy[6 * k + 2], xy[6 * k + 3]);
      EXPECT_LE((next - (d[0] + (breakpoints[k + 1] - breakpoints[k]) / 3 * d[1])).norm(), 1e-6);
    }
  }
}

TEST(SketchSvg, OnlyAClosedCurveIsClosed) {
  const std::string svg = svg_of(test::four_strokes());
  EXPECT_THAT(attribute(element(svg, "stroke-1"), "d"), Not(HasSubstr("Z")));
  EXPECT_THAT(attribute(element(svg, "stroke-3"), "d"), HasSubstr("Z"));
  EXPECT_THAT(attribute(element(svg, "stroke-3-polygon"), "d"), HasSubstr("Z"));
  EXPECT_EQ(numbers(attribute(element(svg, "stroke-3-polygon"), "d")).size(), 2U * 5U);
}

TEST(SketchSvg, LayersComeInOrderAndIdsAreUnique) {
  const auto all = ids(svg_of(test::four_strokes()));
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), all.size());
  std::vector<std::string> layers;
  for (const std::string& id : all) {
    if (id.rfind("stroke-", 0) != 0 && id != "page" && id != "scale-bar") layers.push_back(id);
  }
  EXPECT_THAT(layers, testing::ElementsAre("control-polygons", "ink", "curves", "control-points",
                                           "corners", "annotation"));
}

TEST(SketchSvg, OptionsLeaveLayersOut) {
  PictureOptions bare;
  bare.control_polygons = bare.corners = bare.scale_bar = bare.caption = false;
  const std::string svg = svg_of(test::four_strokes(), bare);
  EXPECT_THAT(svg, Not(HasSubstr("control-")));
  EXPECT_THAT(svg, Not(HasSubstr("corners")));
  EXPECT_THAT(svg, Not(HasSubstr("annotation")));
  EXPECT_THAT(svg, HasSubstr("id=\"stroke-4-ink\""));
}

TEST(SketchSvg, MarksTheCornerWhereTheCurveBends) {
  const auto corner =
      numbers(attribute(element(svg_of(test::four_strokes()), "stroke-2-corners"), "d"));
  ASSERT_EQ(corner.size(), 4U);
  EXPECT_EQ(corner[0], 30);
  EXPECT_EQ(corner[1], 40);
}

TEST(SketchSvg, AnErasersStrokeIsDashedAndHasNoInk) {
  Sketch sketch = test::four_strokes();
  sketch.strokes[0].tool = Tool::kEraser;
  const std::string svg = svg_of(sketch);
  EXPECT_EQ(element(svg, "stroke-1-ink"), "");
  EXPECT_EQ(attribute(element(svg, "stroke-1"), "class"), "curve eraser");
  EXPECT_NE(attribute(element(svg, "stroke-1"), "stroke-dasharray"), "");
  EXPECT_EQ(attribute(element(svg, "stroke-2"), "stroke-dasharray"), "");
}

TEST(SketchSvg, ASketchWithoutStrokesIsAPageWithItsCaption) {
  const std::string svg = svg_of({0.05, {}});
  EXPECT_THAT(svg, HasSubstr("0 strokes, 0 control points, tolerance 0.05 mm</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(SketchSvg, DotsAreDots) {
  const std::string svg = svg_of({0.05, {test::stroke_of(test::dot(30, 20))}});
  EXPECT_EQ(attribute(element(svg, "stroke-1"), "d"), "M30 20L30 20");
  const auto disc = numbers(attribute(element(svg, "stroke-1-ink"), "d"));
  ASSERT_EQ(disc.size(), 26U);
  EXPECT_NEAR(0.5 * (disc[0] + disc[12]), 30, 1e-3);  // opposite points of the disc
  EXPECT_GT(disc[0], disc[12]);
}

TEST(SketchSvg, AHugeCoordinateMakesASmallFile) {
  Sketch sketch = test::four_strokes();
  sketch.strokes.push_back(test::stroke_of(test::dot(1e9, -1e9)));
  const std::string svg = svg_of(sketch);
  EXPECT_LT(svg.size(), 20'000U);
  EXPECT_THAT(svg, HasSubstr("drawn 1:500000"));
  EXPECT_THAT(svg, HasSubstr(" d=\"M1000000000 -1000000000L"));
}

TEST(SketchSvg, RefusesDegreesThatCubicsCannotExpress) {
  Sketch sketch = test::four_strokes();
  sketch.strokes[1] = test::stroke_of(test::make_curve(KnotVector::make_clamped(4, 0, 1),
                                                       {{0, 0}, {1, 1}, {2, 0}, {3, 1}, {4, 0}}));
  const auto svg = sketch_to_svg(sketch);
  ASSERT_FALSE(svg.has_value());
  EXPECT_EQ(svg.error().code, ErrorCode::kLimit);
  EXPECT_EQ(svg.error().at, "stroke 2");
}

TEST(SketchSvg, IsTheRecordedFile) {
  Sketch sketch = test::four_strokes();
  sketch.strokes[0].pressure = {{0, 0.1}, {1, 0.6}, {2, 0.9}, {3, 0.2}};
  EXPECT_TRUE(test::matches_golden(svg_of(sketch), "sketch/four_strokes.svg"));
}

}  // namespace
}  // namespace limn
