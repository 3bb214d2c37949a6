// Every fault before every device, seen from limn's side.

#include "firmware_sim/devices/faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "drivers/devices/trace_decoder.hpp"
#include "firmware_sim/devices/catalogue.hpp"
#include "firmware_sim/devices/drawings.hpp"
#include "firmware_sim/devices/faulty_device.hpp"
#include "firmware_sim/devices/motions.hpp"
#include "input/stroke/drag_sampler.hpp"
#include "input/stroke/stroke_sampler.hpp"
#include "tests/unit/drivers/devices_support.hpp"
#include "tests/unit/firmware_sim/recording_host.hpp"

namespace limn::firmware {
namespace {

using namespace std::chrono_literals;
using test::RecordingHost;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::SizeIs;

TEST(Faults, AreListedOnceAndParsedByTheirNames) {
  std::set<std::string_view> names;
  for (const FaultInfo& info : faults()) {
    EXPECT_TRUE(names.insert(info.name).second);
    EXPECT_FALSE(info.description.empty());
    EXPECT_EQ(info.description.find('\n'), std::string_view::npos);
    const ParsedFault parsed = parse_fault(info.name);
    ASSERT_TRUE(parsed.fault) << parsed.error;
    EXPECT_EQ(parsed.fault->kind, info.usual.kind);
    EXPECT_EQ(parsed.fault->probability, info.usual.probability);
  }
  EXPECT_THAT(names, SizeIs(kFaultKinds));
}

TEST(Faults, ParametersAreSetInAnyOrder) {
  const ParsedFault parsed = parse_fault("unplug,n=3,seed=9,at=1.5,p=0.25");
  ASSERT_TRUE(parsed.fault) << parsed.error;
  EXPECT_EQ(parsed.fault->kind, FaultKind::kUnplug);
  EXPECT_EQ(parsed.fault->at, 1500ms);
  EXPECT_EQ(parsed.fault->probability, 0.25);
  EXPECT_EQ(parsed.fault->count, 3U);
  EXPECT_EQ(parsed.fault->seed, 9U);
}

TEST(Faults, ErrorsAreOneLineAndSayWhatWouldBeRight) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "'': there is no such fault"},
      {"dropp,at=1", "'dropp': there is no such fault"},
      {"drop,", "'': a fault takes at=SECONDS, p=PROBABILITY, n=COUNT and seed=N"},
      {"drop,at", "'at': at= takes seconds, 0 to 86400"},
      {"drop,at=-1", "'at=-1': at= takes seconds, 0 to 86400"},
      {"drop,at=nan", "'at=nan': at= takes seconds, 0 to 86400"},
      {"drop,at=1e9", "'at=1e9': at= takes seconds, 0 to 86400"},
      {"drop,p=0", "'p=0': p= takes a probability, above 0 and at most 1"},
      {"drop,p=1.5", "'p=1.5': p= takes a probability, above 0 and at most 1"},
      {"drop,p=x", "'p=x': p= takes a probability, above 0 and at most 1"},
      {"drop,n=0", "'n=0': n= takes a count, 1 to 4294967295"},
      {"drop,n=4294967296", "'n=4294967296': n= takes a count, 1 to 4294967295"},
      {"drop,seed=-1", "'seed=-1': seed= takes a whole number, 0 to 2^64 - 1"},
      {"drop,often=1", "'often=1': a fault takes at=SECONDS, p=PROBABILITY, n=COUNT and seed=N"},
  };
  for (const auto& [text, error] : cases) {
    const ParsedFault parsed = parse_fault(text);
    EXPECT_FALSE(parsed.fault) << text;
    EXPECT_EQ(parsed.error, error);
    EXPECT_EQ(parsed.unknown_name, std::string_view(error).ends_with("no such fault")) << text;
  }
}

/// A device with faults, plugged in, drawn with or moved, and unplugged at the end.
struct Session {
  test::DecodedTrace decoded;
  std::vector<Stroke> strokes;
  std::string trace;
  std::vector<RecordingHost::Taken> reports;
  int plugged_in = 0;
  int stalls = 0;
  std::uint64_t happened = 0;
};

