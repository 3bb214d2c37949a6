#include "firmware_sim/devices/pen_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "drivers/devices/pen_decoder.hpp"
#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/pen_layout.hpp"
#include "firmware_sim/devices/hand.hpp"

namespace limn::firmware {
namespace {

using testing::IsEmpty;
using testing::Not;
using namespace std::chrono_literals;

/// The stream as the independent decoder in drivers/hid reads it.
struct Seen {
  std::chrono::microseconds time{};
  bool in_range = false, tip = false, invert = false, eraser = false;
  double x_mm = 0, y_mm = 0, pressure = 0, tilt_x_rad = 0, tilt_y_rad = 0;
  bool touching() const { return tip || eraser; }
};

std::vector<TimedReport> reports(const Drawing& drawing, std::uint64_t seed) {
  PenSession session(drawing, seed);
  std::vector<TimedReport> all;
  for (TimedReport report; session.next(report);) all.push_back(report);
  return all;
}

std::vector<Seen> decode(const std::vector<TimedReport>& reports) {
  const auto descriptor = hid::parse_descriptor(HidPen::report_descriptor());
  const auto pen = hid::pen_layouts(descriptor.value()).at(0);
  std::vector<Seen> all;
  for (const TimedReport& report : reports) {
    const auto value = [&](const hid::AxisReader& axis) {
      return axis.map(axis.reader.read(report.bytes).value());
    };
    all.push_back({report.time, pen.in_range.is_set(report.bytes),
                   pen.tip_switch.is_set(report.bytes), pen.invert.is_set(report.bytes),
                   pen.eraser.is_set(report.bytes), value(pen.x), value(pen.y), value(pen.pressure),
                   value(pen.tilt_x), value(pen.tilt_y)});
  }
  return all;
}

/// FNV-1a of times and bytes.
std::uint64_t fingerprint(const std::vector<TimedReport>& reports) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  const auto add = [&](std::uint8_t byte) { hash = (hash ^ byte) * 0x100000001B3U; };
  for (const TimedReport& report : reports) {
    for (int i = 0; i < 8; ++i) add(static_cast<std::uint8_t>(report.time.count() >> (8 * i)));
    for (const std::uint8_t byte : report.bytes) add(byte);
  }
  return hash;
}

class EachDrawing : public testing::TestWithParam<std::string> {
 protected:
  const Drawing drawing_ = find_drawing(GetParam()).value();
  const std::vector<TimedReport> reports_ = reports(drawing_, 1);
  const std::vector<Seen> seen_ = decode(reports_);
};

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const DrawingInfo& info : drawings()) all.emplace_back(info.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Drawings, EachDrawing, testing::ValuesIn(names()),
                         [](const auto& name) { return name.param; });

TEST_P(EachDrawing, ComesAtExactly200ReportsASecondWhileInRange) {
  for (std::size_t i = 1; i < seen_.size(); ++i) {
    const auto interval = seen_[i].time - seen_[i - 1].time;
    if (seen_[i - 1].in_range) {
      ASSERT_EQ(interval, 5ms) << "report " << i;
    } else {
      ASSERT_GT(interval, 5ms) << "silence follows the pen's leaving";
      ASSERT_EQ(interval % 5ms, 0ms);
    }
  }
}

TEST_P(EachDrawing, MakesOnlyTheTransitionsOfRealPens) {
  enum State { kAway, kHovering, kTouching, kHoveringInverted, kErasing };
  const std::set<std::pair<State, State>> legal = {{kAway, kHovering},
                                                   {kHovering, kTouching},
                                                   {kTouching, kHovering},
                                                   {kHovering, kAway},
                                                   {kAway, kHoveringInverted},
                                                   {kHoveringInverted, kErasing},
                                                   {kErasing, kHoveringInverted},
                                                   {kHoveringInverted, kAway}};
  State state = kAway;
  for (const Seen& now : seen_) {
    ASSERT_FALSE(now.tip && now.eraser);
    ASSERT_TRUE(now.in_range || !(now.touching() || now.invert));
    ASSERT_EQ(now.invert || now.eraser, now.invert) << "an eraser touches inverted";
    ASSERT_EQ(now.touching(), now.pressure > 0);
    const State next = !now.in_range ? kAway
                       : now.eraser  ? kErasing
                       : now.invert  ? kHoveringInverted
                       : now.tip     ? kTouching
                                     : kHovering;
    ASSERT_TRUE(next == state || legal.contains({state, next})) << state << " to " << next;
    state = next;
  }
  EXPECT_EQ(state, kAway) << "the pen is put away in the end";
}

