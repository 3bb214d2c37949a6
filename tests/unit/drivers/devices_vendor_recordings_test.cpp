// Real recordings of tablets other than Wacom's. Counts come from an independent decoding of the
// same bytes by the layouts' plain formulas.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "input/trace/descriptor_file.hpp"
#include "tests/support/recordings.hpp"
#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

using test::decode_trace;
using test::DecodedTrace;

std::filesystem::path dumps_folder() { return test::shared_folder() / "traces/pens-usbhid-dump"; }

/// The report descriptor of an interface, as the folder of a tablet keeps it.
std::vector<std::uint8_t> descriptor_of(const std::filesystem::path& tablet, unsigned interface) {
  for (const char* name : {"rd/hid_report_descriptors_without_uc_logic_probe.txt",
                           "rd/original?.txt", "rd/original.txt", "hid_report_descriptors.txt"}) {
    std::string file = name;
    std::replace(file.begin(), file.end(), '?', static_cast<char>('0' + interface));
    if (!std::filesystem::exists(tablet / file)) continue;
    auto bytes = open_bytes((tablet / file).string());
    auto devices = read_descriptors(std::move(*bytes));
    EXPECT_TRUE(devices) << tablet / file;
    for (const TraceDevice& device : *devices) {
      constexpr DeviceIndex kInterfaces = 256;  // beside the ordinal of the bus address
      if (devices->size() == 1 || device.index % kInterfaces == interface) {
        return device.report_descriptor;
      }
    }
  }
  ADD_FAILURE() << "no descriptor of interface " << interface << " in " << tablet;
  return {};
}

std::uint16_t hex(const char* digits) {
  std::uint16_t value = 0;
  std::from_chars(digits, digits + 4, value, 16);
  return value;
}

struct VendorDump {
  const char* tablet = "";
  const char* file = "";
  unsigned interface = 0;
  const char* ids = "";
  const char* kind = "";
  std::size_t pen_reports = 0;
  std::size_t samples = 0;
  std::size_t in_contact = 0;
  std::size_t out_of_range = 0;
  std::array<int, 2> x = {};  ///< counts, least and most
  std::array<int, 2> y = {};
  int pressure = 0;  ///< most
};

void PrintTo(const VendorDump& dump, std::ostream* out) { *out << dump.tablet << '/' << dump.file; }

TraceOptions options_of(const VendorDump& dump, bool with_descriptor) {
  TraceOptions options;
  options.supplied.vendor = hex(dump.ids);
  options.supplied.product = hex(dump.ids + 5);
  if (with_descriptor) {
    options.supplied.report_descriptor =
        descriptor_of(dumps_folder() / dump.tablet, dump.interface);
  }
  return options;
}

DecodedTrace decode_dump(const VendorDump& dump, bool with_descriptor = true) {
  const auto file = dumps_folder() / dump.tablet / "dumps" / dump.file;
  // One file begins with NUL bytes.
  const bool damaged =
      dump.tablet == std::string("Ugee_M708_v2") && dump.file == std::string("pen_tilt.txt");
  return decode_trace(test::read_file(file), options_of(dump, with_descriptor), damaged);
}

