// `limn convert-trace`: what other programs recorded becomes files that `limn decode` reads.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "tests/cli/run_limn.hpp"
#include "tests/cli/sample_traces.hpp"
#include "tests/support/recordings.hpp"

namespace limn::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const std::string kMotion =
    "Timestamp,Tx,Ty,Tz,Rx,Ry,Rz\n"
    "2022-02-15 02:44:23.798001,25,-4,0,0,0,0\n"
    "2022-02-15 02:44:23.815810,216,-62,0,-19,-250,34\n";

const std::string kLibinput =
    "# libinput record\nversion: 1\nndevices: 1\ndevices:\n- node: /dev/input/event1\n  evdev:\n"
    "    name: \"Pen\"\n    id: [3, 1386, 828, 273]\n    absinfo:\n"
    "      0: [0, 15200, 4, 0, 100]\n      1: [0, 9500, 4, 0, 100]\n      24: [0, 2047, 0, 0, 0]\n"
    "  events:\n  - evdev:\n    - [5, 0, 1, 320, 1] # BTN_TOOL_PEN\n    - [5, 0, 3, 0, 1000]\n"
    "    - [5, 0, 3, 1, 2000]\n    - [5, 0, 0, 0, 0]\n";

TEST(ConvertTrace, WritesReportsWithTimesFromTheFirst) {
  const TempFolder folder;
  const std::string out = (folder.path() / "m.hid").string();
  const CommandRun run = run_limn({"convert-trace", "-", "-o", out}, kMotion);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "motion CSV to hid-recorder: 2 reports of 1 device in 0.0 s\n");
  EXPECT_THAT(names_in(folder), ElementsAre("m.hid"));
  const std::string text = read_file(out);
  EXPECT_THAT(text, HasSubstr("I: 3 256f c631\n"));
  EXPECT_THAT(text, HasSubstr("E: 0.000000 13 01 19 00 fc ff 00 00 00 00 00 00 00 00\n"
                              "E: 0.017809 13 01 d8 00 c2 ff 00 00 ed ff 06 ff 22 00\n"));
}

TEST(ConvertTrace, WhatTheKernelDecodedBecomesAnEvemuFileThatDecodes) {
  if (run_limn({"convert-trace", "-", "-o", "-"}, kLibinput).err.find("yaml-cpp") !=
      std::string::npos) {
    GTEST_SKIP() << "this limn was built without yaml-cpp";
  }
  const CommandRun run = run_limn({"convert-trace", "-", "-o", "-"}, kLibinput);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "libinput recording to evemu: 1 frame of 1 device in 0.0 s\n");
  EXPECT_THAT(run.out, StartsWith("# EVEMU 1.3\nN: Pen\n"));
  EXPECT_THAT(run.out, HasSubstr("E: 0.000000 0003 0001 2000\nE: 0.000000 0000 0000 0\n"));
  const CommandRun decoded = run_limn({"decode", "-", "--format", "csv"}, run.out);
  EXPECT_EQ(decoded.exit_code, 0) << decoded.err;
  EXPECT_THAT(decoded.out, HasSubstr("\n0,0,pen,in_range,10,20,"));
}

TEST(ConvertTrace, AnEvemuFileStaysOne) {
  const std::string head =
      "# EVEMU 1.3\nN: Pen\nI: 0003 056a 033c 0111\nB: 03 03 00 00 01 00 00 00 00\n"
      "A: 00 0 15200 4 0 100\nA: 01 0 9500 4 0 100\nA: 18 0 2047 0 0 0\n";
  std::string file = head;
  for (int i = 0; i < 5000; ++i) {  // more than is gathered before it is written
    char line[128];
    std::snprintf(line, sizeof line, "E: %d.500000 0003 0000 %d\nE: %d.500000 0000 0000 0\n", 3 + i,
                  i, 3 + i);
    file += line;
  }
  const CommandRun run = run_limn({"convert-trace", "-", "-o", "-"}, file);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "evemu to evemu: 5000 frames of 1 device in 4999.0 s\n");
  EXPECT_THAT(run.out, StartsWith("# EVEMU 1.3\nN: Pen\n"));
  EXPECT_THAT(run.out, HasSubstr("\nE: 0.000000 0003 0000 0\n"));
  EXPECT_THAT(run.out, testing::EndsWith("\nE: 4999.000000 0003 0000 4999\n"
                                         "E: 4999.000000 0000 0000 0\n"));
  const CommandRun silent = run_limn({"convert-trace", "-", "-o", "-"}, head);
  EXPECT_EQ(silent.exit_code, 0) << silent.err;
  EXPECT_THAT(silent.out, HasSubstr("A: 18 0 2047 0 0"));
}

