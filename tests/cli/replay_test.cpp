// `limn replay`: what `limn decode` prints, at the recording's pace.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "tests/cli/run_limn.hpp"
#include "tests/cli/sample_traces.hpp"

namespace limn::test {
namespace {

using testing::HasSubstr;

TEST(Replay, PrintsWhatDecodePrints) {
  for (const char* format : {"text", "json", "jsonl", "csv"}) {
    const CommandRun decoded = run_limn({"decode", "-", "--format", format}, small_pen_line());
    const CommandRun replayed =
        run_limn({"replay", "-", "--speed", "100", "--format", format}, small_pen_line());
    ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
    EXPECT_EQ(replayed.out, decoded.out);
    EXPECT_EQ(replayed.err, decoded.err);
  }
}

TEST(Replay, TakesAsLongAsTheRecordingDid) {
  const auto begin = std::chrono::steady_clock::now();
  const CommandRun run = run_limn({"replay", "-", "--speed", "0.5"}, small_pen_line());
  EXPECT_EQ(run.exit_code, 0) << run.err;
  // 75 ms at half the speed; a lower bound only, for machines may be slow but not early.
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(150));
}

TEST(Replay, GivesEachSampleBeforeWaitingForTheNext) {
  // The second sample is an hour away when the command is ended.
  const CommandRun run = run_shell("printf '%s\\n' '" + small_pen_header() +
                                   "E: 0.0 6 01 03 64 00 c8 00' 'E: 3600.0 6 01 03 64 00 c8 00' | "
                                   "timeout 2 \"$0\" replay - --format jsonl");
  EXPECT_THAT(run.out, HasSubstr("\"state\":\"in_contact\""));
}

TEST(Replay, RefusesSpeedsThatAreNone) {
  for (const char* speed : {"0", "-1", "inf", "nan", "fast", ""}) {
    const CommandRun run = run_limn({"replay", "-", "--speed", speed});
    EXPECT_EQ(run.exit_code, 2) << speed;
    EXPECT_THAT(run.err, HasSubstr("is no factor above 0, such as 2"));
  }
}

TEST(Replay, TellsDamageAsDecodeDoes) {
  const std::string torn = small_pen_line() + "E: 5.080000 6 01 00";
  const CommandRun decoded = run_limn({"decode", "-"}, torn);
  const CommandRun replayed = run_limn({"replay", "-", "--speed", "100"}, torn);
  EXPECT_EQ(replayed.exit_code, 1);
  EXPECT_EQ(replayed.err, decoded.err);
  EXPECT_EQ(replayed.out, decoded.out);
}

}  // namespace
}  // namespace limn::test