TEST_P(EachDrawing, HasOneContactAStrokeWithTheRightEnd) {
  std::vector<PenEnd> contacts;
  bool touched = false;
  for (const Seen& now : seen_) {
    if (now.touching() && !touched) contacts.push_back(now.tip ? PenEnd::kTip : PenEnd::kEraser);
    touched = now.touching();
  }
  std::vector<PenEnd> expected;
  for (const PenStroke& stroke : drawing_.strokes) expected.push_back(stroke.end);
  EXPECT_EQ(contacts, expected);
}

TEST_P(EachDrawing, StaysInsideTheAreaAtASensibleSize) {
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  for (const Seen& now : seen_) {
    ASSERT_GT(now.x_mm, 0) << "at the edge the sensor would cut the drawing off";
    ASSERT_LT(now.x_mm, HidPen::kWidthMm);
    ASSERT_GT(now.y_mm, 0);
    ASSERT_LT(now.y_mm, HidPen::kHeightMm);
    if (!now.touching()) continue;
    left = std::min(left, now.x_mm);
    right = std::max(right, now.x_mm);
    top = std::min(top, now.y_mm);
    bottom = std::max(bottom, now.y_mm);
  }
  EXPECT_GE(std::max(right - left, bottom - top), 60);
  EXPECT_LE(std::max(right - left, bottom - top), 150);
}

TEST_P(EachDrawing, PressureRisesAndFallsWithinItsRange) {
  double peak = 0;
  bool rising_from_light = true;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const Seen& now = seen_[i];
    ASSERT_LE(now.pressure, 1);
    if (!now.touching()) continue;
    if (i > 0 && !seen_[i - 1].touching()) rising_from_light &= now.pressure < 0.15;
    if (!seen_[i + 1].touching()) rising_from_light &= now.pressure < 0.15;
    peak = std::max(peak, now.pressure);
  }
  EXPECT_TRUE(rising_from_light);
  EXPECT_GT(peak, 0.4);
  EXPECT_LT(peak, 0.95);
}

TEST_P(EachDrawing, TiltIsThatOfARightHandAndMovesSmoothly) {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (!seen_[i].in_range) continue;
    ASSERT_GT(seen_[i].tilt_x_rad, 5 * kDegree);
    ASSERT_LT(seen_[i].tilt_x_rad, 45 * kDegree);
    ASSERT_GT(seen_[i].tilt_y_rad, 15 * kDegree);
    ASSERT_LT(seen_[i].tilt_y_rad, 50 * kDegree);
    if (i == 0 || !seen_[i - 1].in_range) continue;
    ASSERT_NEAR(seen_[i].tilt_x_rad, seen_[i - 1].tilt_x_rad, 0.4 * kDegree);
    ASSERT_NEAR(seen_[i].tilt_y_rad, seen_[i - 1].tilt_y_rad, 0.4 * kDegree);
  }
}

TEST_P(EachDrawing, TheHandIsAsFastAsHandsAre) {
  const Hand hand(drawing_);
  double fastest = 0;  // mm/s
  for (auto t = 0us; t + 5ms <= hand.duration(); t += 5ms) {
    const PenPose a = hand.pose(t);
    const PenPose b = hand.pose(t + 5ms);
    if (a.proximity != Proximity::kTouching || b.proximity != Proximity::kTouching) continue;
    fastest = std::max(fastest, std::hypot(b.x_mm - a.x_mm, b.y_mm - a.y_mm) / 0.005);
  }
  EXPECT_GT(fastest, 40);
  EXPECT_LT(fastest, 200);
}

