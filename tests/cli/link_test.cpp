// `limn simulate` and `limn replay` as devices of other programs: served by USB/IP to a client on
// the loopback device, which takes what a kernel would.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>  // SIGINT
#include <unistd.h>

#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/run_limn.hpp"
#include "tests/cli/running_limn.hpp"
#include "tests/cli/sample_traces.hpp"
#include "tests/support/recordings.hpp"
#include "tests/unit/firmware_sim/usbip_client.hpp"

namespace limn::test {
namespace {

using firmware::Bytes;
using firmware::UsbipClient;
using testing::HasSubstr;

/// A running `limn` that serves a device on a free port.
class Served {
 public:
  explicit Served(std::vector<std::string> arguments) : limn_(on_any_port(std::move(arguments))) {
    hear();
    unsigned port = 0;
    const auto at = told_.find("127.0.0.1:");
    EXPECT_NE(at, std::string::npos) << told_;
    if (at != std::string::npos) std::sscanf(told_.c_str() + at, "127.0.0.1:%u", &port);
    port_ = static_cast<std::uint16_t>(port);
  }

  std::uint16_t port() const { return port_; }
  const std::string& told() const { return told_; }

  /// Adds its next line to told(); false: it says no more.
  bool hear() {
    const std::string next = limn_.line();
    told_ += next;
    return !next.empty();
  }

  /// RunningProgram::end, and hears what there is left to hear.
  int end(int signal) {
    const int status = limn_.end(signal);
    while (hear()) {
    }
    return status;
  }

 private:
  static std::vector<std::string> on_any_port(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--usbip", "0"});
    return arguments;
  }

  RunningLimn limn_;
  std::uint16_t port_ = 0;
  std::string told_;
};

UsbipClient attach(const Served& served) {
  UsbipClient client = UsbipClient::connect(served.port());
  EXPECT_EQ(client.import("1-1").size(), 320U);
  EXPECT_EQ(client.control_out({0x00, 9, 1, 0, 0, 0, 0, 0}).status, 0);
  return client;
}

std::vector<Bytes> read_reports(UsbipClient& client, int count) {
  std::vector<Bytes> reports;
  for (int i = 1; i <= count; ++i) {
    client.submit_in(static_cast<std::uint32_t>(i), 1, 64);
    reports.push_back(client.take_return(true).data);
  }
  return reports;
}

/// The reports of a hid-recorder file.
std::vector<Bytes> recorded(const std::string& trace) {
  std::vector<Bytes> reports;
  std::istringstream lines(trace);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("E: ")) continue;
    std::istringstream words(line);
    std::string skipped;
    words >> skipped >> skipped >> skipped;
    reports.emplace_back();
    for (std::string byte; words >> byte;) {
      reports.back().push_back(static_cast<std::uint8_t>(std::stoul(byte, nullptr, 16)));
    }
  }
  return reports;
}

TEST(Link, ASimulatedPenDrawsForAClientAndEndsByCtrlC) {
  Served served({"simulate", "pen", "--drawing", "star", "--seed", "3"});
  EXPECT_THAT(served.told(), HasSubstr("attach -r 127.0.0.1 -b 1-1"));
  UsbipClient client = attach(served);
  const auto reports = read_reports(client, 50);
  for (const Bytes& report : reports) EXPECT_EQ(report.size(), 18U);
  EXPECT_EQ(served.end(SIGINT), 0) << served.told();
  EXPECT_THAT(served.told(), HasSubstr("a client has the device"));
  EXPECT_THAT(served.told(), HasSubstr("50 reports"));
}

