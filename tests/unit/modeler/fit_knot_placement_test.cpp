#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "modeler/fit/knot_placement.hpp"

namespace limn::fit_detail {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;

TEST(KnotPlacement, EquidistributesMass) {
  const std::array breaks = {0.0, 1.0, 3.0};
  const std::array mass = {3.0, 1.0};
  EXPECT_THAT(equidistribute(breaks, mass, 4, 0),
              ElementsAre(0, DoubleEq(1.0 / 3), DoubleEq(2.0 / 3), DoubleEq(1), 3));
  EXPECT_THAT(equidistribute(breaks, mass, 1, 0), ElementsAre(0, 3));
}

TEST(KnotPlacement, KeepsKnotsApart) {
  const std::array breaks = {0.0, 1.0};
  const std::array mass = {1.0};
  EXPECT_THAT(equidistribute(breaks, mass, 10, 0.25),
              ElementsAre(0, DoubleEq(0.3), DoubleEq(0.6), 1));
}

TEST(KnotPlacement, MassIsOneAtTheTarget) {
  EXPECT_DOUBLE_EQ(span_mass(0.1, 0.1), 1);
  EXPECT_DOUBLE_EQ(span_mass(3.2, 0.1), 2) << "32 times the error: two spans";
}

TEST(KnotPlacement, FailingRangesMergeWhereTheyMeet) {
  const std::array errors = {0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 2.0};
  const auto ranges = failing_ranges(errors, 1, 1);
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_EQ(ranges[0].begin, 0);
  EXPECT_EQ(ranges[0].end, 3);
  EXPECT_EQ(ranges[1].begin, 7);
  EXPECT_EQ(ranges[1].end, 11);
  EXPECT_TRUE(failing_ranges(errors, 3, 1).empty());
}

TEST(KnotPlacement, WindowsTileTheSpans) {
  for (int spans = 1; spans < 40; ++spans) {
    for (int width = 2; width < 9; ++width) {
      for (int offset = 0; offset < width; ++offset) {
        int next = 0;
        for (const SpanRange range : windows(spans, width, offset)) {
          EXPECT_EQ(range.begin, next);
          EXPECT_GE(range.end - range.begin, std::min(spans, 2));
          EXPECT_LE(range.end - range.begin, width + 1);
          next = range.end;
        }
        EXPECT_EQ(next, spans);
      }
    }
  }
}

}  // namespace
}  // namespace limn::fit_detail
