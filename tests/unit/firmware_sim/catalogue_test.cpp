// Every simulated device, seen from limn's side: what its hand did must come out of the decoders.

#include "firmware_sim/devices/catalogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "drivers/devices/trace_decoder.hpp"
#include "drivers/hid/descriptor_parser.hpp"
#include "firmware_sim/devices/drawings.hpp"
#include "firmware_sim/devices/hand_sensor.hpp"
#include "firmware_sim/devices/hid_pen_tablet.hpp"
#include "firmware_sim/devices/huion.hpp"
#include "firmware_sim/devices/motions.hpp"
#include "firmware_sim/devices/wacom_bluetooth.hpp"
#include "firmware_sim/devices/wacom_intuos.hpp"
#include "firmware_sim/devices/xp_pen.hpp"
#include "tests/support/alloc_guard.hpp"
#include "tests/unit/drivers/devices_support.hpp"
#include "tests/unit/firmware_sim/recording_host.hpp"

namespace limn::firmware {
namespace {

using namespace std::chrono_literals;
using test::RecordingHost;
using testing::SizeIs;

constexpr std::uint64_t kSeed = 5;

/// What a pen's reports must give.
struct PenExpected {
  std::string_view name;
  PlanePoint size_mm;
  std::chrono::microseconds period;
  double counts_per_mm;
  double pressure_maximum;
  double tilt_step_deg;  ///< 0: it gives no tilt
  double most_tilt_deg;
  bool tells_entering = false;  ///< in a report of its own
  bool tells_eraser = true;
};

constexpr PenExpected kPens[] = {
    {"pen", {210, 148}, 5000us, 200, 8191, 0.01, 90},
    {"intuos", {WacomIntuos::kWidthMm, WacomIntuos::kHeightMm}, 5000us, 200, 2047, 1, 63, true},
    {"huion", {254, 158.75}, 4000us, 200, 8191, 1, 60, false, false},
    {"huion-1060", {254, 158.75}, 4000us, 200, 8191, 0, 60, false, false},
    {"xppen", {XpPen::kWidthMm, XpPen::kHeightMm}, 4000us, 100, 8191, 1, 60},
    {"bluetooth-pen", {224, 148}, 5000us, 200, 8191, 1, 63},
    {"fast-pen", {210, 148}, 1000us, 200, 8191, 0.01, 90},
};

/// The poses that the tablet saw, in order.
std::vector<PenPose> poses_seen(const PenExpected& pen, std::string_view drawing) {
  HandSensor sensor(find_drawing(drawing).value(), pen.size_mm, kSeed);
  std::vector<PenPose> seen;
  bool present = false;
  for (std::chrono::microseconds time{}; time <= sensor.duration(); time += pen.period) {
    const PenPose pose = sensor.measure(time);
    const bool near = pose.proximity != Proximity::kAway;
    if (near && (present || !pen.tells_entering)) seen.push_back(pose);
    present = near;
  }
  return seen;
}

class EachPen : public testing::TestWithParam<std::tuple<PenExpected, std::string_view>> {};

TEST_P(EachPen, DecodesToThePosesOfTheHandWithinOneUnit) {
  const auto& [pen, drawing] = GetParam();
  const auto device = make_simulated_device(pen.name, drawing, kSeed);
  ASSERT_NE(device, nullptr);
  RecordingHost host(device->bus());
  host.run(device->duration() + 1s);
  EXPECT_EQ(host.stalls(), 0);
  const auto decoded = test::decode_trace(host.trace());
  ASSERT_FALSE(decoded.failed) << decoded.error.what << " " << decoded.error.at;
  EXPECT_EQ(decoded.summary.repaired_transitions(), 0U);
  test::expect_legal_transitions(decoded.samples);

  std::vector<PenSample> samples;
  for (const PenSample& sample : decoded.samples) {
    if (sample.state != PenState::kOutOfRange) samples.push_back(sample);
    EXPECT_EQ(sample.lost, 0U);
  }
  const auto poses = poses_seen(pen, drawing);
  ASSERT_THAT(samples, SizeIs(poses.size()));
  ASSERT_GT(poses.size(), 100U);
  const double unit_mm = 1 / pen.counts_per_mm;
  constexpr double kDegree = 3.14159265358979323846 / 180;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const PenPose& pose = poses[i];
    const PenSample& sample = samples[i];
    ASSERT_NEAR(sample.x_mm, pose.x_mm, unit_mm) << i;
    ASSERT_NEAR(sample.y_mm, pose.y_mm, unit_mm) << i;
    const bool touches = pose.proximity == Proximity::kTouching;
    ASSERT_EQ(in_contact(sample.state), touches) << i;
    // A light touch is told as the least that counts as one: 11 of 2047 at an Intuos.
    if (touches) {
      ASSERT_NEAR(sample.pressure, pose.pressure, 12 / pen.pressure_maximum) << i;
    }
    const bool erases = pose.end == PenEnd::kEraser && pen.tells_eraser;
    ASSERT_EQ(sample.tool, erases ? Tool::kEraser : Tool::kPen) << i;
    ASSERT_EQ(sample.axes.has(PenAxis::kTiltX), pen.tilt_step_deg > 0) << i;
    if (pen.tilt_step_deg == 0) continue;
    ASSERT_NEAR(sample.tilt_x_rad, pose.tilt_x_deg * kDegree, pen.tilt_step_deg * kDegree) << i;
    ASSERT_NEAR(sample.tilt_y_rad, pose.tilt_y_deg * kDegree, pen.tilt_step_deg * kDegree) << i;
  }
}

// Seven measurements that share a report get their times back, but for those of an approach's first
// report, which has no other before it to tell their pace.
TEST_P(EachPen, TheSampleTimesAreThoseOfTheMeasurements) {
  const auto& [pen, drawing] = GetParam();
  const auto device = make_simulated_device(pen.name, drawing, kSeed);
  RecordingHost host(device->bus());
  host.run(device->duration() + 1s);
  const auto decoded = test::decode_trace(host.trace());
  ASSERT_FALSE(decoded.failed);
  const auto poses = poses_seen(pen, drawing);
  const auto start = host.reports().front().time;
  std::size_t seen = 0;
  std::size_t approaches = 0;
  std::size_t other_times = 0;
  PenState before = PenState::kOutOfRange;
  for (const PenSample& sample : decoded.samples) {
    if (sample.state != PenState::kOutOfRange) {
      ASSERT_LT(seen, poses.size());
      if (before == PenState::kOutOfRange) ++approaches;
      if (sample.time != poses[seen].time - start) ++other_times;
      ++seen;
    }
    before = sample.state;
  }
  EXPECT_GE(approaches, drawing == "constellation" ? 2U : 1U);
  const bool bundled = pen.name == "bluetooth-pen";
  EXPECT_LE(other_times, bundled ? WacomBluetooth::kFrames * approaches : 0);
}

std::string name_of(const testing::TestParamInfo<EachPen::ParamType>& tested) {
  std::string name(std::get<0>(tested.param).name);
  for (char& c : name) c = c == '-' ? '_' : c;
  return name + "_" + std::string(std::get<1>(tested.param));
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EachPen,
                         testing::Combine(testing::ValuesIn(kPens),
                                          testing::Values("constellation", "signature")),
                         name_of);

TEST(Catalogue, EveryDeviceIsListedOnceAndMadeByItsName) {
  std::set<std::string_view> names;
  for (const SimulatedInfo& info : simulated_devices()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_FALSE(info.description.empty());
    EXPECT_EQ(info.description.find('\n'), std::string_view::npos);
    const bool is_pen = info.kind == SimulatedKind::kPen;
    const auto pen = make_simulated_device(info.name, drawings()[0].name, 1);
    const auto mouse = make_simulated_device(info.name, motions()[0].name, 1);
    EXPECT_EQ(pen != nullptr, is_pen) << info.name;
    EXPECT_EQ(mouse != nullptr, !is_pen) << info.name;
  }
  EXPECT_EQ(make_simulated_device("pencil", drawings()[0].name, 1), nullptr);
  EXPECT_THAT(names, testing::IsSupersetOf({"pen", "intuos", "huion", "xppen", "bluetooth-pen",
                                            "spacenavigator", "spacemouse", "fast-pen"}));
}

TEST(Catalogue, TheSameArgumentsGiveTheSameBytesAtTheSameTimes) {
  for (const SimulatedInfo& info : simulated_devices()) {
    const std::string_view movement =
        info.kind == SimulatedKind::kPen ? drawings()[0].name : motions()[0].name;
    const auto trace = [&](std::uint64_t seed) {
      const auto device = make_simulated_device(info.name, movement, seed);
      RecordingHost host(device->bus());
      host.run(3s);
      return host.trace();
    };
    EXPECT_EQ(trace(1), trace(1)) << info.name;
    EXPECT_NE(trace(1), trace(2)) << info.name;
  }
}

TEST(Catalogue, EveryDescriptorIsUnderstoodWithoutNotes) {
  for (const SimulatedInfo& info : simulated_devices()) {
    const auto device = make_simulated_device(
        info.name, info.kind == SimulatedKind::kPen ? drawings()[0].name : motions()[0].name, 1);
    for (const InterfaceSpec& interface : device->bus().spec().interfaces) {
      const auto parsed = hid::parse_descriptor(interface.report_descriptor);
      ASSERT_TRUE(parsed) << info.name << " " << parsed.error().what;
    }
  }
}

TEST(Catalogue, TheBluetoothPenAloneIsOnThatBus) {
  for (const SimulatedInfo& info : simulated_devices()) {
    const auto device = make_simulated_device(
        info.name, info.kind == SimulatedKind::kPen ? drawings()[0].name : motions()[0].name, 1);
    EXPECT_EQ(device->bus().spec().bus == Bus::kBluetooth, info.name == "bluetooth-pen");
  }
}

TEST(Catalogue, TabletsAreMiceUntilTheirDriverSpeaks) {
  // A host that only configures and polls.
  const auto reports_of = [](std::string_view name, const auto& before_polling) {
    const auto device = make_simulated_device(name, "circle", 1);
    BusDevice& bus = device->bus();
    bus.reset();
    test::ask(bus, {0x00, 9, 1, 0, 0});
    before_polling(bus);
    std::set<std::pair<int, int>> found;  // interface, report ID
    for (auto now = 0us; now < device->duration(); now += 1ms) {
      const auto& interfaces = bus.spec().interfaces;
      for (std::size_t i = 0; i < interfaces.size(); ++i) {
        std::array<std::uint8_t, 64> report{};
        const auto result = bus.interrupt_in(interfaces[i].endpoints[0].address, now, report);
        if (result.status == TransferStatus::kDone) found.emplace(i, report[0]);
      }
    }
    return found;
  };
  using Found = std::set<std::pair<int, int>>;
  const auto nothing = [](BusDevice&) {};
  EXPECT_EQ(reports_of("huion", nothing), (Found{{1, 10}}));
  EXPECT_EQ(reports_of("xppen", nothing), (Found{{1, 7}}));
  EXPECT_EQ(reports_of("intuos", nothing), (Found{{0, 1}}));
  EXPECT_EQ(reports_of("huion",
                       [](BusDevice& bus) {
                         test::ask(bus, {0x80, 6, 0x03C8, 0x0409, 255});
                       }),
            (Found{{0, 8}}));
  const std::uint8_t magic[] = {0x02, 0xB0, 0x04, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(reports_of("xppen",
                       [&](BusDevice& bus) {
                         EXPECT_EQ(bus.interrupt_out(0x03, 0us, magic).status,
                                   TransferStatus::kDone);
                       }),
            (Found{{2, 2}}));
  EXPECT_EQ(
      reports_of("intuos",
                 [](BusDevice& bus) {
                   std::array<std::uint8_t, 2> mode = {2, 2};
                   bus.control({0x21, 9, 0x0302, 0, 2}, 0us, mode);
                   EXPECT_THAT(test::ask(bus, {0xA1, 1, 0x0302, 0, 2}), testing::ElementsAre(2, 2));
                 }),
      (Found{{0, 2}}));
}

TEST(Catalogue, PollingAllocatesNothing) {
  for (const SimulatedInfo& info : simulated_devices()) {
    const auto device = make_simulated_device(
        info.name, info.kind == SimulatedKind::kPen ? drawings()[0].name : motions()[0].name, 1);
    BusDevice& bus = device->bus();
    bus.reset();
    test::ask(bus, {0x00, 9, 1, 0, 0});
    std::array<std::uint8_t, 512> report{};
    int given = 0;
    const test::AllocGuard guard;
    for (auto now = 0us; now < 2s; now += 1ms) {
      for (const InterfaceSpec& interface : bus.spec().interfaces) {
        const auto result = bus.interrupt_in(interface.endpoints[0].address, now, report);
        given += result.status == TransferStatus::kDone ? 1 : 0;
      }
    }
    EXPECT_EQ(guard.count(), 0U) << info.name;
    EXPECT_GT(given, 30) << info.name;
  }
}

TEST(Catalogue, AHuionNeverTellsThatThePenLeaves) {
  const auto device = make_simulated_device("huion", "constellation", 1);
  RecordingHost host(device->bus());
  host.run(device->duration() + 1s);
  for (const auto& report : host.reports()) {
    ASSERT_EQ(report.bytes[0], 8);
    ASSERT_NE(report.bytes[1] & 0x80, 0);
  }
  const auto decoded = test::decode_trace(host.trace());
  EXPECT_GT(decoded.count(PenState::kOutOfRange), 0U) << "limn's timeout supplies it";
  EXPECT_EQ(decoded.samples.back().state, PenState::kOutOfRange);
}

TEST(Catalogue, AReplugStartsATabletAnew) {
  const auto device = make_simulated_device("huion", "circle", 1);
  BusDevice& bus = device->bus();
  for (int i = 0; i < 2; ++i) {
    bus.reset();
    test::ask(bus, {0x00, 9, 1, 0, 0});
    std::array<std::uint8_t, 64> report{};
    const auto now = 1s + i * 100ms;
    EXPECT_EQ(bus.interrupt_in(0x81, now, report).status, TransferStatus::kNak);
    EXPECT_EQ(bus.interrupt_in(0x82, now, report).status, TransferStatus::kDone);
    test::ask(bus, {0x80, 6, 0x03C8, 0x0409, 255});
    EXPECT_EQ(bus.interrupt_in(0x81, now + 50ms, report).status, TransferStatus::kDone);
  }
}

TEST(Catalogue, MeasurementsWaitForALateHostAndTheOldestAreLost) {
  const auto device = make_simulated_device("fast-pen", "circle", 1);
  BusDevice& bus = device->bus();
  bus.reset();
  test::ask(bus, {0x00, 9, 1, 0, 0});
  std::array<std::uint8_t, 64> report{};
  const auto poll = [&](std::chrono::microseconds now) {
    int given = 0;
    while (bus.interrupt_in(0x81, now, report).status == TransferStatus::kDone) ++given;
    return given;
  };
  EXPECT_EQ(poll(1s), 1);
  EXPECT_EQ(poll(1s + 200ms), 200);
  EXPECT_EQ(poll(2s + 200ms), ReportClock::kMostWaiting);
}

}  // namespace
}  // namespace limn::firmware
