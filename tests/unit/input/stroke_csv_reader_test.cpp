#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

using testing::HasSubstr;

TEST(StrokeCsvReader, ReadsPlainRows) {
  const Reading reading = read_trace("t,x,y,p\n0.000000,163.935,3.655,0.01953\n0.0053,-1,2e1,1\n");
  EXPECT_EQ(reading.format, TraceFormat::kStrokeCsv);
  EXPECT_EQ(reading.order, "ss.");
  const PenSample& first = reading.samples.at(0);
  EXPECT_EQ(first.time.count(), 0);
  EXPECT_EQ(first.device, 0U);
  EXPECT_EQ(first.tool, Tool::kPen);
  EXPECT_EQ(first.state, PenState::kInContact);
  EXPECT_EQ(first.x_mm, 163.935);
  EXPECT_EQ(first.y_mm, 3.655);
  EXPECT_EQ(first.pressure, 0.01953);
  EXPECT_TRUE(first.axes.has_position());
  EXPECT_TRUE(first.axes.has(PenAxis::kPressure));
  for (const PenAxis axis :
       {PenAxis::kTiltX, PenAxis::kTiltY, PenAxis::kTwist, PenAxis::kDistance, PenAxis::kSerial}) {
    EXPECT_FALSE(first.axes.has(axis));
  }
  const PenSample& second = reading.samples.at(1);
  EXPECT_EQ(second.time.count(), 5'300'000);
  EXPECT_EQ(second.x_mm, -1);
  EXPECT_EQ(second.y_mm, 20);
  EXPECT_EQ(second.pressure, 1);
  EXPECT_EQ(reading.places[1], "line 3");
}

TEST(StrokeCsvReader, TurnsAltitudeAndAzimuthIntoTilt) {
  const Reading reading = read_trace("t,x,y,p,alt,az\n0,1,2,0.5,45.0,90.0\n0,1,2,0.5,91.0,0\n");
  ASSERT_EQ(reading.samples.size(), 2U);
  EXPECT_TRUE(reading.samples[0].axes.has(PenAxis::kTiltX));
  EXPECT_TRUE(reading.samples[0].axes.has(PenAxis::kTiltY));
  EXPECT_EQ(reading.samples[0].tilt_x_rad, 0);
  EXPECT_DOUBLE_EQ(reading.samples[0].tilt_y_rad, std::numbers::pi / 4);
  EXPECT_EQ(reading.samples[1].tilt_x_rad, 0) << "above upright is upright";
  EXPECT_EQ(reading.samples[1].tilt_y_rad, 0);
}

TEST(StrokeCsvReader, TheHeaderIsOptionalAndBlanksCommentsAndMarksAreAllowed) {
  EXPECT_EQ(read_trace("0,1,2,0.5\n1,1,2,0.5\n").order, "ss.");
  EXPECT_EQ(read_trace("0,1,2,0.5,60,30\r\n1,1,2,0.5,60,30\r\n").order, "ss.");
  EXPECT_EQ(read_trace("\xEF\xBB\xBFt, x, y, p\n\n# comment\n 0 , 1 ,\t2 , 0.5\n").order, "s.");
  EXPECT_EQ(read_trace("t,x,y,p\n").order, ".");
}

