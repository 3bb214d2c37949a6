#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "drivers/transport/diagnosis.hpp"
#include "tests/support/temp_folder.hpp"

namespace limn::test {
namespace {

namespace fs = std::filesystem;
using State = Finding::State;
using testing::ElementsAre;

ListedDevice pen(std::string node, bool readable) {
  ListedDevice listed;
  listed.node = std::move(node);
  listed.device.name = "A Pen";
  listed.readable = readable;
  return listed;
}

/// "trouble /dev/hidraw1: A Pen: no permission"
std::vector<std::string> texts(const std::vector<Finding>& findings) {
  constexpr const char* kStates[] = {"good", "notice", "trouble"};
  std::vector<std::string> out;
  for (const Finding& f : findings) {
    out.push_back(std::string(kStates[static_cast<int>(f.state)]) + " " + f.subject + ": " +
                  f.what);
    EXPECT_TRUE(!f.remedy.empty() || f.state == State::kGood) << "every trouble has a remedy";
  }
  return out;
}

constexpr const char* kQueues =
    "good queues: the kernel keeps 63 reports a reader on hidraw and tells nobody of more; 'limn "
    "monitor' and 'limn record' count what may be lost, and the overruns that event nodes tell of";

TEST(Diagnose, ABareSystem) {
  const TempFolder root;
  EXPECT_THAT(texts(diagnose({}, root.path())),
              ElementsAre("notice devices: no HID device is here",
                          "trouble udev rules: 70-limn.rules is not installed",
                          "good spacenavd: it does not run", kQueues));
}

TEST(Diagnose, FindsRulesWhereUdevLooks) {
  for (const char* folder : {"etc", "run", "usr/local/lib", "usr/lib", "lib"}) {
    const TempFolder root;
    fs::create_directories(root.path() / folder / "udev/rules.d");
    root.write(std::string(folder) + "/udev/rules.d/70-limn.rules", "");
    const auto found = texts(diagnose({pen("/dev/hidraw0", true)}, root.path()));
    EXPECT_THAT(found, ElementsAre("good /dev/hidraw0: A Pen",
                                   std::string("good udev rules: /") + folder +
                                       "/udev/rules.d/70-limn.rules",
                                   "good spacenavd: it does not run", kQueues));
  }
}

TEST(Diagnose, NamesPermissionsHoldersAndSpacenavd) {
  const TempFolder root;
  fs::create_directories(root.path() / "proc/42/fd");
  fs::create_directories(root.path() / "proc/sys");
  fs::create_directories(root.path() / "run");
  root.write("proc/42/comm", "OpenTabletDrive\n");
  root.write("run/spnav.sock", "");
  fs::create_symlink("/dev/hidraw1", root.path() / "proc/42/fd/7");
  fs::create_symlink("/dev/null", root.path() / "proc/42/fd/8");
  EXPECT_THAT(texts(diagnose({pen("/dev/hidraw0", true), pen("/dev/hidraw1", false)}, root.path())),
              ElementsAre("good /dev/hidraw0: A Pen", "trouble /dev/hidraw1: A Pen: no permission",
                          "trouble udev rules: 70-limn.rules is not installed",
                          "notice /dev/hidraw1: OpenTabletDrive (process 42) has it open",
                          "notice OpenTabletDrive (process 42): OpenTabletDriver sets tablets up "
                          "and takes them from the kernel",
                          "notice spacenavd: it runs and holds the event nodes of 3D mice; "
                          "/run/spnav.sock gives its motions",
                          kQueues));
}

TEST(Diagnose, ASpacenavdWithoutItsSocketIsInTheWay) {
  const TempFolder root;
  fs::create_directories(root.path() / "proc/7");
  root.write("proc/7/comm", "spacenavd\n");
  EXPECT_EQ(texts(diagnose({pen("/dev/hidraw0", true)}, root.path())).at(2),
            "trouble spacenavd: spacenavd (process 7) holds 3D mice, but its socket is not there");
}

TEST(Diagnose, NamesTheDriverOfLinux) {
  const TempFolder root;
  ListedDevice listed = pen("/dev/hidraw0", true);
  for (const auto& [driver, text] :
       {std::pair{"wacom",
                  "good /dev/hidraw0: Linux's driver wacom has it, beside which limn "
                  "reads"},
        std::pair{"hid-generic", "good /dev/hidraw0: Linux's driver hid-generic has it"},
        std::pair{"uclogic",
                  "notice /dev/hidraw0: Linux's driver uclogic has it: it has set the "
                  "tablet up and put its own descriptor in place"}}) {
    listed.driver = driver;
    EXPECT_EQ(texts(diagnose({listed}, root.path())).at(1), text);
  }
}

TEST(LookAt, KnowsWhatKeepsADeviceFromLimn) {
  ListedDevice listed = pen("/dev/input/event3", false);
  listed.backend = Backend::kEvdev;
  EXPECT_EQ(look_at(listed).state, State::kTrouble);
  listed.same_as = "/dev/hidraw0";
  EXPECT_EQ(look_at(listed).state, State::kNotice) << "hidraw will do";
  listed.backend = Backend::kUsb;
  EXPECT_THAT(
      texts({look_at(listed)}),
      ElementsAre(
          "trouble /dev/input/event3: A Pen: no driver of Linux has it, and no permission"));
  listed.readable = true;
  EXPECT_THAT(look_at(listed).remedy, testing::StartsWith("read it with --backend usb"));
  EXPECT_THAT(texts({look_at(listed)}),
              ElementsAre("notice /dev/input/event3: A Pen: no driver of Linux has it"));
  listed.driver = "usbfs";
  EXPECT_THAT(texts({look_at(listed)}),
              ElementsAre("trouble /dev/input/event3: A Pen: another program holds it"));
}

TEST(LookAt, KnowsWhatSettingUpNeeds) {
  const TempFolder folder;
  ListedDevice listed = pen(folder.write("hidraw0", ""), true);
  listed.device.vendor = 0x256C;  // a Huion, which is asked for its strings
  listed.device.product = 0x006E;
  listed.driver = "hid-generic";
  listed.interface_number = 0;
  listed.usb_node = folder.write("usb", "").string();
  EXPECT_EQ(look_at(listed).state, State::kGood);
  listed.usb_node = (folder.path() / "absent").string();
  const Finding finding = look_at(listed);
  EXPECT_EQ(finding.state, State::kNotice);
  EXPECT_EQ(finding.what, "A Pen: cannot be set up, as " + listed.usb_node + " may not be written");
  EXPECT_EQ(finding.remedy, "install the udev rules and plug the device in again");
  listed.driver = "uclogic";
  EXPECT_EQ(look_at(listed).state, State::kGood) << "Linux's driver has set it up";
}

TEST(LookAt, RecommendsTheRulesOnlyWhereTheyHelp) {
  ListedDevice listed = pen("/dev/hidraw0", false);
  EXPECT_EQ(look_at(listed).remedy,
            "no line of 70-limn.rules is about it: add one for its vendor, as those there");
  listed.device.vendor = 0x056A;
  EXPECT_EQ(look_at(listed).remedy, "install the udev rules and plug the device in again");
  listed.backend = Backend::kEvdev;
  EXPECT_EQ(look_at(listed).remedy,
            "log in at this machine's own screen, or read the device on hidraw");
  listed.tablet = true;
  EXPECT_EQ(look_at(listed).remedy, "install the udev rules and plug the device in again");
}

TEST(IsInRules, KnowsTheVendorsOfTheFile) {
  std::ifstream file(LIMN_RULES_FILE);
  const std::string rules{std::istreambuf_iterator<char>(file), {}};
  ASSERT_NE(rules, "");
  int vendors = 0;
  for (unsigned vendor = 0; vendor <= 0xFFFF; ++vendor) {
    char quoted[24];
    std::snprintf(quoted, sizeof quoted, "idVendor}==\"%04x\"", vendor);
    ListedDevice listed;
    listed.device.vendor = static_cast<std::uint16_t>(vendor);
    listed.device.product = 0xC600;
    const bool covered = rules.find(quoted) != std::string::npos;
    ASSERT_EQ(is_in_rules(listed), covered) << quoted;
    vendors += covered;
  }
  EXPECT_EQ(vendors, 8);
  EXPECT_NE(rules.find("KERNEL==\"event*\", ENV{ID_INPUT_TABLET}==\"1\", TAG+=\"uaccess\""),
            std::string::npos);
}

}  // namespace
}  // namespace limn::test
