#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

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
    EXPECT_EQ(f.remedy.empty(), f.state == State::kGood) << "every trouble has a remedy";
  }
  return out;
}

TEST(Diagnose, ABareSystem) {
  const TempFolder root;
  EXPECT_THAT(texts(diagnose({}, root.path())),
              ElementsAre("notice devices: no HID device is here",
                          "trouble udev rules: 70-limn.rules is not installed",
                          "good spacenavd: it does not run"));
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
                                   "good spacenavd: it does not run"));
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
                          "notice spacenavd: it runs and reads the 3D mice"));
}

}  // namespace
}  // namespace limn::test
