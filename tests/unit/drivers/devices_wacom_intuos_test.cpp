// Intuos packets and the Bluetooth bundles of them, byte by byte, made up from the layouts that
// stand with the decoder.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

using test::DecodedDevice;
using test::kDegree;
using test::kWacom;
using test::ReportBytes;
using ::testing::IsEmpty;

PenSample only(const std::vector<PenSample>& samples) {
  EXPECT_EQ(samples.size(), 1U);
  return samples.empty() ? PenSample{} : samples.back();
}

/// Where a repaired transition may come before it.
PenSample last(const std::vector<PenSample>& samples) {
  EXPECT_FALSE(samples.empty());
  return samples.empty() ? PenSample{} : samples.back();
}

/// The enter packet of tool `id` (20 bits) with `serial` (32 bits).
ReportBytes enter(std::uint32_t id, std::uint32_t serial, std::uint8_t slot = 0) {
  const auto byte = [](std::uint32_t bits) { return static_cast<std::uint8_t>(bits); };
  return {0x02,
          byte(0xC2 | slot),
          byte(id >> 4 & 0xFF),
          byte((id & 0xF) << 4 | serial >> 28),
          byte(serial >> 20),
          byte(serial >> 12),
          byte(serial >> 4),
          byte((serial & 0xF) << 4 | (id >> 16 & 0xF)),
          byte(id >> 8 & 0xF0),
          0};
}

/// A position packet: coordinates of 17 bits, pressure of 11, tilt in degrees.
ReportBytes packet(unsigned flags, unsigned x, unsigned y, unsigned pressure = 0, int tilt_x = 0,
                   int tilt_y = 0, unsigned distance = 0) {
  const auto byte = [](unsigned bits) { return static_cast<std::uint8_t>(bits); };
  const auto tx = static_cast<unsigned>(tilt_x + 64);
  const auto ty = static_cast<unsigned>(tilt_y + 64);
  return {0x02,
          byte(flags | (pressure & 1)),
          byte(x >> 9),
          byte(x >> 1),
          byte(y >> 9),
          byte(y >> 1),
          byte(pressure >> 3),
          byte((pressure << 5 & 0xC0) | tx >> 1),
          byte((tx & 1) << 7 | ty),
          byte(distance << 2 | (x & 1) << 1 | (y & 1))};
}

const ReportBytes kLeave = {0x02, 0x80, 0, 0, 0, 0, 0, 0, 0, 0};
constexpr std::uint32_t kProPen = 0x10842;  // any pen: bit 3 clear
constexpr std::uint32_t kEraserEnd = 0x1084A;
constexpr unsigned kPen = 0xE0;
constexpr unsigned kRotation = 0xEA;
constexpr unsigned kMouse = 0xEC;
constexpr unsigned kFarPen = 0x20;
constexpr unsigned kAirbrush = 0xF4;

TEST(WacomIntuos, EveryBitOfAPenPacketCounts) {
  DecodedDevice device(kWacom, 0x0315);  // 200 counts a mm, pressure to 2047, distance to 63
  EXPECT_THAT(device(enter(kProPen, 0xDEADBEEF)), IsEmpty());
  EXPECT_EQ(device.kind(), ReportClass::kPen);
  const PenSample sample = last(device(packet(kPen | 6, 40001, 20003, 2047, -30, 45, 21)));
  EXPECT_EQ(sample.raw, (RawCounts{40001, 20003, 2047}));
  EXPECT_EQ(sample.x_mm, 40001 / 200.0);
  EXPECT_EQ(sample.y_mm, 20003 / 200.0);
  EXPECT_EQ(sample.pressure, 1);
  EXPECT_DOUBLE_EQ(sample.tilt_x_rad, -30 * kDegree);
  EXPECT_DOUBLE_EQ(sample.tilt_y_rad, 45 * kDegree);
  EXPECT_EQ(sample.distance, 21 / 63.0);
  EXPECT_EQ(sample.buttons, 3);
  EXPECT_EQ(sample.serial, 0xDEADBEEFU);
  EXPECT_TRUE(sample.axes.has(PenAxis::kSerial));
  EXPECT_FALSE(sample.axes.has(PenAxis::kTwist));
}

