// Real recordings of real pens. Counts are what the recordings hold; they were checked against an
// independent decoding of the same bytes by the layouts' plain formulas.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "input/stroke/stroke_sampler.hpp"
#include "input/trace/descriptor_file.hpp"
#include "tests/support/recordings.hpp"
#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

using test::decode_trace;
using test::DecodedTrace;

std::size_t strokes_in(const DecodedTrace& trace) {
  std::size_t strokes = 0;
  StrokeSampler sampler;
  const auto count = [&strokes](Stroke&) { ++strokes; };
  for (const PenSample& sample : trace.samples) sampler.push(sample, count);
  sampler.finish(count);
  return strokes;
}

const TraceDeviceSummary* summary_of(const DecodedTrace& trace, DeviceIndex index) {
  for (const TraceDeviceSummary& device : trace.summary.devices) {
    if (device.index == index) return &device;
  }
  return nullptr;
}

/// What holds for every recording of a pen: legal states, positions within the device's range, mm
/// and pressure that follow from the counts.
void expect_sound(const DecodedTrace& trace) {
  test::expect_legal_transitions(trace.samples);
  std::map<DeviceIndex, PenRange> ranges;
  for (const auto& device : trace.summary.devices) ranges[device.index] = device.range;
  Timestamp before{};
  for (const PenSample& sample : trace.samples) {
    const PenRange& range = ranges[sample.device];
    ASSERT_GE(sample.time, before);
    before = sample.time;
    if (sample.axes.has_position()) {
      ASSERT_GE(sample.raw.x, range.x_min);
      ASSERT_LE(sample.raw.x, range.x_max);
      ASSERT_GE(sample.raw.y, range.y_min);
      ASSERT_LE(sample.raw.y, range.y_max);
      const double per_mm = static_cast<double>(range.x_max - range.x_min) / range.width_mm;
      ASSERT_NEAR(sample.x_mm, static_cast<double>(sample.raw.x - range.x_min) / per_mm, 1e-9);
      ASSERT_LE(sample.y_mm, range.height_mm * (1 + 1e-12));
    }
    ASSERT_GE(sample.pressure, 0);
    ASSERT_LE(sample.pressure, 1);
    ASSERT_EQ(sample.lost, 0U) << "nothing tells of losses here";
  }
  EXPECT_EQ(trace.summary.losses().gaps, 0U);
  EXPECT_EQ(trace.summary.losses().clock_jumps, 0U);
}

struct Recording {
  const char* file;
  const char* kind;
  std::size_t pen_reports;
  std::size_t samples;
  std::size_t in_contact;
  std::size_t erasing;
  std::size_t mouse_in_range;
  std::size_t out_of_range;
  std::size_t repaired;
  std::size_t strokes;
  std::array<int, 2> x;  ///< counts, least and most
  std::array<int, 2> y;
  int pressure;  ///< most
};

void PrintTo(const Recording& recording, std::ostream* out) { *out << recording.file; }

class WacomRecording : public ::testing::TestWithParam<Recording> {};