// clang-format off
const VendorDump kDumps[] = {
    // tablet, file, interface, ids, kind, pen reports, samples, contact, out, x, y, pressure
    VendorDump{"Huion_K26", "frame_wheel_srolling.txt", 0, "256C:006E", "HID pen", 6826, 6827, 3807, 15, {0, 32000}, {0, 24000}, 2047},
    VendorDump{"Huion_K26", "pen_buttons_1.txt", 0, "256C:006E", "HID pen", 1272, 1272, 0, 0, {16824, 16970}, {8916, 9141}, 0},
    VendorDump{"Huion_K26", "pen_buttons_2.txt", 0, "256C:006E", "HID pen", 1119, 1119, 0, 0, {16680, 16816}, {8846, 8977}, 0},
    VendorDump{"Huion_K26", "pen_buttons_3.txt", 0, "256C:006E", "HID pen", 1300, 1300, 0, 0, {16502, 16682}, {8810, 8978}, 0},
    VendorDump{"Huion_K26", "pen_coords_1.txt", 0, "256C:006E", "HID pen", 4511, 4513, 3367, 6, {0, 32000}, {0, 24000}, 890},
    VendorDump{"Huion_K26", "pen_coords_2.txt", 0, "256C:006E", "HID pen", 5033, 5034, 3709, 5, {0, 32000}, {0, 24000}, 744},
    VendorDump{"Huion_K26", "pen_coords_3.txt", 0, "256C:006E", "HID pen", 5210, 5210, 4112, 4, {0, 32000}, {0, 24000}, 601},
    VendorDump{"Huion_K26", "pen_pressure_1.txt", 0, "256C:006E", "HID pen", 796, 796, 258, 0, {16235, 16446}, {7173, 7562}, 2047},
    VendorDump{"Huion_K26", "pen_pressure_2.txt", 0, "256C:006E", "HID pen", 1054, 1054, 487, 0, {16133, 16359}, {7526, 8095}, 2047},
    VendorDump{"Huion_K26", "pen_pressure_3.txt", 0, "256C:006E", "HID pen", 839, 839, 359, 1, {16156, 16506}, {7986, 8376}, 2047},
    VendorDump{"Huion_New_1060_Plus", "pen_buttons.txt", 0, "256C:006E", "UC-Logic v2", 1766, 1766, 0, 6, {39649, 40396}, {17424, 19323}, 0},
    VendorDump{"Huion_New_1060_Plus", "pen_coords.txt", 0, "256C:006E", "UC-Logic v2", 3473, 3478, 3132, 5, {0, 50800}, {0, 31750}, 8191},
    VendorDump{"Huion_New_1060_Plus", "pen_pressure.txt", 0, "256C:006E", "UC-Logic v2", 1538, 1538, 1029, 1, {21685, 24715}, {12434, 17373}, 8191},
    VendorDump{"Huion_W58", "pen_buttons.txt", 1, "256C:006E", "pen as mouse", 1839, 1840, 0, 1, {14042, 17821}, {12395, 18126}, 0},
    VendorDump{"Huion_W58", "pen_buttons2.txt", 1, "256C:006E", "pen as mouse", 1718, 1719, 0, 1, {14648, 16719}, {13817, 16268}, 0},
    VendorDump{"Huion_W58", "pen_coordinates.txt", 1, "256C:006E", "pen as mouse", 3174, 3179, 1680, 3, {0, 32767}, {0, 32767}, 1096},
    VendorDump{"Huion_W58", "pen_coordinates2.txt", 1, "256C:006E", "pen as mouse", 3330, 3334, 1719, 2, {0, 32767}, {0, 32767}, 840},
    VendorDump{"Huion_W58", "pen_coordinates3.txt", 1, "256C:006E", "pen as mouse", 3005, 3007, 1784, 2, {0, 32767}, {0, 32767}, 860},
    VendorDump{"Huion_W58", "pen_pressure.txt", 1, "256C:006E", "pen as mouse", 4408, 4409, 2893, 1, {1200, 19244}, {13742, 16786}, 2048},
    VendorDump{"Huion_W58", "pen_pressure2.txt", 1, "256C:006E", "pen as mouse", 4278, 4279, 2770, 1, {15377, 18830}, {10423, 16740}, 2048},
    VendorDump{"KYE_PenSketch_M912", "pen_buttons.txt", 0, "0458:5015", "KYE as mouse", 1581, 1581, 0, 1, {12945, 13129}, {11746, 12071}, 0},
    VendorDump{"KYE_PenSketch_M912", "pen_coords.txt", 0, "0458:5015", "KYE as mouse", 1654, 1658, 878, 4, {0, 30720}, {0, 23040}, 0},
    VendorDump{"KYE_PenSketch_M912", "pen_pressure.txt", 0, "0458:5015", "KYE as mouse", 1479, 1479, 658, 1, {14461, 15144}, {11027, 11971}, 0},
    VendorDump{"KYE_PenSketch_M912", "pen_tilt.txt", 0, "0458:5015", "KYE as mouse", 5915, 5915, 2934, 1, {13848, 15394}, {9110, 12640}, 0},
    VendorDump{"Ugee_M708_v2", "pen_buttons.txt", 1, "28BD:0907", "HID pen", 2177, 2177, 0, 4, {11395, 12959}, {20802, 22468}, 0},
    VendorDump{"Ugee_M708_v2", "pen_coords.txt", 1, "28BD:0907", "HID pen", 1440, 1444, 1211, 3, {17, 50779}, {13810, 30460}, 8191},
    VendorDump{"Ugee_M708_v2", "pen_pressure.txt", 1, "28BD:0907", "HID pen", 2044, 2044, 1620, 1, {19490, 19716}, {16181, 16786}, 8191},
    VendorDump{"Ugee_M708_v2", "pen_tilt.txt", 1, "28BD:0907", "HID pen", 2090, 2091, 1973, 1, {20388, 22367}, {18834, 21258}, 8191},
    VendorDump{"VEIKK_A30", "pen_buttons.txt", 0, "2FEB:0002", "pen as mouse", 2146, 2147, 0, 1, {15299, 15636}, {19001, 20632}, 0},
    VendorDump{"VEIKK_A30", "pen_coords.txt", 0, "2FEB:0002", "pen as mouse", 8904, 8908, 4840, 4, {0, 32764}, {2, 32767}, 973},
    VendorDump{"VEIKK_A30", "pen_pressure.txt", 0, "2FEB:0002", "pen as mouse", 2262, 2263, 1670, 1, {16648, 17066}, {16303, 16881}, 8191},
    VendorDump{"XP-Pen_Deco_01_v2_revb", "pen_buttons.txt", 1, "28BD:0905", "HID pen", 968, 968, 0, 5, {12724, 13391}, {14288, 15563}, 0},
    VendorDump{"XP-Pen_Deco_01_v2_revb", "pen_coords.txt", 1, "28BD:0905", "HID pen", 4697, 4697, 1585, 4, {0, 32767}, {0, 32767}, 8191},
    VendorDump{"XP-Pen_Deco_01_v2_revb", "pen_pressure.txt", 1, "28BD:0905", "HID pen", 2713, 2713, 2491, 1, {14751, 15286}, {15217, 15773}, 8191},
    VendorDump{"XP-Pen_Deco_01_v2_revb", "pen_tilt.txt", 1, "28BD:0905", "HID pen", 5594, 5594, 3854, 1, {13233, 15038}, {13077, 14749}, 8191},
    VendorDump{"XP-Pen_Star_06", "pen_buttons.txt", 0, "28BD:0078", "pen as mouse", 10398, 10400, 2965, 2, {11817, 13776}, {21268, 23745}, 3757},
    VendorDump{"XP-Pen_Star_06", "pen_coords.txt", 0, "28BD:0078", "pen as mouse", 2172, 2176, 1197, 4, {11, 32767}, {0, 32766}, 8191},
    VendorDump{"XP-Pen_Star_06", "pen_pressure.txt", 0, "28BD:0078", "pen as mouse", 6635, 6636, 4530, 1, {14856, 15071}, {21135, 22768}, 8191},
    VendorDump{"XP-Pen_Star_06", "pen_tilt.txt", 0, "28BD:0078", "pen as mouse", 5138, 5139, 740, 1, {13882, 19298}, {16809, 22429}, 666}};