TEST(StrokeCsvReader, TakesTimesInAnyNotation) {
  const Reading reading = read_trace("-1.5,0,0,0\n-2e-9,0,0,0\n5e-05,0,0,0\n0.1234567891,0,0,0\n");
  ASSERT_EQ(reading.samples.size(), 4U);
  EXPECT_EQ(reading.samples[0].time.count(), -1'500'000'000);
  EXPECT_EQ(reading.samples[1].time.count(), -2);
  EXPECT_EQ(reading.samples[2].time.count(), 50'000);
  EXPECT_EQ(reading.samples[3].time.count(), 123'456'789);
}

struct BadRow {
  const char* row;
  ErrorCode code;
  const char* what;
};

class StrokeCsvBadRow : public testing::TestWithParam<BadRow> {};

TEST_P(StrokeCsvBadRow, IsAnErrorWithPlaceAndRemedyOrIsSkipped) {
  const std::string text =
      std::string("t,x,y,p,alt,az\n1,0,0,0.5,60,30\n") + GetParam().row + "\n1.5,0,0,0.5,60,30\n";
  const Reading strict = read_trace(text);
  EXPECT_EQ(strict.order, "s!");
  EXPECT_EQ(strict.error.code, GetParam().code);
  EXPECT_EQ(strict.error.at, "line 3");
  EXPECT_THAT(strict.error.what, HasSubstr(GetParam().what));
  EXPECT_EQ(strict.error.remedy, "add --salvage to skip the damaged part");
  EXPECT_EQ(salvage_trace(text).order, "sxs.");
}

INSTANTIATE_TEST_SUITE_P(
    Each, StrokeCsvBadRow,
    testing::Values(
        BadRow{"1.2,0,0,0.5", ErrorCode::kPointCount, "4 columns where 6 are expected"},
        BadRow{"1.2,0,0,0.5,60,30,9", ErrorCode::kPointCount, "7 columns where 6"},
        BadRow{"x,0,0,0.5,60,30", ErrorCode::kSyntax, "\"x\" is no time"},
        BadRow{"nan,0,0,0.5,60,30", ErrorCode::kSyntax, "is no time"},
        BadRow{"1e300,0,0,0.5,60,30", ErrorCode::kSyntax, "is no time"},
        BadRow{",0,0,0.5,60,30", ErrorCode::kSyntax, "is no time"},
        BadRow{"1.2,,0,0.5,60,30", ErrorCode::kSyntax, "\"\" is no number"},
        BadRow{"1.2,0,1 2,0.5,60,30", ErrorCode::kSyntax, "is no number"},
        BadRow{"1.2,inf,0,0.5,60,30", ErrorCode::kOutOfRange, "x is \"inf\", not within 1e6 mm"},
        BadRow{"1.2,0,nan,0.5,60,30", ErrorCode::kOutOfRange, "y is \"nan\""},
        BadRow{"1.2,0,0,812,60,30", ErrorCode::kOutOfRange, "p is \"812\", not from 0 to 1"},
        BadRow{"1.2,0,0,-0.1,60,30", ErrorCode::kOutOfRange, "p is \"-0.1\""},
        BadRow{"1.2,0,0,0.5,nan,30", ErrorCode::kOutOfRange, "alt is \"nan\""},
        BadRow{"1.2,0,0,0.5,60,1e9", ErrorCode::kOutOfRange, "az is \"1e9\""},
        BadRow{"0.9,0,0,0.5,60,30", ErrorCode::kOutOfRange, "the time \"0.9\" is before"}));

TEST(StrokeCsvReader, OtherColumnsAreAnError) {
  const Reading reading = read_trace("t,x,y,pressure\n0,1,2,0.5\n");
  EXPECT_EQ(reading.order, "!");
  EXPECT_EQ(at_and_what(reading.error),
            "line 1: the columns are \"t,x,y,pressure\" where t,x,y,p or t,x,y,p,alt,az are "
            "expected");
}

TEST(StrokeCsvReader, ALastRowWithoutALineEndMustNotLackTheDecimalsThatAllRowsHave) {
  std::string rows = "t,x,y,p\n";
  for (int i = 0; i < 64; ++i) rows += "0.1,1.0,2.0,0.51\n";
  const std::string order(64, 's');
  EXPECT_EQ(read_trace(rows + "0.2,1.0,2.0,0.52").order, order + "s.");
  const Reading cut = read_trace(rows + "0.2,1.0,2.0,0.5");
  EXPECT_EQ(cut.order, order + "!");
  EXPECT_EQ(cut.error.at, "line 66");
  EXPECT_EQ(salvage_trace(rows + "0.2,1.0,2.0,0.5").order, order + "x.");
  EXPECT_EQ(read_trace(rows + "0.1,1.0,2.0,0.5\n0.2,1.0,2.0,0.5").order, order + "ss.");
}

TEST(StrokeCsvReader, ALastRowWithoutALineEndIsWholeIfItsColumnsAre) {
  const std::string rows = "t,x,y,p\n0.0,1.0,2.0,0.5\n0.1,1.0,2.0,0.55\n";
  EXPECT_EQ(read_trace(rows + "0.2,1.0,2.0,1").order, "sss.");
  EXPECT_EQ(read_trace(rows + "0.2,1.0,2.0,").order, "ss!");
  EXPECT_EQ(read_trace(rows + "0.2,1.0").order, "ss!");
  EXPECT_EQ(read_trace("0,1,2,0\n1,1,2,1").order, "ss.");
}

}  // namespace
}  // namespace limn::test