// clang-format off
INSTANTIATE_TEST_SUITE_P(Pens, WacomRecording, ::testing::Values(
    //  file, kind, pen reports, samples, contact, erasing, mouse, out, repaired, strokes, x, y, p
    Recording{"WACOM_Pen_Tablet_056a_0081", "Graphire Bluetooth", 1273, 1262, 11, 83, 556, 66, 2, 3, {4495, 10526}, {3485, 9660}, 376},
    Recording{"Wacom_Bamboo_Pen_056a_00D4", "Bamboo", 3613, 3113, 843, 0, 0, 13, 1, 6, {0, 14720}, {0, 9200}, 1018},
    Recording{"Wacom_Cintiq_21UX2_056a_00CC", "Cintiq", 2100, 2095, 365, 128, 0, 6, 0, 9, {24872, 54910}, {15819, 44365}, 1679},
    Recording{"Wacom_Cintiq_22HD_056a_00FA", "Cintiq", 1166, 1162, 114, 73, 0, 4, 0, 4, {39023, 58382}, {14136, 39859}, 1521},
    Recording{"Wacom_DTU1031_056a_00FB", "DTU-1031", 7237, 7239, 4291, 0, 0, 23, 2, 5, {441, 21997}, {1001, 8943}, 462},
    Recording{"Wacom_Graphire3_056a_0013", "Graphire", 1317, 1313, 17, 59, 598, 55, 0, 4, {2395, 7032}, {2916, 7354}, 328},
    Recording{"Wacom_Intuos2_4x5_056a_0041", "Intuos", 0, 0, 0, 0, 0, 0, 0, 0, {0, 0}, {0, 0}, 0},
    Recording{"Wacom_Intuos3_6x8_056a_00B1", "Intuos3", 3038, 3036, 0, 0, 3034, 2, 0, 0, {0, 40640}, {80, 30480}, 0},
    Recording{"Wacom_Intuos4_4x6_056a_00B8", "Intuos4", 5540, 5512, 303, 141, 1382, 10, 0, 12, {5279, 21610}, {1264, 19684}, 1569},
    Recording{"Wacom_Intuos4_WL_056a_00BC", "Intuos4", 1971, 1967, 485, 78, 0, 4, 0, 7, {8889, 28073}, {5489, 17420}, 1626},
    Recording{"Wacom_Intuos5_touch_M_056a_0027", "Intuos5", 6599, 6513, 443, 114, 1715, 10, 0, 10, {8916, 31398}, {2610, 24770}, 1345},
    Recording{"Wacom_Intuos_M_056a_0323", "Bamboo", 11094, 10791, 3195, 0, 0, 13, 1, 6, {0, 21600}, {76, 13035}, 964},
    Recording{"Wacom_Intuos_Pro_S_056a_0314", "Intuos Pro", 4204, 4184, 188, 104, 0, 8, 0, 4, {5762, 22100}, {1479, 19568}, 1715}),
    [](const auto& tested) { return std::string(tested.param.file); });
// clang-format on

TEST_P(WacomRecording, DecodesToItsSamples) {
  LIMN_NEEDS_RECORDINGS();
  const Recording& wanted = GetParam();
  const std::string text =
      test::read_file(test::shared_folder() / "traces/pens" / (std::string(wanted.file) + ".hid"));
  const DecodedTrace trace = decode_trace(text);
  ASSERT_FALSE(trace.failed) << trace.error.at << ": " << trace.error.what;
  expect_sound(trace);

  const TraceDeviceSummary* device = summary_of(trace, 0);
  ASSERT_NE(device, nullptr);
  EXPECT_EQ(device->kind, wanted.kind);
  EXPECT_EQ(device->count(ReportClass::kPen), wanted.pen_reports);
  EXPECT_EQ(device->count(ReportClass::kTooShort), 0U);
  EXPECT_EQ(device->count(ReportClass::kUnknownId), 0U);
  EXPECT_EQ(trace.samples.size(), wanted.samples);
  EXPECT_EQ(trace.summary.samples, wanted.samples);
  EXPECT_EQ(trace.count(PenState::kInContact), wanted.in_contact);
  EXPECT_EQ(trace.count(PenState::kErasing), wanted.erasing);
  EXPECT_EQ(trace.count(PenState::kOutOfRange), wanted.out_of_range);
  EXPECT_EQ(trace.summary.repaired_transitions(), wanted.repaired);
  EXPECT_EQ(strokes_in(trace), wanted.strokes);

  std::size_t mouse = 0;
  std::array<int, 2> x = {INT32_MAX, 0};
  std::array<int, 2> y = {INT32_MAX, 0};
  int pressure = 0;
  for (const PenSample& sample : trace.samples) {
    if (sample.tool == Tool::kTabletMouse && sample.state == PenState::kInRange) ++mouse;
    pressure = std::max(pressure, sample.raw.pressure);
    if (!sample.axes.has_position()) continue;
    x = {std::min(x[0], sample.raw.x), std::max(x[1], sample.raw.x)};
    y = {std::min(y[0], sample.raw.y), std::max(y[1], sample.raw.y)};
  }
  EXPECT_EQ(mouse, wanted.mouse_in_range);
  EXPECT_EQ(pressure, wanted.pressure);
  if (wanted.samples > 0) {
    EXPECT_EQ(x, wanted.x);
    EXPECT_EQ(y, wanted.y);
  }
}

