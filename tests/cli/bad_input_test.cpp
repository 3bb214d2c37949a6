// Bad input gives one line on standard error that names the file, the place and what to do, exit
// status 1, and no output file, whole or partial.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/cli/run_limn.hpp"
#include "tests/cli/sample_traces.hpp"

namespace limn::test {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

/// `limn sketch` on `trace`: fails in one line about that file that holds `at` and `what`.
void expect_refused(const std::string& trace, const std::string& at, const std::string& what) {
  const TempFolder folder;
  const std::string path = folder.write("trace", trace);
  const CommandRun run =
      run_limn({"sketch", path, "-o", folder.path() / "out.svg", "-o", folder.path() / "out.json"});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_THAT(run.err, StartsWith("limn: " + path + ": " + at));
  EXPECT_THAT(run.err, HasSubstr(what));
  EXPECT_THAT(run.err, HasSubstr("; ")) << "no remedy";
  EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << "not one line: " << run.err;
  EXPECT_THAT(names_in(folder), ElementsAre("trace")) << "something was left behind";
}

TEST(BadInput, EmptyFile) { expect_refused("", "", "empty"); }

TEST(BadInput, BinaryJunk) {
  std::string junk;
  for (std::uint32_t i = 0, x = 12345; i < 4096; ++i) {
    x = x * 1664525 + 1013904223;
    junk += static_cast<char>(x >> 24);
  }
  expect_refused(junk, "", "no recording");
}

TEST(BadInput, NulBytesInUsbhidDump) {
  expect_refused(
      "001:002:000:STREAM             1.000000\n 01 00 00 00" + std::string(3, '\0') + "\n\n", "",
      "NUL");
}

TEST(BadInput, TruncatedLastLine) {
  expect_refused(small_pen_header() + "E: 0.000000 6 01 02 10 00 10 00\nE: 0.005000 6 01 02 1",
                 "line 5", "");
}

TEST(BadInput, LengthDisagreesWithBytes) {
  expect_refused(small_pen_header() + "E: 0.000000 7 01 02 10 00 10 00\n", "line 4", "7");
}

TEST(BadInput, TimeGoesBackwards) {
  expect_refused(
      small_pen_header() + "E: 1.000000 6 01 02 10 00 10 00\nE: 0.500000 6 01 02 10 00 10 00\n",
      "line 5", "time");
}

TEST(BadInput, ReportsWithoutDescriptor) {
  expect_refused("N: Nameless\nI: 3 1209 0001\nE: 0.000000 6 01 02 10 00 10 00\n", "line 3",
                 "descriptor");
}

TEST(BadInput, UnknownReportId) {
  expect_refused(small_pen_header() + "E: 0.000000 6 09 02 10 00 10 00\n", "line 4", "report ID");
}

TEST(BadInput, DescriptorOfAMillionCollections) {
  std::string descriptor = "R: 2000000";
  for (int i = 0; i < 1'000'000; ++i) descriptor += " a1 01";
  const TempFolder folder;
  const std::string path = folder.write("deep", descriptor + "\n");
  const CommandRun run = run_limn({"descriptor", path});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, StartsWith("limn: " + path + ": "));
  EXPECT_EQ(run.err.find('\n'), run.err.size() - 1);
}

TEST(BadInput, ReportSizeTimesCountOverflows) {
  const TempFolder folder;
  const std::string path = folder.write(
      "overflow.bin",
      {"\x05\x01\x09\x02\xa1\x01\x75\x20\x97\xff\xff\xff\x7f\x09\x30\x81\x02\xc0", 18});
  const CommandRun run = run_limn({"descriptor", path});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, StartsWith("limn: " + path + ": byte "));
  EXPECT_EQ(run.err.find('\n'), run.err.size() - 1);
}

TEST(BadInput, CollectionsNestedTooDeep) {
  std::string descriptor;
  for (int i = 0; i < 30'000; ++i) descriptor += "a1 01 ";
  const TempFolder folder;
  const std::string path = folder.write("deep.txt", descriptor);
  const CommandRun run = run_limn({"descriptor", path});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, StartsWith("limn: " + path + ": byte "));
  EXPECT_THAT(run.err, HasSubstr("collection"));
}

