#include "input/trace/hid_recorder_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "tests/support/for_all.hpp"
#include "tests/support/recordings.hpp"
#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

using testing::HasSubstr;

Report report_of(DeviceIndex device, std::int64_t time_ns, std::span<const std::uint8_t> bytes) {
  return {device, Timestamp(time_ns), bytes};
}

/// Writes what `text` holds anew.
std::string rewritten(std::string_view text) {
  StringSink sink;
  HidRecorderWriter writer(sink);
  auto reader = open_trace(memory_bytes(text));
  EXPECT_TRUE(reader);
  for (;;) {
    const auto event = (*reader)->next();
    EXPECT_TRUE(event) << at_and_what(event.error());
    if (!event || std::holds_alternative<TraceEnd>(*event)) return sink.text();
    Expected<void> written;
    if (const auto* described = std::get_if<DeviceDescribed>(&*event)) {
      written = writer.describe(*described->device);
    } else if (const auto* report = std::get_if<Report>(&*event)) {
      written = writer.write(*report);
    } else if (const auto* note = std::get_if<TraceNote>(&*event)) {
      written = writer.note(note->text);
    }
    EXPECT_TRUE(written);
  }
}

void expect_same(const Reading& a, const Reading& b) {
  EXPECT_EQ(a.order, b.order);
  EXPECT_EQ(a.reports, b.reports);
  EXPECT_EQ(a.notes, b.notes);
  ASSERT_EQ(a.devices.size(), b.devices.size());
  for (std::size_t i = 0; i < a.devices.size(); ++i) {
    EXPECT_EQ(a.devices[i].index, b.devices[i].index);
    EXPECT_EQ(a.devices[i].name, b.devices[i].name);
    EXPECT_EQ(a.devices[i].physical_path, b.devices[i].physical_path);
    EXPECT_EQ(a.devices[i].bus, b.devices[i].bus);
    EXPECT_EQ(a.devices[i].vendor, b.devices[i].vendor);
    EXPECT_EQ(a.devices[i].product, b.devices[i].product);
    EXPECT_EQ(a.devices[i].report_descriptor, b.devices[i].report_descriptor);
  }
}