// clang-format on

class VendorRecording : public ::testing::TestWithParam<VendorDump> {};
INSTANTIATE_TEST_SUITE_P(Pens, VendorRecording, ::testing::ValuesIn(kDumps));

TEST_P(VendorRecording, DecodesToItsSamples) {
  LIMN_NEEDS_RECORDINGS();
  const VendorDump& wanted = GetParam();
  const DecodedTrace trace = decode_dump(wanted);
  ASSERT_FALSE(trace.failed) << trace.error.at << ": " << trace.error.what;
  test::expect_legal_transitions(trace.samples);
  ASSERT_EQ(trace.summary.devices.size(), 1U);
  const TraceDeviceSummary& device = trace.summary.devices.front();
  EXPECT_EQ(device.kind, wanted.kind);
  EXPECT_EQ(device.count(ReportClass::kPen), wanted.pen_reports);
  EXPECT_EQ(device.all_reports(), wanted.pen_reports);
  EXPECT_EQ(trace.samples.size(), wanted.samples);
  EXPECT_EQ(trace.count(PenState::kInContact), wanted.in_contact);
  EXPECT_EQ(trace.count(PenState::kOutOfRange), wanted.out_of_range);

  const PenRange& range = device.range;
  std::array<int, 2> x = {INT32_MAX, 0};
  std::array<int, 2> y = {INT32_MAX, 0};
  int pressure = 0;
  Timestamp before{};
  for (const PenSample& sample : trace.samples) {
    ASSERT_GE(sample.time, before);
    before = sample.time;
    ASSERT_NE(sample.state, PenState::kErasing) << "none of these pens has an eraser";
    ASSERT_GE(sample.pressure, 0);
    ASSERT_LE(sample.pressure, 1);
    pressure = std::max(pressure, sample.raw.pressure);
    if (!sample.axes.has_position()) continue;
    x = {std::min(x[0], sample.raw.x), std::max(x[1], sample.raw.x)};
    y = {std::min(y[0], sample.raw.y), std::max(y[1], sample.raw.y)};
    ASSERT_NEAR(sample.x_mm, sample.raw.x * range.width_mm / static_cast<double>(range.x_max),
                1e-9);
    ASSERT_NEAR(sample.y_mm, sample.raw.y * range.height_mm / static_cast<double>(range.y_max),
                1e-9);
  }
  EXPECT_EQ(x, wanted.x);
  EXPECT_EQ(y, wanted.y);
  EXPECT_EQ(pressure, wanted.pressure);
  EXPECT_LE(x[1], range.x_max);
  EXPECT_LE(y[1], range.y_max);
}

