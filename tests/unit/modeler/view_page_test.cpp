#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "modeler/view/page.hpp"
#include "tests/unit/modeler/sketch_examples.hpp"

namespace limn {
namespace {

Sketch line_to(double x, double y) {
  Sketch sketch;
  sketch.strokes.push_back(
      test::stroke_of(test::make_curve(KnotVector::make_clamped(1, 0, 1), {{0, 0}, {x, y}})));
  return sketch;
}

TEST(ScaleBar, IsTheLargestRoundLengthThatFits) {
  struct Case {
    double most;
    double length;
    const char* label;
  };
  for (const Case& c : {Case{30, 20, "20 mm"}, Case{20, 20, "20 mm"}, Case{49.9, 20, "20 mm"},
                        Case{50, 50, "50 mm"}, Case{100, 100, "100 mm"}, Case{9.99, 5, "5 mm"},
                        Case{1, 1, "1 mm"}, Case{0.3, 0.2, "0.2 mm"},
                        Case{0.0011, 0.001, "0.001 mm"}, Case{3.4e8, 2e8, "200000000 mm"}}) {
    const ScaleBar bar = scale_bar_within(c.most);
    EXPECT_EQ(bar.length_mm, c.length);
    EXPECT_EQ(bar.label, c.label);
  }
}

TEST(ScaleBar, FitsAtEveryScale) {
  for (double most = 1e-9; most < 1e12; most *= 1.07) {
    const ScaleBar bar = scale_bar_within(most);
    EXPECT_LE(bar.length_mm, most);
    EXPECT_GT(bar.length_mm * 2.5000001, most);
  }
}

TEST(Page, FitsTheDrawingWithMarginsAndFooter) {
  // Control points from (10, 10) to (70, 49): a unit of 0.6 mm, margins of 5 units, and below a
  // gap of 4 units and two rows of 3.6.
  const Page page = lay_out_page(test::four_strokes(), {}).value();
  EXPECT_NEAR(page.width, 66, 1e-9);
  EXPECT_NEAR(page.height, 39 + 6 + (4 + 7.2) * 0.6, 1e-9);
  EXPECT_NEAR(page.origin.x(), 7, 1e-9);
  EXPECT_NEAR(page.origin.y(), 7, 1e-9);
  EXPECT_EQ(page.paper_scale, 1);
  EXPECT_EQ(page.scale_bar.length_mm, 10);
}

TEST(Page, IsSmallerWithoutFurniture) {
  PictureOptions bare;
  bare.scale_bar = false;
  bare.caption = false;
  EXPECT_NEAR(lay_out_page(test::four_strokes(), bare).value().height, 39 + 6, 1e-9);
}

TEST(Page, FurnitureLiesBelowTheDrawingAndOnThePage) {
  for (const Sketch& sketch : {test::four_strokes(), Sketch{}, line_to(200, 0), line_to(0, 300),
                               line_to(1e9, -1e9), line_to(1e-7, 0)}) {
    const Page page = lay_out_page(sketch, {}).value();
    double lowest = -std::numeric_limits<double>::infinity();
    for (const auto& stroke : sketch.strokes) {
      for (const auto& p : stroke.curve.control_points()) {
        lowest = std::max(lowest, p.y());
        EXPECT_GT(p.x() - page.ink_width, page.origin.x());
        EXPECT_LT(p.x() + page.ink_width, page.origin.x() + page.width);
        EXPECT_GT(p.y() - page.ink_width, page.origin.y());
      }
    }
    EXPECT_GT(page.scale_bar_at.y() - page.text_size, lowest + page.ink_width);
    EXPECT_GT(page.caption_at.y() - page.text_size, page.scale_bar_at.y() + 0.3 * page.text_size);
    EXPECT_LT(page.caption_at.y() + page.text_size, page.origin.y() + page.height);
    const double letters = static_cast<double>(picture_caption(sketch, page.paper_scale).size());
    EXPECT_LE(page.caption_at.x() + 0.6 * letters * page.text_size,
              page.origin.x() + page.width + 1e-9 * page.width);
    EXPECT_LE(page.scale_bar.length_mm, 0.3 * page.width);
  }
}

TEST(Page, IsDrawnSmallerWherePdfEnds) {
  const Page page = lay_out_page(line_to(1e9, 2e8), {}).value();
  EXPECT_EQ(page.paper_scale, 1.0 / 500'000);  // 1.1e9 mm on at most 5,000
  EXPECT_LE(page.width * page.paper_scale, kLongestPaperMm);
  EXPECT_EQ(lay_out_page(line_to(4500, 0), {}).value().paper_scale, 1);
  EXPECT_EQ(lay_out_page(line_to(5000, 0), {}).value().paper_scale, 0.5);
}

TEST(Page, RefusesCoordinatesThatNothingCanDraw) {
  for (const double x : {6e11, -6e11, 1e300, std::numeric_limits<double>::max()}) {
    const auto page = lay_out_page(line_to(x, 0), {});
    ASSERT_FALSE(page.has_value());
    EXPECT_EQ(page.error().code, ErrorCode::kOutOfRange);
    EXPECT_EQ(page.error().at, "stroke 1");
  }
}

TEST(Caption, CountsAndMeasures) {
  EXPECT_EQ(picture_caption(test::four_strokes(), 1),
            "4 strokes, 19 control points, tolerance 0.05 mm, largest deviation 0.04 mm");
  EXPECT_EQ(picture_caption({0.2, {}}, 1), "0 strokes, 0 control points, tolerance 0.2 mm");
  Sketch dot{0.02, {test::stroke_of(test::dot())}};
  dot.strokes[0].deviation_max_mm = 0.0123456;
  EXPECT_EQ(picture_caption(dot, 1.0 / 500'000),
            "1 stroke, 1 control point, tolerance 0.02 mm, largest deviation 0.0123 mm, "
            "drawn 1:500000");
  dot.strokes[0].deviation_max_mm = 3e-10;
  EXPECT_EQ(picture_caption(dot, 1),
            "1 stroke, 1 control point, tolerance 0.02 mm, largest deviation below 0.0002 mm");
}

}  // namespace
}  // namespace limn