Session session(std::string_view device_name, std::string_view movement, const FaultSpec& fault) {
  const auto device = make_simulated_device(device_name, movement, 1);
  EXPECT_NE(device, nullptr);
  // At the end it is unplugged for good.
  FaultSpec end;
  end.kind = FaultKind::kUnplug;
  end.at = device->duration() + 2s;
  end.count = 1;
  const FaultSpec both[] = {fault, end};
  FaultyDevice faulty(device->bus(), both);
  RecordingHost host(faulty);
  host.run(end.at + 100ms);
  Session out;
  out.trace = host.trace();
  out.reports = host.reports();
  out.plugged_in = host.plugged_in();
  out.stalls = host.stalls();
  out.happened = faulty.happened(fault.kind) - (fault.kind == FaultKind::kUnplug ? 1 : 0);
  out.decoded = test::decode_trace(out.trace, {}, true);
  StrokeSampler sampler;
  const auto keep = [&](Stroke& stroke) { out.strokes.push_back(stroke); };
  for (const PenSample& sample : out.decoded.samples) sampler.push(sample, keep);
  sampler.finish(keep);
  return out;
}

std::string_view movement_of(const SimulatedInfo& info) {
  return info.kind == SimulatedKind::kPen ? "circle" : "push";
}

/// Each report fault often, each fault of the device in mid-stroke.
FaultSpec severe(FaultKind kind) {
  FaultSpec fault = faults()[static_cast<std::size_t>(kind)].usual;
  if (fault.probability < 1) fault.probability = 0.2;
  return fault;
}

/// No 3D mouse is left moving or pressed, and what was lost is told.
void expect_rest_at_the_end(const std::string& trace) {
  limn::TraceDecoder decoder(*open_trace(memory_bytes(trace)), {.salvage = true});
  std::map<DeviceIndex, Drag> last;
  std::map<DeviceIndex, bool> pressed;
  DragSampler drags;
  std::uint64_t lost = 0;
  for (;;) {
    const auto sample = decoder.next_any();
    ASSERT_TRUE(sample) << sample.error().what;
    const auto* const motion = std::get_if<const MotionSample*>(&*sample);
    if (motion == nullptr) break;
    last[(*motion)->device] = drags.push(**motion);
    pressed[(*motion)->device] = !(*motion)->buttons.empty();
    lost += (*motion)->lost;
  }
  for (const auto& [device, drag] : last) {
    EXPECT_EQ(drag.mm_per_s, (std::array<double, 3>{})) << device;
    EXPECT_EQ(drag.rad_per_s, (std::array<double, 3>{})) << device;
    EXPECT_FALSE(pressed[device]) << device;
  }
  EXPECT_EQ(decoder.summary().losses().lost, lost);
}

/// One case a device, so that ctest does not start a program for each of the pairs.
class EachFaultOf : public testing::TestWithParam<SimulatedInfo> {};

TEST_P(EachFaultOf, DoesNoHarm) {
  const SimulatedInfo& info = GetParam();
  for (const FaultInfo& fault : faults()) {
    SCOPED_TRACE(fault.name);
    const Session found = session(info.name, movement_of(info), severe(fault.usual.kind));
    EXPECT_GT(found.happened, 0U) << "or nothing was tested";
    EXPECT_FALSE(found.decoded.failed) << found.decoded.error.what << " " << found.decoded.error.at;
    test::expect_legal_transitions(found.decoded.samples);
    // No pen is left in range, so every stroke was closed by a lift.
    std::map<DeviceIndex, PenState> last;
    for (const PenSample& sample : found.decoded.samples) last[sample.device] = sample.state;
    for (const auto& [device, state] : last) EXPECT_EQ(state, PenState::kOutOfRange) << device;
    for (const Stroke& stroke : found.strokes) {
      EXPECT_TRUE(stroke.closed_by_lift);
      EXPECT_FALSE(stroke.points.empty());
    }
    if (info.kind == SimulatedKind::k3dMouse) {
      EXPECT_THAT(found.decoded.samples, SizeIs(0)) << "no pen's";
      expect_rest_at_the_end(found.trace);
    }
  }
}

TEST_P(EachFaultOf, HappensTheSameEachTime) {
  const SimulatedInfo& info = GetParam();
  for (const FaultInfo& fault : faults()) {
    const FaultSpec spec = severe(fault.usual.kind);
    const std::string first = session(info.name, movement_of(info), spec).trace;
    EXPECT_EQ(session(info.name, movement_of(info), spec).trace, first) << fault.name;
  }
}

std::string name_of(const testing::TestParamInfo<SimulatedInfo>& tested) {
  std::string name(tested.param.name);
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Faults, EachFaultOf, testing::ValuesIn(simulated_devices()), name_of);

FaultSpec at(FaultKind kind, std::chrono::microseconds time, std::uint32_t count = 1) {
  FaultSpec fault = faults()[static_cast<std::size_t>(kind)].usual;
  fault.at = time;
  fault.count = count;
  fault.probability = 1;
  return fault;
}

std::vector<std::vector<std::uint8_t>> bytes_of(const Session& session) {
  std::vector<std::vector<std::uint8_t>> bytes;
  for (const auto& report : session.reports) bytes.push_back(report.bytes);
  return bytes;
}

