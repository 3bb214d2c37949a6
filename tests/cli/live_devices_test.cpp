// `limn devices`, `record` and `monitor` on a hidraw node that umockdev simulates below the C
// library: sysfs, ioctls and reports as a device and Linux give them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tests/cli/live_tablet.hpp"
#include "tests/cli/run_limn.hpp"
#include "tests/cli/sample_traces.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/simulated_tablet.hpp"
#include "tests/support/spacenavd_server.hpp"
#include "tests/support/umockdev_text.hpp"

namespace limn::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// The small pen on hidraw0, drawing `reports` reports 15 ms apart (umockdev runs closer ones
/// together).
class SimulatedPen {
 public:
  explicit SimulatedPen(int reports) {
    const std::string usb = "/devices/pci0000:00/0000:00:14.0/usb1/1-1";
    const std::string hid = usb + "/1-1:1.0/0003:1209:0001.0001";
    device_ = folder_
                  .write("pen.umockdev",
                         "P: " + hid +
                             "/hidraw/hidraw0\nN: hidraw0\nE: DEVNAME=/dev/hidraw0\n"
                             "E: MAJOR=243\nE: MINOR=0\nE: SUBSYSTEM=hidraw\n"
                             "L: device=../../../0003:1209:0001.0001\n\n"
                             "P: " +
                             hid +
                             "\nL: driver=../../../../../bus/hid/drivers/hid-generic\n"
                             "E: DRIVER=hid-generic\n"
                             "E: HID_ID=0003:00001209:00000001\nE: HID_NAME=Small Pen\n"
                             "E: HID_PHYS=usb-1/input0\nE: HID_UNIQ=\nE: SUBSYSTEM=hid\n"
                             "H: report_descriptor=" +
                             digits_of(small_pen_descriptor()) +
                             "\n\n"
                             "P: " +
                             usb +
                             "/1-1:1.0\nE: DEVTYPE=usb_interface\nE: SUBSYSTEM=usb\n"
                             "A: bInterfaceNumber=00\\n\n\n"
                             "P: " +
                             usb +
                             "\nN: bus/usb/001/002\nE: DEVTYPE=usb_device\n"
                             "E: DEVNAME=/dev/bus/usb/001/002\nE: SUBSYSTEM=usb\n"
                             "A: idVendor=1209\\n\nA: idProduct=0001\\n\nA: bcdDevice=0100\\n\n"
                             "A: product=Small Pen\\n\nA: manufacturer=Limn\\n\n")
                  .string();
    ioctls_ = folder_
                  .write("pen.ioctl", hidraw_ioctls({.vendor = 0x1209,
                                                     .product = 1,
                                                     .report_descriptor = small_pen_descriptor(),
                                                     .name = "Small Pen"}))
                  .string();
    std::string script;
    for (int i = 0; i < reports; ++i) {
      // umockdev's own escapes: ^A is 1, ^C 3, ^@ 0; letters stand for themselves.
      script += std::string("r ") + (i == 0 ? "200" : "15") + " ^A^C" + static_cast<char>('a' + i) +
                "^@d^@\n";
    }
    script_ = folder_.write("pen.script", script).string();
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  /// Runs limn on it; `before` may hold a command that runs it in turn.
  CommandRun limn(const std::string& words, const std::string& before = {}) const {
    return run_umockdev("-d " + device_ + " -i /dev/hidraw0=" + ioctls_ +
                        " -s /dev/hidraw0=" + script_ + " -- " + before + " \"$0\" " + words);
  }

 private:
  TempFolder folder_;
  std::string device_;
  std::string ioctls_;
  std::string script_;
};

class LiveDevices : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_umockdev()) GTEST_SKIP() << "umockdev is not installed";
  }
};

