// `limn record` and `monitor` on USB devices that umockdev simulates below libusb, and pens that
// must be set up first, by USB and by hidraw.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>

#include "tests/cli/sample_traces.hpp"
#include "tests/cli/simulated_usb.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/umockdev_text.hpp"

namespace limn::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Bytes = SimulatedUsb::Bytes;

Bytes small_pen_report(int x) { return {1, 3, static_cast<std::uint8_t>(x), 0, 100, 0}; }

/// The reports of a recording, as they stand behind the time, in order.
std::vector<std::string> reports_in(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("E: ")) out.push_back(line.substr(line.find(' ', 3) + 1));
  }
  return out;
}

void make_small_pen(SimulatedUsb& pen) {
  pen.report_descriptor = small_pen_descriptor();
  pen.give_descriptor();
}

class LiveUsb : public testing::Test {
 protected:
  void SetUp() override {
    if (LIMN_HAS_LIBUSB == 0) GTEST_SKIP() << "this build has no libusb";
    if (!has_umockdev()) GTEST_SKIP() << "umockdev is not installed";
  }
};

TEST_F(LiveUsb, RecordsEveryReportWhole) {
  SimulatedUsb pen;
  pen.packet_bytes = 4;  // a report takes two packets
  make_small_pen(pen);
  for (int i = 0; i < 100; ++i) pen.send(small_pen_report(i), 8);
  for (const std::string device : {"", "1209:0001", "1209:1:0", "/dev/bus/usb/001/002"}) {
    const std::string file = pen.path("mine" + std::to_string(device.size()) + ".hid");
    const CommandRun run = pen.limn("record --backend usb " + device + " --seconds 1 -o " + file);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("100 reports of 1 device in "));
    const std::string text = read_file(file);
    const std::string descriptor = small_pen_header().substr(0, small_pen_header().find("N:"));
    EXPECT_THAT(text, StartsWith("D: 0\n" + descriptor +
                                 "N: Limn Small Pen\nP: usb-0000:00:14.0-1/input0\n"
                                 "I: 3 1209 0001\nE: 0.000000 6 01 03 00 00 64 00\n"));
    const auto reports = reports_in(text);
    ASSERT_EQ(reports.size(), 100u);
    EXPECT_EQ(reports[99], "6 01 03 63 00 64 00");
  }
}

TEST_F(LiveUsb, ANodeOfABoundDeviceNeedsNoBackend) {
  SimulatedUsb pen;
  make_small_pen(pen);
  pen.send(small_pen_report(1), 64);
  pen.fail(ENODEV, 64);
  const CommandRun run = pen.limn("record /dev/bus/usb/001/002 -o -");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, StartsWith("1 report of 1 device"));
  EXPECT_THAT(run.out, HasSubstr("P: usb-0000:00:14.0-1/input0"));
}

TEST_F(LiveUsb, AStalledEndpointIsClearedAndReadOn) {
  SimulatedUsb pen;
  make_small_pen(pen);
  for (int i = 0; i < 3; ++i) pen.send(small_pen_report(i), 64);
  pen.fail(EPIPE, 64);
  for (int i = 3; i < 7; ++i) pen.send(small_pen_report(i), 64);
  const std::string file = pen.path("mine.hid");
  const CommandRun run = pen.limn("record --backend usb --seconds 1 -o " + file);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(reports_in(read_file(file)).size(), 7u);
}

TEST_F(LiveUsb, ADeviceThatOnlyStallsCountsAsGone) {
  SimulatedUsb pen;
  make_small_pen(pen);
  // All transfers that wait come back at once, which is one stall.
  for (int i = 0; i < 200; ++i) pen.fail(EPIPE, 64);
  const CommandRun run = pen.limn("record --backend usb /dev/bus/usb/001/002 -o -");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("#limn gone\n"));
}

TEST_F(LiveUsb, AnUnpluggedDeviceIsGone) {
  SimulatedUsb pen;
  make_small_pen(pen);
  pen.send(small_pen_report(1), 64);
  pen.fail(EOVERFLOW, 64);
  pen.send(small_pen_report(2), 64);
  pen.fail(ENODEV, 64);
  const CommandRun run = pen.limn("record --backend usb /dev/bus/usb/001/002 -o -");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(reports_in(run.out).size(), 2u);
  EXPECT_THAT(run.out, HasSubstr("#limn lost 1\n")) << "one was longer than it may be";
  EXPECT_THAT(run.out, HasSubstr("#limn gone\n"));
}

