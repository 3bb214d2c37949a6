#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "drivers/devices/device_traits.hpp"
#include "drivers/devices/evdev_motion_decoder.hpp"
#include "drivers/devices/motion_decoder.hpp"
#include "input/stroke/drag_velocity.hpp"
#include "tests/support/alloc_guard.hpp"
#include "tests/unit/drivers/devices_support.hpp"
#include "tests/unit/drivers/hid_items.hpp"

namespace limn {
namespace {

using namespace std::chrono_literals;
using test::ReportBytes;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Six = std::array<double, kMotionAxes>;
using Counts = std::array<std::int32_t, kMotionAxes>;

constexpr std::uint16_t kLogitech = 0x046D;
constexpr std::uint16_t kNavigator = 0xC626;
constexpr std::uint16_t k3dconnexion = 0x256F;
constexpr std::uint16_t kEnterprise = 0xC633;

/// A decoder and what it gave.
class Decoded3dMouse {
 public:
  explicit Decoded3dMouse(std::uint16_t vendor = kLogitech, std::uint16_t product = kNavigator,
                          std::span<const std::uint8_t> descriptor = {})
      : decoder_(checked(MotionDecoder::make(vendor, product, descriptor))) {}

  /// The last sample of a report.
  MotionSample operator()(const ReportBytes& bytes, Timestamp time = {}) {
    const auto decoded = decoder_.decode(Report{3, time, bytes});
    kind_ = decoded.kind;
    count_ = decoded.samples.size();
    return count_ == 0 ? MotionSample() : decoded.samples.back();
  }
  ReportClass kind() const { return kind_; }
  std::size_t count() const { return count_; }
  MotionDecoder& decoder() { return decoder_; }

 private:
  MotionDecoder decoder_;
  ReportClass kind_ = ReportClass::kOther;
  std::size_t count_ = 0;

