#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "modeler/view/plot.hpp"
#include "modeler/view/plot_layout.hpp"

namespace limn::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> labels(double low, double high, int most) {
  std::vector<std::string> out;
  for (const PlotTick& tick : round_ticks(low, high, most)) out.push_back(tick.label);
  return out;
}

TEST(RoundTicks, AreOnesTwosAndFives) {
  EXPECT_THAT(labels(0, 10, 6), ElementsAre("0", "2", "4", "6", "8", "10"));
  EXPECT_THAT(labels(-1.05, 1.05, 5), ElementsAre("-1.0", "-0.5", "0.0", "0.5", "1.0"));
  EXPECT_THAT(labels(0.0031, 0.0049, 4), ElementsAre("0.0035", "0.0040", "0.0045"));
  EXPECT_THAT(labels(-70, 70, 5), ElementsAre("-50", "0", "50"));
  EXPECT_THAT(labels(1e9, 3e9, 5),
              ElementsAre("1000000000", "1500000000", "2000000000", "2500000000", "3000000000"));
}

TEST(RoundTicks, LieWithinAndAreNoMoreThanAsked) {
  for (int exponent = -9; exponent <= 12; ++exponent) {
    for (const double mantissa : {1.0, 1.7, 3.3, 9.99}) {
      for (const int most : {2, 5, 12}) {
        const double size = mantissa * std::pow(10, exponent);
        const auto ticks = round_ticks(-0.3 * size, 0.7 * size, most);
        ASSERT_GE(ticks.size(), 1U) << size;
        ASSERT_LE(ticks.size(), static_cast<std::size_t>(most)) << size;
        EXPECT_GE(ticks.front().value, -0.3 * size);
        EXPECT_LE(ticks.back().value, 0.7 * size);
      }
    }
  }
}

TEST(PlotTrack, KeepsFewSamplesAsTheyAre) {
  PlotTrack track(2);
  track.push(0, std::array{1.0, kNone});
  track.push(0.5, std::array{2.0, 7.0}, {.begins_anew = true, .shaded = false, .marked = true});
  ASSERT_EQ(track.bins().size(), 2U);
  EXPECT_EQ(track.bins()[1].begin_s, 0.5);
  EXPECT_TRUE(track.bins()[1].flags.begins_anew);
  EXPECT_TRUE(track.bins()[1].flags.marked);
  EXPECT_TRUE(std::isnan(track.range(0, 1).first));
  EXPECT_EQ(track.range(1, 1).last, 7);
  EXPECT_EQ(track.extent(0).low, 1);
  EXPECT_EQ(track.extent(0).high, 2);
  EXPECT_EQ(track.extent(1).low, 7);
}

TEST(PlotTrack, HidesNoSpikeHoweverLongItGoesOn) {
  PlotTrack track(1);
  constexpr int kSamples = 300'000;
  for (int i = 0; i < kSamples; ++i) {
    const double value = i == 123'456 ? 50 : i == 234'567 ? -50 : std::sin(1e-4 * i);
    track.push(1e-3 * i, std::array{value},
               {.begins_anew = false, .shaded = false, .marked = i == 99'999});
  }
  EXPECT_LE(track.bins().size(), PlotTrack::kMostBins);
  EXPECT_GT(track.bins().size(), PlotTrack::kMostBins / 4) << "still fine enough to look at";
  EXPECT_EQ(track.extent(0).high, 50);
  EXPECT_EQ(track.extent(0).low, -50);
  EXPECT_EQ(track.extent(0).last, std::sin(1e-4 * (kSamples - 1)));
  std::size_t marked = 0;
  for (std::size_t i = 0; i < track.bins().size(); ++i) {
    const PlotTrack::Bin& bin = track.bins()[i];
    marked += bin.flags.marked ? 1 : 0;
    EXPECT_TRUE(i == 0 || bin.begin_s > track.bins()[i - 1].end_s) << i;
    const bool holds_spike = bin.begin_s <= 123.456 && 123.456 <= bin.end_s;
    EXPECT_EQ(track.range(i, 0).high == 50, holds_spike);
  }
  EXPECT_EQ(marked, 1U);
}

TEST(PlotTrack, BearsTimesThatGoBack) {
  PlotTrack track(1);
  track.push(5, std::array{1.0});
  track.push(3, std::array{2.0});
  ASSERT_EQ(track.bins().size(), 1U);
  EXPECT_EQ(track.bins()[0].end_s, 5);
  EXPECT_EQ(track.range(0, 0).last, 2);
}

TEST(PlotPath, KeepsItsShapeInBoundedMemory) {
  PlotPath path;
  constexpr int kPoints = 200'000;
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = 2 * M_PI * i / kPoints;
    path.push({100 * std::cos(angle), 100 * std::sin(angle)});
  }
  const auto points = path.points();
  EXPECT_LE(points.size(), PlotPath::kMostPoints);
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  EXPECT_NEAR(length, 200 * M_PI, 0.01);
  EXPECT_NEAR((points.back() - Eigen::Vector2d(100, 0)).norm(), 0, 1e-9);
}

/// The farthest from a circle around 0 that a line of the path gets.
double farthest_from_circle(const std::vector<Eigen::Vector2d>& points, double radius) {
  double farthest = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i - 1].hasNaN() || points[i].hasNaN()) continue;
    for (const double t : {0.0, 0.5, 1.0}) {
      const Eigen::Vector2d at = (1 - t) * points[i - 1] + t * points[i];
      farthest = std::max(farthest, std::abs(at.norm() - radius));
    }
  }
  return farthest;
}

