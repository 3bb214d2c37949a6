#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

using test::decode_trace;
using test::DecodedTrace;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::string_view kIntuos =
    "R: 6 05 01 09 02 a1 01\n"  // broken: the table does not need it
    "N: Intuos Pro\n"
    "I: 3 056a 0315\n"
    "E: 10.000000 10 02 c2 80 42 48 0d e2 11 00 00\n"
    "E: 10.005000 10 02 e0 1e 05 0b cf 00 21 7f c2\n"
    "E: 10.010000 10 02 e0 1e 06 0b cf 40 21 7f 02\n"
    "E: 10.015000 10 02 80 00 00 00 00 00 00 00 00\n";

TEST(TraceDecoder, TimesStartAtTheFirstEventEvenIfItGivesNoSample) {
  const DecodedTrace trace = decode_trace(kIntuos);
  ASSERT_FALSE(trace.failed) << trace.error.what;
  ASSERT_EQ(trace.samples.size(), 4U);
  EXPECT_EQ(trace.samples[0].time, std::chrono::milliseconds(5));
  EXPECT_EQ(trace.samples[0].state, PenState::kInRange);
  EXPECT_EQ(trace.samples[1].state, PenState::kInContact);
  EXPECT_EQ(trace.samples[2].state, PenState::kInRange) << "left in contact: repaired";
  EXPECT_EQ(trace.samples[3].time, std::chrono::milliseconds(15));
  ASSERT_EQ(trace.summary.devices.size(), 1U);
  const TraceDeviceSummary& device = trace.summary.devices[0];
  EXPECT_EQ(device.name, "Intuos Pro");
  EXPECT_EQ(device.vendor, 0x056A);
  EXPECT_EQ(device.product, 0x0315);
  EXPECT_EQ(device.kind, "Intuos Pro");
  EXPECT_EQ(device.range.x_max, 44704);
  EXPECT_EQ(device.samples, 4U);
  EXPECT_EQ(device.repaired_transitions, 1U);
  EXPECT_EQ(device.all_reports(), 4U);
  EXPECT_EQ(device.count(ReportClass::kPen), 4U);
  EXPECT_EQ(trace.summary.samples, 4U);
  EXPECT_EQ(trace.summary.repaired_transitions(), 1U);
}

TEST(TraceDecoder, DevicesAreDecodedSideBySide) {
  const DecodedTrace trace = decode_trace(
      "D: 0\nN: a\nI: 3 056a 0013\n"
      "D: 4\nN: b\nI: 3 056a 00d4\n"
      "D: 0\nE: 1.0 8 02 90 40 1f 20 03 00 00\n"
      "D: 4\nE: 1.5 9 02 f0 e8 03 64 00 00 00 00\n"
      "D: 0\nE: 2.0 8 02 91 40 1f 20 03 ff 01\n");
  ASSERT_FALSE(trace.failed) << trace.error.what;
  ASSERT_EQ(trace.samples.size(), 3U);
  EXPECT_EQ(trace.samples[1].device, 4U);
  EXPECT_EQ(trace.samples[1].x_mm, 10);
  EXPECT_EQ(trace.samples[2].device, 0U);
  EXPECT_EQ(trace.samples[2].x_mm, 100);
  EXPECT_EQ(trace.summary.repaired_transitions(), 0U);
  test::expect_legal_transitions(trace.samples);
}

constexpr std::string_view kUnknownDevice =
    "N: stranger\nI: 3 1234 5678\nE: 1.0 3 01 02 03\nE: 2.0 3 01 02 03\n";

TEST(TraceDecoder, ReportsWithoutADescriptorAreAnErrorWithPlaceAndRemedy) {
  const DecodedTrace trace = decode_trace(kUnknownDevice);
  ASSERT_TRUE(trace.failed);
  EXPECT_EQ(trace.error.code, ErrorCode::kMissing);
  EXPECT_THAT(trace.error.at, HasSubstr("line 3"));
  EXPECT_THAT(trace.error.what, HasSubstr("stranger"));
  EXPECT_THAT(trace.error.remedy, HasSubstr("--descriptor"));
}

TEST(TraceDecoder, SalvagingCountsThem) {
  const DecodedTrace trace = decode_trace(kUnknownDevice, {}, true);
  ASSERT_FALSE(trace.failed) << trace.error.what;
  EXPECT_THAT(trace.samples, IsEmpty());
  ASSERT_EQ(trace.summary.devices.size(), 1U);
  EXPECT_EQ(trace.summary.devices[0].undecodable_reports, 2U);
  EXPECT_EQ(trace.summary.devices[0].all_reports(), 2U);
  EXPECT_EQ(trace.summary.devices[0].kind, "unknown");
}