TEST(BadInput, PopWithoutPush) {
  const TempFolder folder;
  const std::string path = folder.write("pop.txt", "05 01 b4 09 02 a1 01 c0");
  const CommandRun run = run_limn({"descriptor", path});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, StartsWith("limn: " + path + ": byte 2: "));
}

TEST(BadInput, UnbalancedPushesAreTolerated) {  // real devices have them
  const TempFolder folder;
  const std::string path = folder.write(
      "push.txt", "a4 a4 a4 " + small_pen_header().substr(6, small_pen_header().find('\n') - 6));
  const CommandRun run = run_limn({"descriptor", path});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST(BadInput, PenThatNeverLiftsStillGivesItsStroke) {
  const TempFolder folder;
  const std::string path = folder.write(
      "trace",
      small_pen_header() + "E: 0.000000 6 01 03 10 00 10 00\nE: 0.005000 6 01 03 90 00 20 00\n");
  const CommandRun run = run_limn({"sketch", path, "--format", "csv"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("\n1,2,")) << "stroke 1 of 2 samples";
  EXPECT_THAT(run.err, HasSubstr("never lifts"));
}

TEST(BadInput, StrokeOfOneSampleIsADot) {
  const TempFolder folder;
  const std::string path = folder.write(
      "trace",
      small_pen_header() + "E: 0.000000 6 01 03 10 00 10 00\nE: 0.005000 6 01 02 10 00 10 00\n");
  const CommandRun run = run_limn({"sketch", path, "-o", "-"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("\"degree\":0"));
}

TEST(BadInput, OutputIntoAMissingFolder) {
  const TempFolder folder;
  const std::string trace = folder.write("trace", small_pen_header());
  const std::string out = folder.path() / "none/out.svg";
  const CommandRun run = run_limn({"sketch", trace, "-o", folder.path() / "good.json", "-o", out});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, StartsWith("limn: " + out + ": cannot create"));
  EXPECT_THAT(names_in(folder), ElementsAre("trace"));
}

TEST(BadInput, UnknownNamesOfferTheNearest) {
  const CommandRun drawing = run_limn({"simulate", "pen", "--drawing", "spirl", "-o", "/dev/null"});
  EXPECT_EQ(drawing.exit_code, 2);
  EXPECT_THAT(drawing.err, HasSubstr("did you mean spiral?"));
  const CommandRun device = run_limn({"simulate", "pencil", "-o", "/dev/null"});
  EXPECT_EQ(device.exit_code, 2);
  EXPECT_THAT(device.err, HasSubstr("pen"));
}

TEST(BadInput, WrongCommandLinesExitWithTwo) {
  const TempFolder folder;
  const std::string trace = folder.write("trace", small_pen_header());
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{},
        {"decode"},
        {"decode", trace, "--format", "yaml"},
        {"sketch", trace, "--tolerance", "0"},
        {"sketch", trace, "--tolerance", "-1"},
        {"sketch", trace, "--tolerance", "nan"},
        {"sketch", trace, "--tolerance", "0.1mm"},
        {"sketch", trace, "-o", "-", "--format", "csv"},
        {"decode", trace, "--format", "3"},
        {"decode", trace, "--id", "-1:2"},
        {"simulate", "pen", "--seed", "-1", "-o", "/dev/null"},
        {"simulate", "--list", "-o", folder.path() / "list"},
        {"sketch", trace, "-o", folder.path() / "out.doc"},
        {"sketch", trace, "-o", folder.path() / "a.svg", "-o", folder.path() / "a.svg"},
        {"decode", trace, "--id", "zz"},
        {"simulate", "pen"},
        {"nonsense"}}) {
    const CommandRun run = run_limn(arguments);
    EXPECT_EQ(run.exit_code, 2) << testing::PrintToString(arguments) << run.err;
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << run.err;
  }
  EXPECT_THAT(names_in(folder), ElementsAre("trace"));
}

}  // namespace
}  // namespace limn::test
