#include "input/stroke/stroke_sampler.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/support/alloc_guard.hpp"
#include "tests/support/for_all.hpp"

namespace limn {
namespace {

using ::testing::ElementsAre;

PenSample touching(double x_mm, int ms = 0, DeviceIndex device = 0, Tool tool = Tool::kPen) {
  PenSample sample;
  sample.time = std::chrono::milliseconds(ms);
  sample.device = device;
  sample.tool = tool;
  sample.state = tool == Tool::kEraser ? PenState::kErasing : PenState::kInContact;
  for (const PenAxis axis : {PenAxis::kX, PenAxis::kY, PenAxis::kPressure, PenAxis::kTiltX,
                             PenAxis::kTiltY, PenAxis::kSerial}) {
    sample.axes.add(axis);
  }
  sample.x_mm = x_mm;
  sample.y_mm = 2 * x_mm;
  sample.pressure = 0.25;
  sample.tilt_x_rad = 0.5;
  sample.tilt_y_rad = -0.5;
  return sample;
}

PenSample hovering(double x_mm, int ms = 0, DeviceIndex device = 0) {
  PenSample sample = touching(x_mm, ms, device);
  sample.state = PenState::kInRange;
  return sample;
}

std::vector<double> x_of(const Stroke& stroke) {
  std::vector<double> out;
  for (const StrokePoint& point : stroke.points) out.push_back(point.x_mm);
  return out;
}

class StrokeSamplerTest : public ::testing::Test {
 protected:
  std::vector<Stroke> strokes_;
  void push(StrokeSampler& sampler, const PenSample& sample) {
    sampler.push(sample, [this](Stroke& stroke) { strokes_.push_back(std::move(stroke)); });
  }
  void finish(StrokeSampler& sampler) {
    sampler.finish([this](Stroke& stroke) { strokes_.push_back(std::move(stroke)); });
  }
};

TEST_F(StrokeSamplerTest, KeepsEverySampleFromTouchToLiftAndNoOther) {
  StrokeSampler sampler;
  push(sampler, hovering(0));
  push(sampler, touching(1, 10));
  push(sampler, touching(1, 15));  // a dwell
  push(sampler, touching(3, 20));
  EXPECT_TRUE(strokes_.empty());
  push(sampler, hovering(9, 25));
  ASSERT_EQ(strokes_.size(), 1U);
  const Stroke& stroke = strokes_[0];
  EXPECT_THAT(x_of(stroke), ElementsAre(1, 1, 3));
  EXPECT_EQ(stroke.points[2].time, std::chrono::milliseconds(20));
  EXPECT_EQ(stroke.points[2].y_mm, 6);
  EXPECT_EQ(stroke.points[2].pressure, 0.25);
  EXPECT_EQ(stroke.points[2].tilt_x_rad, 0.5);
  EXPECT_EQ(stroke.points[2].tilt_y_rad, -0.5);
  EXPECT_EQ(stroke.tool, Tool::kPen);
  EXPECT_TRUE(stroke.closed_by_lift);
  EXPECT_TRUE(stroke.axes.has(PenAxis::kTiltY));
  EXPECT_FALSE(stroke.axes.has(PenAxis::kSerial)) << "no axis of a stroke's points";
  EXPECT_EQ(sampler.strokes(), 1U);
}

TEST_F(StrokeSamplerTest, AnUnfinishedContactIsGivenAtTheEndAndMarked) {
  StrokeSampler sampler;
  push(sampler, touching(1));
  finish(sampler);
  ASSERT_EQ(strokes_.size(), 1U);
  EXPECT_FALSE(strokes_[0].closed_by_lift);
  finish(sampler);
  EXPECT_EQ(strokes_.size(), 1U);
}

TEST_F(StrokeSamplerTest, ErasersDrawAndTabletMiceDoNot) {
  StrokeSampler sampler;
  push(sampler, touching(1, 0, 0, Tool::kEraser));
  PenSample mouse = hovering(5);
  mouse.tool = Tool::kTabletMouse;
  push(sampler, mouse);
  push(sampler, mouse);
  finish(sampler);
  ASSERT_EQ(strokes_.size(), 1U);
  EXPECT_EQ(strokes_[0].tool, Tool::kEraser);
}

TEST_F(StrokeSamplerTest, DevicesDrawSideBySide) {
  StrokeSampler sampler;
  push(sampler, touching(1, 0, 7));
  push(sampler, touching(10, 1, 8));
  push(sampler, touching(2, 2, 7));
  push(sampler, hovering(0, 3, 7));
  push(sampler, touching(11, 4, 8));
  finish(sampler);
  ASSERT_EQ(strokes_.size(), 2U);
  EXPECT_EQ(strokes_[0].device, 7U);
  EXPECT_THAT(x_of(strokes_[0]), ElementsAre(1, 2));
  EXPECT_EQ(strokes_[1].device, 8U);
  EXPECT_THAT(x_of(strokes_[1]), ElementsAre(10, 11));
}

TEST_F(StrokeSamplerTest, SamplesWithoutPositionNeitherDrawNorLift) {
  StrokeSampler sampler;
  push(sampler, touching(1));
  PenSample blind = touching(2);
  blind.axes.remove(PenAxis::kY);
  push(sampler, blind);
  push(sampler, touching(3));
  finish(sampler);
  ASSERT_EQ(strokes_.size(), 1U);
  EXPECT_THAT(x_of(strokes_[0]), ElementsAre(1, 3));
  EXPECT_EQ(sampler.samples_without_position(), 1U);
}

TEST_F(StrokeSamplerTest, AnAxisThatOnePointMissesIsNoAxisOfTheStroke) {
  StrokeSampler sampler;
  push(sampler, touching(1));
  PenSample flat = touching(2);
  flat.axes.remove(PenAxis::kTiltX);
  push(sampler, flat);
  push(sampler, touching(3));
  finish(sampler);
  ASSERT_EQ(strokes_.size(), 1U);
  EXPECT_FALSE(strokes_[0].axes.has(PenAxis::kTiltX));
  EXPECT_TRUE(strokes_[0].axes.has(PenAxis::kTiltY));
  EXPECT_TRUE(strokes_[0].axes.has_position());
}

TEST_F(StrokeSamplerTest, TimeNeverRunsBackWithinAStroke) {
  StrokeSampler sampler;
  push(sampler, touching(1, 30));
  push(sampler, touching(2, 10));
  push(sampler, touching(3, 40));
  finish(sampler);
  ASSERT_EQ(strokes_.size(), 1U);
  EXPECT_EQ(strokes_[0].points[1].time, std::chrono::milliseconds(30));
  EXPECT_EQ(strokes_[0].points[2].time, std::chrono::milliseconds(40));
  EXPECT_EQ(sampler.time_reversals(), 1U);
}

TEST_F(StrokeSamplerTest, APenThatNeverLiftsIsCutAndGoesOnFromTheSharedPoint) {
  StrokeSampler sampler({.max_points = 3});
  for (int i = 0; i < 7; ++i) push(sampler, touching(i, i));
  push(sampler, hovering(7, 7));
  ASSERT_EQ(strokes_.size(), 3U);
  EXPECT_THAT(x_of(strokes_[0]), ElementsAre(0, 1, 2));
  EXPECT_THAT(x_of(strokes_[1]), ElementsAre(2, 3, 4));
  EXPECT_THAT(x_of(strokes_[2]), ElementsAre(4, 5, 6));
  EXPECT_FALSE(strokes_[0].closed_by_lift);
  EXPECT_FALSE(strokes_[1].closed_by_lift);
  EXPECT_TRUE(strokes_[2].closed_by_lift);
}

TEST_F(StrokeSamplerTest, OneDeviceTooManyCutsTheOldestStroke) {
  StrokeSampler sampler({.max_open_strokes = 2});
  push(sampler, touching(1, 0, 1));
  push(sampler, touching(2, 1, 2));
  push(sampler, touching(3, 2, 3));
  ASSERT_EQ(strokes_.size(), 1U);
  EXPECT_EQ(strokes_[0].device, 1U);
  EXPECT_FALSE(strokes_[0].closed_by_lift);
  finish(sampler);
  EXPECT_EQ(strokes_.size(), 3U);
}

TEST_F(StrokeSamplerTest, AToolChangedInContactEndsAStrokeThatNeverLifted) {
  StrokeSampler sampler;
  push(sampler, touching(1));
  push(sampler, touching(2, 0, 0, Tool::kEraser));
  finish(sampler);
  ASSERT_EQ(strokes_.size(), 2U);
  EXPECT_FALSE(strokes_[0].closed_by_lift);
  EXPECT_EQ(strokes_[0].tool, Tool::kPen);
  EXPECT_EQ(strokes_[1].tool, Tool::kEraser);
}

TEST_F(StrokeSamplerTest, ResetForgetsOpenStrokes) {
  StrokeSampler sampler;
  push(sampler, touching(1));
  sampler.reset();
  finish(sampler);
  EXPECT_TRUE(strokes_.empty());
}

TEST(StrokeSampler, ASinkThatLeavesTheStrokeItsMemoryMakesLaterStrokesFree) {
  StrokeSampler sampler;
  std::size_t points = 0;
  const auto count = [&points](Stroke& stroke) { points += stroke.points.size(); };
  const auto draw = [&] {
    for (int i = 0; i < 500; ++i) sampler.push(touching(i, i), count);
    sampler.push(hovering(0, 500), count);
  };
  draw();
  test::AllocGuard guard;
  draw();
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_EQ(points, 1000U);
}

// The law: strokes hold each touching sample once, but for the shared points of cut ones.
TEST(StrokeSamplerProperty, EveryTouchingSampleIsInExactlyOneStroke) {
  test::for_all(100, [](test::Rng& rng) {
    const auto limit = static_cast<std::size_t>(rng.integer(2, 40));
    StrokeSampler sampler({.max_points = limit});
    std::size_t points = 0;
    std::size_t cuts = 0;
    bool last_was_cut = false;
    const auto sink = [&](Stroke& stroke) {
      ASSERT_FALSE(stroke.points.empty());
      ASSERT_LE(stroke.points.size(), limit);
      for (std::size_t i = 1; i < stroke.points.size(); ++i) {
        ASSERT_LE(stroke.points[i - 1].time, stroke.points[i].time);
      }
      points += stroke.points.size();
      last_was_cut = !stroke.closed_by_lift;
      cuts += last_was_cut ? 1 : 0;
    };
    std::size_t touched = 0;
    for (int i = 0; i < 500; ++i) {
      const bool down = rng.chance(0.9);
      touched += down ? 1 : 0;
      const int ms = static_cast<int>(rng.integer(0, 1000));
      sampler.push(down ? touching(i, ms) : hovering(i, ms), sink);
    }
    sampler.push(hovering(0, 1000), sink);
    EXPECT_EQ(points, touched + cuts);
    EXPECT_FALSE(last_was_cut);
  });
}

}  // namespace
}  // namespace limn