constexpr std::string_view kUnknownId =
    "N: graphire\nI: 3 056a 0013\n"
    "E: 1.0 8 02 90 40 1f 20 03 00 00\n"
    "E: 2.0 2 7f 00\n"
    "E: 3.0 8 02 90 41 1f 20 03 00 00\n";

TEST(TraceDecoder, AnUnknownReportIdIsAnErrorAndEverythingBeforeItStands) {
  const DecodedTrace trace = decode_trace(kUnknownId);
  ASSERT_TRUE(trace.failed);
  EXPECT_EQ(trace.error.code, ErrorCode::kUnknown);
  EXPECT_THAT(trace.error.at, HasSubstr("line 4"));
  EXPECT_THAT(trace.error.what, HasSubstr("report ID 127"));
  EXPECT_EQ(trace.samples.size(), 1U);
}

TEST(TraceDecoder, SalvagingPassesUnknownReportIds) {
  const DecodedTrace trace = decode_trace(kUnknownId, {}, true);
  ASSERT_FALSE(trace.failed) << trace.error.what;
  EXPECT_EQ(trace.samples.size(), 2U);
  EXPECT_EQ(trace.summary.devices[0].count(ReportClass::kUnknownId), 1U);
}

TEST(TraceDecoder, AfterAnErrorItGivesTheSameErrorAgain) {
  auto reader = open_trace(memory_bytes(kUnknownDevice), {});
  ASSERT_TRUE(reader);
  TraceDecoder decoder(std::move(*reader));
  const auto first = decoder.next();
  const auto second = decoder.next();
  ASSERT_FALSE(first);
  ASSERT_FALSE(second);
  EXPECT_EQ(first.error().at, second.error().at);
  EXPECT_EQ(first.error().what, second.error().what);
}

TEST(TraceDecoder, TheEndComesForEver) {
  auto reader = open_trace(memory_bytes("N: idle\nI: 3 056a 0013\nE: 1.0 2 01 00\n"), {});
  ASSERT_TRUE(reader);
  TraceDecoder decoder(std::move(*reader));
  for (int i = 0; i < 3; ++i) {
    const auto sample = decoder.next();
    ASSERT_TRUE(sample);
    EXPECT_EQ(*sample, nullptr);
  }
  EXPECT_EQ(decoder.summary().devices[0].count(ReportClass::kMouse), 1U);
}

TEST(TraceDecoder, ADeviceDescribedAnewHasLiftedAndLeft) {
  const DecodedTrace trace = decode_trace(
      "N: pen\nI: 3 056a 0013\n"
      "E: 1.0 8 02 90 40 1f 20 03 00 00\n"
      "E: 1.5 8 02 91 40 1f 20 03 ff 01\n"
      "N: pen\nI: 3 056a 0013\n"
      "E: 4.0 8 02 90 40 1f 20 03 00 00\n");
  ASSERT_FALSE(trace.failed) << trace.error.what;
  ASSERT_EQ(trace.samples.size(), 5U);
  EXPECT_EQ(trace.samples[2].state, PenState::kInRange);
  EXPECT_EQ(trace.samples[3].state, PenState::kOutOfRange);
  EXPECT_EQ(trace.samples[3].time, std::chrono::milliseconds(500));
  EXPECT_EQ(trace.samples[4].time, std::chrono::seconds(3));
  test::expect_legal_transitions(trace.samples);
  EXPECT_EQ(trace.summary.repaired_transitions(), 0U);
  EXPECT_EQ(trace.summary.devices.size(), 1U);
}

TEST(TraceDecoder, TooManyDevicesAreALimitNotMemory) {
  std::string text;
  for (std::size_t i = 0; i <= TraceDecoder::kMaxDevices; ++i) {
    text += "D: " + std::to_string(i) + "\nI: 3 056a 0013\nE: 1.0 2 01 00\n";
  }
  const DecodedTrace trace = decode_trace(text);
  ASSERT_TRUE(trace.failed);
  EXPECT_EQ(trace.error.code, ErrorCode::kLimit);
}

TEST(TraceDecoder, StrokeCsvPassesThrough) {
  const DecodedTrace trace = decode_trace("t,x,y,p\n5.0,1,2,0.5\n5.5,3,4,0.25\n");
  ASSERT_FALSE(trace.failed) << trace.error.what;
  std::vector<PenSample> touching;
  for (const PenSample& sample : trace.samples) {
    if (in_contact(sample.state)) touching.push_back(sample);
  }
  ASSERT_EQ(touching.size(), 2U);
  EXPECT_EQ(touching[0].time, Timestamp{0});
  EXPECT_EQ(touching[1].time, std::chrono::milliseconds(500));
  EXPECT_EQ(touching[1].x_mm, 3);
  EXPECT_EQ(touching[1].pressure, 0.25);
  EXPECT_EQ(trace.summary.devices[0].kind, "stroke CSV");
}

