#include "firmware_sim/devices/report_clock.hpp"

#include <gtest/gtest.h>

namespace limn::firmware {
namespace {

using namespace std::chrono_literals;

TEST(ReportClock, TicksAtMultiplesOfItsPeriodFromTheFirstQuestionOn) {
  ReportClock clock(5ms);
  EXPECT_EQ(clock.take(12ms), 10ms) << "not what was before the host asked";
  EXPECT_EQ(clock.take(12ms), std::nullopt);
  EXPECT_EQ(clock.take(14999us), std::nullopt);
  EXPECT_EQ(clock.take(26ms), 15ms);
  EXPECT_EQ(clock.take(26ms), 20ms);
  EXPECT_EQ(clock.take(26ms), 25ms);
  EXPECT_EQ(clock.take(26ms), std::nullopt);
}

TEST(ReportClock, OfManyThatWaitTheOldestAreLost) {
  ReportClock clock(1ms);
  EXPECT_EQ(clock.take(0ms), 0ms);
  int given = 0;
  auto first = 0us;
  while (const auto time = clock.take(1s)) {
    if (given++ == 0) first = *time;
  }
  EXPECT_EQ(given, ReportClock::kMostWaiting);
  EXPECT_EQ(first, 1s - (ReportClock::kMostWaiting - 1) * 1ms);
}

TEST(ReportClock, SwitchedOnAgainItForgetsWhatWaited) {
  ReportClock clock(1ms);
  EXPECT_EQ(clock.take(0ms), 0ms);
  clock.restart();
  EXPECT_EQ(clock.take(50ms), 50ms);
  EXPECT_EQ(clock.take(50ms), std::nullopt);
}

}  // namespace
}  // namespace limn::firmware