TEST(PlotPath, IsNoTangleOfChordsHoweverOftenItGoesRound) {
  PlotPath path;
  constexpr double kRadiusMm = 40;
  constexpr double kStep = 0.031;  // radians; a lap is no whole number of them
  double angle = 0;
  for (; angle < 2 * M_PI * 1000; angle += kStep) {
    path.push({kRadiusMm * std::cos(angle), kRadiusMm * std::sin(angle)});
  }
  angle -= kStep;
  const auto points = path.points();
  EXPECT_LE(points.size(), PlotPath::kMostPoints);
  EXPECT_LT(farthest_from_circle(points, kRadiusMm), 0.5);
  // No gap in the circle, either.
  std::vector<bool> covered(360);
  for (const Eigen::Vector2d& point : points) {
    if (point.hasNaN()) continue;
    const double degrees = std::atan2(point.y(), point.x()) * 180 / M_PI;
    covered[static_cast<std::size_t>(degrees + 360) % 360] = true;
  }
  EXPECT_EQ(std::count(covered.begin(), covered.end(), true), 360);
  EXPECT_NEAR((points.front() - Eigen::Vector2d(kRadiusMm, 0)).norm(), 0, 1e-9);
  const Eigen::Vector2d end(kRadiusMm * std::cos(angle), kRadiusMm * std::sin(angle));
  EXPECT_NEAR((points.back() - end).norm(), 0, 1e-9);
}

TEST(PlotPath, OfAnAreaThatItFillsStaysBounded) {
  PlotPath path;
  std::uint64_t state = 1;
  const auto random = [&state] {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state >> 40);
  };
  for (int i = 0; i < 100'000; ++i) {
    path.push({random(), random()});
    path.push({0, i % 2 == 0 ? 0.0 : 1e-320});
  }
  EXPECT_LE(path.points().size(), PlotPath::kMostPoints);
}

PlotDevice device_of(const std::vector<double>& values) {
  PlotDevice device{"Pen <1>", PlotTrack(1), "in contact", "reports lost", {}, {}};
  double time = 0;
  for (const double value : values) {
    device.track.push(time, std::array{value});
    time += 0.5;
  }
  device.panels.push_back({"pressure", {{"p", 0}}, {}, {}, {}});
  return device;
}

