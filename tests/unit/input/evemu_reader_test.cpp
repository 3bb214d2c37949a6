#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

using testing::HasSubstr;

constexpr std::string_view kHeader =
    "# EVEMU 1.3\n"
    "# Kernel: 4.11\n"
    "N: Pen #2 of 3\n"
    "I: 0003 056a 0304 0090\n"
    "P: 02 00 00 00 00 00 00 00\n"
    "B: 00 1b 00 00 00 00 00 00 00\n"
    "A: 00 0 59552 4 0\n"
    "A: 1a -64 63 0 1 57 # tilt\n"
    "S: 01 1\n";

std::string with_header(std::string_view events) { return std::string(kHeader).append(events); }

TEST(EvemuReader, ReadsTheDescription) {
  const Reading reading = read_trace(kHeader);
  EXPECT_EQ(reading.format, TraceFormat::kEvemu);
  EXPECT_EQ(reading.order, "d.");
  const TraceDevice& device = reading.devices.at(0);
  EXPECT_EQ(device.index, 0U);
  EXPECT_EQ(device.name, "Pen #2 of 3");
  EXPECT_EQ(device.bus, 3);
  EXPECT_EQ(device.vendor, 0x056A);
  EXPECT_EQ(device.product, 0x0304);
  EXPECT_EQ(device.version, 0x0090);
  ASSERT_EQ(device.axes.size(), 2U);
  EXPECT_EQ(device.axes[0].code, 0);
  EXPECT_EQ(device.axes[0].maximum, 59552);
  EXPECT_EQ(device.axes[0].fuzz, 4);
  EXPECT_EQ(device.axes[0].resolution, 0);
  EXPECT_EQ(device.axes[1].code, 0x1A);
  EXPECT_EQ(device.axes[1].minimum, -64);
  EXPECT_EQ(device.axes[1].flat, 1);
  EXPECT_EQ(device.axes[1].resolution, 57);
}

TEST(EvemuReader, GivesAFrameForEachSynReport) {
  const Reading reading = read_trace(
      with_header("################################\n"
                  "E: 1369413757.964832 0003 0000 23122\t# EV_ABS / ABS_X                23122\n"
                  "E: 1369413757.964833 0003 001a -0012\n"
                  "E: 1369413757.964840 0000 0000 0000\t# ------------ SYN_REPORT (0) ----------\n"
                  "E: 1369413757.965000 0000 0000 1\n"
                  "E: 1369413757.966000 0000 0003 0\n"
                  "E: 1369413757.966000 0000 0000 0\n"));
  EXPECT_EQ(reading.order, "dfff.");
  ASSERT_EQ(reading.frames.size(), 3U);
  EXPECT_EQ(reading.frames[0].time_ns, 1'369'413'757'964'840'000) << "that of the SYN_REPORT";
  ASSERT_EQ(reading.frames[0].events.size(), 2U);
  EXPECT_EQ(reading.frames[0].events[0].time.count(), 1'369'413'757'964'832'000);
  EXPECT_EQ(reading.frames[0].events[0].type, 3);
  EXPECT_EQ(reading.frames[0].events[0].code, 0);
  EXPECT_EQ(reading.frames[0].events[0].value, 23122);
  EXPECT_EQ(reading.frames[0].events[1].code, 0x1A);
  EXPECT_EQ(reading.frames[0].events[1].value, -12);
  EXPECT_TRUE(reading.frames[1].events.empty());
  ASSERT_EQ(reading.frames[2].events.size(), 1U) << "SYN_DROPPED stays";
  EXPECT_EQ(reading.frames[2].events[0].type, 0);
  EXPECT_EQ(reading.frames[2].events[0].code, 3);
  EXPECT_EQ(reading.places[1], "line 13");
}

TEST(EvemuReader, NeedsNeitherVersionLineNorDescription) {
  const Reading reading = read_trace("E: 1.000000 0003 0000 5\nE: 1.000000 0000 0000 0\n");
  EXPECT_EQ(reading.format, TraceFormat::kEvemu);
  EXPECT_EQ(reading.order, "df.");
  EXPECT_EQ(read_trace("N: Pen\nI: 0003 04f3 000a 0000\nB: 00 0b\n").format, TraceFormat::kEvemu);
}

TEST(EvemuReader, ANameBeginsANewDescription) {
  const Reading reading =
      read_trace(with_header("E: 1.0 0000 0000 0\nN: other\nA: 01 0 9 0 0\nE: 1.0 0000 0000 0\n"));
  EXPECT_EQ(reading.order, "dfdf.");
  EXPECT_EQ(reading.devices[1].name, "other");
  EXPECT_EQ(reading.devices[1].vendor, 0);
  ASSERT_EQ(reading.devices[1].axes.size(), 1U);
  EXPECT_EQ(reading.devices[1].axes[0].code, 1);
}

TEST(EvemuReader, AnAxisGivenAgainReplacesTheFirst) {
  const Reading reading = read_trace(with_header("A: 00 -5 5 0 0\n"));
  ASSERT_EQ(reading.devices.at(0).axes.size(), 2U);
  EXPECT_EQ(reading.devices[0].axes[0].minimum, -5);
}

struct BadLine {
  const char* line;
  const char* what;
};

class EvemuBadLine : public testing::TestWithParam<BadLine> {};