TEST_P(VendorRecording, WithoutADescriptorTheRowSuffices) {
  LIMN_NEEDS_RECORDINGS();
  const VendorDump& wanted = GetParam();
  const DecodedTrace trace = decode_dump(wanted, /*with_descriptor=*/false);
  ASSERT_FALSE(trace.failed) << trace.error.at << ": " << trace.error.what;
  EXPECT_EQ(trace.summary.devices[0].count(ReportClass::kPen), wanted.pen_reports);
  // The K26 shows only by its first contact or switch what it means by in range.
  if (wanted.tablet == std::string("Huion_K26")) {
    EXPECT_GT(trace.samples.size(), wanted.samples / 2);
    return;
  }
  EXPECT_EQ(trace.samples.size(), wanted.samples);
  EXPECT_EQ(trace.count(PenState::kInContact), wanted.in_contact);
  const DecodedTrace beside = decode_dump(wanted);
  for (std::size_t i = 0; i < std::min(trace.samples.size(), beside.samples.size()); ++i) {
    if (!trace.samples[i].axes.has_position()) continue;
    // UGEE's descriptor rounds its size down to thousandths of an inch.
    ASSERT_NEAR(trace.samples[i].x_mm, beside.samples[i].x_mm, 0.02);
    ASSERT_NEAR(trace.samples[i].y_mm, beside.samples[i].y_mm, 0.02);
    ASSERT_EQ(trace.samples[i].pressure, beside.samples[i].pressure);
  }
}