TEST(WacomRecordings, NoFileIsForgotten) {
  LIMN_NEEDS_RECORDINGS();
  EXPECT_EQ(test::recordings("traces/pens", ".hid").size(), 13U);
}

TEST(WacomRecordings, SerialsFollowTheEnterPacketOfEachTool) {
  LIMN_NEEDS_RECORDINGS();
  const std::string text =
      test::read_file(test::shared_folder() / "traces/pens/Wacom_Intuos4_4x6_056a_00B8.hid");
  std::map<std::uint64_t, std::map<Tool, std::size_t>> by_serial;
  for (const PenSample& sample : decode_trace(text).samples) {
    if (sample.state != PenState::kOutOfRange) ++by_serial[sample.serial][sample.tool];
  }
  EXPECT_EQ(by_serial.count(0), 0U) << "every tool says its serial";
  EXPECT_EQ(by_serial.size(), 3U) << "two pens and a mouse";
  for (const auto& [serial, tools] : by_serial) {
    EXPECT_EQ(tools.count(Tool::kTabletMouse) == 1 ? tools.size() : 1U, 1U) << serial;
  }
}

TEST(WacomRecordings, AnArtPensTwistAndAPensTiltStayWithinTheirTurns) {
  LIMN_NEEDS_RECORDINGS();
  const std::string text =
      test::read_file(test::shared_folder() / "traces/pens/Wacom_Intuos4_4x6_056a_00B8.hid");
  double least = 10;
  double most = 0;
  std::size_t turned = 0;
  double steepest = 0;
  for (const PenSample& sample : decode_trace(text).samples) {
    if (sample.axes.has(PenAxis::kTwist)) {
      ++turned;
      least = std::min(least, sample.twist_rad);
      most = std::max(most, sample.twist_rad);
    }
    steepest = std::max({steepest, std::abs(sample.tilt_x_rad), std::abs(sample.tilt_y_rad)});
  }
  EXPECT_GT(turned, 3000U) << "1675 rotation packets, and the tilt packets between them";
  EXPECT_GE(least, 0);
  EXPECT_LT(most, 6.2832);
  EXPECT_GT(steepest, 0.3);
  EXPECT_LE(steepest, 64 * test::kDegree);
}

/// The interface that speaks, its descriptor's file, and what its dumps hold.
struct Dump {
  const char* folder;
  const char* descriptor;
  const char* file;
  std::size_t pen_reports;
  std::size_t in_contact;
  int x_max;
  int pressure_max;
};

void PrintTo(const Dump& dump, std::ostream* out) { *out << dump.folder << '/' << dump.file; }

class UsbhidDump : public ::testing::TestWithParam<Dump> {};

// clang-format off
INSTANTIATE_TEST_SUITE_P(Pens, UsbhidDump, ::testing::Values(
    Dump{"Huion_K26", "original0.txt", "pen_coords_1.txt", 4511, 3367, 32000, 890},
    Dump{"Huion_K26", "original0.txt", "pen_coords_3.txt", 5210, 4112, 32000, 601},
    Dump{"Huion_K26", "original0.txt", "pen_pressure_2.txt", 1054, 487, 16359, 2047},
    Dump{"Huion_W58", "original1.txt", "pen_coordinates.txt", 3174, 1680, 32767, 1096},
    Dump{"Huion_W58", "original1.txt", "pen_pressure2.txt", 4278, 2770, 18830, 2048},
    Dump{"Ugee_M708_v2", "original1.txt", "pen_coords.txt", 1440, 1211, 50779, 8191},
    Dump{"Ugee_M708_v2", "original1.txt", "pen_pressure.txt", 2044, 1620, 19716, 8191}));