TEST_P(EachDrawing, JitterIsWhiteAndTwoHundredthsOfAMillimetre) {
  const Hand hand(drawing_);
  double sum = 0, squares = 0, products = 0, cross = 0, previous = 0;
  std::size_t n = 0;
  for (const Seen& now : seen_) {
    if (!now.in_range) continue;
    const PenPose ideal = hand.pose(now.time);
    const double dx = now.x_mm - ideal.x_mm;
    const double dy = now.y_mm - ideal.y_mm;
    sum += dx + dy;
    squares += dx * dx + dy * dy;
    cross += dx * dy;
    products += dx * previous;
    previous = dx;
    ++n;
  }
  const double values = 2.0 * static_cast<double>(n);
  const double deviation = std::sqrt(squares / values);
  // Quantisation adds a count's 1/sqrt(12): 0.02005 mm in all. Five standard errors.
  EXPECT_NEAR(deviation, 0.02005, 5 * 0.02 / std::sqrt(2 * values));
  EXPECT_NEAR(sum / values, 0, 5 * 0.02 / std::sqrt(values));
  EXPECT_NEAR(cross / static_cast<double>(n), 0, 5 * 4e-4 / std::sqrt(n)) << "x and y independent";
  EXPECT_NEAR(products / static_cast<double>(n), 0, 5 * 4e-4 / std::sqrt(n)) << "and in time";
  RecordProperty("jitter_um", static_cast<int>(deviation * 1e3 + 0.5));
}

TEST_P(EachDrawing, CornersAreReachedAndRestedAt) {
  constexpr double kWithinJitter = 4 * PenSession::kJitterMm;
  const Hand hand(drawing_);
  for (const PenStroke& stroke : drawing_.strokes) {
    for (std::size_t i = 1; i < stroke.pieces.size(); ++i) {
      const PlanePoint corner = stroke.pieces[i].front();
      ASSERT_EQ(corner, stroke.pieces[i - 1].back()) << "pieces join";
      int resting = 0;
      for (const Seen& now : seen_) {
        const PenPose ideal = hand.pose(now.time);
        if (!now.touching() || ideal.x_mm != corner.x || ideal.y_mm != corner.y) continue;
        ++resting;
        ASSERT_NEAR(now.x_mm, corner.x, kWithinJitter);
        ASSERT_NEAR(now.y_mm, corner.y, kWithinJitter);
      }
      EXPECT_GE(resting, 11) << "60 ms at " << corner.x << ", " << corner.y;
    }
  }
}

TEST_P(EachDrawing, TheSameSeedGivesTheSameBytesAndAnotherSeedOthers) {
  EXPECT_EQ(fingerprint(reports(drawing_, 1)), fingerprint(reports_));
  const auto other = reports(drawing_, 2);
  EXPECT_NE(fingerprint(other), fingerprint(reports_));
  EXPECT_EQ(other.size(), reports_.size())
      << "the hand is the same, only the sensor's noise differs";
}

TEST_P(EachDrawing, TheDriverNeedsToRepairNothing) {
  auto decoder = PenDecoder::make(HidPen::kIdentity.vendor, HidPen::kIdentity.product,
                                  HidPen::report_descriptor());
  ASSERT_TRUE(decoder) << decoder.error().what;
  std::vector<PenSample> samples;
  for (const TimedReport& report : reports_) {
    decoder->decode(Report{0, report.time, report.bytes},
                    [&](const PenSample& sample) { samples.push_back(sample); });
  }
  EXPECT_EQ(decoder->repaired_transitions(), 0U);
  ASSERT_EQ(samples.size(), seen_.size()) << "one sample a report";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(in_contact(samples[i].state), seen_[i].touching());
    ASSERT_EQ(samples[i].lost, 0U);
    ASSERT_EQ(samples[i].x_mm, seen_[i].x_mm);
  }
}

