#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "input/trace/format_detection.hpp"
#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

using testing::HasSubstr;

TEST(OpenTrace, NamesTheFormats) {
  EXPECT_EQ(name(TraceFormat::kHidRecorder), "hid-recorder");
  EXPECT_EQ(name(TraceFormat::kUsbhidDump), "usbhid-dump");
  EXPECT_EQ(name(TraceFormat::kEvemu), "evemu");
  EXPECT_EQ(name(TraceFormat::kStrokeCsv), "stroke CSV");
}

TEST(OpenTrace, TellsTheFormatFromOneLine) {
  using enum TraceFormat;
  EXPECT_EQ(format_of_line("D: 0"), kHidRecorder);
  EXPECT_EQ(format_of_line("D:12"), kHidRecorder);
  EXPECT_EQ(format_of_line("R: 3 05 0d c0"), kHidRecorder);
  EXPECT_EQ(format_of_line("I: 3 056a 0314"), kHidRecorder);
  EXPECT_EQ(format_of_line("E: 000000.000000 10 02 80 00 00"), kHidRecorder);
  EXPECT_EQ(format_of_line("E: 0.0 1 02"), kHidRecorder);
  EXPECT_EQ(format_of_line("#limn lost 4"), kHidRecorder);
  EXPECT_EQ(format_of_line("# EVEMU 1.0"), kEvemu);
  EXPECT_EQ(format_of_line("I: 0003 056a 0314 0100"), kEvemu);
  EXPECT_EQ(format_of_line("A: 00 0 100 0 0"), kEvemu);
  EXPECT_EQ(format_of_line("E: 1369413757.964832 0003 0000 23122\t# EV_ABS"), kEvemu);
  EXPECT_EQ(format_of_line("001:006:002:STREAM             1.0"), kUsbhidDump);
  EXPECT_EQ(format_of_line("001:006:002:DESCRIPTOR         1.0"), kUsbhidDump);
  EXPECT_EQ(format_of_line("000:STREAM                     1.0"), kUsbhidDump);
  EXPECT_EQ(format_of_line("t,x,y,p"), kStrokeCsv);
  EXPECT_EQ(format_of_line("0.0,1,2,0.5"), kStrokeCsv);
  EXPECT_EQ(format_of_line("0.0,1,2,0.5,60,30"), kStrokeCsv);
  for (const char* line : {"", "# comment", "N: name", "P: usb", "B: 00 0b 00", "x,y", "1,2,3",
                           "a,b,c,d", " 05 0D", "version: 1", "E: x", "Bus 001 Device 006"}) {
    EXPECT_EQ(format_of_line(line), std::nullopt) << line;
  }
}

TEST(OpenTrace, LooksPastWhatSeveralFormatsShare) {
  const std::string shared = "# comment\nN: name\nB: 00 1b\nP: 02 00\n";
  EXPECT_EQ(read_trace(shared + "E: 0.0 1 02\n").format, TraceFormat::kHidRecorder);
  EXPECT_EQ(read_trace(shared + "I: 0003 0001 0002 0003\n").format, TraceFormat::kEvemu);
  const std::string long_comments(100'000, '#');
  EXPECT_EQ(read_trace(long_comments + "\n" + long_comments + "\nD: 0\n").format,
            TraceFormat::kHidRecorder);
}

TEST(OpenTrace, AnEmptyFileIsAnError) {
  const Reading reading = read_trace("");
  EXPECT_EQ(reading.order, "!");
  EXPECT_EQ(reading.error.code, ErrorCode::kSyntax);
  EXPECT_EQ(at_and_what(reading.error), "byte 0: the file is empty");
  EXPECT_THAT(reading.error.remedy, HasSubstr("hid-recorder"));
}

TEST(OpenTrace, NothingButNulBytesIsAnError) {
  const Reading reading = salvage_trace(std::string(1'000'000, '\0'));
  EXPECT_EQ(reading.order, "!");
  EXPECT_EQ(at_and_what(reading.error), "byte 1000000: there is nothing but 1000000 NUL bytes");
}

TEST(OpenTrace, BinaryJunkIsAnErrorInOneLine) {
  std::mt19937 random(1);
  std::string junk;
  for (int i = 0; i < 1'000'000; ++i) junk += static_cast<char>(random());
  for (const Reading& reading : {read_trace(junk), salvage_trace(junk)}) {
    EXPECT_EQ(reading.order, "!");
    EXPECT_EQ(at_and_what(reading.error),
              "byte 0: this is no recording: neither hid-recorder, usbhid-dump, evemu nor stroke "
              "CSV");
  }
}

TEST(OpenTrace, JunkBehindAGoodStartIsDamage) {
  std::mt19937 random(2);
  std::string text = "R: 1 c0\nE: 0.0 1 01\n";
  for (int i = 0; i < 500'000; ++i) text += static_cast<char>(random());
  text += "\nE: 0.5 1 02\n";
  const Reading strict = read_trace(text);
  EXPECT_EQ(strict.order, "dr!");
  EXPECT_EQ(strict.error.what.find('\n'), std::string::npos);
  const Reading salvaged = salvage_trace(text);
  EXPECT_EQ(salvaged.order, "drxr.");
}

TEST(OpenTrace, AFailureToReadIsPassedOn) {
  class Failing final : public ByteSource {
   public:
    explicit Failing(std::string_view text) : rest_(text) {}
    Expected<std::size_t> read(std::span<char> out) override {
      if (rest_.empty()) return fail(ErrorCode::kIo, "", "the cable is out", "put it in");
      out[0] = rest_[0];
      rest_.remove_prefix(1);
      return std::size_t{1};
    }

   private:
    std::string_view rest_;
  };
  EXPECT_EQ(read_trace(std::make_unique<Failing>("")).error.what, "the cable is out");
  TraceOptions salvage;
  salvage.salvage = true;
  const Reading reading = read_trace(std::make_unique<Failing>("D: 0\nE: 0.0 1 01\nE: 0"), salvage);
  EXPECT_EQ(reading.order, "dr!") << "salvage is for damage, not for a broken source";
  EXPECT_EQ(reading.error.code, ErrorCode::kIo);
}

/// A pipe that still has a line to give must give it before its writer goes on.
TEST(OpenTrace, GivesAnEventAsSoonAsItsLineIsThere) {
  class Live final : public ByteSource {
   public:
    Expected<std::size_t> read(std::span<char> out) override {
      ++reads;
      const std::string_view line = reads == 1 ? "E: 0.0 1 01\n" : "E: 0.1 1 02\n";
      std::copy(line.begin(), line.end(), out.begin());
      return line.size();
    }
    int reads = 0;
  };
  auto owned = std::make_unique<Live>();
  const Live& live = *owned;
  auto reader = open_trace(std::move(owned));
  ASSERT_TRUE(reader);
  EXPECT_EQ(live.reads, 1);
  ASSERT_TRUE(std::holds_alternative<DeviceDescribed>(*(*reader)->next()));
  ASSERT_TRUE(std::holds_alternative<Report>(*(*reader)->next()));
  EXPECT_EQ(live.reads, 1);
  ASSERT_TRUE(std::holds_alternative<Report>(*(*reader)->next()));
  EXPECT_EQ(live.reads, 2);
}

}  // namespace
}  // namespace limn::test