TEST(WacomIntuos, StatesFollowPressureAboveNoise) {
  DecodedDevice device(kWacom, 0x0315);
  device(enter(kProPen, 1));
  EXPECT_EQ(only(device(packet(kPen, 1, 1, 10))).state, PenState::kInRange);
  EXPECT_EQ(only(device(packet(kPen, 1, 1, 11))).state, PenState::kInContact);
  EXPECT_EQ(only(device(packet(kPen, 1, 1, 0))).state, PenState::kInRange);
  const PenSample gone = only(device(kLeave));
  EXPECT_EQ(gone.state, PenState::kOutOfRange);
  EXPECT_FALSE(gone.axes.has_position());
  EXPECT_EQ(gone.serial, 1U);
  EXPECT_THAT(device(kLeave), IsEmpty());
  EXPECT_EQ(device.decoder().repaired_transitions(), 0U);
}

TEST(WacomIntuos, TenBitPensHalveThePressure) {
  DecodedDevice device(kWacom, 0xB1);  // Intuos3: pressure to 1023
  device(enter(kProPen, 1));
  EXPECT_EQ(last(device(packet(kPen, 1, 1, 2047))).raw.pressure, 1023);
  EXPECT_EQ(only(device(packet(kPen, 1, 1, 21))).state, PenState::kInRange);
  EXPECT_EQ(only(device(packet(kPen, 1, 1, 22))).state, PenState::kInContact);
}

TEST(WacomIntuos, TheFirstTwoCountHalfAsFine) {
  DecodedDevice device(kWacom, 0x41);
  device(enter(kProPen, 1));
  const PenSample sample = only(device(packet(kPen, 20001, 10001, 0, 0, 0, 62)));
  EXPECT_EQ(sample.raw.x, 10000);
  EXPECT_EQ(sample.raw.y, 5000);
  EXPECT_EQ(sample.x_mm, 100);
  EXPECT_EQ(sample.distance, 1);
}

TEST(WacomIntuos, TheEraserIsKnownByItsId) {
  DecodedDevice device(kWacom, 0x0315);
  device(enter(kEraserEnd, 1));
  EXPECT_EQ(only(device(packet(kPen, 1, 1, 0))).state, PenState::kInRangeErasing);
  EXPECT_EQ(only(device(packet(kPen, 1, 1, 500))).state, PenState::kErasing);
}

TEST(WacomIntuos, ToolIds) {
  for (const std::uint32_t mouse :
       {0x007U, 0x017U, 0x094U, 0x09CU, 0x806U, 0x096U, 0x097U, 0x006U}) {
    EXPECT_EQ(wacom_tool(mouse), Tool::kTabletMouse) << mouse;
  }
  EXPECT_EQ(wacom_tool(0x802), Tool::kPen);
  EXPECT_EQ(wacom_tool(0x80A), Tool::kEraser);
  EXPECT_EQ(wacom_tool(0x10804), Tool::kPen);
  EXPECT_EQ(wacom_tool(0x1080C), Tool::kEraser);
  EXPECT_EQ(wacom_tool(0x912), Tool::kPen);
}

