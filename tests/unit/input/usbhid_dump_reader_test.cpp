#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

constexpr std::string_view kDump =
    "Starting dumping interrupt transfer stream\n"
    "with 1 minute timeout.\n"
    "\n"
    "001:006:002:DESCRIPTOR         1568360146.932711\n"
    " 06 0A FF 09 01 A1 01 85 09 09 02 75 08 95 08 15\n"
    " 00 C0\n"
    "\n"
    "001:006:002:STREAM             1568360147.000001\n"
    " 09 80 86\n"
    "\n"
    "001:006:000:STREAM             1568360147.000001\n"
    " 00 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 0F\n"
    " 10\n"
    "\n"
    "006:002:000:Interrupt transfer timed out\n"
    "No more interfaces to dump\n";

TEST(UsbhidDumpReader, ReadsDescriptorsAndReports) {
  const Reading reading = read_trace(kDump);
  EXPECT_EQ(reading.format, TraceFormat::kUsbhidDump);
  EXPECT_EQ(reading.order, "drdr.");
  ASSERT_EQ(reading.devices.size(), 2U);
  EXPECT_EQ(reading.devices[0].index, 2U);
  EXPECT_EQ(reading.devices[0].bus, 3);
  EXPECT_EQ(reading.devices[0].report_descriptor,
            (Bytes{0x06, 0x0A, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x85, 0x09, 0x09, 0x02, 0x75, 0x08,
                   0x95, 0x08, 0x15, 0x00, 0xC0}));
  EXPECT_EQ(reading.devices[1].index, 0U);
  EXPECT_TRUE(reading.devices[1].report_descriptor.empty());
  ASSERT_EQ(reading.reports.size(), 2U);
  EXPECT_EQ(reading.reports[0], (ReadReport{2, 1'568'360'147'000'001'000, {0x09, 0x80, 0x86}}));
  EXPECT_EQ(reading.reports[1].device, 0U);
  EXPECT_EQ(reading.reports[1].bytes.size(), 17U);
  EXPECT_EQ(reading.reports[1].bytes[16], 0x10);
  EXPECT_THAT(reading.places, ElementsAre("line 4", "line 8", "line 11", "line 11"));
}

TEST(UsbhidDumpReader, GivesTheSameInPiecesOfAnySize) {
  for (const std::size_t longest : {1U, 2U, 31U}) {
    const Reading pieces = read_trace(dribble_bytes(kDump, longest));
    EXPECT_EQ(pieces.order, "drdr.");
    EXPECT_EQ(pieces.reports, read_trace(kDump).reports);
  }
}

TEST(UsbhidDumpReader, NeedsNoBlankLinesBetweenRecords) {
  const Reading reading = read_trace(
      "002:004:000:STREAM             1.0\n 01\n002:004:000:STREAM             1.5\n 02 03\n");
  EXPECT_EQ(reading.order, "drr.");
  EXPECT_THAT(reading.reports,
              ElementsAre(ReadReport{0, 1'000'000'000, {1}}, ReadReport{0, 1'500'000'000, {2, 3}}));
  EXPECT_THAT(reading.places, ElementsAre("line 1", "line 1", "line 3"));
}

TEST(UsbhidDumpReader, ReadsTheFormWithoutBusAndDevice) {
  const Reading reading =
      read_trace("001:STREAM                     1282391779.587446\n 01 02\n\n");
  EXPECT_EQ(reading.order, "dr.");
  EXPECT_EQ(reading.reports[0], (ReadReport{1, 1'282'391'779'587'446'000, {1, 2}}));
}

TEST(UsbhidDumpReader, ReadsIndentedHeadersAndCarriageReturns) {
  const Reading reading = read_trace(" 001:005:003:DESCRIPTOR         1.0\r\n 06 0A\r\n\r\n");
  EXPECT_EQ(reading.order, "d.");
  EXPECT_EQ(reading.devices[0].report_descriptor, (Bytes{0x06, 0x0A}));
}