TEST_P(EvemuBadLine, IsAnErrorAndSalvageSkipsItsWholeFrame) {
  const std::string text = with_header(
                               "E: 1.0 0003 0000 1\nE: 1.0 0000 0000 0\n"
                               "E: 1.1 0003 0000 2\n") +
                           GetParam().line +
                           "\nE: 1.1 0003 0001 3\nE: 1.1 0000 0000 0\n"
                           "E: 1.2 0003 0000 4\nE: 1.2 0000 0000 0\n";
  const Reading strict = read_trace(text);
  EXPECT_EQ(strict.order, "df!");
  EXPECT_EQ(strict.error.at, "line 13");
  EXPECT_THAT(strict.error.what, HasSubstr(GetParam().what));
  EXPECT_EQ(strict.error.remedy, "add --salvage to skip the damaged part");
  const Reading salvaged = salvage_trace(text);
  EXPECT_EQ(salvaged.order, "dfxf.");
  EXPECT_EQ(salvaged.damage[0].at, "line 13");
  EXPECT_EQ(salvaged.frames[1].time_ns, 1'200'000'000);
  ASSERT_EQ(salvaged.frames[1].events.size(), 1U);
  EXPECT_EQ(salvaged.frames[1].events[0].value, 4);
}

INSTANTIATE_TEST_SUITE_P(
    Each, EvemuBadLine,
    testing::Values(BadLine{"E: 1.1 0003 0000", "wants type, code and value"},
                    BadLine{"E: 1.1 0003", "wants type, code and value"},
                    BadLine{"E: 1.1 0003 0000 x", "wants type, code and value"},
                    BadLine{"E: 1.1 0003 10000 1", "wants type, code and value"},
                    BadLine{"E: 1.1 0003 0000 2147483648", "wants type, code and value"},
                    BadLine{"E: 1.1 0003 0000 1 2", "stands behind the value"},
                    BadLine{"E: x 0003 0000 1", "\"x\" is no time"},
                    BadLine{"E: 0.9 0003 0000 1", "the time 0.9 is before"},
                    BadLine{"0003 0000 1", "is no line of an evemu file"},
                    BadLine{"\x02\x03", "is no line of an evemu file"}));

TEST(EvemuReader, BadDescriptionLinesAreErrors) {
  for (const char* line : {"I: 0003 056a 0304", "I: 0003 056a 0304 x", "A: 40 0 1 0 0",
                           "A: xx 0 1 0 0", "A: 00 0 1 0", "A: 00 0 1 0 0 x"}) {
    const Reading strict = read_trace(with_header(std::string(line) + "\nE: 1.0 0000 0000 0\n"));
    EXPECT_EQ(strict.order, "!") << line;
    EXPECT_EQ(strict.error.at, "line 10") << line;
    EXPECT_EQ(salvage_trace(with_header(std::string(line) + "\nE: 1.0 0000 0000 0\n")).order,
              "xdf.")
        << line;
  }
}

TEST(EvemuReader, ALastLineOrFrameThatMayBeCutShortIsAnError) {
  for (const char* last : {"E: 1.1 0003 0000 2\n", "E: 1.1 0003 0000 2",
                           "E: 1.1 0003 0000 23\t# EV_A", "E: 1.1 00", "E", "A: 00 0 5"}) {
    const std::string text = with_header("E: 1.0 0000 0000 0\n") + last;
    const Reading strict = read_trace(text);
    EXPECT_EQ(strict.order, "df!") << last;
    EXPECT_THAT(strict.error.remedy, HasSubstr("add --salvage")) << last;
    EXPECT_EQ(salvage_trace(text).order, "dfx.") << last;
  }
  EXPECT_EQ(read_trace(with_header("E: 1.0 0000 0000 0")).order, "df.");
}

TEST(EvemuReader, AFrameIsLimited) {
  std::string frame;
  for (std::size_t i = 0; i < kMaxFrameEvents; ++i) frame += "E: 1.0 0003 0000 1\n";
  const Reading largest = read_trace(with_header(frame + "E: 1.0 0000 0000 0\n"));
  EXPECT_EQ(largest.frames.at(0).events.size(), kMaxFrameEvents);
  const std::string larger =
      with_header(frame + "E: 1.0 0003 0000 1\nE: 1.0 0000 0000 0\nE: 1.1 0000 0000 0\n");
  const Reading strict = read_trace(larger);
  EXPECT_EQ(strict.order, "!");
  EXPECT_EQ(strict.error.code, ErrorCode::kLimit);
  EXPECT_EQ(salvage_trace(larger).order, "xdf.");
}

TEST(EvemuReader, NulBytesBetweenFramesMayHideAFramesBeginning) {
  const std::string nuls(5, '\0');
  const Reading reading =
      salvage_trace(with_header("E: 1.0 0000 0000 0\n" + nuls +
                                "3 0000 1\nE: 1.1 0003 0001 1\n"
                                "E: 1.1 0000 0000 0\nE: 1.2 0003 0001 2\nE: 1.2 0000 0000 0\n"));
  EXPECT_EQ(reading.order, "dfxf.");
  EXPECT_EQ(reading.frames[1].time_ns, 1'200'000'000);
}

TEST(EvemuReader, SuppliedIdsServeWhereTheTraceHasNone) {
  TraceOptions options;
  options.supplied.vendor = 0x056A;
  options.supplied.product = 0x0304;
  const std::string frame = "E: 1.0 0003 0000 1\nE: 1.0 0000 0000 0\n";
  const Reading without = read_trace("# EVEMU 1.3\nN: pen\n" + frame, options);
  EXPECT_EQ(without.devices.at(0).vendor, 0x056A);
  EXPECT_EQ(without.devices.at(0).product, 0x0304);
  const Reading with = read_trace("# EVEMU 1.3\nI: 3 1234 5678 0\n" + frame, options);
  EXPECT_EQ(with.devices.at(0).vendor, 0x1234);
}

}  // namespace
}  // namespace limn::test