TEST(Link, AReplayGivesTheRecordingsDescriptorAndReports) {
  const std::string trace = small_pen_line();
  const TempFolder folder;
  const std::string path = folder.write("pen.hid", trace);
  Served served({"replay", path, "--speed", "4"});
  UsbipClient client = attach(served);
  const auto descriptor = client.control_in({0x81, 6, 0x00, 0x22, 0, 0, 0xFF, 0});
  EXPECT_EQ(descriptor.status, 0);
  std::string hex = "R: " + std::to_string(descriptor.data.size());
  for (const std::uint8_t byte : descriptor.data) {
    char text[4];
    std::snprintf(text, sizeof text, " %02x", byte);
    hex += text;
  }
  EXPECT_THAT(trace, HasSubstr(hex));
  const auto expected = recorded(trace);
  ASSERT_GT(expected.size(), 3U);
  EXPECT_EQ(read_reports(client, static_cast<int>(expected.size())), expected);
  EXPECT_EQ(served.end(0), 0) << "it ends with the recording";
  EXPECT_THAT(served.told(), HasSubstr(std::to_string(expected.size()) + " reports"));
}

TEST(Link, AReplayUnplugsTheDeviceWhereItWasUnplugged) {
  // Its first reports again, by a device that had gone and is described anew.
  const std::string before = small_pen_line();
  const auto reports = recorded(before);
  const std::string header = before.substr(0, before.find("E: "));
  std::string report = before.substr(before.find("E: "));
  report = report.substr(report.find(' ', 3));
  report.resize(report.find('\n') + 1);
  const TempFolder folder;
  const std::string path =
      folder.write("pen.hid", before + "#limn gone\n" + header + "E: 8.000000" + report);
  Served served({"replay", path, "--speed", "2"});
  const auto count = static_cast<int>(reports.size());
  {
    UsbipClient client = attach(served);
    EXPECT_EQ(read_reports(client, count), reports);
    client.submit_in(static_cast<std::uint32_t>(count + 1), 1, 64);
    EXPECT_TRUE(client.closed()) << "it stays plugged in";
  }
  while (served.told().find("plugged in again") == std::string::npos) ASSERT_TRUE(served.hear());
  UsbipClient again = attach(served);
  EXPECT_EQ(read_reports(again, 1).at(0), reports.at(0));
  EXPECT_EQ(served.end(0), 0);
}

TEST(Link, ATakenPortIsOneLine) {
  const Served served({"simulate", "pen"});
  const CommandRun run = run_limn({"simulate", "pen", "--usbip", std::to_string(served.port())});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.err, "limn: cannot listen on 127.0.0.1:" + std::to_string(served.port()) +
                         ": the port is taken; choose another one, or 0 for any that is free\n");
}

TEST(Link, PortsAreOfThisMachineAlone) {
  for (const char* port : {"65536", "-1", "0.0.0.0:3240", "usbip", ""}) {
    const CommandRun run = run_limn({"simulate", "pen", "--usbip", port});
    EXPECT_EQ(run.exit_code, 2) << port;
    EXPECT_THAT(run.err, HasSubstr("is no port of 127.0.0.1")) << port;
  }
}

TEST(Link, UhidSaysWhatToLoadWhereItIsAbsent) {
  if (::access("/dev/uhid", F_OK) == 0) GTEST_SKIP() << "/dev/uhid is here";
  const CommandRun run = run_limn({"simulate", "pen", "--uhid"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(
      run.err,
      "limn: cannot open /dev/uhid: No such file or directory; load it: sudo modprobe uhid\n");
}

TEST(Link, ReplaysOnlyWhatADeviceSent) {
  const auto refused = [](const std::string& trace, const char* what) {
    const CommandRun run = run_limn({"replay", "-", "--usbip", "0"}, trace);
    EXPECT_EQ(run.exit_code, 1) << trace;
    EXPECT_THAT(run.err, HasSubstr(what));
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << "not one line: " << run.err;
  };
  refused("t,x,y,p\n0,1,1,0.5\n", "holds samples");
  refused(small_pen_header(), "holds no report");
  refused("N: Nameless\nI: 3 1209 0001\nE: 0.000000 6 01 02 10 00 10 00\n", "no report descriptor");
  refused(small_pen_line() + "D: 1\nN: Other\nI: 3 dead beef\nR: 2 05 01\nE: 0.0 1 00\n",
          "several devices");
}

}  // namespace
}  // namespace limn::test