TEST(TraceDecoder, KernelFramesNeedASize) {
  const std::string head = "# EVEMU 1.3\nN: kernel pen\nI: 0003 1234 5678 0000\n";
  const std::string events =
      "E: 7.000000 0003 0000 0100\nE: 7.000000 0003 0001 0200\nE: 7.000000 0001 0140 0001\n"
      "E: 7.000000 0000 0000 0000\n";
  const DecodedTrace sized =
      decode_trace(head + "A: 00 0 1000 0 0 10\nA: 01 0 1000 0 0 10\nA: 18 0 255 0 0 0\n" + events);
  ASSERT_FALSE(sized.failed) << sized.error.what;
  ASSERT_EQ(sized.samples.size(), 1U);
  EXPECT_EQ(sized.samples[0].x_mm, 10);
  EXPECT_EQ(sized.samples[0].time, Timestamp{0});
  EXPECT_EQ(sized.summary.devices[0].kind, "kernel pen");
  EXPECT_EQ(sized.summary.devices[0].frames, 1U);

  const std::string sizeless =
      head + "A: 00 0 1000 0 0 0\nA: 01 0 1000 0 0 0\nA: 18 0 255 0 0 0\n" + events;
  const DecodedTrace refused = decode_trace(sizeless);
  ASSERT_TRUE(refused.failed);
  EXPECT_EQ(refused.error.code, ErrorCode::kMissing);
  EXPECT_THAT(refused.error.what, HasSubstr("ABS_X"));
  EXPECT_FALSE(decode_trace(sizeless, {}, true).failed);
}

std::vector<std::uint32_t> lost_of(const DecodedTrace& trace) {
  std::vector<std::uint32_t> lost;
  for (const PenSample& sample : trace.samples) lost.push_back(sample.lost);
  return lost;
}

TEST(TraceDecoder, SkippedReportsAreToldWithTheNextSampleOfTheirDevice) {
  const DecodedTrace trace = decode_trace(
      "D: 0\nN: a\nI: 3 056a 0013\nD: 1\nN: b\nI: 3 056a 0013\n"
      "E: 1.0 8 02 90 40 1f 20 03 00 00\n"
      "D: 0\nE: 1.0 8 02 90 40\nE: 1.0 8 zz\n"
      "D: 1\nE: 2.0 8 02 90 41 1f 20 03 00 00\n"
      "D: 0\nE: 2.0 8 02 90 40 1f 20 03 00 00\nE: 2.5 8 02 90 41 1f 20 03 00 00\n",
      {}, true);
  ASSERT_FALSE(trace.failed) << trace.error.what;
  EXPECT_EQ(lost_of(trace), (std::vector<std::uint32_t>{0, 0, 2, 0}));
  EXPECT_EQ(trace.samples.at(2).device, 0U);
}

TEST(TraceDecoder, SkippedRecordsFramesAndRowsAreLostToo) {
  const std::string bytes = "\n 02 90 40 1f 20 03 00 00\n\n";
  const std::string damaged = "0:STREAM 3.0\n 02 Q\n\n0:STREAM 1.0" + bytes;
  TraceOptions graphire;
  graphire.supplied.vendor = 0x056A;
  graphire.supplied.product = 0x0013;
  const DecodedTrace dump =
      decode_trace("0:STREAM 2.0" + bytes + damaged + "0:STREAM 3.0" + bytes, graphire, true);
  EXPECT_EQ(lost_of(dump), (std::vector<std::uint32_t>{0, 2}));

  const DecodedTrace frames = decode_trace(
      "# EVEMU 1.3\nA: 00 0 1000 0 0 10\nA: 01 0 1000 0 0 10\nA: 18 0 255 0 0 0\n"
      "E: 1.0 0003 0000 junk\nE: 1.0 0003 0001 5\nE: 1.0 0000 0000 0\n"
      "E: 2.0 0003 0000 100\nE: 2.0 0001 0140 1\nE: 2.0 0000 0000 0\n",
      {}, true);
  EXPECT_EQ(lost_of(frames), (std::vector<std::uint32_t>{1}));

  const DecodedTrace rows = decode_trace("t,x,y,p\n0,1,2,0.5\n1,1\n2,1\n3,1,2,0.5\n", {}, true);
  EXPECT_EQ(lost_of(rows), (std::vector<std::uint32_t>{0, 2}));
}