TEST(VendorRecordings, HaveTheSizeOfTheirTablet) {
  LIMN_NEEDS_RECORDINGS();
  struct Size {
    const char* tablet;
    double width_mm;
    double height_mm;
  };
  // What the makers state, in inches; UGEE's descriptor rounds down by a thousandth.
  const Size sizes[] = {{"Huion_K26", 8 * 25.4, 6 * 25.4},
                        {"Huion_New_1060_Plus", 10 * 25.4, 6.25 * 25.4},
                        {"Huion_W58", 8 * 25.4, 5 * 25.4},
                        {"KYE_PenSketch_M912", 12 * 25.4, 9 * 25.4},
                        {"Ugee_M708_v2", 9.999 * 25.4, 5.999 * 25.4},
                        {"VEIKK_A30", 10 * 25.4, 6 * 25.4},
                        {"XP-Pen_Deco_01_v2_revb", 10 * 25.4, 6.25 * 25.4},
                        {"XP-Pen_Star_06", 10 * 25.4, 6 * 25.4}};
  for (const Size& size : sizes) {
    const auto dump = std::find_if(std::begin(kDumps), std::end(kDumps), [&](const auto& d) {
      return d.tablet == std::string(size.tablet);
    });
    ASSERT_NE(dump, std::end(kDumps));
    const DecodedTrace trace = decode_dump(*dump);
    ASSERT_FALSE(trace.summary.devices.empty()) << size.tablet;
    EXPECT_NEAR(trace.summary.devices[0].range.width_mm, size.width_mm, 0.01) << size.tablet;
    EXPECT_NEAR(trace.summary.devices[0].range.height_mm, size.height_mm, 0.01) << size.tablet;
  }
}

TEST(VendorRecordings, NoneOfAPenIsForgotten) {
  LIMN_NEEDS_RECORDINGS();
  std::set<std::string> known;
  for (const VendorDump& dump : kDumps) known.insert(std::string(dump.tablet) + "/" + dump.file);
  for (const auto& dump : test::recordings("traces/pens-usbhid-dump", ".txt")) {
    const std::string file = dump.filename();
    if (dump.parent_path().filename() != "dumps" || file.rfind("pen_", 0) != 0) continue;
    const std::string tablet = dump.parent_path().parent_path().filename();
    EXPECT_EQ(known.count(tablet + "/" + file), 1U) << dump;
  }
}

/// Keys, dials, touch pads and relative mice: known for what they are, and no samples.
TEST(VendorRecordings, WhatIsNotThePenGivesNoSamples) {
  LIMN_NEEDS_RECORDINGS();
  struct Other {
    VendorDump dump;
    ReportClass kind;
    std::size_t reports;
  };
  const Other others[] = {
      {{"Huion_New_1060_Plus", "frame_buttons.txt", 0, "256C:006E"}, ReportClass::kPad, 24},
      {{"KYE_PenSketch_M912", "mouse_buttons.txt", 0, "0458:5015"}, ReportClass::kMouse, 1144},
      {{"KYE_PenSketch_M912", "mouse_coords.txt", 0, "0458:5015"}, ReportClass::kMouse, 582},
      {{"KYE_PenSketch_M912", "mouse_wheel.txt", 0, "0458:5015"}, ReportClass::kMouse, 1521},
      {{"Ugee_M708_v2", "frame_buttons.txt", 0, "28BD:0907"}, ReportClass::kOther, 16},
      {{"VEIKK_A30", "frame_buttons.txt", 2, "2FEB:0002"}, ReportClass::kPad, 8},
      {{"VEIKK_A30", "frame_swipe.txt", 2, "2FEB:0002"}, ReportClass::kTouch, 12},
      {{"XP-Pen_Deco_01_v2_revb", "frame_buttons.txt", 0, "28BD:0905"}, ReportClass::kOther, 16},
      {{"XP-Pen_Star_06", "frame_buttons.txt", 1, "28BD:0078"}, ReportClass::kOther, 12},
      {{"XP-Pen_Star_06", "frame_dials.txt", 1, "28BD:0078"}, ReportClass::kOther, 413},
      {{"XP-Pen_Star_06", "frame_wheel_srolling.txt", 1, "28BD:0078"}, ReportClass::kOther, 284}};
  for (const Other& other : others) {
    SCOPED_TRACE(::testing::PrintToString(other.dump));
    const DecodedTrace trace = decode_dump(other.dump);
    ASSERT_FALSE(trace.failed) << trace.error.at << ": " << trace.error.what;
    EXPECT_TRUE(trace.samples.empty());
    ASSERT_EQ(trace.summary.devices.size(), 1U);
    EXPECT_EQ(trace.summary.devices[0].count(other.kind), other.reports);
    EXPECT_EQ(trace.summary.devices[0].all_reports(), other.reports);
  }
}

