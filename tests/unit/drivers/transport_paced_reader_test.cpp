#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "drivers/devices/trace_decoder.hpp"
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

/// Samples of a recording, each with the time since the first at which it came out.
struct Out {
  PenSample sample;
  Timestamp at{};
};

std::vector<Out> samples_out(std::string_view recording, double speed) {
  CountingClock clock;
  TraceDecoder decoder(
      std::make_unique<PacedReader>(*open_trace(memory_bytes(recording)), speed, clock));
  std::vector<Out> out;
  for (;;) {
    const auto sample = decoder.next();
    EXPECT_TRUE(sample.has_value());
    if (!sample || *sample == nullptr) return out;
    out.push_back({**sample, clock.now() - 1h});
  }
}

// A New 1060 Plus, which never says that its pen leaves.
constexpr std::string_view kSilentLeaving =
    "I: 3 256c 006e\n"
    "E: 5.000000 12 08 80 10 27 10 27 00 00 00 00 00 00\n"
    "#limn lost 2\n"
    "E: 5.500000 12 08 80 20 27 10 27 00 00 00 00 00 00\n";

TEST(PacedReader, SilenceOfTheRecordingTakesASilentPenOutOfRangeInTime) {
  for (const double speed : {0.25, 1.0, 8.0}) {
    const auto out = samples_out(kSilentLeaving, speed);
    ASSERT_EQ(out.size(), 4u);
    const auto at = [speed](Timestamp recorded) {
      return Timestamp(static_cast<std::int64_t>(static_cast<double>(recorded.count()) / speed));
    };
    EXPECT_EQ(out[1].sample.state, PenState::kOutOfRange);
    EXPECT_EQ(out[1].sample.time, 100ms);
    EXPECT_EQ(out[1].at, at(100ms));
    EXPECT_EQ(out[2].sample.state, PenState::kInRange);
    EXPECT_EQ(out[2].sample.time, 500ms);
    EXPECT_EQ(out[2].at, at(500ms));
    EXPECT_EQ(out[3].sample.state, PenState::kOutOfRange) << "also at the end";
    EXPECT_EQ(out[3].sample.time, 600ms);
    EXPECT_EQ(out[3].at, at(600ms));
  }
}

TEST(PacedReader, SilenceIsThatOfTheRecordingHoweverLateItIsAsked) {
  CountingClock clock;
  PacedReader reader(*open_trace(memory_bytes("E: 1.0 1 01\nE: 1.010000 1 02\nE: 2.0 1 03\n")), 1,
                     clock);
  ASSERT_TRUE((*reader.next_until(1500ms)).has_value()) << "the description";
  ASSERT_TRUE((*reader.next_until(1500ms)).has_value());
  clock.pass(10s);
  EXPECT_TRUE((*reader.next_until(1500ms)).has_value()) << "an event from before the deadline";
  EXPECT_FALSE((*reader.next_until(1500ms)).has_value());
  EXPECT_FALSE((*reader.next_until(1900ms)).has_value());
  const auto held = *reader.next_until(2s);
  ASSERT_TRUE(held.has_value());
  EXPECT_EQ(std::get<Report>(*held).bytes[0], 3);
  EXPECT_FALSE((*reader.next_until(3s)).has_value()) << "nothing comes before 3 s, the end does";
  EXPECT_TRUE(std::holds_alternative<TraceEnd>(*reader.next()));
}

TEST(PacedReader, DevicesThatShareNoClockTellNoSilence) {
  // Device 1 counts from its own start: at once, device 0's pen never left before 5.020.
  constexpr std::string_view kTwoClocks =
      "D: 0\nI: 3 256c 006e\nD: 1\nI: 3 056a 0013\n"
      "D: 0\nE: 5.000000 12 08 80 10 27 10 27 00 00 00 00 00 00\n"
      "D: 1\nE: 0.000000 8 02 90 40 1f 20 03 00 00\n"
      "D: 0\nE: 5.010000 12 08 80 20 27 10 27 00 00 00 00 00 00\n"
      "D: 1\nE: 9.000000 8 02 90 41 1f 20 03 00 00\n"
      "D: 0\nE: 5.020000 12 08 80 30 27 10 27 00 00 00 00 00 00\n";
  std::vector<Timestamp> times;
  for (const Out& out : samples_out(kTwoClocks, 1)) {
    if (out.sample.device == 0) times.push_back(out.sample.time);
  }
  EXPECT_THAT(times, ElementsAre(0ms, 10ms, 20ms, 20ms + kLeavingTimeout));
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
