// What holds of every drag: the way does not depend on when reports come, no step at any edge,
// rest is rest.

#include <gtest/gtest.h>

#include <functional>

#include "input/stroke/drag_velocity.hpp"
#include "tests/support/alloc_guard.hpp"
#include "tests/support/for_all.hpp"
#include "tests/support/motion_stream.hpp"

namespace limn {
namespace {

using namespace std::chrono_literals;
using test::Counts;
using test::for_all;
using test::motion_of;
using test::pushed;
using test::Rng;

using Step = std::function<Timestamp(Rng&)>;

/// The report intervals that real devices have, and one that nobody can foretell.
std::vector<Step> paces() {
  return {[](Rng&) { return 1ms; }, [](Rng&) { return 8ms; }, [](Rng&) { return 17ms; },
          [](Rng& rng) { return Timestamp(rng.integer(500'000, 25'000'000)); }};
}

constexpr Timestamp kBegin = 300ms;
constexpr Timestamp kLength = 1360ms;  // a whole number of all regular steps

/// How far x goes while it is held at `counts` from one report to another, as a whole kLength on.
double way_of_constant(int counts, const Step& step, Rng& rng) {
  DragVelocity drag;
  double mm = 0;
  const auto push = [&](Timestamp time, int held) { mm += drag.push(pushed(time, held)).mm[0]; };
  push(0ms, 0);
  Timestamp time = kBegin;
  for (; time < kBegin + kLength; time += step(rng)) push(time, counts);
  for (int zero = 0; zero < 3; ++zero) push(kBegin + kLength + zero * 8ms, 0);
  return mm;
}

TEST(DragLaws, AConstantDeflectionGoesTheSameWayAtAnyPace) {
  for_all(200, [](Rng& rng) {
    const int counts = static_cast<int>(rng.integer(1, 500)) * (rng.chance(0.5) ? 1 : -1);
    const double expected = 100.0 * counts / test::kFullCounts * to_seconds(kLength);
    for (const Step& step : paces()) {
      EXPECT_NEAR(way_of_constant(counts, step, rng) / expected, 1, 1e-6);
    }
  });
}

/// Of a movement with minimum jerk from 0 to 1 in unit time: its speed, 0 at both ends.
double speed(double t) { return t <= 0 || t >= 1 ? 0 : 30 * t * t * (1 - t) * (1 - t); }

TEST(DragLaws, ASmoothPushGoesTheSameWayAtAnyPace) {
  constexpr double kPeak = 1.875;  // of that speed
  for_all(200, [](Rng& rng) {
    const double most = rng.uniform(0.3, 1.2);
    const double seconds = rng.uniform(1, 2);
    for (const Step& step : paces()) {
      DragVelocity drag;
      double mm = 0;
      Timestamp time = 0ms;
      for (; to_seconds(time) < seconds + 0.2; time += step(rng)) {
        MotionSample sample = pushed(time, 0);
        sample.deflection[0] = most / kPeak * speed((to_seconds(time) - 0.1) / seconds);
        mm += drag.push(sample).mm[0];
      }
      EXPECT_NEAR(mm / (100 * most / kPeak * seconds), 1, 1e-3);
    }
  });
}

TEST(DragLaws, TheHalvesMayTakeTurns) {
  for_all(100, [](Rng& rng) {
    const double seconds = rng.uniform(1, 2);
    DragVelocity drag;
    std::array<double, 2> way{};
    bool turn = false;
    for (Timestamp time = 0ms; to_seconds(time) < seconds + 0.2; time += 8ms) {
      MotionSample sample = pushed(time, 0);
      const double held = 0.5 * speed((to_seconds(time) - 0.1) / seconds);
      sample.deflection = {held, 0, 0, 0, held, 0};
      sample.translation_told = !turn;
      sample.rotation_told = turn;
      turn = !turn;
      const Drag moved = drag.push(sample);
      way[0] += moved.mm[0];
      way[1] += moved.rad[1];
    }
    EXPECT_NEAR(way[0] / (50 * seconds), 1, 1e-3);
    EXPECT_NEAR(way[1] / (0.5 * seconds), 1, 1e-3);
  });
}

DragOptions random_options(Rng& rng) {
  DragOptions options;
  options.mm_per_s = rng.uniform(1, 500);
  options.rad_per_s = rng.uniform(0.1, 5);
  options.dead_zone = rng.chance(0.5) ? 0 : rng.uniform(0, 0.3);
  options.curve = rng.chance(0.5) ? 0 : rng.uniform(0, 1);
  for (double& factor : options.sensitivity) factor = rng.uniform(-2, 2);
  for (auto& axis : options.source) axis = static_cast<std::uint8_t>(rng.integer(0, 5));
  for (bool& inverted : options.inverted) inverted = rng.chance(0.5);
  return options;
}

/// Six axes that wander, through zero and through any dead zone, in small steps.
class Wander {
 public:
  explicit Wander(Rng& rng) : rng_(rng) {}
  std::array<double, kMotionAxes> next() {
    for (std::size_t i = 0; i < kMotionAxes; ++i) {
      speed_[i] = 0.9 * speed_[i] + 0.004 * rng_.normal();
      at_[i] = std::clamp(at_[i] + std::clamp(speed_[i], -kMostStep, kMostStep), -1.4, 1.4);
    }
    return at_;
  }
  static constexpr double kMostStep = 0.01;

 private:
  Rng& rng_;
  std::array<double, kMotionAxes> at_{};
  std::array<double, kMotionAxes> speed_{};
};

TEST(DragLaws, VelocityHasNoStepAndIsZeroAfterRelease) {
  constexpr double kMostNoise = 0.1;  // that RestTracker learns
  for_all(1000, [](Rng& rng) {
    const DragOptions options = random_options(rng);
    const bool known = rng.chance(0.5);  // that its rest is exact
    DragVelocity drag(options);
    Wander wander(rng);
    // The slope: the curve's 3 at 1.4 full deflections, what lies beyond the dead zone,
    // sensitivity.
    const double steepest =
        (1 + 2 * 1.4 * 1.4 * 1.5) / (1 - std::max(options.dead_zone, known ? 0 : kMostNoise)) * 2;
    Timestamp time = 0ms;
    Drag before = drag.push(pushed(time, 0, known));
    for (int i = 0; i < 300; ++i) {
      time += 8ms;
      MotionSample sample = pushed(time, 0, known);
      sample.deflection = wander.next();
      const Drag now = drag.push(sample);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_LE(std::abs(now.mm_per_s[axis] - before.mm_per_s[axis]),
                  steepest * options.mm_per_s * Wander::kMostStep);
        EXPECT_LE(std::abs(now.rad_per_s[axis] - before.rad_per_s[axis]),
                  steepest * options.rad_per_s * Wander::kMostStep);
      }
      before = now;
    }
    // Devices that tell the halves in turn need two reports to say that both are released.
    for (int report = 0; report < 2; ++report) {
      MotionSample sample = pushed(time += 8ms, 0, known);
      sample.translation_told = report == 0;
      sample.rotation_told = report == 1;
      before = drag.push(sample);
    }
    EXPECT_EQ(before.mm_per_s, (std::array<double, 3>{}));
    EXPECT_EQ(before.rad_per_s, (std::array<double, 3>{}));
    const Drag after = drag.push(pushed(time + 8ms, 0, known));
    EXPECT_EQ(after.mm, (std::array<double, 3>{}));
    EXPECT_EQ(after.rad, (std::array<double, 3>{}));
  });
}

TEST(DragLaws, NoisyRestDoesNotDriftInTenMinutes) {
  for_all(4, [](Rng& rng) {
    Counts bias{};
    for (int& count : bias) count = static_cast<int>(rng.integer(-8, 8));
    const double sigma = rng.uniform(0.2, 2);
    DragVelocity drag;
    for (Timestamp time = 0ms; time < 600s; time += 8ms) {
      Counts counts = bias;
      for (int& count : counts) count += static_cast<int>(std::lround(sigma * rng.normal()));
      const Drag moved = drag.push(motion_of(time, counts, false));
      ASSERT_EQ(moved.mm_per_s, (std::array<double, 3>{})) << to_seconds(time);
      ASSERT_EQ(moved.rad_per_s, (std::array<double, 3>{})) << to_seconds(time);
    }
    EXPECT_EQ(drag.rest().kind(), RestTracker::Kind::kNoisy);
    for (std::size_t axis = 0; axis < kMotionAxes; ++axis) {
      EXPECT_NEAR(drag.rest().bias(axis) * test::kFullCounts, bias[axis], 1);
    }
  });
}

TEST(DragLaws, ASampleAllocatesNothing) {
  Rng rng(1);
  DragVelocity drag(random_options(rng));
  Wander wander(rng);
  const test::AllocGuard guard;
  for (int i = 0; i < 1000; ++i) {
    MotionSample sample = pushed(i * 8ms, 0, false);
    sample.deflection = wander.next();
    drag.push(sample);
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace limn
