#include "input/trace/evemu_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/for_all.hpp"
#include "tests/support/recordings.hpp"
#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

EvdevEvent event(std::int64_t time_ns, std::uint16_t type, std::uint16_t code, std::int32_t value) {
  return {Timestamp(time_ns), type, code, value};
}

/// A frame with the time of its last event.
Expected<void> write(EvemuWriter& writer, const std::vector<EvdevEvent>& events) {
  return writer.write({0, events.back().time, events});
}

TraceDevice pen() {
  TraceDevice device;
  device.name = "Pen #2";
  device.bus = 3;
  device.vendor = 0x56A;
  device.product = 0x304;
  device.version = 0x90;
  device.axes = {{0, -5, 59552, 4, 1, 200}, {0x1A, -64, 63, 0, 0, 57}};
  device.report_descriptor = {0x05, 0x0D, 0xA1};
  return device;
}

TEST(EvemuWriter, WritesTheLinesOfTheFormat) {
  StringSink sink;
  EvemuWriter writer(sink);
  ASSERT_TRUE(writer.describe(pen()));
  ASSERT_TRUE(write(writer, {event(0, 3, 0, 17), event(1'000'000, 1, 0x140, 1)}));
  ASSERT_TRUE(writer.lost());
  ASSERT_TRUE(write(writer, {event(2'000'000'001, 3, 0, -2)}));
  EXPECT_EQ(sink.text(),
            "# EVEMU 1.3\nN: Pen #2\nI: 0003 056a 0304 0090\n#limn R: 3 05 0d a1\n"
            "A: 00 -5 59552 4 1 200\nA: 1a -64 63 0 0 57\n"
            "E: 0.000000 0003 0000 17\nE: 0.001000 0001 0140 1\nE: 0.001000 0000 0000 0\n"
            "E: 0.001000 0000 0003 0\nE: 0.001000 0000 0000 0\n"
            "E: 2.000000001 0003 0000 -2\nE: 2.000000001 0000 0000 0\n");
}

TEST(EvemuWriter, NotesComeBackWhereTheyStood) {
  StringSink sink;
  EvemuWriter writer(sink);
  ASSERT_TRUE(writer.describe(pen()));
  ASSERT_TRUE(write(writer, {event(0, 3, 0, 17)}));
  ASSERT_TRUE(writer.note("gone"));
  ASSERT_TRUE(writer.describe(pen()));
  ASSERT_TRUE(write(writer, {event(1'000'000, 3, 0, 18)}));
  const Reading reading = read_trace(sink.text());
  EXPECT_EQ(reading.order, "dfndf.");
}

TEST(EvemuWriter, TheReaderGivesTheSameAgain) {
  for_all(100, [](Rng& rng) {
    StringSink sink;
    EvemuWriter writer(sink);
    const TraceDevice device = pen();
    ASSERT_TRUE(writer.describe(device));
    std::vector<std::vector<EvdevEvent>> frames(static_cast<std::size_t>(rng.integer(0, 20)));
    std::int64_t now = 0;
    for (auto& frame : frames) {
      const std::int64_t count = rng.integer(1, 6);
      for (std::int64_t i = 0; i < count; ++i) {
        now += rng.integer(0, 3'000'000);
        frame.push_back(event(
            now, static_cast<std::uint16_t>(rng.integer(1, 4)),
            static_cast<std::uint16_t>(rng.integer(0, 0x2FF)),
            static_cast<std::int32_t>(rng.integer(std::numeric_limits<std::int32_t>::min(),
                                                  std::numeric_limits<std::int32_t>::max()))));
      }
      ASSERT_TRUE(write(writer, frame));
    }
    const Reading reading = read_trace(sink.text());
    EXPECT_EQ(reading.order, "d" + std::string(frames.size(), 'f') + ".");
    ASSERT_EQ(reading.devices.size(), 1u);
    const TraceDevice& read = reading.devices[0];
    EXPECT_EQ(read.name, device.name);
    EXPECT_EQ(std::tuple(read.bus, read.vendor, read.product, read.version),
              std::tuple(device.bus, device.vendor, device.product, device.version));
    EXPECT_EQ(read.report_descriptor, device.report_descriptor);
    ASSERT_EQ(read.axes.size(), device.axes.size());
    for (std::size_t i = 0; i < read.axes.size(); ++i) {
      const EvdevAxis& a = read.axes[i];
      const EvdevAxis& b = device.axes[i];
      EXPECT_EQ(std::tuple(a.code, a.minimum, a.maximum, a.fuzz, a.flat, a.resolution),
                std::tuple(b.code, b.minimum, b.maximum, b.fuzz, b.flat, b.resolution));
    }
    ASSERT_EQ(reading.frames.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(reading.frames[i].time_ns, frames[i].back().time.count());
      ASSERT_EQ(reading.frames[i].events.size(), frames[i].size());
      for (std::size_t k = 0; k < frames[i].size(); ++k) {
        const EvdevEvent& a = reading.frames[i].events[k];
        const EvdevEvent& b = frames[i][k];
        EXPECT_EQ(std::tuple(a.time, a.type, a.code, a.value),
                  std::tuple(b.time, b.type, b.code, b.value));
      }
    }
  });
}

TEST(EvemuWriter, RefusesWhatCannotBeReadBack) {
  StringSink sink;
  EvemuWriter writer(sink);
  TraceDevice device;
  device.report_descriptor.resize(kMaxDescriptorBytes + 1);
  EXPECT_EQ(writer.describe(device).error().code, ErrorCode::kLimit);
  const std::vector<EvdevEvent> many(kMaxFrameEvents + 1);
  EXPECT_EQ(write(writer, many).error().code, ErrorCode::kLimit);
  EXPECT_EQ(write(writer, {event(-1, 3, 0, 0)}).error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(write(writer, {event(7, 3, 0, 0), event(6, 3, 0, 0), event(8, 3, 0, 0)}).error().code,
            ErrorCode::kOutOfRange);
  EXPECT_EQ(sink.text(), "");
  ASSERT_TRUE(write(writer, {event(5, 3, 0, 0)})) << "a refused frame has left no time behind";
}

TEST(EvemuWriter, KeepsTheNameOnOneLine) {
  StringSink sink;
  EvemuWriter writer(sink);
  TraceDevice device;
  device.name = "a\nE: 0.0";
  ASSERT_TRUE(writer.describe(device));
  EXPECT_EQ(sink.text(), "# EVEMU 1.3\nN: a E: 0.0\nI: 0000 0000 0000 0000\n");
}

TEST(EvemuReader, ADescriptorBehindACommentIsCheckedLikeOthers) {
  EXPECT_EQ(read_trace("# EVEMU 1.3\nN: x\n#limn R: 2 05 0d\n").devices.at(0).report_descriptor,
            (std::vector<std::uint8_t>{0x05, 0x0D}));
  for (const char* bad : {"#limn R: 3 05 0d", "#limn R: x", "#limn R: 1 5", "#limn R: 65536"}) {
    const Reading reading = read_trace("# EVEMU 1.3\nN: x\n" + std::string(bad) + "\n");
    EXPECT_EQ(reading.order, "!") << bad;
    EXPECT_THAT(at_and_what(reading.error), testing::StartsWith("line 3: #limn R: wants")) << bad;
  }
}

}  // namespace
}  // namespace limn::test