TEST_F(LiveUsb, ADeviceThatLiesAboutLengthsIsRead) {
  SimulatedUsb pen;
  pen.announced_descriptor = 4096;
  make_small_pen(pen);
  pen.send(Bytes(64, 1), 64);  // ten times what its descriptor says
  pen.send({}, 64);
  pen.send({1}, 64);
  const std::string file = pen.path("mine.hid");
  const CommandRun run = pen.limn("record --backend usb --seconds 1 -o " + file);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto reports = reports_in(read_file(file));
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_THAT(reports[0], StartsWith("64 01 01"));
  EXPECT_EQ(reports[1], "1 01");
}

TEST_F(LiveUsb, DescriptorsAbove4KibAreRefused) {
  SimulatedUsb pen;
  pen.announced_descriptor = 4097;
  make_small_pen(pen);
  const CommandRun run = pen.limn("monitor --backend usb 1209:1");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.err,
            "limn: /dev/bus/usb/001/002: a report descriptor of 4097 bytes is above 4 KiB; this is "
            "no device that Linux supports\n");
}

TEST_F(LiveUsb, ADeviceThatVanishesIsNamed) {
  SimulatedUsb pen;
  make_small_pen(pen);
  const CommandRun run =
      pen.limn("monitor --backend usb 1209:1", std::string("rm ") + SimulatedUsb::kNode);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.err,
            "limn: /dev/bus/usb/001/002: cannot be opened: No such device; plug the device in and "
            "see 'limn devices'\n");
}

TEST_F(LiveUsb, PermissionIsNamedWithItsRemedy) {
  SimulatedUsb pen;
  make_small_pen(pen);
  std::string before = "chmod 000 " + std::string(SimulatedUsb::kNode);
  if (::geteuid() == 0) {
    // Root may do anything: become nobody, who must be able to come so far.
    before = "chmod -R a+rwX \"$UMOCKDEV_DIR\"; " + before +
             "; set -- setpriv --reuid 65534 --clear-groups \"$@\"";
  }
  const CommandRun run = pen.limn("monitor --backend usb 1209:1", before);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.err,
            "limn: /dev/bus/usb/001/002: cannot be opened: Permission denied; install limn's udev "
            "rules and plug the device in again, or see 'limn doctor'\n");
}

TEST_F(LiveUsb, AnInterfaceInUseIsNamed) {
  SimulatedUsb pen;
  make_small_pen(pen);
  const CommandRun run =
      pen.limn("monitor --backend usb 1209:1", "export LD_PRELOAD=" LIMN_BUSY_USBFS ":$LD_PRELOAD");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.err,
            "limn: /dev/bus/usb/001/002: cannot be claimed at interface 0: Device or resource "
            "busy; end the program that has it ('limn doctor' may name it)\n");
}

TEST_F(LiveUsb, WordsThatNameNothingAreErrors) {
  const CommandRun backend = run_limn({"monitor", "--backend", "usbb"});
  EXPECT_EQ(backend.exit_code, 2);
  EXPECT_THAT(backend.err, HasSubstr("there is no backend 'usbb'; did you mean usb?"));
  SimulatedUsb pen;
  make_small_pen(pen);
  EXPECT_THAT(pen.limn("monitor --backend usb 1:2").err, HasSubstr("no device 1:2 is here"));
  EXPECT_THAT(pen.limn("monitor --backend usb /dev/hidraw0").err,
              HasSubstr("/dev/hidraw0: is no node of a USB device"));
  EXPECT_THAT(pen.limn("monitor --backend usb /dev/bus/usb/001/009").err,
              HasSubstr("cannot be opened: No such device"));
}

