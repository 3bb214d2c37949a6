#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "input/trace_import/trace_import.hpp"
#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

using testing::HasSubstr;

const std::string kHeader = "Timestamp,Tx,Ty,Tz,Rx,Ry,Rz\n";

Reading read(const std::string& text, TraceOptions options = {}) {
  return read_whole(open_import(memory_bytes(text), std::move(options)));
}

TEST(MotionCsvReader, MakesTheReportOfEachRow) {
  const Reading reading = read(kHeader +
                               "2022-02-15 02:44:23.798001,25,-4,0,0,300,-32768\n"
                               "2022-02-15 02:44:24,0,0,0,0,0,0\r\n");
  EXPECT_EQ(reading.format, TraceFormat::kMotionCsv);
  EXPECT_EQ(reading.order, "drr.");
  EXPECT_EQ(reading.devices.at(0).vendor, 0x256F);
  EXPECT_EQ(reading.devices.at(0).product, 0xC631);
  EXPECT_EQ(reading.devices.at(0).report_descriptor.size(), 46U);
  EXPECT_EQ(reading.reports.at(0),
            (ReadReport{0,
                        1'644'893'063'798'001'000,
                        {1, 25, 0, 0xFC, 0xFF, 0, 0, 0, 0, 0x2C, 0x01, 0x00, 0x80}}));
  EXPECT_EQ(reading.reports.at(1).time_ns, 1'644'893'064'000'000'000);
}

TEST(MotionCsvReader, SuppliedIdsAndDescriptorComeFirst) {
  TraceOptions options;
  options.supplied = {{0xC0}, 0x046D, 0xC62B};
  const Reading reading = read(kHeader, options);
  EXPECT_EQ(reading.order, "d.");
  EXPECT_EQ(reading.devices.at(0).product, 0xC62B);
  EXPECT_TRUE(reading.devices.at(0).name.empty());
  EXPECT_EQ(reading.devices.at(0).report_descriptor, (std::vector<std::uint8_t>{0xC0}));
}

TEST(MotionCsvReader, DaysOfLeapYearsAreRight) {
  EXPECT_EQ(read("2024-02-29 00:00:00,0,0,0,0,0,0\n").reports.at(0).time_ns,
            1'709'164'800'000'000'000);
  EXPECT_EQ(read("1970-01-01 00:00:00,0,0,0,0,0,0\n").reports.at(0).time_ns, 0);
}

struct BadRow {
  std::string row;
  std::string what;
};

class MotionCsvDamage : public testing::TestWithParam<BadRow> {};

TEST_P(MotionCsvDamage, IsAnErrorOrSkipped) {
  const std::string good = "2022-02-15 02:44:23.5,1,2,3,4,5,6\n";
  const std::string text = kHeader + good + GetParam().row + good;
  const Reading strict = read(text);
  EXPECT_EQ(strict.order, "dr!");
  EXPECT_EQ(strict.error.at, "line 3");
  EXPECT_THAT(strict.error.what, HasSubstr(GetParam().what));
  TraceOptions options;
  options.salvage = true;
  EXPECT_EQ(read(text, options).order, "drxr.");
}

INSTANTIATE_TEST_SUITE_P(
    Rows, MotionCsvDamage,
    testing::Values(BadRow{"2022-02-15 02:44:23.6,1,2,3,4,5\n", "too few cells"},
                    BadRow{"2022-02-15 02:44:23.6,1,2,3,4,5,6,7\n", "\"7\""},
                    BadRow{"2022-02-15 02:44:23.6,1,2,3,4,5,40000\n", "\"40000\""},
                    BadRow{"2022-13-15 02:44:23.6,1,2,3,4,5,6\n", "\"2022-13-15"},
                    BadRow{"2022-02-15 24:44:23.6,1,2,3,4,5,6\n", "neither a time"},
                    BadRow{"2022-02-15 02:44:22,1,2,3,4,5,6\n", "before that of the row"}));

TEST(MotionCsvReader, ATornLastRowIsDamage) {
  EXPECT_EQ(read(kHeader + "2022-02-15 02:44:23.5,1,2,3,4,5,6").order, "!");
}

TEST(OpenImport, ReadsWhatOpenTraceDoes) {
  EXPECT_EQ(read("R: 1 c0\nE: 0.0 1 01\n").format, TraceFormat::kHidRecorder);
  EXPECT_EQ(read("001:006:002:STREAM 1.0\n 09\n\n").format, TraceFormat::kUsbhidDump);
  EXPECT_EQ(read("t,x,y,p\n0.0,1,2,0.5\n").format, TraceFormat::kStrokeCsv);
}

TEST(OpenImport, NamesWhatItReadsWhereItIsNoRecording) {
  for (const char* text : {"", "version: x\n", "hello\n", "a,b,c\n"}) {
    const Reading reading = read(text);
    EXPECT_EQ(reading.order, "!") << text;
    EXPECT_EQ(reading.error.code, ErrorCode::kSyntax) << text;
    EXPECT_THAT(reading.error.remedy, HasSubstr("pcapng")) << text;
  }
}

TEST(OpenImport, TellsFormatsFromBytesThatDribbleIn) {
  const std::string csv = kHeader + "2022-02-15 02:44:23,1,2,3,4,5,6\n";
  EXPECT_EQ(read_whole(open_import(dribble_bytes(csv, 5))).order, "dr.");
}

}  // namespace
}  // namespace limn::test