/// The circle drawn with the generic pen, as nothing goes wrong.
const std::vector<std::vector<std::uint8_t>>& undisturbed() {
  static const auto bytes = bytes_of(session("pen", "circle", at(FaultKind::kDrop, 24h)));
  return bytes;
}

/// What the samples say of losses.
struct Told {
  std::uint64_t lost = 0;
  std::map<Disturbance, int> disturbances;
};

Told told(const Session& session) {
  Told out;
  for (const PenSample& sample : session.decoded.samples) {
    out.lost += sample.lost;
    for (unsigned i = 0; i < kDisturbanceCount; ++i) {
      const auto one = static_cast<Disturbance>(1U << i);
      if (sample.disturbances.has(one)) ++out.disturbances[one];
    }
  }
  return out;
}

constexpr auto kInStroke = 1500ms;  // of the circle

TEST(FaultyDevice, LostReportsAreCountedByTheScanTime) {
  for (const std::uint32_t count : {1U, 2U, 9U}) {
    const Session found = session("pen", "circle", at(FaultKind::kDrop, kInStroke, count));
    EXPECT_THAT(found.reports, SizeIs(undisturbed().size() - count));
    EXPECT_EQ(told(found).lost, count);
    EXPECT_EQ(told(found).disturbances[Disturbance::kGap], 1);
  }
  const Session fast = session("fast-pen", "circle", at(FaultKind::kDrop, kInStroke, 7));
  EXPECT_EQ(told(fast).lost, 7U);
}

// At landings, lifts and leavings a step is no step of one pace, and nothing can be counted there.
TEST(FaultyDevice, ScatteredLossesAreNeverCountedTooHighAndMostlyAll) {
  for (const std::string_view name : {"pen", "fast-pen"}) {
    FaultSpec fault = at(FaultKind::kDrop, 0s, 1000000);
    fault.probability = 0.02;
    const Session found = session(name, "teapot", fault);
    ASSERT_GT(found.happened, 20U);
    EXPECT_LE(told(found).lost, found.happened) << name;
    EXPECT_GE(told(found).lost, found.happened * 8 / 10) << name;
  }
}

TEST(FaultyDevice, AHaltedEndpointLosesOneReportAndGoesOn) {
  const Session found = session("pen", "circle", at(FaultKind::kStall, kInStroke));
  EXPECT_EQ(found.stalls, 1);
  EXPECT_THAT(found.reports, SizeIs(undisturbed().size() - 1));
  EXPECT_EQ(told(found).lost, 1U);
}

TEST(FaultyDevice, DuplicatesAndReordersGiveTheSameReports) {
  const Session twice = session("pen", "circle", at(FaultKind::kDuplicate, kInStroke));
  auto bytes = bytes_of(twice);
  ASSERT_THAT(bytes, SizeIs(undisturbed().size() + 1));
  EXPECT_NE(std::adjacent_find(bytes.begin(), bytes.end()), bytes.end());
  bytes.erase(std::adjacent_find(bytes.begin(), bytes.end()));
  EXPECT_EQ(bytes, undisturbed());

  auto swapped = bytes_of(session("pen", "circle", at(FaultKind::kReorder, kInStroke)));
  ASSERT_THAT(swapped, SizeIs(undisturbed().size()));
  EXPECT_NE(swapped, undisturbed());
  EXPECT_THAT(swapped, testing::UnorderedElementsAreArray(undisturbed()));
}

TEST(FaultyDevice, SpoiledReportsDifferInWhatTheirNameSays) {
  const auto different = [](FaultKind kind) {
    const auto bytes = bytes_of(session("pen", "circle", at(kind, kInStroke)));
    EXPECT_THAT(bytes, SizeIs(undisturbed().size()));
    std::vector<std::pair<std::vector<std::uint8_t>, std::vector<std::uint8_t>>> found;
    for (std::size_t i = 0; i < std::min(bytes.size(), undisturbed().size()); ++i) {
      if (bytes[i] != undisturbed()[i]) found.emplace_back(undisturbed()[i], bytes[i]);
    }
    EXPECT_THAT(found, SizeIs(1));
    return found.at(0);
  };
  const auto [whole, cut] = different(FaultKind::kShort);
  EXPECT_LT(cut.size(), whole.size());
  EXPECT_TRUE(std::equal(cut.begin(), cut.end(), whole.begin()));
  const auto [plain, longer] = different(FaultKind::kOverlong);
  EXPECT_GT(longer.size(), plain.size());
  EXPECT_TRUE(std::equal(plain.begin(), plain.end(), longer.begin()));
  const auto [right, wrong] = different(FaultKind::kWrongId);
  EXPECT_NE(right[0], wrong[0]);
  EXPECT_TRUE(std::equal(right.begin() + 1, right.end(), wrong.begin() + 1, wrong.end()));
  const auto [sense, garbage] = different(FaultKind::kGarbage);
  EXPECT_EQ(sense[0], garbage[0]);
  EXPECT_EQ(sense.size(), garbage.size());
}