TEST_F(LiveUsb, DrainingAFloodAllocatesNothingOfOursAndHasItsShare) {
  SimulatedUsb pen;
  make_small_pen(pen);
  for (int i = 0; i < 1000; ++i) pen.send(small_pen_report(i), 64);
  pen.fail(ENODEV, 64);
  const CommandRun run = pen.run(LIMN_DEVICE_PROBE, "drain");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "1000 reports, 0 allocations, gone\n") << run.err;
}

/// A Huion whose product no table knows; its string 200 is that of a New 1060 Plus: 50800 x 31750
/// counts at 5080 lines an inch.
void make_unknown_huion(SimulatedUsb& tablet) {
  tablet.vendor = 0x256C;
  tablet.product = 0x0999;
  tablet.report_descriptor = small_pen_descriptor();
}
const Bytes kStringV2 = {0x12, 0x03, 0x70, 0xC6, 0x00, 0x06, 0x7C, 0x00, 0xFF,
                         0x1F, 0xD8, 0x13, 0x03, 0x0C, 0x10, 0x00, 0x01, 0x00};
constexpr const char* kStringNotes =
    "#limn string 201\n"
    "#limn string 200 12 03 70 c6 00 06 7c 00 ff 1f d8 13 03 0c 10 00 01 00\n";
/// At 25400 x 12700 counts: 127 x 63.5 mm.
const Bytes kReportV2 = {0x08, 0x81, 0x38, 0x63, 0x9C, 0x31, 0xFF, 0x0F, 0, 0, 0, 0};

void expect_decoded(const std::string& recording) {
  const CommandRun decoded = run_limn({"decode", "-", "--format", "csv"}, recording);
  EXPECT_EQ(decoded.exit_code, 0) << decoded.err;
  EXPECT_THAT(decoded.out, HasSubstr(",127,63.5,"));
}

TEST_F(LiveUsb, AnUnknownHuionIsSetUpAndItsRecordingDecodesWithoutIt) {
  SimulatedUsb tablet;
  make_unknown_huion(tablet);
  tablet.give_descriptor();
  tablet.give_string(201, {});
  tablet.give_string(200, kStringV2);
  tablet.send(kReportV2, 64);
  tablet.fail(ENODEV, 64);
  const CommandRun run = tablet.limn("record --backend usb /dev/bus/usb/001/002 -o -");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr(std::string("I: 3 256c 0999\n") + kStringNotes + "E: "));
  expect_decoded(run.out);
}

TEST_F(LiveUsb, NoInitLeavesItAsItIs) {
  SimulatedUsb tablet;
  make_unknown_huion(tablet);
  tablet.give_descriptor();
  tablet.send(small_pen_report(1), 64);
  tablet.fail(ENODEV, 64);
  const CommandRun run = tablet.limn("record --backend usb --no-init /dev/bus/usb/001/002 -o -");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(reports_in(run.out).size(), 1u);
  EXPECT_THAT(run.out, Not(HasSubstr("#limn string")));
}

TEST_F(LiveUsb, KyeIsSetByAFeatureReportAndUgeeByWritingToIt) {
  SimulatedUsb kye;
  kye.vendor = 0x0458;
  kye.product = 0x5011;
  kye.report_descriptor = small_pen_descriptor();
  kye.give_descriptor();
  kye.take_feature({0x05, 0x12, 0x10, 0x11, 0x12, 0, 0, 0});
  kye.send(small_pen_report(1), 64);
  kye.fail(ENODEV, 64);
  const CommandRun run = kye.limn("record --backend usb /dev/bus/usb/001/002 -o -");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, StartsWith("1 report of 1 device"));

  SimulatedUsb ugee;
  ugee.vendor = 0x28BD;
  ugee.product = 0x0907;
  ugee.interface_number = 2;
  ugee.report_descriptor = small_pen_descriptor();
  ugee.give_descriptor();
  ugee.take_interrupt({0x02, 0xB0, 0x04, 0, 0, 0, 0, 0, 0, 0});
  ugee.give_string(
      100, {0x0E, 0x03, 0x40, 0x9C, 0xA8, 0x61, 0x03, 0x00, 0xFF, 0x1F, 0xA0, 0x0F, 0x08, 0x00});
  ugee.send(small_pen_report(1), 64);
  ugee.fail(ENODEV, 64);
  const CommandRun second = ugee.limn("record --backend usb /dev/bus/usb/001/002 -o -");
  EXPECT_EQ(second.exit_code, 0);
  EXPECT_THAT(second.err, StartsWith("1 report of 1 device"));
  EXPECT_THAT(second.out, HasSubstr("#limn string 100 0e 03 40 9c a8 61"));
}

