// Every real recording is read whole: as many reports as the file has lines of them, none of it
// damaged but what is known to be.

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/support/recordings.hpp"
#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

struct LineCounts {
  std::size_t events = 0;        // E:
  std::size_t syn_reports = 0;   // E: with type 0 and code 0
  std::size_t stream_heads = 0;  // ..:STREAM
  std::size_t rows = 0;          // with a comma, but for the header
};

LineCounts count_lines(const std::string& text) {
  LineCounts counts;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("E:", 0) == 0) ++counts.events;
    if (line.rfind("E:", 0) == 0 && line.find(" 0000 0000 ") != std::string::npos) {
      ++counts.syn_reports;
    }
    if (line.find(":STREAM ") != std::string::npos) ++counts.stream_heads;
    if (line.find(',') != std::string::npos && line[0] != 't') ++counts.rows;
  }
  return counts;
}

void expect_times_in_order(const Reading& reading) {
  std::vector<std::pair<DeviceIndex, std::int64_t>> last;
  for (const ReadReport& report : reading.reports) {
    auto same = last.begin();
    while (same != last.end() && same->first != report.device) ++same;
    if (same == last.end()) same = last.insert(same, {report.device, report.time_ns});
    ASSERT_LE(same->second, report.time_ns);
    same->second = report.time_ns;
  }
}

TEST(TraceRecordings, HidRecorder) {
  LIMN_NEEDS_RECORDINGS();
  std::size_t reports = 0;
  for (const char* folder : {"traces/pens", "traces/pens-kernel-oracle"}) {
    for (const auto& path : recordings(folder, ".hid")) {
      SCOPED_TRACE(path.string());
      const std::string text = read_file(path);
      const Reading reading = read_trace(text);
      EXPECT_EQ(reading.format, TraceFormat::kHidRecorder);
      EXPECT_EQ(reading.order.back(), '.') << at_and_what(reading.error);
      EXPECT_EQ(reading.reports.size(), count_lines(text).events);
      for (const TraceDevice& device : reading.devices) {
        EXPECT_FALSE(device.report_descriptor.empty());
        EXPECT_NE(device.vendor, 0);
      }
      expect_times_in_order(reading);
      reports += reading.reports.size();
    }
  }
  EXPECT_GE(reports, 57'927U);
}

TEST(TraceRecordings, UsbhidDump) {
  LIMN_NEEDS_RECORDINGS();
  std::size_t files = 0;
  std::size_t damaged = 0;
  for (const auto& path : recordings("traces/pens-usbhid-dump", ".txt")) {
    const std::string text = read_file(path);
    const std::size_t heads = count_lines(text).stream_heads;
    if (heads == 0) continue;
    SCOPED_TRACE(path.string());
    ++files;
    const bool has_nuls = text.find('\0') != std::string::npos;
    const Reading reading = has_nuls ? salvage_trace(text) : read_trace(text);
    EXPECT_EQ(reading.format, TraceFormat::kUsbhidDump);
    EXPECT_EQ(reading.order.back(), '.') << at_and_what(reading.error);
    EXPECT_EQ(reading.damage.size(), has_nuls ? 1U : 0U);
    EXPECT_EQ(reading.reports.size(), has_nuls ? heads - 1 : heads);
    expect_times_in_order(reading);
    if (!has_nuls) continue;
    ++damaged;
    const Reading strict = read_trace(text);
    EXPECT_EQ(strict.order, "!");
    EXPECT_EQ(at_and_what(strict.error), "byte 0: 65536 NUL bytes in the text");
    EXPECT_EQ(strict.error.remedy, "add --salvage to skip the damaged part");
  }
  EXPECT_GE(files, 50U);
  EXPECT_GE(damaged, 1U);
}

TEST(TraceRecordings, Evemu) {
  LIMN_NEEDS_RECORDINGS();
  auto paths = recordings("traces/pens-evemu", ".events");
  for (const auto& path : recordings("traces/pens-kernel-oracle", ".ev")) paths.push_back(path);
  EXPECT_GE(paths.size(), 4U);
  for (const auto& path : paths) {
    SCOPED_TRACE(path.string());
    const std::string text = read_file(path);
    const LineCounts counts = count_lines(text);
    const Reading reading = read_trace(text);
    EXPECT_EQ(reading.format, TraceFormat::kEvemu);
    EXPECT_EQ(reading.order.back(), '.') << at_and_what(reading.error);
    EXPECT_EQ(reading.frames.size(), counts.syn_reports);
    std::size_t events = 0;
    for (const ReadFrame& frame : reading.frames) events += frame.events.size() + 1;
    EXPECT_EQ(events, counts.events);
    ASSERT_EQ(reading.devices.size(), 1U);
    EXPECT_GE(reading.devices[0].axes.size(), 3U);
  }
}

TEST(TraceRecordings, StrokeCsv) {
  LIMN_NEEDS_RECORDINGS();
  std::size_t files = 0;
  for (const char* folder : {"strokes/real", "strokes/synthetic"}) {
    for (const auto& path : recordings(folder, ".csv")) {
      const std::string text = read_file(path);
      if (text.rfind("t,", 0) != 0) continue;  // the noise-free curves have no times
      SCOPED_TRACE(path.string());
      const Reading reading = read_trace(text);
      EXPECT_EQ(reading.format, TraceFormat::kStrokeCsv);
      EXPECT_EQ(reading.order.back(), '.') << at_and_what(reading.error);
      EXPECT_EQ(reading.samples.size(), count_lines(text).rows);
      const bool tilted = text.rfind("t,x,y,p,alt,az", 0) == 0;
      EXPECT_EQ(reading.samples.at(0).axes.has(PenAxis::kTiltX), tilted);
      ++files;
    }
  }
  EXPECT_GE(files, 312U);
}

}  // namespace
}  // namespace limn::test