// The second barrel switch, that the descriptors call an eraser.
TEST(VendorRecordings, BothBarrelSwitchesAreSeen) {
  LIMN_NEEDS_RECORDINGS();
  std::size_t seen = 0;
  for (const VendorDump& dump : kDumps) {
    if (std::string(dump.file).rfind("pen_buttons", 0) != 0) continue;
    std::array<std::size_t, 4> pressed{};
    for (const PenSample& sample : decode_dump(dump).samples) ++pressed.at(sample.buttons);
    const bool second_only = dump.tablet == std::string("Huion_New_1060_Plus");
    EXPECT_TRUE(pressed[1] > 50 || second_only) << ::testing::PrintToString(dump);
    EXPECT_GT(pressed[2], 25U) << ::testing::PrintToString(dump);
    ++seen;
  }
  EXPECT_EQ(seen, 11U);
}

TEST(VendorRecordings, SilentPensLeaveATimeoutAfterTheirLastReport) {
  LIMN_NEEDS_RECORDINGS();
  std::size_t left = 0;
  for (const VendorDump& dump : kDumps) {
    if (dump.kind != std::string("pen as mouse")) continue;
    const DecodedTrace trace = decode_dump(dump);
    Timestamp reported{};
    for (const PenSample& sample : trace.samples) {
      if (sample.time - reported == kLeavingTimeout) {
        left += sample.state == PenState::kOutOfRange ? 1 : 0;
        continue;  // its lift has the same time
      }
      ASSERT_NE(sample.state, PenState::kOutOfRange);
      reported = sample.time;
    }
    EXPECT_EQ(trace.samples.back().state, PenState::kOutOfRange) << "the end of the recording";
  }
  EXPECT_EQ(left, 25U);
}

/// In degrees.
struct Lean {
  int x = 0;
  int y = 0;
};

// The pen leans away from the user and a little to the left, then to the right, then to the left,
// as its descriptor's X Tilt and Y Tilt say it in the HID frame: right and towards the user are
// positive. Its range ends at 60 degrees.
TEST(VendorRecordings, TiltOfTheDeco01HasItsSign) {
  LIMN_NEEDS_RECORDINGS();
  const auto dump = std::find_if(std::begin(kDumps), std::end(kDumps), [](const auto& d) {
    return d.tablet == std::string("XP-Pen_Deco_01_v2_revb") &&
           d.file == std::string("pen_tilt.txt");
  });
  ASSERT_NE(dump, std::end(kDumps));
  const auto lean_at = [trace = decode_dump(*dump)](double seconds) {
    Lean lean;
    for (const PenSample& sample : trace.samples) {
      if (to_seconds(sample.time) > seconds) break;
      EXPECT_LE(std::abs(sample.tilt_x_rad), 60.001 * test::kDegree);
      EXPECT_LE(std::abs(sample.tilt_y_rad), 60.001 * test::kDegree);
      if (!sample.axes.has(PenAxis::kTiltX)) continue;
      lean.x = static_cast<int>(std::lround(sample.tilt_x_rad / test::kDegree));
      lean.y = static_cast<int>(std::lround(sample.tilt_y_rad / test::kDegree));
    }
    return lean;
  };
  EXPECT_EQ(lean_at(1.0).x, 0) << "upright";
  EXPECT_EQ(lean_at(4.11).y, -60) << "away from the user";
  EXPECT_EQ(lean_at(4.11).x, -33);
  EXPECT_EQ(lean_at(9.9).x, 60) << "to the right";
  EXPECT_GT(lean_at(9.9).y, 0);
  EXPECT_EQ(lean_at(19.3).x, -60) << "to the left";
  EXPECT_EQ(lean_at(16.0).x, 0) << "upright";
}

}  // namespace
}  // namespace limn