TEST(ConvertTrace, KeepsWhatLimnReadsAlready) {
  const CommandRun run = run_limn({"convert-trace", "-", "-o", "-"}, small_pen_line());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const CommandRun before = run_limn({"decode", "-"}, small_pen_line());
  EXPECT_EQ(run_limn({"decode", "-"}, run.out).out, before.out);
}

TEST(ConvertTrace, SuppliedIdsGoIntoTheFileAndOneDeviceMayBeKept) {
  const std::string dump = "001:006:001:STREAM 1.0\n 07\n\n001:006:002:STREAM 1.5\n 09\n\n";
  const CommandRun run =
      run_limn({"convert-trace", "-", "-o", "-", "--id", "28bd:0905", "--device", "2"}, dump);
  EXPECT_EQ(run.out, "D: 2\nI: 3 28bd 0905\nE: 0.000000 1 09\n") << run.err;
  const CommandRun none = run_limn({"convert-trace", "-", "-o", "-", "--device", "3"}, dump);
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("has no device 3"));
}

TEST(ConvertTrace, DamageLeavesNoFileUnlessItIsSkipped) {
  const TempFolder folder;
  const std::string out = (folder.path() / "m.hid").string();
  const std::string damaged =
      kMotion + "2022-02-15 02:44:24,1,2\n2022-02-15 02:44:25,1,2,3,4,5,6\n";
  const CommandRun strict = run_limn({"convert-trace", "-", "-o", out}, damaged);
  EXPECT_EQ(strict.exit_code, 1);
  EXPECT_THAT(strict.err, HasSubstr("line 4: the row has too few cells"));
  EXPECT_THAT(names_in(folder), IsEmpty());
  const CommandRun salvaged = run_limn({"convert-trace", "-", "-o", out, "--salvage"}, damaged);
  EXPECT_EQ(salvaged.exit_code, 0) << salvaged.err;
  EXPECT_THAT(salvaged.err, HasSubstr("3 reports of 1 device in 1.2 s, 1 damaged part\n"));
  EXPECT_THAT(read_file(out), HasSubstr("#limn lost 1\n"));
}

TEST(ConvertTrace, NamesTheDeviceThatNothingExplains) {
  const std::string first = "D: 1\nI: 3 1234 5678\nE: 0.0 2 07 01\n";
  const std::string line =
      "device 1 (1234:5678) has no report descriptor in it: decode with --salvage, or give it with "
      "--descriptor";
  EXPECT_THAT(run_limn({"convert-trace", "-", "-o", "-"}, first).err, HasSubstr(line + "\n"));
  EXPECT_THAT(
      run_limn({"convert-trace", "-", "-o", "-"}, first + "D: 2\nI: 3 1234 5679\nE: 0.1 2 07 01\n")
          .err,
      HasSubstr(line + ", or convert another one with --device N\n"));
}

TEST(ConvertTrace, StrokesAreNoReports) {
  const CommandRun run = run_limn({"convert-trace", "-", "-o", "-"}, "t,x,y,p\n0,1,2,0.5\n");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("not a device's reports"));
}

TEST(ConvertTrace, TheCapturedTabletDecodes) {
  LIMN_NEEDS_RECORDINGS();
  const auto capture = shared_folder() / "traces/init-captures/huion_q11k.pcapng";
  const CommandRun run = run_limn({"convert-trace", capture.string(), "-o", "-"});
  if (run.err.find("libpcap") != std::string::npos) {
    GTEST_SKIP() << "this limn was built without libpcap";
  }
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "USB capture to hid-recorder: 763 reports of 1 device in 9.6 s\n");
  const CommandRun decoded = run_limn({"decode", "-", "--format", "csv"}, run.out);
  EXPECT_EQ(decoded.exit_code, 0) << decoded.err;
  EXPECT_EQ(decoded.err, "748 samples\n") << "by the parameters in the noted strings";
}

}  // namespace
}  // namespace limn::test