TEST(WacomIntuos, ArtPenPacketsKeepEachOthersAxes) {
  DecodedDevice device(kWacom, 0x0315);
  device(enter(0x10804, 1));
  EXPECT_EQ(last(device(packet(kPen, 100, 100, 1000, 20, 0))).state, PenState::kInContact);
  ReportBytes rotation = packet(kRotation, 102, 100);
  rotation[6] = 900 >> 3;  // direction clear: -450 steps of 0.2 degrees
  rotation[7] = static_cast<std::uint8_t>((900 & 7) << 5);
  rotation[8] = 0;
  const PenSample turned = only(device(rotation));
  EXPECT_EQ(turned.state, PenState::kInContact);
  EXPECT_EQ(turned.raw, (RawCounts{102, 100, 1000}));
  EXPECT_DOUBLE_EQ(turned.tilt_x_rad, 20 * kDegree);
  EXPECT_NEAR(turned.twist_rad, 270 * kDegree, 1e-12);
  rotation[7] |= 0x20;  // 901: the other direction
  EXPECT_NEAR(only(device(rotation)).twist_rad, 90 * kDegree, 1e-12);
  const PenSample next = only(device(packet(kPen, 104, 100, 1200, 22, 0)));
  EXPECT_NEAR(next.twist_rad, 90 * kDegree, 1e-12);
  EXPECT_EQ(next.raw.pressure, 1200);
  EXPECT_EQ(only(device(packet(kAirbrush, 106, 100))).raw.pressure, 1200);
}

TEST(WacomIntuos, FarPacketsHaveAPositionButNoPressureOrTilt) {
  DecodedDevice device(kWacom, 0x0315);
  EXPECT_THAT(device(packet(kFarPen, 100, 100, 0, 0, 0, 63)), IsEmpty())
      << "no tool has said what it is";
  device(enter(kProPen, 1));
  device(packet(kPen, 100, 100, 1000, 20, 30));
  const auto lifted = device(packet(kFarPen, 300, 200, 0, 0, 0, 63));
  const PenSample far = only(lifted);
  EXPECT_EQ(far.state, PenState::kInRange);
  EXPECT_EQ(far.raw, (RawCounts{300, 200, 0}));
  EXPECT_EQ(far.distance, 1);
  EXPECT_FALSE(far.axes.has(PenAxis::kPressure));
  EXPECT_FALSE(far.axes.has(PenAxis::kTiltX));
}

TEST(WacomIntuos, ARecordingThatStartsAmidAStrokeIsThePens) {
  DecodedDevice device(kWacom, 0x0315);
  const auto samples = device(packet(kPen, 100, 100, 1000));
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].state, PenState::kInRange);
  EXPECT_EQ(samples[1].state, PenState::kInContact);
  EXPECT_FALSE(samples[1].axes.has(PenAxis::kSerial));
  EXPECT_EQ(only(device(packet(kFarPen, 100, 100))).state, PenState::kInRange);
  EXPECT_EQ(only(device(kLeave)).state, PenState::kOutOfRange);
}

TEST(WacomIntuos, AMouseNeverTouches) {
  DecodedDevice device(kWacom, 0x0315);
  ReportBytes mouse = packet(kMouse, 100, 100);
  mouse[6] = 0x1F;
  const PenSample unnamed = only(device(mouse));
  EXPECT_EQ(unnamed.tool, Tool::kTabletMouse);
  EXPECT_EQ(unnamed.state, PenState::kInRange);
  EXPECT_EQ(unnamed.buttons, 0x1F);
  EXPECT_FALSE(unnamed.axes.has(PenAxis::kPressure));
  EXPECT_EQ(only(device(kLeave)).tool, Tool::kTabletMouse);

  DecodedDevice intuos3(kWacom, 0xB1);
  intuos3(enter(0x017, 5));
  ReportBytes two_d = packet(0xF0, 100, 100);
  two_d[8] = 0x04 | 0x40;
  EXPECT_EQ(only(intuos3(two_d)).buttons, 0b01001) << "left, side";
  intuos3(kLeave);
  intuos3(enter(0x097, 5));
  two_d[8] = 0x02;
  EXPECT_EQ(only(intuos3(two_d)).buttons, 0b00100) << "the lens cursor's middle button";
  ReportBytes four_d = packet(0xE8, 100, 100);
  four_d[8] = 0x04;
  EXPECT_EQ(only(intuos3(four_d)).buttons, 0b00010) << "right";
}

