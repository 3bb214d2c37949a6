#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "drivers/transport/paced_reader.hpp"

namespace limn::test {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

/// Time that passes only by being waited for.
class CountingClock final : public WaitingClock {
 public:
  Timestamp now() noexcept override { return now_; }
  void wait_until(Timestamp time) noexcept override { now_ = std::max(now_, time); }
  void pass(Timestamp time) { now_ += time; }

 private:
  Timestamp now_ = 1h;
};

/// When each report of a recording came out, since the first.
std::vector<Timestamp> times_out(std::string_view recording, double speed) {
  CountingClock clock;
  PacedReader reader(*open_trace(memory_bytes(recording)), speed, clock);
  std::vector<Timestamp> out;
  for (;;) {
    const auto event = reader.next();
    EXPECT_TRUE(event.has_value());
    if (!event || std::holds_alternative<TraceEnd>(*event)) return out;
    if (std::holds_alternative<Report>(*event)) out.push_back(clock.now() - 1h);
  }
}

constexpr std::string_view kThree = "E: 7.000000 1 01\nE: 7.004000 1 02\nE: 3607.004000 1 03\n";

TEST(PacedReader, HoldsReportsBackAndKeepsGaps) {
  EXPECT_THAT(times_out(kThree, 1), ElementsAre(0ms, 4ms, 3600s + 4ms));
}

TEST(PacedReader, DividesBySpeed) {
  EXPECT_THAT(times_out(kThree, 4), ElementsAre(0ms, 1ms, 900s + 1ms));
  EXPECT_THAT(times_out(kThree, 0.5), ElementsAre(0ms, 8ms, 7200s + 8ms));
}

TEST(PacedReader, TimesOfOtherClocksAndEnormousGapsDoNoHarm) {
  EXPECT_THAT(times_out("D: 0\nE: 7.0 1 01\nD: 1\nE: 0.0 1 02\nE: 8.0 1 02\n", 1),
              ElementsAre(0ms, 0ms, 1s));
  const auto times = times_out("E: 0.0 1 01\nE: 9000000000.0 1 02\n", 1e-6);
  ASSERT_EQ(times.size(), 2u);
  EXPECT_GT(times[1], 24h * 365);
}

TEST(PacedReader, KeepsTheScheduleAfterADelay) {
  CountingClock clock;
  PacedReader reader(*open_trace(memory_bytes("E: 0.0 1 01\nE: 0.010000 1 02\nE: 0.030000 1 03\n")),
                     1, clock);
  while (!std::holds_alternative<Report>(*reader.next())) {
  }
  clock.pass(15ms);
  ASSERT_TRUE(reader.next().has_value());
  EXPECT_EQ(clock.now() - 1h, 15ms);
  EXPECT_EQ(reader.lateness(), 5ms);
  ASSERT_TRUE(reader.next().has_value());
  EXPECT_EQ(clock.now() - 1h, 30ms) << "late once, not for ever";
  EXPECT_EQ(reader.lateness(), 0ms);
}

TEST(PacedReader, PassesErrorsOn) {
  CountingClock clock;
  PacedReader reader(*open_trace(memory_bytes("E: 0.0 1 01\nE: 0.0 2 02\n")), 1, clock);
  Expected<TraceEvent> event = reader.next();
  while (event && !std::holds_alternative<TraceEnd>(*event)) event = reader.next();
  ASSERT_FALSE(event.has_value());
  EXPECT_EQ(event.error().at, "line 2");
}

TEST(MonotonicClock, WaitsNoShorterThanAsked) {
  WaitingClock& clock = monotonic_clock();
  const Timestamp until = clock.now() + 2ms;
  clock.wait_until(until);
  EXPECT_GE(clock.now(), until);
  clock.wait_until(until);  // past: at once
}

}  // namespace
}  // namespace limn::test
