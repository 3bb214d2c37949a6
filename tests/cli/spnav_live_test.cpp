// `limn spnav-server` and a 3D mouse that is plugged in and unplugged while it serves: a hidraw
// node that umockdev plays below the C library, and Debian's libspnav. Runs under umockdev-wrapper.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>  // SIGTERM
#include <umockdev.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_sim/devices/catalogue.hpp"
#include "tests/cli/running_limn.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/umockdev_text.hpp"

#define SPNAV_CONFIG_H_
#include <spnav.h>

namespace limn::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr const char* kUsb = "/devices/pci0000:00/0000:00:14.0/usb1/1-1";
constexpr const char* kHid = "/1-1:1.0/0003:046D:C626.0001";

std::string node_of(int number) { return "/dev/hidraw" + std::to_string(number); }
std::string hidraw_path(int number) {
  return std::string(kUsb) + kHid + "/hidraw/hidraw" + std::to_string(number);
}

/// The next event as text, "add", "motion 350 0 0 0 0 0", "press 0"; "nothing" where none comes in
/// ten seconds.
std::string next_event() {
  spnav_event event{};
  while (spnav_poll_event(&event) == 0) {
    pollfd ready{spnav_fd(), POLLIN, 0};
    if (::poll(&ready, 1, 10'000) != 1) return "nothing";
  }
  if (event.type == SPNAV_EVENT_DEV) return event.dev.op == SPNAV_DEV_ADD ? "add" : "remove";
  if (event.type == SPNAV_EVENT_BUTTON) {
    return (event.button.press != 0 ? "press " : "release ") + std::to_string(event.button.bnum);
  }
  const spnav_event_motion& m = event.motion;
  std::string text = "motion";
  for (const int axis : {m.x, m.y, m.z, m.rx, m.ry, m.rz}) text += " " + std::to_string(axis);
  return text;
}

/// All events up to the first `last`. A slow machine has rests between them: whoever hears nothing
/// of a deflected mouse for 100 ms takes it for released.
std::vector<std::string> events_until(const std::string& last) {
  std::vector<std::string> events;
  do {
    events.push_back(next_event());
  } while (events.back() != last && events.back() != "nothing");
  EXPECT_EQ(events.back(), last);
  return events;
}

constexpr const char* kRest = "motion 0 0 0 0 0 0";

class SpnavServerLive : public testing::Test {
 protected:
  void SetUp() override {
    const char* preloaded = std::getenv("LD_PRELOAD");
    if (preloaded == nullptr ||
        std::string_view(preloaded).find("umockdev") == std::string_view::npos) {
      GTEST_SKIP() << "umockdev-wrapper did not start this program";
    }
    testbed_ = umockdev_testbed_new();
    ::setenv("SPNAV_SOCKET", socket_.c_str(), 1);
  }
  void TearDown() override {
    spnav_close();
    if (testbed_ != nullptr) g_object_unref(testbed_);
  }

  void add(const std::string& devices) {
    GError* error = nullptr;
    ASSERT_TRUE(umockdev_testbed_add_from_string(testbed_, devices.c_str(), &error))
        << error->message;
  }
  /// A SpaceNavigator on hidraw.
  void plug(int number) {
    const auto made = firmware::make_simulated_device("spacenavigator", "push", 1);
    const auto bytes = made->bus().spec().interfaces[0].report_descriptor;
    const HidrawNode node{
        node_of(number), 0x046D, 0xC626, {bytes.begin(), bytes.end()}, "SpaceNavigator"};
    const std::string file = folder_.write("ioctls" + std::to_string(number), hidraw_ioctls(node));
    GError* error = nullptr;
    ASSERT_TRUE(umockdev_testbed_load_ioctl(testbed_, node.path.c_str(), file.c_str(), &error))
        << error->message;
    const std::string digits = std::to_string(number);
    const std::string hid = std::string(kUsb) + kHid;
    // udev tells of each as it is added, of hidraw last.
    add("P: " + std::string(kUsb) +
        "\nN: bus/usb/001/002\nE: DEVTYPE=usb_device\nE: DEVNAME=/dev/bus/usb/001/002\n"
        "E: SUBSYSTEM=usb\nA: idVendor=046d\\n\nA: idProduct=c626\\n\nA: "
        "product=SpaceNavigator\\n\n");
    add("P: " + std::string(kUsb) +
        "/1-1:1.0\nE: DEVTYPE=usb_interface\nE: SUBSYSTEM=usb\nA: bInterfaceNumber=00\\n\n");
    add("P: " + hid +
        "\nE: DRIVER=hid-generic\nE: HID_ID=0003:0000046D:0000C626\nE: HID_NAME=SpaceNavigator\n"
        "E: HID_PHYS=usb-1/input0\nE: HID_UNIQ=\nE: SUBSYSTEM=hid\nH: report_descriptor=" +
        digits_of(bytes) + "\n");
    add("P: " + hidraw_path(number) + "\nN: hidraw" + digits + "\nE: DEVNAME=/dev/hidraw" + digits +
        "\nE: MAJOR=243\nE: MINOR=" + digits + "\nE: SUBSYSTEM=hidraw\nA: dev=243:" + digits +
        "\\n\nL: device=../../../0003:046D:C626.0001\n");
  }
  void unplug(int number) {
    const std::string node = node_of(number);
    ::close(umockdev_testbed_get_dev_fd(testbed_, node.c_str()));
    for (const std::string& path : {hidraw_path(number), std::string(kUsb) + kHid,
                                    std::string(kUsb) + "/1-1:1.0", std::string(kUsb)}) {
      umockdev_testbed_uevent(testbed_, ("/sys" + path).c_str(), "remove");
      umockdev_testbed_remove_device(testbed_, ("/sys" + path).c_str());
    }
    // umockdev leaves these behind, and stumbles over them when another device comes.
    g_autofree char* root = umockdev_testbed_get_root_dir(testbed_);
    for (const std::string& left :
         {node, "/ioctl" + node, std::string("/dev/.node"), std::string("/dev/.ptymap")}) {
      std::filesystem::remove_all(root + left);
    }
  }
  void send(int number, const std::vector<std::uint8_t>& report) {
    ASSERT_EQ(::write(umockdev_testbed_get_dev_fd(testbed_, node_of(number).c_str()), report.data(),
                      report.size()),
              static_cast<ssize_t>(report.size()));
  }

  TempFolder folder_;
  std::string socket_ = (folder_.path() / "spnav.sock").string();
  UMockdevTestbed* testbed_ = nullptr;
};

TEST_F(SpnavServerLive, AMouseMayComeGoInMidMotionAndComeBack) {
  RunningLimn limn({"spnav-server", "--socket", socket_});
  EXPECT_EQ(limn.line(), "limn: no 3D mouse is here yet; it is waited for\n");
  EXPECT_THAT(limn.line(), HasSubstr("listening on " + socket_));
  ASSERT_EQ(spnav_open(), 0);

  plug(0);
  EXPECT_EQ(next_event(), "add");
  send(0, {1, 0x5E, 0x01, 0, 0, 0, 0});
  EXPECT_EQ(next_event(), "motion 350 0 0 0 0 0");
  send(0, {3, 1, 0});
  events_until("press 0");
  send(0, {1, 0, 0, 0xA2, 0xFE, 0, 0});
  events_until("motion 0 0 350 0 0 0");
  unplug(0);
  const auto leaving = events_until("remove");
  EXPECT_THAT(leaving, Contains(kRest));
  EXPECT_THAT(leaving, Contains("release 0"));

  plug(1);
  EXPECT_EQ(next_event(), "add");
  send(1, {2, 0, 0, 0xA2, 0xFE, 0, 0});
  EXPECT_EQ(next_event(), "motion 0 0 0 0 0 350");
  send(1, {2, 0, 0, 0, 0, 0, 0});
  events_until(kRest);
  EXPECT_EQ(limn.end(SIGTERM), 0);
  EXPECT_NE(limn.line_with(" samples"), "");
}

TEST_F(SpnavServerLive, AMouseThatIsHereAnswersFromTheStart) {
  plug(0);
  RunningLimn limn({"spnav-server", "046d:c626", "--socket", socket_});
  EXPECT_THAT(limn.line(), HasSubstr("listening on " + socket_));
  ASSERT_EQ(spnav_open(), 0);
  send(0, {1, 0x5E, 0x01, 0, 0, 0, 0});
  events_until("motion 350 0 0 0 0 0");  // "add" before it where the client was faster
  send(0, {1, 0, 0, 0, 0, 0, 0});
  events_until(kRest);
  std::array<char, 64> name{};
  EXPECT_GT(spnav_dev_name(name.data(), static_cast<int>(name.size())), 0);
  EXPECT_STREQ(name.data(), "SpaceNavigator");
  EXPECT_EQ(spnav_dev_buttons(), 2);
  EXPECT_EQ(limn.end(SIGTERM), 0);
}

}  // namespace
}  // namespace limn::test