TEST(TraceDecoder, NotesOfLostReportsAreToldWithTheNextSample) {
  const DecodedTrace trace = decode_trace(
      "N: a\nI: 3 056a 0013\n#limn lost 3\n#limn lost many\n#limn lost 4294967295\n"
      "E: 1.0 8 02 90 40 1f 20 03 00 00\n#limn lost 2\nE: 2.0 8 02 90 41 1f 20 03 00 00\n");
  ASSERT_FALSE(trace.failed) << trace.error.what;
  EXPECT_EQ(lost_of(trace), (std::vector<std::uint32_t>{4294967295, 2}));
}

TEST(TraceDecoder, EstimatedLossIsToldToo) {
  const DecodedTrace trace =
      decode_trace("N: a\nI: 3 056a 0013\n#limn lost? 1\nE: 1.0 8 02 90 40 1f 20 03 00 00\n");
  ASSERT_EQ(trace.samples.size(), 1U);
  EXPECT_EQ(trace.samples[0].lost, 1U);
}

TEST(TraceDecoder, ADeviceThatIsUnpluggedHasLiftedAndLeft) {
  const DecodedTrace trace = decode_trace(
      "N: a\nI: 3 056a 0013\nE: 1.0 8 02 91 40 1f 20 03 ff 01\n#limn gone\n#limn gone\n");
  ASSERT_FALSE(trace.failed) << trace.error.what;
  ASSERT_GE(trace.samples.size(), 2U);
  EXPECT_EQ(trace.samples[trace.samples.size() - 2].state, PenState::kInRange);
  EXPECT_EQ(trace.samples.back().state, PenState::kOutOfRange);
}

// Recorded: probe of Huion New 1060 Plus. 50800 x 31750 counts at 5080 lines an inch.
const std::string kStringV2 =
    "#limn string 200 12 03 70 c6 00 06 7c 00 ff 1f d8 13 03 0c 10 00 01 00\n";

TEST(TraceDecoder, NotedStringsMakeAPenOfAProductThatNoTableKnows) {
  const std::string pen = "N: Huion\nI: 3 256c 0999\n";
  const std::string report = "E: 1.0 12 08 80 70 c6 06 7c 00 00 00 00 00 00\n";
  EXPECT_TRUE(decode_trace(pen + report).failed);
  const DecodedTrace trace = decode_trace(pen + "#limn string 201\n" + kStringV2 + report);
  ASSERT_FALSE(trace.failed) << trace.error.what;
  ASSERT_GE(trace.samples.size(), 1U);
  EXPECT_EQ(trace.samples[0].x_mm, 254);
  EXPECT_EQ(trace.samples[0].y_mm, 158.75);
  EXPECT_EQ(trace.summary.devices[0].range.width_mm, 254);
  // Described anew it is another device, of which nothing is known.
  EXPECT_TRUE(decode_trace(pen + kStringV2 + report + "N: Huion\n" + report).failed);
}

TEST(TraceDecoder, NotedFirmwareChoosesTheRow) {
  const std::string firmware = "HUION_T164_170520";
  std::string note = "#limn string 201 " + std::string("24 03");
  for (const char c : firmware) {
    note += ' ';
    note += "0123456789abcdef"[c >> 4];
    note += "0123456789abcdef"[c & 15];
    note += " 00";
  }
  const DecodedTrace trace = decode_trace("N: a\nI: 3 256c 006e\n" + note +
                                          "\nE: 1.0 12 08 80 70 c6 06 7c 00 00 00 00 00 00\n");
  ASSERT_FALSE(trace.failed) << trace.error.what;
  EXPECT_EQ(trace.summary.devices[0].range.x_max, 55880) << "Huion Q11K's";
}

TEST(TraceDecoder, NotesThatAreNoStringsChangeNothing) {
  const DecodedTrace trace = decode_trace(
      "N: a\nI: 3 056a 0013\n#limn string\n#limn string 300 12\n#limn string 200 zz\n"
      "#limn strings 200\n" +
      kStringV2 + "E: 1.0 8 02 90 40 1f 20 03 00 00\n");
  ASSERT_FALSE(trace.failed) << trace.error.what;
  EXPECT_EQ(trace.samples.size(), 1U);
}

TEST(TraceDecoder, SalvagedDamageIsCountedAndTheFirstPartsAreKept) {
  std::string text = "N: pen\nI: 3 056a 0013\n";
  for (int i = 0; i < 40; ++i) text += "E: broken line\nE: 1.0 2 01 00\n";
  const DecodedTrace trace = decode_trace(text, {}, true);
  ASSERT_FALSE(trace.failed) << trace.error.what;
  EXPECT_EQ(trace.summary.damaged_parts, 40U);
  EXPECT_EQ(trace.summary.damage.size(), TraceSummary::kDamageKept);
}

}  // namespace
}  // namespace limn