/// What umockdev-run needs for /dev/hidraw0; `script` is what its node sends and takes.
std::string hidraw_options(const SimulatedUsb& tablet, const TempFolder& folder,
                           const std::string& script, const std::string& more_ioctls = {}) {
  const HidrawNode node{.vendor = tablet.vendor,
                        .product = tablet.product,
                        .report_descriptor = tablet.report_descriptor,
                        .name = "Limn Small Pen"};
  const std::string ioctls =
      folder.write("hidraw.ioctl", hidraw_ioctls(node) + more_ioctls).string();
  return "-i /dev/hidraw0=" + ioctls +
         " -s /dev/hidraw0=" + folder.write("hidraw.script", script).string();
}

TEST_F(LiveUsb, FeatureReportsAreAskedForOnBothWays) {
  SimulatedUsb mouse;
  make_small_pen(mouse);
  mouse.give_feature(7, {0x07, 0x01, 0x02}, 4);
  const CommandRun run = mouse.run(LIMN_DEVICE_PROBE, "feature");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "07 01 02 \n");

  SimulatedUsb hidraw;
  hidraw.on_hidraw = true;
  hidraw.report_descriptor = small_pen_descriptor();
  const TempFolder folder;
  const CommandRun second =
      hidraw.run(LIMN_DEVICE_PROBE, "feature /dev/hidraw0", "",
                 hidraw_options(hidraw, folder, "", "HIDIOCGFEATURE 3 07010200\n"));
  EXPECT_EQ(second.exit_code, 0) << second.err;
  EXPECT_EQ(second.out, "07 01 02 \n");
}

TEST_F(LiveUsb, AStreamedDeviceIsAskedAndToldThings) {
  SimulatedUsb mouse;
  make_small_pen(mouse);
  mouse.send(small_pen_report(1), 64);
  mouse.give_feature(7, {0x07, 0x01, 0x02}, 4);
  mouse.take_output({0x04, 0x01});
  mouse.send(small_pen_report(2), 64);
  mouse.fail(ENODEV, 64);
  const CommandRun run = mouse.run(LIMN_DEVICE_PROBE, "streamed");
  EXPECT_EQ(run.out, "07 01 02 \n2 reports, gone\n") << run.err;
  EXPECT_THAT(run.err, HasSubstr("cannot be asked: No such device; plug the device in"));
}

TEST_F(LiveUsb, OpeningADeviceThatComesHoldsUpNoOther) {
  // Were it opened in the reading thread, the probe would wait for ever.
  SimulatedUsb tablet;
  make_small_pen(tablet);
  tablet.on_hidraw = true;
  const std::string file = tablet.write_description();
  const std::string interface = "/sys/devices/pci0000:00/0000:00:14.0/usb1/1-1/1-1:1.0";
  for (const std::string& device : {interface + "/0003:1209:0001.0001/hidraw/hidraw0", interface}) {
    const CommandRun run = run_shell(
        "export ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0; timeout 60 "
        "umockdev-wrapper " +
        std::string(LIMN_DEVICE_PROBE) + " hotplug " + file + " " + device);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, "described first\nreport while opening\ndescribed Limn Small Pen\n");
  }
}

/// kReportV2 in umockdev's escapes: ^A is 1, ^@ 0, other bytes as they are.
std::string send_report_v2() {
  std::string line = "r 300 ";
  for (const std::uint8_t byte : kReportV2) {
    if (byte < 32) {
      line += '^';
      line += static_cast<char>(byte + 64);
    } else {
      line += static_cast<char>(byte);
    }
  }
  return line + "\n";
}

