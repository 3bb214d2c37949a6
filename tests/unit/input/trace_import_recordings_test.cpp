// Real captures are read whole, and their hid-recorder form holds the same.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "input/trace/hid_recorder_writer.hpp"
#include "input/trace_import/trace_import.hpp"
#include "tests/support/recordings.hpp"
#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

struct Recording {
  const char* path;
  bool capture;  ///< needs libpcap
  std::size_t reports;
  std::uint16_t vendor;  ///< of the device `of` that is looked at
  std::uint16_t product;
  std::size_t descriptor_bytes;
};

class ImportedRecordings : public testing::TestWithParam<Recording> {};

TEST_P(ImportedRecordings, AreReadWholeAndWrittenAsHidRecorderFiles) {
  LIMN_NEEDS_RECORDINGS();
  if (GetParam().capture && !has_usb_captures()) {
    GTEST_SKIP() << "this limn was built without libpcap";
  }
  const auto path = shared_folder() / "traces" / GetParam().path;
  const std::string text = read_file(path);
  const Reading reading = read_whole(open_import(memory_bytes(text)));
  EXPECT_EQ(reading.order.back(), '.') << at_and_what(reading.error);
  EXPECT_EQ(reading.reports.size(), GetParam().reports);
  const auto& devices = reading.devices;
  const bool found = std::any_of(devices.begin(), devices.end(), [](const TraceDevice& device) {
    return device.vendor == GetParam().vendor && device.product == GetParam().product &&
           device.report_descriptor.size() == GetParam().descriptor_bytes;
  });
  EXPECT_TRUE(found);

  StringSink sink;
  HidRecorderWriter writer(sink);
  for (const TraceDevice& device : reading.devices) ASSERT_TRUE(writer.describe(device));
  for (const ReadReport& report : reading.reports) {
    ASSERT_TRUE(writer.write({report.device, Timestamp(report.time_ns), report.bytes}));
  }
  const Reading again = read_trace(sink.text());
  EXPECT_EQ(again.format, TraceFormat::kHidRecorder);
  EXPECT_EQ(again.reports, reading.reports);
}

INSTANTIATE_TEST_SUITE_P(
    All, ImportedRecordings,
    testing::Values(Recording{"init-captures/huion_q11k.pcapng", true, 763, 0x256C, 0x006E, 83},
                    Recording{"init-captures/kye_mousepen_i608x_v1.pcap", true, 513, 0x093A, 0x2510,
                              0},
                    Recording{"3d-mice/SpaceNavigator-Connected-Calibrate.pcapng", true, 0, 0x046D,
                              0xC626, 217},
                    Recording{"3d-mice/mouse_log_24515c1.csv", false, 103, 0x256F, 0xC631, 46}),
    [](const testing::TestParamInfo<Recording>& tested) {
      return "Recording" + std::to_string(tested.index);
    });

}  // namespace
}  // namespace limn::test