TEST(UsbhidDumpReader, AReplugIsADifferentDevice) {
  const Reading reading = read_trace(
      "001:006:001:STREAM 1.0\n 01\n\n001:007:001:STREAM 1.1\n 02\n\n001:006:001:STREAM 1.2\n "
      "03\n\n"
      "002:006:000:STREAM 1.3\n 04\n\n");
  EXPECT_EQ(reading.order, "drdrrdr.");
  ASSERT_EQ(reading.reports.size(), 4U);
  EXPECT_EQ(reading.reports[0].device, 1U);
  EXPECT_EQ(reading.reports[1].device, 256U + 1U);
  EXPECT_EQ(reading.reports[2].device, 1U);
  EXPECT_EQ(reading.reports[3].device, 512U);
}

TEST(UsbhidDumpReader, CompletesADescriptionWithWhatIsSupplied) {
  TraceOptions options;
  options.supplied = {{0x05, 0x0D}, 0x28BD, 0x0905};
  const Reading reading = read_trace(kDump, options);
  ASSERT_EQ(reading.devices.size(), 2U);
  EXPECT_EQ(reading.devices[0].report_descriptor.size(), 18U) << "the trace's own stands";
  EXPECT_EQ(reading.devices[1].report_descriptor, (Bytes{0x05, 0x0D}));
  EXPECT_EQ(reading.devices[1].vendor, 0x28BD);
  EXPECT_EQ(reading.devices[1].product, 0x0905);
}

TEST(UsbhidDumpReader, AnEmptyRecordIsAnEmptyReport) {
  const Reading reading = read_trace("001:006:001:STREAM 1.0\n\n001:006:001:STREAM 1.1\n 02\n\n");
  EXPECT_EQ(reading.order, "drr.");
  EXPECT_TRUE(reading.reports[0].bytes.empty());
}

struct BadPart {
  const char* part;
  const char* at;
  const char* what;
};

class UsbhidDumpBadPart : public testing::TestWithParam<BadPart> {};

TEST_P(UsbhidDumpBadPart, IsAnErrorWithPlaceAndRemedyOrIsSkipped) {
  const std::string text = "001:006:001:STREAM 1.0\n 01\n\n" + std::string(GetParam().part) +
                           "\n001:006:001:STREAM 2.0\n 02\n\n";
  const Reading strict = read_trace(text);
  EXPECT_EQ(strict.order, "dr!");
  EXPECT_EQ(strict.error.at, GetParam().at);
  EXPECT_THAT(strict.error.what, HasSubstr(GetParam().what));
  EXPECT_EQ(strict.error.remedy, "add --salvage to skip the damaged part");
  const Reading salvaged = salvage_trace(text);
  EXPECT_EQ(salvaged.order, "drxr.");
  EXPECT_EQ(salvaged.damage[0].at, GetParam().at);
  EXPECT_EQ(salvaged.reports[1].bytes, Bytes{2});
}

INSTANTIATE_TEST_SUITE_P(
    Each, UsbhidDumpBadPart,
    testing::Values(
        BadPart{" 07 08\n", "line 4", "\"07 08\" belongs to no record"},
        BadPart{"001:006:001:STREAM 1.5\n 01 0\n 02\n", "line 5", "\"0\" is no two-digit byte"},
        BadPart{"001:006:001:STREAM 1.5\n 01 GG\n\n", "line 5", "\"GG\" is no two-digit byte"},
        BadPart{"001:006:001:STREAM 1.5\n 0 1 2 3 4 5\n", "line 5", "is no two-digit byte"},
        BadPart{"001:006:001:STREAM 1.5\n 00 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 0F 10\n",
                "line 5", "17 bytes in a line that holds at most 16"},
        BadPart{"001:006:001:STREAM\n 01\n", "line 4", "no time follows STREAM"},
        BadPart{"001:006:001:STREAM 1.\n 01\n", "line 4", "no time follows STREAM"},
        BadPart{"001:006:001:STREAM 1.5 x\n 01\n", "line 4", "no time follows STREAM"},
        BadPart{"001:006:001:STREAM 0.9\n 01\n", "line 4", "the time 0.9 is before"},
        BadPart{"001:006:001:STR\n 01\n", "line 4", "neither STREAM nor DESCRIPTOR"},
        BadPart{"001:006:\n 01\n", "line 4", "is no record's first line"},
        BadPart{"001:006:256:STREAM 1.5\n 01\n", "line 4", "is no record's first line"},
        BadPart{":001:STREAM 1.5\n 01\n", "line 4", "is no record's first line"}));