TEST(LayOutPlot, DevicesShareTheTimeAndFollowEachOther) {
  Plot plot{"two", {device_of({0, 1, 4}), device_of({1, 2})}};
  plot.devices[0].panels.push_back({"levels", {}, {-3, 3}, "dead zone", {}});
  plot.devices[1].ways.push_back({"path", "x", "y", {{0, 0}, {10, 5}}});
  const auto layout = lay_out_plot(plot);
  ASSERT_TRUE(layout);
  ASSERT_EQ(layout->devices.size(), 2U);
  const PlotFrame& first = layout->devices[0].panels.at(0);
  const PlotFrame& second = layout->devices[1].panels.at(0);
  EXPECT_EQ(first.x.high, 1);
  EXPECT_EQ(second.x.high, 1) << "of the longer one";
  EXPECT_EQ(first.x.at(0.5), 0.5 * (first.x.from + first.x.to));
  EXPECT_DOUBLE_EQ(first.y.low, -0.24) << "6 % of room";
  EXPECT_DOUBLE_EQ(first.y.high, 4.24);
  EXPECT_GT(first.y.from, first.y.to) << "up the page";
  const PlotFrame& levels = layout->devices[0].panels.at(1);
  EXPECT_LT(levels.y.low, -3);
  EXPECT_GT(levels.y.to, first.y.from) << "panels do not overlap";
  EXPECT_GT(layout->devices[1].name_y, levels.y.from + 7.5) << "nor does the next device";
  const PlotFrame& way = layout->devices[1].ways.at(0);
  const double mm_per_x = (way.x.to - way.x.from) / (way.x.high - way.x.low);
  const double mm_per_y = (way.y.from - way.y.to) / (way.y.high - way.y.low);
  EXPECT_NEAR(mm_per_x, mm_per_y, 1e-12);
  EXPECT_GT(layout->height, way.y.from);
}

TEST(LayOutPlot, GivesWhatNeverChangesARangeToReadItIn) {
  const auto zeros = lay_out_plot({"", {device_of({0, 0, 0})}});
  ASSERT_TRUE(zeros);
  EXPECT_EQ(zeros->devices[0].panels[0].y.low, -1);
  EXPECT_EQ(zeros->devices[0].panels[0].y.high, 1);
  const auto one = lay_out_plot({"", {device_of({7})}});
  ASSERT_TRUE(one);
  EXPECT_EQ(one->devices[0].panels[0].y.high, 14);
  EXPECT_EQ(one->devices[0].panels[0].x.high, 1);
  EXPECT_TRUE(lay_out_plot({"", {device_of({kNone, kNone})}}));
}

TEST(LayOutPlot, HasRoomForADeviceThatBeganBeforeTheFirstOne) {
  PlotDevice early = device_of({});
  early.track.push(-2, std::array{1.0});
  const auto layout = lay_out_plot({"", {device_of({1, 2, 3}), early}});
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->devices[0].panels[0].x.low, -2);
  EXPECT_EQ(layout->devices[0].panels[0].x.high, 1);
}

TEST(LayOutPlot, RefusesWhatCannotBeDrawn) {
  const auto nothing = lay_out_plot({});
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, ErrorCode::kMissing);
  for (const double value : {1e13, std::numeric_limits<double>::infinity()}) {
    const auto far = lay_out_plot({"", {device_of({0, value})}});
    ASSERT_FALSE(far);
    EXPECT_EQ(far.error().code, ErrorCode::kOutOfRange);
    EXPECT_EQ(far.error().at, "pressure");
  }
}

TEST(PlotToSvg, DrawsLinesGapsShadesAndMarks) {
  PlotDevice device = device_of({0, 1, kNone, 2});
  device.track.push(2, std::array{3.0}, {.begins_anew = false, .shaded = true, .marked = false});
  device.track.push(3, std::array{3.0}, {.begins_anew = false, .shaded = false, .marked = true});
  const auto svg = plot_to_svg({"a & b", {device}});
  ASSERT_TRUE(svg);
  EXPECT_THAT(*svg, HasSubstr("<title>a &amp; b</title>"));
  EXPECT_THAT(*svg, HasSubstr(">Pen &lt;1></text>"));
  EXPECT_THAT(*svg, HasSubstr(">in contact</text>"));
  EXPECT_THAT(*svg, HasSubstr(">reports lost</text>"));
  const std::size_t line = svg->find("id=\"device-1-panel-1-line-1\"");
  ASSERT_NE(line, std::string::npos);
  const std::string data = svg->substr(line, svg->find("/>", line) - line);
  EXPECT_EQ(std::count(data.begin(), data.end(), 'M'), 2) << "one line before the gap, one after";
  EXPECT_EQ(*svg, *plot_to_svg({"a & b", {device}})) << "the same bytes";
}

}  // namespace
}  // namespace limn::test