TEST(HidRecorderWriter, WritesTheLinesOfTheFormat) {
  StringSink sink;
  HidRecorderWriter writer(sink);
  TraceDevice device;
  device.index = 1;
  device.name = "A pen";
  device.physical_path = "usb-1/input0";
  device.bus = 3;
  device.vendor = 0x56A;
  device.product = 0x314;
  device.report_descriptor = {0x05, 0x0D, 0xA1};
  constexpr std::array<std::uint8_t, 2> kBytes = {0x02, 0xFF};
  ASSERT_TRUE(writer.note("begin"));
  ASSERT_TRUE(writer.describe(device));
  ASSERT_TRUE(writer.write(report_of(1, 12'000'345'000, kBytes)));
  ASSERT_TRUE(writer.write(report_of(1, 12'000'345'001, kBytes)));
  ASSERT_TRUE(writer.note(""));
  ASSERT_TRUE(writer.write(report_of(0, 0, {})));
  EXPECT_EQ(sink.text(),
            "#limn begin\n"
            "D: 1\nR: 3 05 0d a1\nN: A pen\nP: usb-1/input0\nI: 3 056a 0314\n"
            "E: 12.000345 2 02 ff\n"
            "E: 12.000345001 2 02 ff\n"
            "#limn\n"
            "D: 0\nE: 0.000000 0\n");
}

TEST(HidRecorderWriter, KeepsTextsOnOneLine) {
  StringSink sink;
  HidRecorderWriter writer(sink);
  TraceDevice device;
  device.name = "a\nE: 0.0 1 01\rb\x7F";
  ASSERT_TRUE(writer.describe(device));
  ASSERT_TRUE(writer.note("x\ny"));
  EXPECT_EQ(sink.text(), "D: 0\nN: a E: 0.0 1 01 b \n#limn x y\n");
}

TEST(HidRecorderWriter, RefusesWhatCannotBeReadBack) {
  StringSink sink;
  HidRecorderWriter writer(sink);
  TraceDevice device;
  device.report_descriptor.resize(kMaxDescriptorBytes + 1);
  EXPECT_EQ(writer.describe(device).error().code, ErrorCode::kLimit);
  device.report_descriptor.clear();
  device.name.assign(kMaxDeviceTextBytes + 1, 'n');
  EXPECT_EQ(writer.describe(device).error().code, ErrorCode::kLimit);
  const std::vector<std::uint8_t> long_report(kMaxReportBytes + 1);
  EXPECT_EQ(writer.write(report_of(0, 0, long_report)).error().code, ErrorCode::kLimit);
  EXPECT_EQ(writer.write(report_of(0, -1, {})).error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(writer.note(std::string(kMaxLineBytes, 'n')).error().code, ErrorCode::kLimit);
  EXPECT_EQ(sink.text(), "");
}

TEST(HidRecorderWriter, SelectsTheDeviceAgainAfterAFailure) {
  class FullOnce final : public ByteSink {
   public:
    Expected<void> write(std::string_view bytes) override {
      if (++calls == 2) return fail(ErrorCode::kIo, "", "no space left", "free some");
      text.append(bytes);
      return {};
    }
    int calls = 0;
    std::string text;
  };
  FullOnce sink;
  HidRecorderWriter writer(sink);
  ASSERT_TRUE(writer.write(report_of(0, 0, {})));
  EXPECT_EQ(writer.write(report_of(1, 1'000, {})).error().what, "no space left");
  ASSERT_TRUE(writer.write(report_of(1, 2'000, {})));
  EXPECT_EQ(sink.text, "D: 0\nE: 0.000000 0\nD: 1\nE: 0.000002 0\n");
}

TEST(HidRecorderWriter, EachCallEndsWithALineEnd) {
  class LineSink final : public ByteSink {
   public:
    Expected<void> write(std::string_view bytes) override {
      EXPECT_TRUE(bytes.ends_with('\n'));
      return {};
    }
  };
  LineSink sink;
  HidRecorderWriter writer(sink);
  ASSERT_TRUE(writer.describe({}));
  ASSERT_TRUE(writer.write(report_of(3, 0, {})));
  ASSERT_TRUE(writer.note("n"));
}

TEST(HidRecorderWriter, WhatIsWrittenIsReadBack) {
  for_all(100, [](Rng& rng) {
    StringSink sink;
    HidRecorderWriter writer(sink);
    std::vector<ReadReport> wrote;
    std::int64_t time = 0;
    for (int i = 0; i < 30; ++i) {
      time += static_cast<std::int64_t>(rng.integer(0, 3'000'000'000));
      if (rng.integer(0, 1) == 0) time = time / 1000 * 1000;
      std::vector<std::uint8_t> bytes(static_cast<std::size_t>(rng.integer(0, 40)));
      for (auto& byte : bytes) byte = static_cast<std::uint8_t>(rng.integer(0, 255));
      const auto device = static_cast<DeviceIndex>(rng.integer(0, 3));
      wrote.push_back({device, time, bytes});
      ASSERT_TRUE(writer.write(report_of(device, time, bytes)));
    }
    EXPECT_EQ(read_trace(sink.text()).reports, wrote);
  });
}

TEST(HidRecorderWriter, ReadingAndWritingRealRecordingsKeepsEveryReport) {
  LIMN_NEEDS_RECORDINGS();
  std::size_t files = 0;
  for (const char* folder : {"traces/pens", "traces/pens-kernel-oracle"}) {
    for (const auto& path : recordings(folder, ".hid")) {
      SCOPED_TRACE(path.string());
      const std::string text = read_file(path);
      const std::string again = rewritten(text);
      expect_same(read_trace(text), read_trace(again));
      EXPECT_EQ(rewritten(again), again) << "a second time changes nothing at all";
      ++files;
    }
  }
  EXPECT_GE(files, 14U);
}

}  // namespace
}  // namespace limn::test