TEST_P(EachDrawing, ReportsTakenOutAreCountedByTheScanTime) {
  // In the middle of the longest time without landing, lifting or leaving.
  std::size_t first = 0, length = 0, begin = 0;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const bool same = i > 0 && seen_[i].in_range && seen_[i - 1].in_range &&
                      seen_[i].touching() == seen_[i - 1].touching();
    if (!same) begin = i;
    if (i - begin + 1 > length) {
      first = begin;
      length = i - begin + 1;
    }
  }
  ASSERT_GE(length, 40U);
  for (const std::size_t taken : {1U, 2U, 9U}) {
    auto decoder = PenDecoder::make(HidPen::kIdentity.vendor, HidPen::kIdentity.product,
                                    HidPen::report_descriptor());
    ASSERT_TRUE(decoder) << decoder.error().what;
    const std::size_t from = first + length / 2;
    std::vector<std::uint32_t> lost;
    for (std::size_t i = 0; i < reports_.size(); ++i) {
      if (i >= from && i < from + taken) continue;
      decoder->decode(Report{0, reports_[i].time, reports_[i].bytes}, [&](const PenSample& sample) {
        if (!sample.disturbances.empty()) lost.push_back(sample.lost);
        EXPECT_FALSE(sample.lost_estimated);
      });
    }
    EXPECT_THAT(lost, testing::ElementsAre(taken)) << "and nothing else";
  }
}

TEST(PenSession, TheBytesAreTheSameOnEveryMachine) {
  // A change of any drawing, of the hand or of the noise changes these, and says so in its commit.
  const std::map<std::string, std::uint64_t> expected = {
      {"circle", 0x61DF2E7B07FEEDB9},    {"constellation", 0x82360080D74B3B01},
      {"signature", 0xE4C32C859E290548}, {"spiral", 0xB25D0878E14E6BDC},
      {"star", 0xB88BC3EF10685224},      {"teapot", 0x03C4E081B55DBAA7},
  };
  std::map<std::string, std::uint64_t> found;
  for (const DrawingInfo& info : drawings()) {
    found[std::string(info.name)] = fingerprint(reports(find_drawing(info.name).value(), 1));
  }
  EXPECT_EQ(found, expected);
}

TEST(PenSession, ItsEndIsForEverAndLeavesTheReportAlone) {
  PenSession session(find_drawing("circle").value(), 1);
  TimedReport report;
  while (session.next(report)) {
  }
  const auto time = report.time;
  const auto bytes = report.bytes;
  EXPECT_FALSE(session.next(report));
  EXPECT_EQ(report.time, time);
  EXPECT_EQ(report.bytes, bytes);
}

TEST(Drawings, HaveNamesDescriptionsAndNoOthers) {
  EXPECT_THAT(names(), testing::IsSupersetOf(
                           {"signature", "spiral", "teapot", "star", "circle", "constellation"}));
  std::set<std::string_view> unique;
  for (const DrawingInfo& info : drawings()) {
    EXPECT_TRUE(unique.insert(info.name).second) << info.name;
    EXPECT_THAT(info.description, Not(IsEmpty()));
    EXPECT_THAT(info.description, Not(testing::HasSubstr("\n")));
    EXPECT_EQ(find_drawing(info.name)->info.description, info.description);
  }
  EXPECT_FALSE(find_drawing("Signature")) << "names are exact";
  EXPECT_FALSE(find_drawing(""));
}

TEST(Drawings, TheStarHasFiveSharpCornersAndTheCircleCloses) {
  const auto star = find_drawing("star").value();
  ASSERT_EQ(star.strokes.size(), 1U);
  const auto& pieces = star.strokes.front().pieces;
  ASSERT_EQ(pieces.size(), 5U);
  EXPECT_EQ(pieces.front().front(), pieces.back().back());
  const auto circle = find_drawing("circle").value();
  const auto& path = circle.strokes.front().pieces.front();
  EXPECT_EQ(path.front(), path.back());
}

}  // namespace
}  // namespace limn::firmware