TEST(FaultyDevice, UnpluggingInMidStrokeClosesItAndIsToldAsAReset) {
  for (const SimulatedInfo& info : simulated_devices()) {
    if (info.kind != SimulatedKind::kPen) continue;
    const Session found = session(info.name, "circle", at(FaultKind::kUnplug, kInStroke));
    EXPECT_EQ(found.plugged_in, 2) << info.name;
    EXPECT_THAT(found.strokes, SizeIs(2)) << info.name << ": before and after";
    EXPECT_GE(told(found).disturbances[Disturbance::kReset], 1) << info.name;
  }
}

TEST(FaultyDevice, AnsweringNothingForASecondLosesWhatTheDeviceCannotHold) {
  const Session slow = session("pen", "circle", at(FaultKind::kTimeout, kInStroke));
  EXPECT_EQ(bytes_of(slow), undisturbed()) << "200 reports wait";
  const Session fast = session("fast-pen", "circle", at(FaultKind::kTimeout, kInStroke));
  // Of the measurements of a second, both ends counted, 256 are held.
  EXPECT_EQ(told(fast).lost, 1001U - 256U);
}

TEST(FaultyDevice, ABatchComesAllAtOnceAndLosesNothing) {
  const Session found = session("pen", "circle", at(FaultKind::kBatch, kInStroke));
  EXPECT_THAT(bytes_of(found), ElementsAreArray(undisturbed()));
  std::map<std::chrono::microseconds, int> at_once;
  for (const auto& report : found.reports) ++at_once[report.time];
  int most = 0;
  for (const auto& [time, count] : at_once) most = std::max(most, count);
  EXPECT_GE(most, 19);
  EXPECT_EQ(told(found).lost, 0U);
}

TEST(FaultyDevice, AFloodIsOneReportTwoThousandTimes) {
  const Session found = session("pen", "circle", at(FaultKind::kFlood, kInStroke));
  EXPECT_THAT(found.reports, SizeIs(undisturbed().size() + FaultyDevice::kFloodReports - 1));
}

TEST(FaultyDevice, AnOrphanedExitGivesNoStroke) {
  const Session found = session("pen", "circle", at(FaultKind::kOrphanExit, 0ms));
  ASSERT_THAT(found.reports, SizeIs(1)) << "all of the drawing is one approach";
  EXPECT_EQ(found.reports.back().bytes, undisturbed().back());
  EXPECT_THAT(found.strokes, SizeIs(0));
}

TEST(FaultyDevice, AStuckTipEndsWithTheDevice) {
  const Session found = session("pen", "circle", at(FaultKind::kStuckTip, kInStroke, 100000));
  EXPECT_THAT(found.reports, SizeIs(undisturbed().size()));
  EXPECT_EQ(found.reports.back().bytes, found.reports[found.reports.size() - 50].bytes);
  EXPECT_THAT(found.strokes, SizeIs(1));
}

TEST(FaultyDevice, AClockThatJumpsIsTold) {
  const Session found = session("pen", "spiral", at(FaultKind::kTimeJump, kInStroke));
  Told said = told(found);
  EXPECT_EQ(said.disturbances[Disturbance::kClockJump] + said.disturbances[Disturbance::kGap], 1);
}

TEST(FaultyDevice, AModeChangeMakesATabletAMouseAgain) {
  const Session found = session("huion", "circle", at(FaultKind::kModeChange, kInStroke));
  EXPECT_EQ(found.plugged_in, 1) << "the host sees nothing of it";
  EXPECT_EQ(found.reports.front().interface, 0);
  EXPECT_EQ(found.reports.back().interface, 1);
}

TEST(FaultyDevice, AHostileDescriptorIsTheSameAtEachReading) {
  const auto device = make_simulated_device("pen", "circle", 1);
  FaultSpec fault = severe(FaultKind::kHostileDescriptor);
  FaultyDevice faulty(device->bus(), {&fault, 1});
  const SetupPacket read{0x81, 6, 0x2200, 0, 4096};
  const auto spoiled = test::ask(faulty, read);
  EXPECT_NE(spoiled, test::ask(device->bus(), read));
  EXPECT_EQ(spoiled, test::ask(faulty, read));
}

}  // namespace
}  // namespace limn::firmware
