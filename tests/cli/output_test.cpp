// What -o and standard output leave behind when something ends the command early.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "tests/cli/run_limn.hpp"
#include "tests/cli/sample_traces.hpp"
#include "tests/support/recordings.hpp"

namespace limn::test {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

TEST(Output, DiskFull) {  // root ignores permissions, but not a full disk
  const CommandRun simulated = run_limn({"simulate", "pen", "-o", "/dev/full"});
  EXPECT_EQ(simulated.exit_code, 1);
  EXPECT_THAT(simulated.err,
              StartsWith("limn: /dev/full: cannot write: No space left on device; "));
}

TEST(Output, AFullDiskLeavesNoneOfSeveralFiles) {
  const TempFolder folder;
  const std::string trace = folder.write("trace", small_pen_header());
  const std::string full = folder.path() / "full.svg";
  std::filesystem::create_symlink("/dev/full", full);
  const CommandRun run = run_limn({"sketch", trace, "-o", folder.path() / "good.json", "-o", full});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("limn: " + full + ": cannot write: No space left on device; "));
  EXPECT_THAT(names_in(folder), ElementsAre("full.svg", "trace"));
}

TEST(Output, AFullDiskUnderStandardOutputIsAnError) {
  const CommandRun run = run_shell("\"$0\" simulate --list >/dev/full");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, StartsWith("limn: standard output: cannot write: No space left"));
}

TEST(Output, ALimitOfFileSizesIsToldAsAFullDiskIs) {
  const std::string told =
      ": cannot write: File too large; raise the limit of file sizes (ulimit -f) or choose another "
      "disk\n";
  const TempFolder folder;
  ASSERT_EQ(run_limn({"simulate", "pen", "-o", folder.path() / "trace"}).exit_code, 0);
  const std::string limited = "cd '" + folder.path().string() + "' && ulimit -f 1 && \"$0\" ";
  for (const std::string output : {"out.svg", "out.pdf", "out.png", "out.step", "out.json"}) {
    const CommandRun run = run_shell(limited + "sketch trace -o " + output);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, EndsWith("limn: " + output + told));
    EXPECT_THAT(names_in(folder), ElementsAre("trace"));
  }
  const CommandRun simulated = run_shell(limited + "simulate pen -o out.hid");
  EXPECT_EQ(simulated.exit_code, 1);
  EXPECT_EQ(simulated.err, "limn: out.hid" + told);
  const CommandRun decoded = run_shell(limited + "decode trace");
  EXPECT_EQ(decoded.exit_code, 1);
  EXPECT_EQ(decoded.err, "limn: standard output" + told);
  EXPECT_THAT(names_in(folder), ElementsAre("trace"));
}

TEST(Output, ADeviceStaysADevice) {
  const TempFolder folder;
  const std::string trace = folder.write("trace", small_pen_header());
  EXPECT_EQ(run_limn({"simulate", "pen", "-o", "/dev/null"}).exit_code, 0);
  EXPECT_EQ(run_limn({"sketch", trace, "-o", "/dev/null"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(Output, ALinkStaysALink) {
  const TempFolder folder;
  const std::string trace = folder.write("trace", small_pen_header());
  for (const bool dangling : {true, false}) {
    if (!dangling) folder.write("there.json", "old");
    std::filesystem::remove(folder.path() / "link.json");
    std::filesystem::create_symlink("there.json", folder.path() / "link.json");
    EXPECT_EQ(run_limn({"sketch", trace, "-o", folder.path() / "link.json"}).exit_code, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link.json"));
    EXPECT_THAT(read_file(folder.path() / "there.json"), HasSubstr("\"strokes\""));
    EXPECT_THAT(names_in(folder), ElementsAre("link.json", "there.json", "trace"));
    std::filesystem::remove(folder.path() / "there.json");
  }
}

TEST(Output, ASignalLeavesNothing) {
  const TempFolder folder;
  const CommandRun run = run_shell("cd '" + folder.path().string() +
                                   "' && mkfifo in && { \"$0\" sketch in -o out.svg & }\n"
                                   "until ls out.svg.* >/dev/null 2>&1; do sleep 0.01; done\n"
                                   "kill -TERM $!\n"
                                   "wait $!");
  EXPECT_EQ(run.exit_code, 128 + SIGTERM);
  EXPECT_THAT(names_in(folder), ElementsAre("in"));
}

TEST(Output, AClosedPipeLeavesNothing) {
  const TempFolder folder;
  // The reader of the pipe has gone before the trace comes.
  const CommandRun run = run_shell("cd '" + folder.path().string() +
                                   "' && \"$0\" simulate pen --drawing star -o trace &&"
                                   "{ (sleep 0.2; cat trace) | \"$0\" decode - ; echo $? >status; }"
                                   " | true\n"
                                   "{ (sleep 0.2; cat trace) | \"$0\" sketch - -o out.svg -o -; }"
                                   " | true");
  EXPECT_THAT(run.out, IsEmpty());
  EXPECT_EQ(read_file(folder.path() / "status"), std::to_string(128 + SIGPIPE) + "\n");
  EXPECT_THAT(names_in(folder), ElementsAre("status", "trace"));
}

}  // namespace
}  // namespace limn::test