TEST(WacomIntuos, AnotherToolEnteringWithoutALeavePacketMakesTheFirstLeave) {
  DecodedDevice device(kWacom, 0x0315);
  device(enter(kProPen, 1));
  device(packet(kPen, 100, 100));
  EXPECT_THAT(device(enter(kProPen, 1)), IsEmpty()) << "the same tool again";
  const PenSample gone = only(device(enter(kEraserEnd, 1)));
  EXPECT_EQ(gone.state, PenState::kOutOfRange);
  EXPECT_EQ(only(device(packet(kPen, 100, 100))).tool, Tool::kEraser);
  EXPECT_EQ(device.decoder().repaired_transitions(), 0U);
}

TEST(WacomIntuos, OfTwoToolsAtOnceThePenWinsOverTheMouse) {
  DecodedDevice device(kWacom, 0x41);
  device(enter(0x007, 2, 0));
  ReportBytes mouse = packet(0xE8, 100, 100);
  EXPECT_EQ(only(device(mouse)).tool, Tool::kTabletMouse);
  device(enter(kProPen, 1, 1));
  const auto taken_over = device(packet(kPen | 1, 200, 200));
  ASSERT_EQ(taken_over.size(), 2U);
  EXPECT_EQ(taken_over[0].state, PenState::kOutOfRange);
  EXPECT_EQ(taken_over[1].tool, Tool::kPen);
  EXPECT_THAT(device(mouse), IsEmpty());
  EXPECT_EQ(only(device({0x02, 0x81, 0, 0, 0, 0, 0, 0, 0, 0})).state, PenState::kOutOfRange);
  EXPECT_EQ(only(device(mouse)).tool, Tool::kTabletMouse);
  EXPECT_EQ(device.decoder().repaired_transitions(), 0U);
}

TEST(WacomIntuosArt, CountsNearnessAndHasNoTilt) {
  DecodedDevice device(kWacom, 0x033B);  // 100 counts a mm
  device(enter(kProPen, 1));
  const PenSample sample = last(device(packet(kPen, 1000, 100, 2047, 20, 20, 63)));
  EXPECT_EQ(sample.x_mm, 10);
  EXPECT_EQ(sample.distance, 0);
  EXPECT_FALSE(sample.axes.has(PenAxis::kTiltX));
}

