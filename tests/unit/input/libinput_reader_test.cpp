#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "input/trace_import/trace_import.hpp"
#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

using testing::HasSubstr;

#define LIMN_NEEDS_YAML() \
  if (!has_libinput_records()) GTEST_SKIP() << "this limn was built without yaml-cpp"

const std::string kHead =
    "# libinput record\n"
    "version: 1\n"
    "ndevices: 1\n"
    "libinput:\n"
    "  version: \"1.23.0\"\n"
    "system:\n"
    "  os: \"debian:12\"\n"
    "devices:\n";

const std::string kPen =
    "- node: /dev/input/event20\n"
    "  evdev:\n"
    "    # Name: Some Pen\n"
    "    name: \"Some Pen\"\n"
    "    id: [3, 1386, 828, 273]\n"
    "    codes:\n"
    "      0: [0, 1, 4] # EV_SYN\n"
    "    absinfo:\n"
    "      0: [0, 15200, 4, 0, 100]\n"
    "      24: [-5, 2047, 0, 1, 0]\n"
    "    properties: [0]\n"
    "  hid: [\n"
    "    0x05, 13, 0xc0\n"
    "  ]\n"
    "  udev:\n"
    "    properties:\n"
    "    - ID_INPUT=1\n"
    "  quirks:\n"
    "  events:\n";

const std::string kFrame =
    "  # Current time is 12:34:56\n"
    "  - evdev:\n"
    "    - [  0,      7,   3,   0,    -300] # EV_ABS / ABS_X -300 (+1)\n"
    "    - [  0,      9,   0,   0,       0] # ------------ SYN_REPORT (0) ---------- +0ms\n";

const std::string kReport =
    "  - hid:\n"
    "      time: [  1,     20]\n"
    "      hidraw0: [\n"
    "        0x02, 0x80\n"
    "      ]\n";

Reading read(const std::string& text, bool salvage = false) {
  TraceOptions options;
  options.salvage = salvage;
  return read_whole(open_import(memory_bytes(text), std::move(options)));
}