TEST_F(LiveUsb, OnHidrawStringsAreAskedOfTheUsbDeviceAbove) {
  SimulatedUsb tablet;
  make_unknown_huion(tablet);
  tablet.on_hidraw = true;
  tablet.give_string(201, {});
  tablet.give_string(200, kStringV2);
  const TempFolder folder;
  const std::string file = tablet.path("mine.hid");
  const CommandRun run = tablet.limn("record --seconds 1 -o " + file, "",
                                     hidraw_options(tablet, folder, send_report_v2()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string text = read_file(file);
  EXPECT_THAT(text, HasSubstr(std::string("I: 3 256c 0999\n") + kStringNotes));
  expect_decoded(text);
}

TEST_F(LiveUsb, OnHidrawAPenThatCannotBeSetUpIsReadAsItIs) {
  SimulatedUsb tablet;
  make_unknown_huion(tablet);
  tablet.on_hidraw = true;
  const TempFolder folder;
  const std::string file = tablet.path("mine.hid");
  const std::string options = hidraw_options(tablet, folder, "r 300 ^A^Ca^@d^@\n");
  const CommandRun run = tablet.limn("record --seconds 1 -o " + file,
                                     std::string("rm ") + SimulatedUsb::kNode, options);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err,
              StartsWith("limn: /dev/hidraw0: is read as it is, not set up: /dev/bus/usb/001/002 "
                         "cannot be opened: No such device; plug the device in"));
  EXPECT_THAT(run.err, HasSubstr("1 report of 1 device"));
  EXPECT_THAT(read_file(file), Not(HasSubstr("#limn string")));
}

TEST_F(LiveUsb, OnHidrawADeviceOfAnotherDriverIsLeftToIt) {
  SimulatedUsb tablet;
  make_unknown_huion(tablet);
  tablet.on_hidraw = true;
  tablet.driver = "uclogic";
  const TempFolder folder;
  const CommandRun run = tablet.limn("record 256c:999 --seconds 0.5 -o " + tablet.path("mine.hid"),
                                     "", hidraw_options(tablet, folder, ""));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(read_file(tablet.path("mine.hid")), Not(HasSubstr("#limn string")));
}

TEST_F(LiveUsb, OnHidrawReportsAreWrittenToTheNode) {
  SimulatedUsb ugee;
  ugee.vendor = 0x28BD;
  ugee.product = 0x0907;
  ugee.interface_number = 2;
  ugee.on_hidraw = true;
  ugee.report_descriptor = small_pen_descriptor();
  ugee.give_string(
      100, {0x0E, 0x03, 0x40, 0x9C, 0xA8, 0x61, 0x03, 0x00, 0xFF, 0x1F, 0xA0, 0x0F, 0x08, 0x00});
  const TempFolder folder;
  // The node only sends once it was written to.
  std::string written = "w 0 ^B";
  written += static_cast<char>(0xB0);
  const std::string script = written + "^D^@^@^@^@^@^@^@\n" + "r 300 ^A^Ca^@d^@\n";
  const std::string file = ugee.path("mine.hid");
  const CommandRun run =
      ugee.limn("record --seconds 1 -o " + file, "", hidraw_options(ugee, folder, script));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(read_file(file), HasSubstr("#limn string 100 0e 03 40 9c a8 61"));
  EXPECT_EQ(reports_in(read_file(file)).size(), 1u);
}

TEST_F(LiveUsb, OnHidrawFeatureReportsGoThroughTheNode) {
  SimulatedUsb kye;
  kye.vendor = 0x0458;
  kye.product = 0x5011;
  kye.on_hidraw = true;
  kye.report_descriptor = small_pen_descriptor();
  const TempFolder folder;
  const std::string file = kye.path("mine.hid");
  const std::string taken = "HIDIOCSFEATURE 8 0512101112000000\n";
  const std::string script = "r 300 ^A^Ca^@d^@\n";
  const CommandRun run =
      kye.limn("record --seconds 1 -o " + file, "", hidraw_options(kye, folder, script, taken));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, Not(HasSubstr("not set up")));
  const CommandRun refused =
      kye.limn("monitor --seconds 0.5", "", hidraw_options(kye, folder, script));
  EXPECT_THAT(refused.err, HasSubstr("/dev/hidraw0: is read as it is, not set up: /dev/hidraw0 "
                                     "cannot be told: "));
}

}  // namespace
}  // namespace limn::test
