#include "firmware_sim/devices/hid_pen.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <vector>

#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/pen_layout.hpp"
#include "drivers/hid/usages.hpp"
#include "tests/support/alloc_guard.hpp"
#include "tests/support/for_all.hpp"

namespace limn::firmware {
namespace {

using test::for_all;
using test::Rng;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::SizeIs;
using namespace std::chrono_literals;

using ReportBytes = std::array<std::uint8_t, HidPen::kReportBytes>;

// Written down by hand from the HID specification, item by item.
constexpr std::uint8_t kExpectedDescriptor[] = {
    0x05, 0x0D,                    // Usage Page (Digitizer)
    0x09, 0x02,                    // Usage (Pen)
    0xA1, 0x01,                    // Collection (Application)
    0x85, 0x01,                    //   Report ID (1)
    0x09, 0x20,                    //   Usage (Stylus)
    0xA1, 0x00,                    //   Collection (Physical)
    0x09, 0x42,                    //     Usage (Tip Switch)
    0x09, 0x44,                    //     Usage (Barrel Switch)
    0x09, 0x5A,                    //     Usage (Secondary Barrel Switch)
    0x09, 0x3C,                    //     Usage (Invert)
    0x09, 0x45,                    //     Usage (Eraser)
    0x09, 0x32,                    //     Usage (In Range)
    0x15, 0x00,                    //     Logical Minimum (0)
    0x25, 0x01,                    //     Logical Maximum (1)
    0x75, 0x01,                    //     Report Size (1)
    0x95, 0x06,                    //     Report Count (6)
    0x81, 0x02,                    //     Input (Data, Variable, Absolute)
    0x75, 0x02,                    //     Report Size (2)
    0x95, 0x01,                    //     Report Count (1)
    0x81, 0x03,                    //     Input (Constant, Variable, Absolute)
    0x05, 0x01,                    //     Usage Page (Generic Desktop)
    0x09, 0x30,                    //     Usage (X)
    0x27, 0x10, 0xA4, 0x00, 0x00,  //     Logical Maximum (42000)
    0x46, 0xD2, 0x00,              //     Physical Maximum (210)
    0x65, 0x11,                    //     Unit (cm)
    0x55, 0x0F,                    //     Unit Exponent (-1)
    0x75, 0x10,                    //     Report Size (16)
    0x81, 0x02,                    //     Input
    0x09, 0x31,                    //     Usage (Y)
    0x26, 0xA0, 0x73,              //     Logical Maximum (29600)
    0x46, 0x94, 0x00,              //     Physical Maximum (148)
    0x81, 0x02,                    //     Input
    0x05, 0x0D,                    //     Usage Page (Digitizer)
    0x09, 0x30,                    //     Usage (Tip Pressure)
    0x26, 0xFF, 0x1F,              //     Logical Maximum (8191)
    0x45, 0x00,                    //     Physical Maximum (0)
    0x65, 0x00,                    //     Unit (none)
    0x55, 0x00,                    //     Unit Exponent (0)
    0x81, 0x02,                    //     Input
    0x09, 0x3D,                    //     Usage (X Tilt)
    0x09, 0x3E,                    //     Usage (Y Tilt)
    0x16, 0xD8, 0xDC,              //     Logical Minimum (-9000)
    0x26, 0x28, 0x23,              //     Logical Maximum (9000)
    0x36, 0xD8, 0xDC,              //     Physical Minimum (-9000)
    0x46, 0x28, 0x23,              //     Physical Maximum (9000)
    0x65, 0x14,                    //     Unit (degree)
    0x55, 0x0E,                    //     Unit Exponent (-2)
    0x95, 0x02,                    //     Report Count (2)
    0x81, 0x02,                    //     Input
    0x09, 0x56,                    //     Usage (Scan Time)
    0x15, 0x00,                    //     Logical Minimum (0)
    0x27, 0xFF, 0xFF, 0x00, 0x00,  //     Logical Maximum (65535)
    0x35, 0x00,                    //     Physical Minimum (0)
    0x47, 0xFF, 0xFF, 0x00, 0x00,  //     Physical Maximum (65535)
    0x66, 0x01, 0x10,              //     Unit (second)
    0x55, 0x0C,                    //     Unit Exponent (-4)
    0x95, 0x01,                    //     Report Count (1)
    0x81, 0x02,                    //     Input
    0x09, 0x5B,                    //     Usage (Transducer Serial Number)
    0x27, 0xFF, 0xFF, 0xFF, 0x7F,  //     Logical Maximum (2147483647)
    0x45, 0x00,                    //     Physical Maximum (0)
    0x65, 0x00,                    //     Unit (none)
    0x55, 0x00,                    //     Unit Exponent (0)
    0x75, 0x20,                    //     Report Size (32)
    0x81, 0x02,                    //     Input
    0xC0,                          //   End Collection
    0xC0,                          // End Collection
};

TEST(HidPen, TheDescriptorIsTheOneOfTheWindowsForm) {
  EXPECT_THAT(HidPen::report_descriptor(), ElementsAreArray(kExpectedDescriptor));
}

hid::PenLayout layout() {
  const auto descriptor = hid::parse_descriptor(HidPen::report_descriptor());
  EXPECT_TRUE(descriptor) << descriptor.error().what;
  if (!descriptor) return {};
  EXPECT_THAT(descriptor->notes, SizeIs(0));
  const auto layouts = hid::pen_layouts(*descriptor);
  EXPECT_THAT(layouts, SizeIs(1));
  return layouts.empty() ? hid::PenLayout{} : layouts.front();
}

TEST(HidPen, TheDescriptorIsUnderstoodAsItWasMeant) {
  const auto descriptor = hid::parse_descriptor(HidPen::report_descriptor());
  ASSERT_TRUE(descriptor);
  const auto pen = layout();
  EXPECT_EQ(pen.report_id, 1);
  EXPECT_TRUE(pen.numbered);
  EXPECT_EQ(pen.byte_length, HidPen::kReportBytes);
  EXPECT_EQ(pen.transducer, hid::Transducer::kStylus);

  // Exactly 5080 lines an inch: 200 counts a mm, both as the resolution and as the map to mm.
  int lengths = 0;
  for (const hid::Field& field : descriptor->fields) {
    if (hid::quantity(field.unit) != hid::Quantity::kLength) continue;
    ++lengths;
    EXPECT_DOUBLE_EQ(hid::counts_per_mm(field).value_or(0) * 25.4, 5080);
  }
  EXPECT_EQ(lengths, 2);
  EXPECT_TRUE(pen.x.has_unit && pen.y.has_unit && pen.tilt_x.has_unit && pen.tilt_y.has_unit);
  EXPECT_DOUBLE_EQ(pen.x.map(42000), HidPen::kWidthMm);
  EXPECT_DOUBLE_EQ(pen.y.map(29600), HidPen::kHeightMm);
  EXPECT_EQ(pen.x.reader.logical(), (hid::Range{0, 42000}));
  EXPECT_EQ(pen.y.reader.logical(), (hid::Range{0, 29600}));
  EXPECT_EQ(pen.pressure.reader.logical(), (hid::Range{0, 8191}));
  EXPECT_EQ(pen.tilt_x.reader.logical(), (hid::Range{-9000, 9000}));
  EXPECT_NEAR(pen.tilt_x.map(9000), 1.5707963267948966, 1e-15);
  EXPECT_NEAR(pen.tilt_y.map(-9000), -1.5707963267948966, 1e-15);
  EXPECT_DOUBLE_EQ(pen.scan_time.map(65535), 6.5535);
  EXPECT_EQ(pen.serial.bit_size(), 32U);
  EXPECT_FALSE(pen.twist);
}

PenPose touching_at(double x_mm, double y_mm) {
  PenPose pose;
  pose.proximity = Proximity::kTouching;
  pose.x_mm = x_mm;
  pose.y_mm = y_mm;
  pose.pressure = 0.5;
  return pose;
}

TEST(HidPen, OneReportByteByByte) {
  HidPen pen;
  ReportBytes report{};
  PenPose pose = touching_at(100, 50);
  pose.time = 1234500us;
  pose.barrel_switch = true;
  pose.pressure = 1;
  pose.tilt_x_deg = 30;
  pose.tilt_y_deg = -45.5;
  ASSERT_TRUE(pen.scan(pose, report));
  EXPECT_THAT(report, ElementsAre(0x01,                      // report ID
                                  0x23,                      // tip, barrel, in range
                                  0x20, 0x4E,                // X 20000
                                  0x10, 0x27,                // Y 10000
                                  0xFF, 0x1F,                // pressure 8191
                                  0xB8, 0x0B,                // X tilt 3000
                                  0x3A, 0xEE,                // Y tilt -4550
                                  0x39, 0x30,                // scan time 12345
                                  0x4E, 0x4D, 0x49, 0x4C));  // serial 0x4C494D4E
}

TEST(HidPen, SwitchesTellTheStatesOfTheWindowsForm) {
  constexpr std::uint8_t kTip = 0x01, kBarrel2 = 0x04, kInvert = 0x08, kEraser = 0x10,
                         kInRange = 0x20;
  const auto switches = [](Proximity proximity, PenEnd end, bool second = false) {
    HidPen pen;
    ReportBytes report{};
    PenPose pose = touching_at(1, 1);
    pose.proximity = proximity;
    pose.end = end;
    pose.secondary_barrel_switch = second;
    EXPECT_TRUE(pen.scan(pose, report));
    return report[1];
  };
  EXPECT_EQ(switches(Proximity::kHovering, PenEnd::kTip), kInRange);
  EXPECT_EQ(switches(Proximity::kTouching, PenEnd::kTip), kInRange | kTip);
  EXPECT_EQ(switches(Proximity::kHovering, PenEnd::kTip, true), kInRange | kBarrel2);
  EXPECT_EQ(switches(Proximity::kHovering, PenEnd::kEraser), kInRange | kInvert);
  EXPECT_EQ(switches(Proximity::kTouching, PenEnd::kEraser), kInRange | kInvert | kEraser);
}

TEST(HidPen, LeavingIsToldOnceWithTheLastPosition) {
  HidPen pen;
  ReportBytes report{};
  PenPose away;
  away.x_mm = 7;
  const ReportBytes untouched = report;
  EXPECT_FALSE(pen.scan(away, report)) << "nothing was ever in range";
  EXPECT_EQ(report, untouched);
  ASSERT_TRUE(pen.scan(touching_at(20, 30), report));
  const std::vector<std::uint8_t> position(report.begin() + 2, report.begin() + 6);
  ASSERT_TRUE(pen.scan(away, report));
  EXPECT_EQ(report[1], 0) << "no switch, not in range";
  EXPECT_THAT(std::vector<std::uint8_t>(report.begin() + 2, report.begin() + 6), position);
  EXPECT_THAT(std::vector<std::uint8_t>(report.begin() + 6, report.begin() + 12),
              ElementsAre(0, 0, 0, 0, 0, 0));
  EXPECT_FALSE(pen.scan(away, report));
}

TEST(HidPen, ValuesBeyondTheSensorAreToldAsItsLimits) {
  const auto pen_layout = layout();
  HidPen pen;
  ReportBytes report{};
  PenPose pose = touching_at(-3, 1e300);
  pose.pressure = 1.5;
  pose.tilt_x_deg = -1e9;
  pose.tilt_y_deg = 91;
  ASSERT_TRUE(pen.scan(pose, report));
  EXPECT_EQ(pen_layout.x.reader.read(report), 0);
  EXPECT_EQ(pen_layout.y.reader.read(report), 29600);
  EXPECT_EQ(pen_layout.pressure.reader.read(report), 8191);
  EXPECT_EQ(pen_layout.tilt_x.reader.read(report), -9000);
  EXPECT_EQ(pen_layout.tilt_y.reader.read(report), 9000);
}

TEST(HidPen, AClosedTipSwitchHasPressureAndAnOpenOneNone) {
  const auto pen_layout = layout();
  HidPen pen;
  ReportBytes report{};
  PenPose pose = touching_at(1, 1);
  pose.pressure = 0;
  ASSERT_TRUE(pen.scan(pose, report));
  EXPECT_EQ(pen_layout.pressure.reader.read(report), 1);
  pose.proximity = Proximity::kHovering;
  pose.pressure = 0.7;
  ASSERT_TRUE(pen.scan(pose, report));
  EXPECT_EQ(pen_layout.pressure.reader.read(report), 0);
}

TEST(HidPen, ScanTimeCountsTenthsOfMillisecondsAndWraps) {
  const auto pen_layout = layout();
  HidPen pen;
  ReportBytes report{};
  PenPose pose = touching_at(1, 1);
  for (const auto& [time, count] :
       {std::pair{0us, 0}, std::pair{5000us, 50}, std::pair{6553500us, 65535},
        std::pair{6553600us, 0}, std::pair{10000000us, 34464}}) {
    pose.time = time;
    ASSERT_TRUE(pen.scan(pose, report));
    EXPECT_EQ(pen_layout.scan_time.reader.read(report), count);
  }
}

TEST(HidPen, ReportsDecodeToTheirPoseWithinHalfACount) {
  constexpr double kRounding = 1e-9;  // of doubles, far below any count
  constexpr double kDegree = 3.14159265358979323846 / 180;
  const auto pen_layout = layout();
  for_all(2000, [&](Rng& rng) {
    HidPen pen;
    ReportBytes report{};
    PenPose pose = touching_at(rng.uniform(0, 210), rng.uniform(0, 148));
    pose.end = rng.chance(0.5) ? PenEnd::kTip : PenEnd::kEraser;
    pose.barrel_switch = rng.chance(0.5);
    pose.secondary_barrel_switch = rng.chance(0.5);
    pose.pressure = rng.uniform(1e-3, 1);
    pose.tilt_x_deg = rng.uniform(-90, 90);
    pose.tilt_y_deg = rng.uniform(-90, 90);
    ASSERT_TRUE(pen.scan(pose, report));
    ASSERT_TRUE(pen_layout.matches(report));
    const auto value = [&](const hid::AxisReader& axis) {
      return axis.map(axis.reader.read(report).value());
    };
    EXPECT_NEAR(value(pen_layout.x), pose.x_mm, 0.5 / 200 + kRounding);
    EXPECT_NEAR(value(pen_layout.y), pose.y_mm, 0.5 / 200 + kRounding);
    EXPECT_NEAR(value(pen_layout.pressure), pose.pressure, 0.5 / 8191 + kRounding);
    EXPECT_NEAR(value(pen_layout.tilt_x), pose.tilt_x_deg * kDegree, 0.005 * kDegree + kRounding);
    EXPECT_NEAR(value(pen_layout.tilt_y), pose.tilt_y_deg * kDegree, 0.005 * kDegree + kRounding);
    EXPECT_TRUE(pen_layout.in_range.is_set(report));
    EXPECT_EQ(pen_layout.tip_switch.is_set(report), pose.end == PenEnd::kTip);
    EXPECT_EQ(pen_layout.eraser.is_set(report), pose.end == PenEnd::kEraser);
    EXPECT_EQ(pen_layout.invert.is_set(report), pose.end == PenEnd::kEraser);
    EXPECT_EQ(pen_layout.barrel_switch.is_set(report), pose.barrel_switch);
    EXPECT_EQ(pen_layout.secondary_barrel_switch.is_set(report), pose.secondary_barrel_switch);
    EXPECT_EQ(pen_layout.serial.read_bits(report), HidPen::kTransducerSerial);
  });
}

TEST(HidPen, ScanningAllocatesNothing) {
  HidPen pen;
  ReportBytes report{};
  const PenPose pose = touching_at(1, 2);
  const test::AllocGuard guard;
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(pen.scan(pose, report));
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace limn::firmware