TEST(LibinputReader, GivesDevicesAndFrames) {
  LIMN_NEEDS_YAML();
  const Reading reading = read(kHead + kPen + kFrame);
  EXPECT_EQ(reading.format, TraceFormat::kLibinputRecord);
  EXPECT_EQ(reading.order, "df.") << reading.error.what;
  const TraceDevice& pen = reading.devices.at(0);
  EXPECT_EQ(pen.name, "Some Pen");
  EXPECT_EQ(pen.bus, 3);
  EXPECT_EQ(pen.vendor, 0x056A);
  EXPECT_EQ(pen.product, 0x033C);
  EXPECT_EQ(pen.version, 0x0111);
  EXPECT_EQ(pen.report_descriptor, (std::vector<std::uint8_t>{0x05, 0x0D, 0xC0}));
  ASSERT_EQ(pen.axes.size(), 2U);
  EXPECT_EQ(pen.axes[0].maximum, 15200);
  EXPECT_EQ(pen.axes[0].fuzz, 4);
  EXPECT_EQ(pen.axes[0].resolution, 100);
  EXPECT_EQ(pen.axes[1].code, 24);
  EXPECT_EQ(pen.axes[1].minimum, -5);
  EXPECT_EQ(pen.axes[1].flat, 1);
  const ReadFrame& frame = reading.frames.at(0);
  EXPECT_EQ(frame.time_ns, 9'000);
  ASSERT_EQ(frame.events.size(), 1U);
  EXPECT_EQ(frame.events[0].time.count(), 7'000);
  EXPECT_EQ(frame.events[0].type, 3);
  EXPECT_EQ(frame.events[0].code, 0);
  EXPECT_EQ(frame.events[0].value, -300);
  EXPECT_EQ(reading.places.back(), "line 30");
}

TEST(LibinputReader, HidrawNodesAreDevicesBehindTheListedOnes) {
  LIMN_NEEDS_YAML();
  const Reading reading = read(kHead + kPen + kFrame + kReport + kPen + kReport);
  EXPECT_EQ(reading.order, "dfdrd.") << "the second event node tells the same report";
  EXPECT_EQ(reading.devices.at(1).index, 2U);
  EXPECT_EQ(reading.devices.at(1).vendor, 0x056A);
  EXPECT_TRUE(reading.devices.at(1).axes.empty());
  EXPECT_EQ(reading.reports.at(0), (ReadReport{2, 1'000'020'000, {0x02, 0x80}}));
  EXPECT_EQ(reading.devices.at(2).index, 1U);
}

TEST(LibinputReader, ARecordingWithoutEventsIsOne) {
  LIMN_NEEDS_YAML();
  EXPECT_EQ(read(kHead + kPen).order, "d.");
  EXPECT_EQ(read("version: 1\nndevices: 0\n").order, ".");
}

TEST(LibinputReader, UnknownKeysArePassedOver) {
  LIMN_NEEDS_YAML();
  const std::string more =
      "  - bpf: {x: [1, y], ? [a] : b}\n"
      "  - libinput:\n    - {time: 0.1, type: POINTER_MOTION, delta: [1.00, 0.00]}\n"
      "  - hid:\n      time: [2, 0]\n      future: yes\n";
  EXPECT_EQ(read(kHead + kPen + more + kFrame).order, "df.");
}

struct Damaged {
  std::string part;
  std::string what;
};

class LibinputDamage : public testing::TestWithParam<Damaged> {};

TEST_P(LibinputDamage, IsAnErrorOrSkipped) {
  LIMN_NEEDS_YAML();
  const std::string text =
      kHead + kPen + kFrame + GetParam().part + "  - evdev:\n    - [0, 30, 0, 0, 0]\n";
  const Reading strict = read(text);
  EXPECT_EQ(strict.order, "df!");
  EXPECT_THAT(strict.error.what, HasSubstr(GetParam().what));
  EXPECT_THAT(strict.error.at, HasSubstr("line 3"));
  const Reading salvaged = read(text, true);
  EXPECT_EQ(salvaged.order, "dfxf.");
}

INSTANTIATE_TEST_SUITE_P(
    Parts, LibinputDamage,
    testing::Values(
        Damaged{"  - evdev:\n    - [0, 9, 3, 0]\n    - [0, 9, 0, 0, 0]\n", "an event wants"},
        Damaged{"  - evdev:\n    - [0, 9, 3, 0, x]\n    - [0, 9, 0, 0, 0]\n", "no whole number"},
        Damaged{"  - evdev:\n    - [0, 9, 3, 0, 5]\n", "no SYN_REPORT"},
        Damaged{"  - evdev:\n    - [0, 2, 0, 0, 0]\n", "before that of the event"},
        Damaged{"  - hid:\n      time: [1]\n      hidraw0: [1]\n", "seconds and microseconds"},
        Damaged{"  - hid:\n      time: [1, 0]\n      hidraw0: [256]\n", "beyond 255"}));

TEST(LibinputReader, DamageAllOverIsToldOnceAndCounted) {
  LIMN_NEEDS_YAML();
  std::string text = kHead + kPen + kFrame;
  for (int i = 0; i < 100; ++i) text += "  - evdev:\n    - [0, 9, 3, 0, 5]\n";
  text += "  - evdev:\n    - [0, 30, 0, 0, 0]\n";
  const Reading salvaged = read(text, true);
  EXPECT_EQ(salvaged.order, "dfxf.");
  ASSERT_EQ(salvaged.damage.size(), 1U);
  EXPECT_THAT(salvaged.damage[0].what, HasSubstr("no SYN_REPORT"));
  EXPECT_THAT(salvaged.damage[0].what, HasSubstr("(100 damages skipped)"));
}

TEST(LibinputReader, ATornFileEndsAfterWhatIsWhole) {
  LIMN_NEEDS_YAML();
  const std::string torn = kHead + kPen + kFrame + "  - evdev:\n    - [  0,     10,   3";
  const Reading strict = read(torn);
  EXPECT_EQ(strict.order, "df!");
  EXPECT_THAT(strict.error.at, HasSubstr("line 3"));
  EXPECT_EQ(read(torn, true).order, "dfx.");
}

TEST(LibinputReader, AnotherVersionIsAnErrorEvenWhereDamageIsSkipped) {
  LIMN_NEEDS_YAML();
  for (const bool salvage : {false, true}) {
    const Reading reading = read("# libinput record\nversion: 2\nndevices: 0\n", salvage);
    EXPECT_EQ(reading.order, "!");
    EXPECT_EQ(reading.error.code, ErrorCode::kUnknown);
    EXPECT_EQ(at_and_what(reading.error),
              "line 2: libinput's format \"2\" is none that limn knows");
  }
}

TEST(LibinputReader, DeepNestingIsRefusedBeforeItCosts) {
  LIMN_NEEDS_YAML();
  const Reading reading = read("# libinput record\nversion: 1\nx: " + std::string(4'000'000, '['));
  EXPECT_EQ(reading.order, "!");
  EXPECT_EQ(reading.error.code, ErrorCode::kLimit);
  EXPECT_EQ(at_and_what(reading.error), "line 3: brackets are nested deeper than 32");
}

TEST(LibinputReader, AliasesAreNotFollowed) {
  LIMN_NEEDS_YAML();
  std::string text = "# libinput record\nversion: 1\na0: &a0 [x]\n";
  for (int i = 1; i < 40; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before + ", " + before +
            "]\n";
  }
  EXPECT_EQ(read(text).order, ".");
}

TEST(LibinputReader, WithoutYamlCppItSaysSo) {
  if (has_libinput_records()) GTEST_SKIP() << "this limn was built with yaml-cpp";
  const Reading reading = read(kHead);
  EXPECT_EQ(reading.error.code, ErrorCode::kMissing);
  EXPECT_THAT(reading.error.remedy, HasSubstr("libyaml-cpp-dev"));
}

}  // namespace
}  // namespace limn::test