// clang-format on

DecodedTrace decode_dump(const std::filesystem::path& folder, const std::string& descriptor,
                         const std::string& file, bool salvage = false) {
  auto bytes = open_bytes((folder / "rd" / descriptor).string());
  EXPECT_TRUE(bytes);
  auto devices = read_descriptors(std::move(*bytes));
  EXPECT_TRUE(devices);
  TraceOptions options;
  options.supplied.report_descriptor = devices->front().report_descriptor;
  return decode_trace(test::read_file(folder / "dumps" / file), options, salvage);
}

TEST_P(UsbhidDump, DecodesByTheDescriptorBesideIt) {
  LIMN_NEEDS_RECORDINGS();
  const Dump& wanted = GetParam();
  const auto folder = test::shared_folder() / "traces/pens-usbhid-dump" / wanted.folder;
  const DecodedTrace trace = decode_dump(folder, wanted.descriptor, wanted.file);
  ASSERT_FALSE(trace.failed) << trace.error.at << ": " << trace.error.what;
  test::expect_legal_transitions(trace.samples);
  std::size_t pen_reports = 0;
  for (const auto& device : trace.summary.devices) {
    EXPECT_EQ(device.kind, "HID pen");
    EXPECT_EQ(device.count(ReportClass::kPen), device.all_reports());
    pen_reports += device.count(ReportClass::kPen);
  }
  EXPECT_EQ(pen_reports, wanted.pen_reports);
  EXPECT_EQ(trace.samples.size(), wanted.pen_reports + trace.summary.repaired_transitions());
  EXPECT_EQ(trace.count(PenState::kInContact), wanted.in_contact);
  int x_max = 0;
  int pressure_max = 0;
  for (const PenSample& sample : trace.samples) {
    x_max = std::max(x_max, sample.raw.x);
    pressure_max = std::max(pressure_max, sample.raw.pressure);
    ASSERT_TRUE(sample.axes.has_position() || sample.state == PenState::kOutOfRange);
    ASSERT_LE(sample.pressure, 1);
  }
  EXPECT_EQ(x_max, wanted.x_max);
  EXPECT_EQ(pressure_max, wanted.pressure_max);
}

/// "002:004:001:STREAM": the descriptor file of interface 1.
std::string descriptor_of(const std::string& dump) {
  const std::size_t at = dump.find(":STREAM");
  if (at == std::string::npos || at == 0) return {};
  return std::string("original") + dump[at - 1] + ".txt";
}

TEST(UsbhidDumps, EveryDumpWithItsInterfacesDescriptorEndsWithoutHarm) {
  LIMN_NEEDS_RECORDINGS();
  std::size_t decoded = 0;
  std::size_t samples = 0;
  for (const auto& dump : test::recordings("traces/pens-usbhid-dump", ".txt")) {
    if (dump.parent_path().filename() != "dumps") continue;
    const auto folder = dump.parent_path().parent_path();
    const std::string descriptor = descriptor_of(test::read_file(dump).substr(0, 200));
    if (descriptor.empty() || !std::filesystem::exists(folder / "rd" / descriptor)) continue;
    const DecodedTrace trace = decode_dump(folder, descriptor, dump.filename(), /*salvage=*/true);
    EXPECT_FALSE(trace.failed) << dump << trace.error.what;
    test::expect_legal_transitions(trace.samples);
    ++decoded;
    samples += trace.samples.size();
  }
  EXPECT_EQ(decoded, 37U);
  EXPECT_GT(samples, 50000U);
}

}  // namespace
}  // namespace limn