TEST(WacomIntuos4Bluetooth, BundledPacketsSpreadOverTheTimeSinceTheLastReport) {
  DecodedDevice device(kWacom, 0xBD);
  const auto bundle = [](std::uint8_t id, const std::vector<ReportBytes>& packets) {
    ReportBytes out = {id};
    for (const ReportBytes& bytes : packets) out.insert(out.end(), bytes.begin(), bytes.end());
    out.resize(id == 4 ? 32 : 22);
    return out;
  };
  using std::chrono::milliseconds;
  const ReportBytes pad = {0x0C, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_THAT(device(bundle(3, {enter(kProPen, 9), pad}), milliseconds(100)), IsEmpty());
  const auto three = device(bundle(4, {packet(kPen, 2, 2), packet(kPen, 4, 2), packet(kPen, 6, 2)}),
                            milliseconds(115));
  ASSERT_EQ(three.size(), 3U);
  EXPECT_EQ(three[0].time, milliseconds(105));
  EXPECT_EQ(three[1].time, milliseconds(110));
  EXPECT_EQ(three[2].time, milliseconds(115));
  EXPECT_EQ(three[2].raw.x, 6);
  EXPECT_EQ(three[2].serial, 9U);
  // After a silence the packets are no older than the pen's own pace.
  const auto late = device(bundle(3, {packet(kPen, 2, 2), packet(kPen, 4, 2)}), milliseconds(900));
  ASSERT_EQ(late.size(), 2U);
  EXPECT_EQ(late[0].time, milliseconds(890));
  device(ReportBytes(20, 0x03));
  EXPECT_EQ(device.kind(), ReportClass::kTooShort);
}

TEST(WacomIntuosPro2Bluetooth, SevenFramesEachWithItsTime) {
  DecodedDevice device(kWacom, 0x0360);  // 200 counts a mm, pressure to 8191
  const auto report = [](int frames, std::uint8_t flags) {
    ReportBytes out(361, 0);
    out[0] = 0x80;
    for (int i = 0; i < frames; ++i) {
      std::uint8_t* frame = out.data() + 1 + 14 * i;
      frame[0] = flags;
      frame[1] = static_cast<std::uint8_t>(200 + i);
      frame[3] = 100;
      frame[5] = 0xFF;
      frame[6] = 0x1F;
      frame[7] = static_cast<std::uint8_t>(-10);
      frame[8] = 20;
      frame[9] = 0x3E;  // -450: a quarter turn back
      frame[10] = 0xFE;
      frame[13] = 63;
    }
    out[99] = 0x78;
    out[103] = 0x42;  // serial 0x0010004200000078: pen ids' upper bits at 32..51
    out[105] = 0x10;
    out[107] = 0x04;
    out[108] = 0x08;
    return out;
  };
  using std::chrono::milliseconds;
  const auto first = device(report(7, 0xE0), milliseconds(1000));
  ASSERT_EQ(first.size(), 7U);
  EXPECT_EQ(first.front().time, milliseconds(1000)) << "nothing before it to spread over";
  const auto second = device(report(7, 0xE1), milliseconds(1035));
  ASSERT_EQ(second.size(), 7U);
  EXPECT_EQ(second[0].time, milliseconds(1005));
  EXPECT_EQ(second[6].time, milliseconds(1035));
  const PenSample& sample = second[6];
  EXPECT_EQ(sample.state, PenState::kInContact);
  EXPECT_EQ(sample.raw, (RawCounts{206, 100, 8191}));
  EXPECT_EQ(sample.x_mm, 1.03);
  EXPECT_EQ(sample.pressure, 1);
  EXPECT_DOUBLE_EQ(sample.tilt_x_rad, -10 * kDegree);
  EXPECT_DOUBLE_EQ(sample.tilt_y_rad, 20 * kDegree);
  EXPECT_EQ(sample.distance, 1);
  EXPECT_EQ(sample.serial, 0x0010004200000078U);
  EXPECT_FALSE(sample.axes.has(PenAxis::kTwist)) << "0x42'0804 is no art pen";
  EXPECT_THAT(device(report(0, 0)), IsEmpty());
  device(report(1, 0xE0), milliseconds(1040));
  EXPECT_EQ(only(device(report(1, 0x80), milliseconds(1045))).state, PenState::kOutOfRange);
}

TEST(WacomIntuosPro2Bluetooth, AToolThatOnlyCameNearLeavesNoSerialBehind) {
  DecodedDevice device(kWacom, 0x0360);
  ReportBytes report(361, 0);
  report[0] = 0x80;
  report[1] = 0xC0;  // in proximity only
  report[99] = 0x78;
  EXPECT_THAT(device(report), IsEmpty());
  report[1] = 0xE0;
  report[99] = 0;
  EXPECT_FALSE(only(device(report)).axes.has(PenAxis::kSerial));
}

TEST(WacomIntuosBluetooth, FourShortFrames) {
  DecodedDevice device(kWacom, 0x0377);  // 100 counts a mm, pressure to 4095
  ReportBytes report(43, 0);
  report[0] = 0x81;
  const ReportBytes frame = {0xF1, 0xE8, 0x03, 0x64, 0x00, 0xFF, 0x0F, 0x3F};
  for (std::size_t i = 0; i < 4; ++i) {
    std::copy(frame.begin(), frame.end(), report.begin() + 1 + 8 * static_cast<std::ptrdiff_t>(i));
  }
  const auto samples = device(report);
  ASSERT_EQ(samples.size(), 5U) << "contact out of nowhere first comes in range";
  EXPECT_EQ(samples[4].state, PenState::kErasing);
  EXPECT_EQ(samples[4].x_mm, 10);
  EXPECT_EQ(samples[4].y_mm, 1);
  EXPECT_EQ(samples[4].pressure, 1);
  EXPECT_EQ(samples[4].distance, 1);
}

}  // namespace
}  // namespace limn