TEST_F(LiveDevices, DevicesListsBothSidesOfATablet) {
  const LiveTablet tablet;
  const CommandRun run = tablet.limn("devices --format json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json rows = json::parse(run.out);
  ASSERT_EQ(rows.size(), 2u) << run.out;
  for (const json& row : rows) {
    EXPECT_EQ(row["id"], "1209:0002");
    EXPECT_EQ(row["name"], "Simulated Tablet");
    EXPECT_NEAR(row["width_mm"], 105.3, 1e-9);
    EXPECT_EQ(row["pressure_max"], 1023);
    EXPECT_EQ(row["axes"], "x y pressure tilt_x tilt_y");
    EXPECT_EQ(row["rate"], 200);
    EXPECT_EQ(row["driver"], "hid-generic");
    EXPECT_FALSE(row.contains("trouble"));
  }
  EXPECT_EQ(rows[0]["backend"], "hidraw");
  EXPECT_EQ(rows[0]["kind"], "HID pen");
  EXPECT_FALSE(rows[0].contains("same_as"));
  EXPECT_EQ(rows[1]["backend"], "evdev");
  EXPECT_EQ(rows[1]["kind"], "kernel pen");
  EXPECT_EQ(rows[1]["same_as"], "/dev/hidraw0");
}

TEST_F(LiveDevices, DevicesFitsATerminal) {
  const LiveTablet tablet;
  const CommandRun run = tablet.limn("devices");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("105 x 53"));
  EXPECT_THAT(run.out, HasSubstr("x y p t"));
  EXPECT_THAT(run.out, HasSubstr("/dev/input/event300: the same device as /dev/hidraw0\n"));
  std::istringstream lines(run.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
}

TEST_F(LiveDevices, RecordsAnEventNodeAsEvemu) {
  const LiveTablet tablet;
  const std::string file = tablet.path("mine.evemu");
  const CommandRun run =
      tablet.limn(std::string("record ") + SimulatedTablet::kEvent + " --seconds 1.5 -o " + file);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr(" frames of 1 device in "));
  const std::string text = read_file(file);
  EXPECT_THAT(text, StartsWith("# EVEMU 1.3\nN: Simulated Tablet\nI: 0003 1209 0002 0100\n"
                               "#limn R: "));
  EXPECT_THAT(text, HasSubstr("\nA: 00 0 20000 0 0 190\n"));
  const CommandRun decoded = run_limn({"decode", file, "--format", "jsonl"});
  ASSERT_EQ(decoded.exit_code, 0) << decoded.err;
  std::istringstream lines(decoded.out);
  std::vector<json> samples;
  for (std::string line; std::getline(lines, line);) samples.push_back(json::parse(line));
  ASSERT_EQ(samples.size(), std::size_t{LiveTablet::kSteps + 1}) << decoded.out;
  EXPECT_EQ(samples[0]["state"], "in_range");
  EXPECT_EQ(samples[2]["state"], "in_contact");
  EXPECT_EQ(samples[10]["state"], "out_of_range");
  EXPECT_NEAR(samples[2]["x_mm"], 1200 * 105.3 / 20000, 1e-9) << "by the descriptor in the file";
}

TEST_F(LiveDevices, MonitorsAnEventNode) {
  const LiveTablet tablet;
  const CommandRun run = tablet.limn(std::string("monitor ") + SimulatedTablet::kEvent +
                                     " --seconds 1.5 --format jsonl");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream lines(run.out);
  json last;
  for (std::string line; std::getline(lines, line);) last = json::parse(line);
  EXPECT_EQ(last["id"], "1209:0002");
  EXPECT_GE(last["reports"], LiveTablet::kSteps + 1);
  EXPECT_EQ(last["lost"], 0);
}

void replace_all(std::string& text, const std::string& old, const std::string& put) {
  for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos; at += put.size()) {
    text.replace(at, old.size(), put);
  }
}

/// Its HID interface sends what no pen's report descriptor is.
void make_vendor_reports(std::string& text) {
  constexpr const char* kVendorDefined = "0600FF0901A101090215002500750895098102C0";
  const std::size_t at = text.find("H: report_descriptor=") + 21;
  text.replace(at, text.find('\n', at) - at, kVendorDefined);
}

/// An event node of the same device that is no pen: the keys of its pad.
void add_pad(std::string& text) {
  std::string pad = SimulatedTablet::event_device();
  replace_all(pad, "event300", "event301");
  replace_all(pad, "60000", "60001");
  replace_all(pad, "input5", "input6");
  replace_all(pad, "key=c01 0 0", "key=0 0 0");
  text += pad;
}

TEST_F(LiveDevices, APenThatOnlyTheKernelDecodesIsReadByItsEventNode) {
  const LiveTablet tablet(make_vendor_reports);
  for (const std::string device : {"", "1209:2", "1209:2:0"}) {
    const CommandRun run = tablet.limn("record " + device + " --seconds 1.5 -o " +
                                       tablet.path("mine" + std::to_string(device.size())));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr(" frames of 1 device in ")) << device;
  }
  EXPECT_THAT(tablet.limn("record 1209:2:1 -o " + tablet.path("no")).err,
              HasSubstr("no device 1209:2:1 is here"))
      << "the hidraw node is not among those that devices lists";
}