TEST(UsbhidDumpReader, ARecordWithoutBytesOrBlankLineIsDamage) {
  const std::string text =
      "001:006:001:STREAM 1.0\n001:006:001:STREAM 1.1\n 02\n\n001:006:001:STREAM 1.2\n 03\n\n";
  const Reading strict = read_trace(text);
  EXPECT_EQ(strict.order, "!");
  EXPECT_EQ(strict.error.at, "line 2");
  EXPECT_EQ(salvage_trace(text).order, "xdr.");
}

TEST(UsbhidDumpReader, TimesMayStepBackBetweenInterfacesOnly) {
  EXPECT_EQ(read_trace("1:1:0:STREAM 5.0\n 01\n\n1:1:1:STREAM 4.0\n 02\n\n").order, "drdr.");
}

TEST(UsbhidDumpReader, DamageAtTheStartHidesNeitherFormatNorTheRest) {
  for (const std::size_t nuls : {1U, 65536U, 700'000U}) {
    const std::string text = std::string(nuls, '\0') +
                             ":001:STREAM             1.0\n 07 A1\n\n"
                             "001:011:001:STREAM             1.1\n 07 A2\n\n";
    const Reading strict = read_trace(text);
    EXPECT_EQ(strict.format, TraceFormat::kUsbhidDump);
    EXPECT_EQ(strict.order, "!");
    EXPECT_EQ(strict.error.at, "byte 0");
    EXPECT_THAT(strict.error.what, HasSubstr("NUL byte"));
    const Reading salvaged = salvage_trace(text);
    EXPECT_EQ(salvaged.order, "xdr.");
    EXPECT_THAT(salvaged.damage[0].what, HasSubstr("(2 lines skipped)"));
    EXPECT_EQ(salvaged.reports[0].bytes, (Bytes{0x07, 0xA2}));
  }
}

TEST(UsbhidDumpReader, ALastRecordThatMayBeCutShortIsAnError) {
  const std::string whole = "001:006:001:STREAM 1.0\n 01\n\n";
  for (const char* last :
       {"001:006:001:STREAM 1.5\n 00 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 0F\n",
        "001:006:001:STREAM 1.5\n 01 02", "001:006:001:STREAM 1.5\n 01 0",
        "001:006:001:STREAM 1.5\n", "001:006:001:STREAM 1.5", "001:006:0", "00",
        "001:006:001:DESCRIPTOR 1.5\n"}) {
    const Reading strict = read_trace(whole + last);
    EXPECT_EQ(strict.order, "dr!") << last;
    EXPECT_THAT(strict.error.remedy, HasSubstr("add --salvage")) << last;
    EXPECT_EQ(salvage_trace(whole + last).order, "drx.") << last;
  }
  EXPECT_EQ(read_trace(whole + "001:006:001:STREAM 1.5\n 01 02\n").order, "drr.");
  EXPECT_EQ(read_trace(whole + "001:006:001:DESCRIPTOR 1.5\n"
                               " 00 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 0F\n")
                .order,
            "drd.");
}

TEST(UsbhidDumpReader, ReportsAndDevicesAreLimited) {
  std::string row;
  for (int i = 0; i < 16; ++i) row += " 5A";
  row += '\n';
  std::string text = "001:006:001:STREAM 1.0\n";
  for (std::size_t i = 0; i < kMaxReportBytes / 16; ++i) text += row;
  const Reading largest = read_trace(text + "\n");
  EXPECT_EQ(largest.order, "dr.");
  EXPECT_EQ(largest.reports[0].bytes.size(), kMaxReportBytes);
  const Reading larger = read_trace(text + " 00\n\n");
  EXPECT_EQ(larger.order, "!");
  EXPECT_EQ(larger.error.code, ErrorCode::kLimit);
  EXPECT_THAT(larger.error.what, HasSubstr("more than 16384 bytes"));

  std::string many;
  for (std::size_t i = 0; i <= kMaxTraceDevices; ++i) {
    many += "001:" + std::to_string(i) + ":000:STREAM 1.0\n 01\n\n";
  }
  const Reading devices = read_trace(many);
  EXPECT_EQ(devices.reports.size(), kMaxTraceDevices);
  EXPECT_EQ(devices.error.code, ErrorCode::kLimit);
}

}  // namespace
}  // namespace limn::test
