#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

constexpr std::string_view kTwoDevices =
    "# a comment\n"
    "D: 0\n"
    "R: 4 05 0d 09 02\n"
    "N: A pen # 1\n"
    "P: usb-0000:00:14.0-1/input0\n"
    "I: 3 056a 0314\n"
    "D:7\n"
    "R: 2 A1 01\n"
    "D: 0\n"
    "E: 000000.000001 3 02 FF 00\n"
    "D:7\n"
    "E: 0.000001 1 09\n"
    "D:0\n"
    "E: 1.5 0\n";

TEST(HidRecorderReader, ReadsDevicesAndReports) {
  const Reading reading = read_trace(kTwoDevices);
  EXPECT_EQ(reading.format, TraceFormat::kHidRecorder);
  EXPECT_EQ(reading.order, "ddrrr.");
  ASSERT_EQ(reading.devices.size(), 2U);
  EXPECT_EQ(reading.devices[0].index, 0U);
  EXPECT_EQ(reading.devices[0].report_descriptor, (Bytes{0x05, 0x0D, 0x09, 0x02}));
  EXPECT_EQ(reading.devices[0].name, "A pen # 1");
  EXPECT_EQ(reading.devices[0].physical_path, "usb-0000:00:14.0-1/input0");
  EXPECT_EQ(reading.devices[0].bus, 3);
  EXPECT_EQ(reading.devices[0].vendor, 0x056A);
  EXPECT_EQ(reading.devices[0].product, 0x0314);
  EXPECT_EQ(reading.devices[1].index, 7U);
  EXPECT_EQ(reading.devices[1].report_descriptor, (Bytes{0xA1, 0x01}));
  EXPECT_THAT(reading.reports,
              ElementsAre(ReadReport{0, 1000, {0x02, 0xFF, 0x00}}, ReadReport{7, 1000, {0x09}},
                          ReadReport{0, 1'500'000'000, {}}));
  EXPECT_EQ(reading.places.back(), "line 14");
}

TEST(HidRecorderReader, GivesTheSameInPiecesOfAnySize) {
  const Reading whole = read_trace(kTwoDevices);
  for (const std::size_t longest : {1U, 3U, 17U}) {
    const Reading pieces = read_trace(dribble_bytes(kTwoDevices, longest));
    EXPECT_EQ(pieces.order, whole.order);
    EXPECT_EQ(pieces.reports, whole.reports);
    EXPECT_EQ(pieces.places, whole.places);
  }
}

TEST(HidRecorderReader, TakesCarriageReturnsAndAMissingLastLineEnd) {
  const Reading reading = read_trace("R: 1 c0\r\nN: Pen\r\nE: 0.0 2 01 02\r\nE: 0.1 1 03");
  EXPECT_EQ(reading.order, "drr.");
  EXPECT_EQ(reading.devices[0].name, "Pen");
  EXPECT_EQ(reading.reports[1].bytes, Bytes{3});
}

TEST(HidRecorderReader, PassesOverOtherPrefixesPromptsAndComments) {
  const Reading reading = read_trace(
      "Please follow these 3 steps:\n"
      "R: 1 c0\nB: 01 02\nLED: 1\n   - move your two fingers\n\n \t\n"
      "#limnology is no note\nE: 0.0 1 01\n# Thank you.");
  EXPECT_EQ(reading.order, "dr.");
}

TEST(HidRecorderReader, GivesNotes) {
  const Reading reading =
      read_trace("#limn lost 3\nE: 0.0 1 01\n#limn   unplugged, spaces kept\n#limn\nE: 0.1 1 02\n");
  EXPECT_EQ(reading.order, "ndrnnr.");
  EXPECT_THAT(reading.notes, ElementsAre("lost 3", "  unplugged, spaces kept", ""));
}

TEST(HidRecorderReader, GivesANoteBehindTheDescriptionAboveIt) {
  EXPECT_EQ(read_trace("N: a\n#limn string 201\nE: 0.0 1 01\n").order, "dnr.");
  EXPECT_EQ(read_trace("N: a\nE: 0.0 1 01\nN: b\n#limn string 201\nE: 0.1 1 01\n").order, "drdnr.");
}

TEST(HidRecorderReader, DescribesADeviceAgainWhenTheTraceDoes) {
  const Reading reading =
      read_trace("R: 1 c0\nI: 3 1 2\nE: 0.0 1 01\nE: 0.1 1 02\nR: 2 a1 01\nE: 0.2 1 03\n");
  EXPECT_EQ(reading.order, "drrdr.");
  EXPECT_EQ(reading.devices[0].report_descriptor, Bytes{0xC0});
  EXPECT_EQ(reading.devices[1].report_descriptor, (Bytes{0xA1, 0x01}));
  EXPECT_EQ(reading.devices[1].product, 2) << "what is not described anew stays";
}

TEST(HidRecorderReader, DescribesDevicesThatNeverReport) {
  const Reading reading = read_trace("D: 1\nR: 1 c0\nD: 2\nN: two\n");
  EXPECT_EQ(reading.order, "dd.");
  EXPECT_EQ(reading.devices[0].index, 1U);
  EXPECT_EQ(reading.devices[1].index, 2U);
}

TEST(HidRecorderReader, DeliversReportsThatNothingDescribes) {
  const Reading reading = read_trace("D: 3\nE: 0.0 1 01\n");
  EXPECT_EQ(reading.order, "dr.");
  EXPECT_EQ(reading.devices[0].index, 3U);
  EXPECT_TRUE(reading.devices[0].report_descriptor.empty());
}

TEST(HidRecorderReader, CompletesADescriptionWithWhatIsSupplied) {
  TraceOptions options;
  options.supplied = {{0x05, 0x0D}, 0x28BD, 0x0905};
  const Reading reading =
      read_trace("N: first\nE: 0.0 1 01\nD: 1\nR: 1 c0\nI: 5 1 0\nE: 0.0 1 01\n", options);
  ASSERT_EQ(reading.devices.size(), 2U);
  EXPECT_EQ(reading.devices[0].name, "first");
  EXPECT_EQ(reading.devices[0].report_descriptor, (Bytes{0x05, 0x0D}));
  EXPECT_EQ(reading.devices[0].vendor, 0x28BD);
  EXPECT_EQ(reading.devices[0].product, 0x0905);
  EXPECT_EQ(reading.devices[1].report_descriptor, Bytes{0xC0});
  EXPECT_EQ(reading.devices[1].vendor, 1);
  EXPECT_EQ(reading.devices[1].product, 0);
}

TEST(HidRecorderReader, TimesMayStepBackBetweenDevicesOnly) {
  const Reading apart =
      read_trace("D: 0\nE: 5.0 1 01\nD: 1\nE: 1.0 1 02\nD: 0\nE: 5.0 1 03\nD: 1\nE: 1.5 1 04\n");
  EXPECT_EQ(apart.order, "drdrrr.");
  const Reading back = read_trace("D: 0\nE: 5.0 1 01\nE: 4.999999 1 02\n");
  EXPECT_EQ(back.order, "dr!");
  EXPECT_EQ(back.error.code, ErrorCode::kOutOfRange);
  EXPECT_EQ(at_and_what(back.error),
            "line 3: the time 4.999999 is before that of the report before it");
}

struct BadLine {
  const char* line;
  const char* what;
};

class HidRecorderBadLine : public testing::TestWithParam<BadLine> {};

TEST_P(HidRecorderBadLine, IsAnErrorWithPlaceAndRemedyOrIsSkipped) {
  const std::string before = "D: 0\nR: 1 c0\nE: 0.0 1 01\n";
  const std::string after = "D: 0\nE: 0.1 1 02\n";
  const Reading strict = read_trace(before + GetParam().line + "\n" + after);
  EXPECT_EQ(strict.order, "dr!");
  EXPECT_EQ(strict.error.at, "line 4");
  EXPECT_THAT(strict.error.what, HasSubstr(GetParam().what));
  EXPECT_EQ(strict.error.remedy, "add --salvage to skip the damaged part");
  const Reading salvaged = salvage_trace(before + GetParam().line + "\n" + after);
  EXPECT_EQ(salvaged.order, "drxr.");
  ASSERT_EQ(salvaged.damage.size(), 1U);
  EXPECT_EQ(salvaged.damage[0].at, "line 4");
  EXPECT_EQ(salvaged.damage[0].what, strict.error.what + " (1 line skipped)");
  EXPECT_EQ(salvaged.places[2], "line 4");
  EXPECT_EQ(salvaged.places[3], "line 6");
}

INSTANTIATE_TEST_SUITE_P(
    Each, HidRecorderBadLine,
    testing::Values(
        BadLine{"E: 0.1 3 01 02", "the length says 3 bytes but 2 follow"},
        BadLine{"E: 0.1 1 01 02", "the length says 1 byte but 2 follow"},
        BadLine{"E: 0.1 2 01 0x", "\"0x\" is no two-digit byte"},
        BadLine{"E: 0.1 2 01 2", "\"2\" is no two-digit byte"},
        BadLine{"E: 0.1", "\"\" is no length"}, BadLine{"E: 0.1 -1", "\"-1\" is no length"},
        BadLine{"E: 0.1 16385 01", "at most 16384 bytes"},
        BadLine{"E: 0.1 99999999999 01", "is no length"}, BadLine{"E:", "\"\" is no time"},
        BadLine{"E: 1:5 1 01", "\"1:5\" is no time"}, BadLine{"E: -1.0 1 01", "is no time"},
        BadLine{"R: 70000 c0", "at most 65535 bytes"},
        BadLine{"R: 2 c0", "the length says 2 bytes but 1 follow"},
        BadLine{"D: x", "is no device number"}, BadLine{"D: 4294967296", "is no device number"},
        BadLine{"I: 3 056a", "three hexadecimal numbers"},
        BadLine{"I: 3 056a 12345", "three hexadecimal numbers"},
        BadLine{"02 ff 00", "is no line of a hid-recorder file"},
        BadLine{"\x01\x02\xFF", "is no line of a hid-recorder file"},
        BadLine{"5: 1", "is no prefix of a hid-recorder line"}));

TEST(HidRecorderReader, NulBytesAreDamageAtTheirByte) {
  std::string text = "R: 1 c0\nE: 0.0 1 01\nE: 0.1 1 ";
  text += std::string(3, '\0') + "02\nE: 0.2 1 03\n";
  const Reading strict = read_trace(text);
  EXPECT_EQ(strict.order, "dr!");
  EXPECT_EQ(at_and_what(strict.error), "byte 29: 3 NUL bytes in the text");
  EXPECT_EQ(salvage_trace(text).order, "drxr.");
}

TEST(HidRecorderReader, AnEndlessLineIsDamage) {
  const std::string text = "R: 1 c0\n# " + std::string(kMaxLineBytes, 'x') + "\nE: 0.2 1 03\n";
  const Reading strict = read_trace(text);
  EXPECT_EQ(strict.order, "!");
  EXPECT_EQ(strict.error.code, ErrorCode::kLimit);
  EXPECT_EQ(at_and_what(strict.error), "line 2: the line is longer than 262144 bytes");
  EXPECT_EQ(salvage_trace(text).order, "xdr.");
}

TEST(HidRecorderReader, ALastLineThatMayBeCutShortIsAnError) {
  for (const char* last : {"D: 1", "N: Pe", "P: usb-0000:0", "I: 3 056a 31", "#limn lost 1", "B: 0",
                           "E: 0.1 2 01", "E: 0.1 2 01 0", "E: 0.1 1", "E: 0.", "E", "R: 2 c0"}) {
    const Reading reading = read_trace(std::string("R: 1 c0\nE: 0.0 1 01\n") + last);
    EXPECT_EQ(reading.order, "dr!") << last;
    EXPECT_EQ(reading.error.at, "line 3") << last;
    EXPECT_THAT(reading.error.remedy, HasSubstr("add --salvage")) << last;
    EXPECT_EQ(salvage_trace(std::string("R: 1 c0\nE: 0.0 1 01\n") + last).order, "drx.") << last;
  }
  EXPECT_EQ(read_trace("E: 0.0 1 01\n# cut comm").order, "dr.");
  EXPECT_EQ(read_trace("E: 0.0 1 01\nI: 3 056a 0314").order, "drd.");
}

TEST(HidRecorderReader, NeighbouringDamageIsOneEvent) {
  const Reading reading = salvage_trace(
      "E: 0.0 1 01\nE: 0.1 2 01\n# comment\nE: 0.1 x\nE: 0.1 1 02\nE: 0.0 1 01\nE: 0.2 1 03\n");
  EXPECT_EQ(reading.order, "drxrxr.");
  EXPECT_EQ(at_and_what(reading.damage[0]),
            "line 2: the length says 2 bytes but 1 follow (2 lines skipped)");
  EXPECT_EQ(reading.damage[1].at, "line 6");
}

TEST(HidRecorderReader, SalvageKeepsTimesInOrder) {
  const Reading reading =
      salvage_trace("E: 5.0 1 01\nE: 1.0 1 02\nE: 4.9 1 03\nE: 5.0 1 04\nE: 6.0 1 05\n");
  EXPECT_EQ(reading.order, "drxrr.");
  EXPECT_EQ(reading.reports[1].bytes, Bytes{4});
}

TEST(HidRecorderReader, SalvageNeverGivesAReportToTheWrongDevice) {
  const std::string two = "D: 0\nE: 0.0 1 01\nD: 1\nE: 0.0 1 02\n";
  // The damage may have held a "D: 0".
  const Reading torn = salvage_trace(two + "\x01\nE: 0.1 1 03\nR: 1 c0\nD: 0\nE: 0.2 1 04\n");
  EXPECT_EQ(torn.order, "drdrxr.");
  EXPECT_EQ(torn.reports[2], (ReadReport{0, 200'000'000, {4}}));
  EXPECT_THAT(torn.damage[0].what, HasSubstr("(3 lines skipped)"));
  // A report's own line cannot.
  const Reading report = salvage_trace(two + "E: 0.1 2 03\nE: 0.2 1 04\n");
  EXPECT_EQ(report.order, "drdrxr.");
  EXPECT_EQ(report.reports[2].device, 1U);
}

TEST(HidRecorderReader, AnErrorIsGivenForEver) {
  auto reader = open_trace(memory_bytes("E: 0.0 1 01\nE: x\nE: 0.1 1 01\n"));
  ASSERT_TRUE(reader);
  ASSERT_TRUE((*reader)->next());
  ASSERT_TRUE((*reader)->next());
  const auto first = (*reader)->next();
  const auto second = (*reader)->next();
  ASSERT_FALSE(first);
  ASSERT_FALSE(second);
  EXPECT_EQ(first.error().what, second.error().what);
}

TEST(HidRecorderReader, TheEndIsGivenForEver) {
  auto reader = open_trace(memory_bytes("R: 1 c0\n"));
  ASSERT_TRUE(reader);
  ASSERT_TRUE(std::holds_alternative<DeviceDescribed>(*(*reader)->next()));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(std::holds_alternative<TraceEnd>(*(*reader)->next()));
}

TEST(HidRecorderReader, DevicesNamesAndSizesAreLimited) {
  std::string many;
  for (std::size_t i = 0; i <= kMaxTraceDevices; ++i) many += "D: " + std::to_string(i) + "\n";
  const Reading devices = read_trace(many);
  EXPECT_EQ(devices.order, std::string(kMaxTraceDevices, 'd') + "!");
  EXPECT_EQ(at_and_what(devices.error), "line 65: more than 64 devices");
  EXPECT_EQ(devices.error.code, ErrorCode::kLimit);

  const Reading name =
      read_trace("R: 1 c0\nN: " + std::string(kMaxDeviceTextBytes + 1, 'n') + "\n");
  EXPECT_EQ(at_and_what(name.error), "line 2: a device name of 1025 bytes");

  std::string largest = "R: " + std::to_string(kMaxDescriptorBytes);
  for (std::size_t i = 0; i < kMaxDescriptorBytes; ++i) largest += " c0";
  const Reading descriptor = read_trace(largest + "\nE: 0.0 1 01\n");
  EXPECT_EQ(descriptor.order, "dr.");
  EXPECT_EQ(descriptor.devices[0].report_descriptor.size(), kMaxDescriptorBytes);
}

}  // namespace
}  // namespace limn::test