TEST_F(LiveDevices, BackendEvdevOpensPensOnly) {
  const LiveTablet tablet(add_pad);
  const CommandRun all = tablet.limn("devices --all --format json");
  EXPECT_EQ(json::parse(all.out).size(), 3u) << all.out;
  for (const std::string device : {"", "1209:2"}) {
    const CommandRun run = tablet.limn("record --backend evdev " + device + " --seconds 1.5 -o " +
                                       tablet.path("mine" + std::to_string(device.size())));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr(" frames of 1 device in "));
  }
}

TEST_F(LiveDevices, WhatCannotBeOpenedBesideOthersIsTold) {
  const LiveTablet tablet([](std::string& text) { text += SimulatedTablet::hidraw_device(1); });
  const CommandRun run = tablet.limn("record --seconds 0.2 -o " + tablet.path("mine.hid"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("limn: /dev/hidraw1: "));
  EXPECT_THAT(run.err, HasSubstr("0 reports of 1 device in "));
}

TEST_F(LiveDevices, NamesOfDevicesDoNotReachTheTerminalRaw) {
  const LiveTablet tablet(
      [](std::string& text) { replace_all(text, "Simulated Tablet", "Simulated\x1b[2JTablet"); });
  for (const std::string words : {"devices", "monitor --seconds 0.2", "doctor"}) {
    const CommandRun run = tablet.limn(words);
    EXPECT_THAT(run.out + run.err, Not(HasSubstr("\x1b"))) << words;
    EXPECT_THAT(run.out, HasSubstr("Simulated")) << words;
  }
}

TEST(LiveSpnav, BackendSpnavReadsWhateverSpacenavdHas) {
  if (LIMN_HAS_SPNAV == 0) GTEST_SKIP() << "this build has no libspnav";
  if (std::filesystem::exists("/run/spnav.sock")) GTEST_SKIP() << "a spacenavd runs here";
  for (const std::string device : {"", "256f:c635"}) {
    SpacenavdServer server(1);
    std::thread hand([&server] {
      server.wait_for_client();
      for (std::int32_t i = 1; i <= 5; ++i) server.send({0, i, 2 * i, 0, 0, 0, 0, 8});
      server.leave();
    });
    ::setenv("SPNAV_SOCKET", server.path().c_str(), 1);
    const CommandRun run =
        run_shell("\"$0\" record --backend spnav " + device + " --seconds 60 -o -");
    ::unsetenv("SPNAV_SOCKET");
    server.stop_listening();
    hand.join();
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("5 frames of 1 device in ")) << "and it ends with spacenavd";
    EXPECT_THAT(run.out, HasSubstr("N: SpaceMouse Compact"));
  }
}

TEST(LiveSpnav, SaysWhereNoSpacenavdRuns) {
  if (std::filesystem::exists("/run/spnav.sock")) GTEST_SKIP() << "a spacenavd runs here";
  const CommandRun run = run_limn({"monitor", "--backend", "spnav"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.err, "limn: spacenavd does not run; start spacenavd, or name its socket\n");
}

TEST_F(LiveDevices, DoctorNamesTheDriverAndTheQueues) {
  const LiveTablet tablet;
  const std::string out = tablet.limn("doctor --format csv").out;
  EXPECT_THAT(out, HasSubstr("good,/dev/hidraw0,Linux's driver hid-generic has it"));
  EXPECT_THAT(out, HasSubstr("good,/dev/input/event300,Simulated Tablet"));
  EXPECT_THAT(out, HasSubstr("good,queues,"));
}

TEST_F(LiveDevices, DevicesNamesPensWithSizeAndNode) {
  const SimulatedPen pen(0);
  const CommandRun run = pen.limn("devices --format json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json rows = json::parse(run.out);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0]["id"], "1209:0001");
  EXPECT_EQ(rows[0]["node"], "/dev/hidraw0");
  EXPECT_EQ(rows[0]["name"], "Small Pen");
  EXPECT_EQ(rows[0]["kind"], "HID pen");
  EXPECT_EQ(rows[0]["width_mm"], 100.0);
  EXPECT_FALSE(rows[0].contains("trouble") && !rows[0]["trouble"].is_null());
}

TEST_F(LiveDevices, DoctorLooksAtEachNode) {
  const SimulatedPen pen(0);
  const json rows = json::parse(pen.limn("doctor --format json").out);
  ASSERT_GE(rows.size(), 3u);
  EXPECT_EQ(rows[0]["state"], "good");
  EXPECT_EQ(rows[0]["subject"], "/dev/hidraw0");
  EXPECT_EQ(rows[0]["what"], "Small Pen");
  EXPECT_EQ(rows[1]["what"], "Linux's driver hid-generic has it");
  EXPECT_EQ(rows[2]["subject"], "udev rules");
}

TEST_F(LiveDevices, RecordsWhatComesAsAFileThatDecodes) {
  const SimulatedPen pen(10);
  for (const std::string device : {"", "1209:0001", "1209:1:0", "/dev/hidraw0"}) {
    const std::string file = pen.path("mine" + std::to_string(device.size()) + ".hid");
    const CommandRun run = pen.limn("record " + device + " --seconds 1 -o " + file);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr(" of 1 device in "));
    const std::string text = read_file(file);
    EXPECT_THAT(text,
                StartsWith("D: 0\n" + small_pen_header().substr(0, small_pen_header().find("I:")) +
                           "P: usb-1/input0\nI: 3 1209 0001\nE: 0.000000 "));
    // Where the machine is slow umockdev joins reports, so bytes are counted and not lines.
    std::size_t bytes = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("E: ")) continue;
      bytes += std::stoul(line.substr(line.find(' ', 3)));
    }
    EXPECT_EQ(bytes, 60u) << text;
    const CommandRun decoded = run_limn({"decode", file, "--format", "csv"});
    EXPECT_EQ(decoded.exit_code, 0) << decoded.err;
    EXPECT_THAT(decoded.out, HasSubstr("in_contact"));
  }
}