  static MotionDecoder checked(Expected<MotionDecoder> made) {
    EXPECT_TRUE(made) << made.error().what;
    return *std::move(made);
  }
};

std::vector<unsigned> pressed(const MotionSample& sample) {
  std::vector<unsigned> numbers;
  sample.buttons.for_each([&numbers](unsigned number) { numbers.push_back(number); });
  return numbers;
}

/// A Multi-axis Controller with `axes` axes of 16 bits and this range in report 1 of no ID, and
/// three buttons in front of them.
hid::test::Items controller(std::uint32_t axes, std::int64_t most) {
  hid::test::Items items;
  items.usage_page(hid::page::kGenericDesktop).usage(8).collection(1);
  items.usage_page(hid::page::kButton).usages(1, 3).logical(0, 1).report_size(1).report_count(3);
  items.input(0x02).report_size(5).report_count(1).input(0x03);
  items.usage_page(hid::page::kGenericDesktop);
  for (std::uint32_t i = 0; i < axes; ++i) items.usage(0x30 + i);
  items.logical(-most, most).report_size(16).report_count(axes).input(0x06).end_collection();
  return items;
}

TEST(MotionSpecs, IdsAreUniqueAndRowsSayWhatTheyRestOn) {
  std::set<std::pair<int, int>> ids;
  for (const MotionSpec& spec : motion_specs()) {
    EXPECT_TRUE(ids.emplace(spec.vendor, spec.product).second) << spec.name;
    EXPECT_FALSE(spec.name.empty());
    EXPECT_FALSE(spec.evidence.empty()) << spec.name;
    EXPECT_EQ(find_motion_spec(spec.vendor, spec.product), &spec);
    EXPECT_TRUE(MotionDecoder::make(spec.vendor, spec.product, {})) << spec.name;
  }
  EXPECT_EQ(find_motion_spec(kLogitech, 0xC077), nullptr) << "an ordinary mouse";
}

TEST(MotionDecoder, HalvesComeInTurnInTheFrameOfTheModeler) {
  Decoded3dMouse mouse;
  // 350 to the right, 175 towards the user, 70 down.
  const MotionSample moved = mouse({1, 0x5E, 0x01, 0xAF, 0x00, 0x46, 0x00}, 8ms);
  EXPECT_EQ(mouse.kind(), ReportClass::kMotion);
  EXPECT_EQ(moved.deflection, (Six{1, -0.5, -0.2, 0, 0, 0}));
  EXPECT_EQ(moved.raw, (Counts{350, 175, 70, 0, 0, 0}));
  EXPECT_EQ(moved.time, 8ms);
  EXPECT_EQ(moved.device, 3U);
  EXPECT_TRUE(moved.translation_told);
  EXPECT_FALSE(moved.rotation_told);
  EXPECT_TRUE(moved.rests_exactly);
  const MotionSample turned = mouse({2, 0x00, 0x00, 0xA2, 0xFE, 0x00, 0x00}, 16ms);
  EXPECT_EQ(turned.deflection, (Six{1, -0.5, -0.2, 0, 1, 0}));
  EXPECT_FALSE(turned.translation_told);
  EXPECT_TRUE(turned.rotation_told);
}

TEST(MotionDecoder, ReportsOf13BytesHoldAllSix) {
  Decoded3dMouse mouse;
  const MotionSample moved =
      mouse({1, 0x23, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xDD, 0xFF});
  EXPECT_EQ(moved.raw, (Counts{35, 0, 0, 0, 0, -35}));
  EXPECT_EQ(moved.deflection, (Six{0.1, 0, 0, 0, 0, 0.1}));
  EXPECT_TRUE(moved.translation_told);
  EXPECT_TRUE(moved.rotation_told);
}

TEST(MotionDecoder, WhatIsBeyondTheRangeIsNotClamped) {
  Decoded3dMouse mouse;
  EXPECT_DOUBLE_EQ(mouse({1, 0xF2, 0x01, 0, 0, 0, 0}).deflection[0], 498.0 / 350);
}

TEST(MotionDecoder, ButtonsAreNumberedFromOne) {
  Decoded3dMouse mouse;
  EXPECT_THAT(pressed(mouse({3, 0x02, 0x80})), ElementsAre(2, 16));
  EXPECT_THAT(pressed(mouse({3, 0x00, 0x00})), IsEmpty());
  EXPECT_EQ(mouse.kind(), ReportClass::kMotion);
}

TEST(MotionDecoder, AnEnterpriseNamesThePressedButtons) {
  Decoded3dMouse mouse(k3dconnexion, kEnterprise);
  EXPECT_THAT(pressed(mouse({0x1C, 0xB0, 0, 13, 0, 0, 0, 0, 0, 0, 0, 0, 0})), ElementsAre(13, 176));
  // 0xFFFF is no button of anything.
  EXPECT_THAT(pressed(mouse({0x1C, 0xFF, 0xFF, 13, 0, 0, 0, 0, 0, 0, 0, 0, 0})), ElementsAre(13));
  EXPECT_THAT(pressed(mouse({0x1C, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0})), IsEmpty());
}

TEST(MotionDecoder, TheBatteryIsAPercentage) {
  Decoded3dMouse mouse(k3dconnexion, 0xC62E);
  EXPECT_EQ(mouse({0x17, 84, 1}).battery_percent, 84);
  EXPECT_EQ(mouse.kind(), ReportClass::kStatus);
  EXPECT_FALSE(mouse({0x17, 200, 1}).battery_percent);
  EXPECT_FALSE(mouse({3, 0, 0}).battery_percent) << "told once";
}

TEST(MotionDecoder, HalvesThatAreCutOffStayAsTheyWere) {
  Decoded3dMouse mouse;
  mouse({1, 1, 0, 2, 0, 3, 0});
  EXPECT_EQ(mouse({1, 9, 0, 9, 0}).raw, Counts{});
  EXPECT_EQ(mouse.kind(), ReportClass::kTooShort);
  EXPECT_EQ(mouse.count(), 0U);
  EXPECT_EQ(mouse({3, 0, 0}).raw, (Counts{1, 2, 3, 0, 0, 0}));
}

TEST(MotionDecoder, MoreThanSixAxesAreSix) {
  const auto seven = controller(7, 350);
  Decoded3dMouse mouse(0x1209, 1, seven.bytes());
  const MotionSample moved = mouse({0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0, 7, 0});
  EXPECT_EQ(moved.raw, (Counts{1, 2, 3, 4, 5, 6}));
}

TEST(MotionDecoder, FullDeflectionIsWhatTheDescriptorSays) {
  const auto of_500 = controller(6, 500);
  Decoded3dMouse mouse(0x1209, 1, of_500.bytes());
  const MotionSample moved = mouse({5, 0xFA, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(moved.deflection[0], 0.5);
  EXPECT_THAT(pressed(moved), ElementsAre(1, 3));
  EXPECT_FALSE(moved.rests_exactly) << "nobody knows";
  const auto whole_field = controller(6, 32767);
  Decoded3dMouse imitation(0x1209, 1, whole_field.bytes());
  EXPECT_EQ(imitation({0, 0x5E, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}).deflection[0], 1);
}

TEST(MotionDecoder, LogitechsFirstOnesPointElsewhere) {
  Decoded3dMouse mouse(kLogitech, 0xC603);
  EXPECT_EQ(mouse({1, 0, 0, 0x5E, 1, 0, 0}).deflection, (Six{0, 0, 1, 0, 0, 0})) << "Y is up";
}

TEST(MotionDecoder, SilenceInMidMotionEndsIt) {
  Decoded3dMouse mouse;
  mouse({1, 0x5E, 1, 0, 0, 0, 0}, 8ms);
  mouse({3, 1, 0}, 50ms);  // no news of the axes
  ASSERT_EQ(mouse.decoder().due(), Timestamp(108ms));
  EXPECT_THAT(mouse.decoder().advance(107ms), IsEmpty());
  const auto samples = mouse.decoder().advance(108ms);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_TRUE(samples[0].silence);
  EXPECT_TRUE(samples[0].is_zero());
  EXPECT_EQ(samples[0].time, 108ms);
  EXPECT_TRUE(samples[0].disturbances.has(Disturbance::kGap));
  EXPECT_EQ(samples[0].lost, 1U);
  EXPECT_THAT(pressed(samples[0]), ElementsAre(1)) << "buttons are told when they change";
  EXPECT_FALSE(mouse.decoder().due());
}

TEST(MotionDecoder, ALateReportComesBehindTheSilenceThatItEnds) {
  Decoded3dMouse mouse;
  mouse({1, 0x5E, 1, 0, 0, 0, 0}, 8ms);
  const MotionSample late = mouse({1, 0x5E, 1, 0, 0, 0, 0}, 500ms);
  EXPECT_EQ(mouse.count(), 2U);
  EXPECT_EQ(late.time, 500ms);
  EXPECT_FALSE(late.silence);
  EXPECT_TRUE(late.disturbances.empty());
}

TEST(MotionDecoder, RestIsSilenceToo) {
  Decoded3dMouse mouse;
  mouse({1, 0x5E, 1, 0, 0, 0, 0}, 8ms);
  mouse({1, 0, 0, 0, 0, 0, 0}, 16ms);
  EXPECT_FALSE(mouse.decoder().due());
}

TEST(MotionDecoder, WhoIsUnpluggedIsReleased) {
  Decoded3dMouse mouse;
  mouse({3, 1, 0}, 1ms);
  const auto samples = mouse.decoder().disconnect(3, 5ms);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_THAT(pressed(samples[0]), IsEmpty());
  EXPECT_EQ(samples[0].lost, 0U);
  EXPECT_THAT(mouse.decoder().disconnect(3, 6ms), IsEmpty());
}

TEST(MotionDecoder, ReportsOfWhichNothingIsPublishedArePassedOver) {
  Decoded3dMouse mouse;
  mouse({0x1D, 1, 2, 3});
  EXPECT_EQ(mouse.kind(), ReportClass::kOther);
  mouse({});
  EXPECT_EQ(mouse.count(), 0U);
}

TEST(MotionDecoder, WhatIsNo3dMouseIsRefused) {
  const auto made = MotionDecoder::make(0x1209, 1, {});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kMissing);
  const ReportBytes broken = {0xC0};
  ASSERT_FALSE(MotionDecoder::make(0x1209, 1, broken));
  EXPECT_TRUE(MotionDecoder::make(kLogitech, kNavigator, broken)) << "its ids are enough";
}

TEST(MotionDecoder, AReportAllocatesNothing) {
  Decoded3dMouse mouse;
  const ReportBytes report = {1, 0x5E, 1, 0, 0, 0, 0};
  const test::AllocGuard guard;
  for (int i = 0; i < 1000; ++i) mouse(report, i * 1ms);
  EXPECT_EQ(guard.count(), 0U);
}

TraceDevice node(std::uint16_t vendor, std::uint16_t product, std::int32_t most) {
  TraceDevice device;
  device.vendor = vendor;
  device.product = product;
  for (std::uint16_t code = 0; code < kMotionAxes; ++code) {
    device.axes.push_back({code, -most, most, 0, 0, 0});
  }
  return device;
}

/// Hands frames to a decoder.
class DecodedNode {
 public:
  explicit DecodedNode(const TraceDevice& device) : decoder(device) {}
  MotionSample operator()(Timestamp time, std::vector<EvdevEvent> events) {
    for (EvdevEvent& event : events) event.time = time;
    const auto samples = decoder.decode(EvdevFrame{0, time, events});
    count = samples.size();
    return samples.empty() ? MotionSample() : samples.back();
  }
  EvdevMotionDecoder decoder;
  std::size_t count = 0;
};

constexpr std::uint16_t kRel = 2;
constexpr std::uint16_t kAbs = 3;

TEST(EvdevMotionDecoder, AbsoluteAxesAreHeld) {
  DecodedNode mouse(node(k3dconnexion, 0xC62E, 350));
  EXPECT_EQ(mouse(1ms, {{{}, kAbs, 1, -350}}).deflection, (Six{0, 1, 0, 0, 0, 0}));
  const MotionSample both = mouse(9s, {{{}, kAbs, 5, 35}});
  EXPECT_EQ(both.deflection, (Six{0, 1, 0, 0, 0, -0.1}));
  EXPECT_FALSE(both.translation_told);
  EXPECT_EQ(mouse.decoder.due(), Timestamp(69s)) << "the kernel tells no more than changes";
  const auto end = mouse.decoder.advance(69s);
  ASSERT_EQ(end.size(), 1U);
  EXPECT_TRUE(end[0].silence);
  EXPECT_TRUE(end[0].disturbances.has(Disturbance::kGap));
  EXPECT_FALSE(mouse.decoder.due());
}

TEST(EvdevMotionDecoder, RelativeAxesAreDeflectionsThatNeverTellZero) {
  TraceDevice device = node(kLogitech, kNavigator, 0);
  device.axes.clear();
  DecodedNode mouse(device);
  EXPECT_EQ(mouse(8ms, {{{}, kRel, 0, 35}, {{}, kRel, 1, 70}}).raw, (Counts{35, 70, 0, 0, 0, 0}));
  EXPECT_EQ(mouse(16ms, {{{}, kRel, 3, 7}}).raw, (Counts{35, 70, 0, 7, 0, 0}));
  EXPECT_EQ(mouse(24ms, {{{}, kRel, 0, 35}}).raw, (Counts{35, 0, 0, 7, 0, 0})) << "y was let go";
  EXPECT_EQ(mouse(40ms, {{{}, kRel, 0, 36}}).raw, (Counts{36, 0, 0, 7, 0, 0}));
  EXPECT_EQ(mouse(56ms, {{{}, kRel, 0, 36}}).raw, (Counts{36, 0, 0, 0, 0, 0})) << "rx as well";
  ASSERT_EQ(mouse.decoder.due(), Timestamp(96ms));
  const auto end = mouse.decoder.advance(96ms);
  ASSERT_EQ(end.size(), 1U);
  EXPECT_TRUE(end[0].is_zero());
  EXPECT_TRUE(end[0].silence);
  EXPECT_TRUE(end[0].disturbances.empty()) << "that is how they rest";
  EXPECT_FALSE(mouse.decoder.due());
}

TEST(EvdevMotionDecoder, ARangeThatIsTheWholeFieldSaysNothing) {
  DecodedNode mouse(node(k3dconnexion, 0xC62E, 32767));
  EXPECT_EQ(mouse(1ms, {{{}, kAbs, 0, 350}}).deflection[0], 1);
}

TEST(EvdevMotionDecoder, WhatItReleasesIsAtRest) {
  DragVelocity drag;
  DecodedNode absolute(node(k3dconnexion, 0xC62E, 350));
  EXPECT_FALSE(drag.push(absolute(1ms, {{{}, kAbs, 0, 350}})).at_rest);
  EXPECT_TRUE(drag.push(absolute(9ms, {{{}, kAbs, 0, 0}})).at_rest) << "zeros come once";
  TraceDevice device = node(kLogitech, kNavigator, 0);
  device.axes.clear();
  DecodedNode relative(device);
  DragVelocity other;
  EXPECT_FALSE(other.push(relative(8ms, {{{}, kRel, 0, 35}})).at_rest);
  EXPECT_TRUE(other.push(relative.decoder.advance(48ms).front()).at_rest);
}

TEST(EvdevMotionDecoder, ButtonsComeFromBtn0On) {
  DecodedNode mouse(node(k3dconnexion, 0xC62E, 350));
  EXPECT_THAT(pressed(mouse(1ms, {{{}, 1, 0x101, 1}})), ElementsAre(2));
  EXPECT_THAT(pressed(mouse(2ms, {{{}, 1, 0x101, 0}})), IsEmpty());
  mouse(3ms, {{{}, 4, 4, 1}});
  EXPECT_EQ(mouse.count, 0U) << "a scan code moves nothing";
}

TEST(EvdevMotionDecoder, WhatTheKernelLostIsTold) {
  DecodedNode mouse(node(k3dconnexion, 0xC62E, 350));
  mouse(1ms, {{{}, 0, 3, 0}, {{}, kAbs, 0, 99}});
  EXPECT_EQ(mouse.count, 0U);
  const MotionSample next = mouse(2ms, {{{}, kAbs, 1, 35}});
  EXPECT_EQ(next.raw[0], 0);
  EXPECT_EQ(next.lost, 1U);
  EXPECT_TRUE(next.disturbances.has(Disturbance::kOverrun));
}

TEST(EvdevMotionDecoder, SpacenavdHasAFrameOfItsOwn) {
  TraceDevice device = node(0, 0, 0);
  device.physical_path = kSpacenavdPath;
  ASSERT_TRUE(is_3d_mouse(device));
  DecodedNode mouse(device);
  // Right, up, away.
  EXPECT_EQ(mouse(1ms, {{{}, kAbs, 0, 500}, {{}, kAbs, 1, 250}, {{}, kAbs, 2, 50}}).deflection,
            (Six{1, 0.1, 0.5, 0, 0, 0}));
}

/// All samples of a trace, pens' by their x, 3D mice' by their deflection to the right.
std::vector<double> all_of(std::string_view text, TraceSummary* summary = nullptr) {
  TraceDecoder decoder(*open_trace(memory_bytes(text)));
  std::vector<double> values;
  for (;;) {
    const auto sample = decoder.next_any();
    EXPECT_TRUE(sample) << sample.error().what;
    if (!sample || std::holds_alternative<std::monostate>(*sample)) break;
    const auto* const motion = std::get_if<const MotionSample*>(&*sample);
    values.push_back(motion != nullptr ? (*motion)->deflection[0]
                                       : std::get<const PenSample*>(*sample)->x_mm);
  }
  if (summary != nullptr) *summary = decoder.summary();
  return values;
}

constexpr std::string_view kPenAndMice =
    "D: 0\nN: pen\nI: 3 056a 0013\n"
    "D: 1\nN: mouse\nI: 3 046d c626\n"
    "D: 2\nN: mouse\nI: 3 256f c635\n"
    "D: 0\nE: 1.0 8 02 90 40 1f 20 03 00 00\n"
    "D: 1\nE: 1.1 7 01 5e 01 00 00 00 00\n"
    "D: 2\nE: 1.1 7 01 af 00 00 00 00 00\n"
    "D: 2\nE: 1.15 7 01 00 00 00 00 00 00\n"
    "D: 0\nE: 2.0 8 02 91 40 1f 20 03 ff 01\n";

TEST(TraceDecoder, PensAndTwo3dMiceAreDecodedSideBySide) {
  TraceSummary summary;
  // The first mouse falls silent while pushed: it ends before the pen goes on.
  EXPECT_THAT(all_of(kPenAndMice, &summary), ElementsAre(100, 1, 0.5, 0, 100, 0));
  ASSERT_EQ(summary.devices.size(), 3U);
  EXPECT_EQ(summary.devices[1].kind, "3D mouse");
  EXPECT_EQ(summary.devices[1].samples, 2U);
  EXPECT_EQ(summary.devices[1].losses.gaps, 1U);
  EXPECT_EQ(summary.devices[2].count(ReportClass::kMotion), 2U);
  EXPECT_EQ(summary.samples, 6U);
}

TEST(TraceDecoder, WhoAsksForPensGetsThemAlone) {
  const test::DecodedTrace trace = test::decode_trace(kPenAndMice);
  ASSERT_FALSE(trace.failed) << trace.error.what;
  EXPECT_EQ(trace.samples.size(), 2U);
}

TEST(TraceDecoder, AnUnpluggedMouseIsReleasedAndLossIsTold) {
  TraceDecoder decoder(
      *open_trace(memory_bytes("N: mouse\nI: 3 046d c626\n"
                               "E: 1.0 7 01 5e 01 00 00 00 00\n"
                               "#limn gone\n#limn lost 3\n"
                               "E: 2.0 7 01 af 00 00 00 00 00\n"
                               "E: 2.008 7 01 00 00 00 00 00 00\n")));
  std::vector<MotionSample> samples;
  for (;;) {
    const auto sample = decoder.next_any();
    ASSERT_TRUE(sample) << sample.error().what;
    if (std::holds_alternative<std::monostate>(*sample)) break;
    samples.push_back(*std::get<const MotionSample*>(*sample));
  }
  ASSERT_EQ(samples.size(), 4U);
  EXPECT_TRUE(samples[1].silence);
  EXPECT_TRUE(samples[1].disturbances.has(Disturbance::kReset));
  EXPECT_EQ(samples[2].lost, 3U);
  EXPECT_TRUE(samples[2].disturbances.has(Disturbance::kOverrun));
  EXPECT_TRUE(samples[3].disturbances.empty());
}

TEST(TraceDecoder, ADescriptorThatIsNo3dMousesDecides) {
  // The SpaceNavigator's ids on a device of no axes: nothing is decoded, nothing is wrong.
  EXPECT_THAT(all_of("R: 15 05 01 09 06 a1 01 75 08 95 01 09 30 81 02 c0\n"
                     "I: 3 046d c626\nE: 1.0 7 01 5e 01 00 00 00 00\n"),
              IsEmpty());
}

}  // namespace
}  // namespace limn