TEST_F(LiveDevices, RecordNeverWritesOverARecording) {
  const SimulatedPen pen(1);
  const std::string file = pen.path("mine.hid");
  ASSERT_EQ(pen.limn("record --seconds 0.1 -o " + file).exit_code, 0);
  const std::string before = read_file(file);
  const CommandRun again = pen.limn("record --seconds 0.1 -o " + file);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.err, HasSubstr("exists already; choose another name or remove it"));
  EXPECT_EQ(read_file(file), before);
}

TEST_F(LiveDevices, RecordEndsCleanlyBySignal) {
  const SimulatedPen pen(5);
  const std::string file = pen.path("mine.hid");
  // Once a report is in the file; in the background the shell would have SIGINT ignored.
  const std::string stopped_when_it_records =
      "sh -c '\"$@\" & until grep -q ^E: " + file +
      " 2>/dev/null; do sleep 0.1; done; kill -TERM $!; wait $!' sh";
  const CommandRun run = pen.limn("record -o " + file, stopped_when_it_records);
  EXPECT_THAT(run.err, HasSubstr(" of 1 device in ")) << run.err;
  EXPECT_THAT(read_file(file), HasSubstr("\nE: 0.000000 "));
}

TEST_F(LiveDevices, RecordTellsAFullDisk) {
  const SimulatedPen pen(3);
  const CommandRun run = pen.limn("record --seconds 1 -o /dev/full");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("/dev/full: cannot write: No space left on device"));
}

TEST_F(LiveDevices, MonitorCountsAndShowsValues) {
  const SimulatedPen pen(10);
  const CommandRun run = pen.limn("monitor --seconds 1 --format jsonl");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream lines(run.out);
  json last;
  for (std::string line; std::getline(lines, line);) last = json::parse(line);
  EXPECT_EQ(last["id"], "1209:0001");
  EXPECT_EQ(last["name"], "Small Pen");
  EXPECT_GT(last["reports"], 0);
  EXPECT_LE(last["reports"], 10);
  EXPECT_EQ(last["lost"], 0);
  const CommandRun text = pen.limn("monitor --seconds 1");
  EXPECT_THAT(text.out, HasSubstr("in_contact"));
  EXPECT_THAT(text.out, HasSubstr("latency"));
}

TEST_F(LiveDevices, SayWhatIsMissing) {
  const SimulatedPen pen(0);
  EXPECT_THAT(pen.limn("record 1:2 -o " + pen.path("no.hid")).err,
              HasSubstr("no device 1:2 is here; plug it in and see 'limn devices'"));
  EXPECT_THAT(pen.limn("record 1209:1:7 -o " + pen.path("no.hid")).err,
              HasSubstr("no device 1209:1:7 is here"));
  const CommandRun word = pen.limn("monitor pen");
  EXPECT_EQ(word.exit_code, 2);
  EXPECT_THAT(word.err, HasSubstr("'pen' is no device; give VID:PID, VID:PID:N or a node"));
  EXPECT_THAT(pen.limn("monitor /dev/null").err, HasSubstr("/dev/null: is no hidraw node"));
  EXPECT_THAT(pen.limn("monitor /dev/hidraw9").err, HasSubstr("No such file or directory"));
  EXPECT_FALSE(std::filesystem::exists(pen.path("no.hid")));
}

}  // namespace
}  // namespace limn::test
