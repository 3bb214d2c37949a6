#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "modeler/app/device_selection.hpp"
#include "tests/support/simulated_tablet.hpp"

namespace limn::app {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A pen's interface is 0; others send what no pen does.
ListedDevice row(std::string node, std::string place, int interface_number = 0) {
  ListedDevice listed;
  listed.node = std::move(node);
  listed.device.vendor = 0x1209;
  listed.device.product = 2;
  if (interface_number == 0) {
    listed.device.report_descriptor = test::SimulatedTablet::report_descriptor();
  }
  listed.device.name = "A Pen";
  listed.device.physical_path = std::move(place);
  listed.interface_number = interface_number;
  return listed;
}

ListedDevice event(std::string node, std::string place, bool tablet) {
  ListedDevice listed = row(std::move(node), std::move(place));
  listed.backend = Backend::kEvdev;
  listed.tablet = tablet;
  listed.device.axes = {{0, 0, 20000, 0, 0, 100}, {1, 0, 10000, 0, 0, 100}, {24, 0, 1023, 0, 0, 0}};
  return listed;
}

ListedDevice spacenavd() {
  ListedDevice listed;
  listed.backend = Backend::kSpnav;
  listed.node = "/run/spnav.sock";
  return listed;
}

std::vector<std::string> named(const std::vector<ListedDevice>& rows, const std::string& id,
                               std::optional<Backend> backend = {}) {
  std::vector<std::string> nodes;
  const auto parsed = id.empty() ? std::optional<DeviceId>() : parse_device_id(id);
  for (const auto& one : devices_named(rows, parsed, backend)) nodes.push_back(one.node);
  return nodes;
}

TEST(DevicesNamed, CountsWhatDevicesLists) {
  const std::vector<ListedDevice> rows = {
      row("other", "usb-1/input1", 1), row("a", "usb-1/input0"), row("b", "usb-2/input0"),
      event("pad", "usb-1/input0", false), event("pen", "usb-1/input0", true)};
  EXPECT_THAT(named(rows, ""), ElementsAre("a", "b", "pen"));
  EXPECT_THAT(named(rows, "1209:2"), ElementsAre("a", "b", "pen"));
  EXPECT_THAT(named(rows, "1209:2:0"), ElementsAre("a"));
  EXPECT_THAT(named(rows, "1209:2:2"), ElementsAre("pen"));
  EXPECT_THAT(named(rows, "1209:2:3"), IsEmpty());
  EXPECT_THAT(named(rows, "1:2"), IsEmpty());
}

TEST(DevicesNamed, TakesReportsOfAnUnknownDeviceButNoMereAxes) {
  EXPECT_THAT(named({row("other", "p", 1), event("pad", "p", false)}, "1209:2"),
              ElementsAre("other"));
  EXPECT_THAT(named({row("other", "p", 1)}, ""), IsEmpty());
  EXPECT_THAT(named({event("pad", "p", false)}, "1209:2", Backend::kEvdev), IsEmpty());
}

TEST(DevicesNamed, OfSpacenavdWhateverItHas) {
  EXPECT_THAT(named({spacenavd()}, "", Backend::kSpnav), ElementsAre("/run/spnav.sock"));
  EXPECT_THAT(named({spacenavd()}, "256f:c635", Backend::kSpnav), ElementsAre("/run/spnav.sock"));
  EXPECT_THAT(named({spacenavd()}, ""), IsEmpty()) << "it is no pen";
}

TEST(PenInterfaces, IsTheOneOfThePen) {
  const auto pen = pen_interfaces({row("n", "p1", 1), row("n", "p0", 0)});
  ASSERT_EQ(pen.size(), 1u);
  EXPECT_EQ(pen[0].interface_number, 0);
  EXPECT_EQ(pen_interfaces({row("n", "p1", 1), row("n", "p2", 2)}).size(), 2u) << "none is known";
}

TEST(PenInterfaces, IsTheOneOfTheInitialisation) {
  std::vector<ListedDevice> rows = {row("n", "p0", 0), row("n", "p2", 2)};
  for (ListedDevice& one : rows) {  // an XP-Pen of UGEE, whose interface 2 is told to report
    one.device.vendor = 0x28BD;
    one.device.product = 0x0907;
    one.device.report_descriptor = test::SimulatedTablet::report_descriptor();
  }
  const auto pen = pen_interfaces(rows);
  ASSERT_EQ(pen.size(), 1u);
  EXPECT_EQ(pen[0].interface_number, 2);
}

TEST(DevicesNamed, AreOfTheKindThatIsWanted) {
  const std::vector<ListedDevice> rows = {row("pen", "usb-1/input0"), spacenavd()};
  const auto mice = devices_named(rows, {}, {}, DeviceKind::k3dMouse);
  ASSERT_EQ(mice.size(), 1U);
  EXPECT_EQ(mice[0].node, "/run/spnav.sock");
  const LaterDevices later({}, {}, mice, DeviceKind::k3dMouse);
  EXPECT_FALSE(later.wants(row("pen", "usb-1/input0")));
}

TEST(WithoutSpacenavd, LeavesTheOthersToChooseFrom) {
  const auto rows = without_spacenavd({spacenavd(), row("a", "usb-1/input0"), spacenavd()});
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].node, "a");
  EXPECT_THAT(devices_named(without_spacenavd({spacenavd()}), {}, {}, DeviceKind::k3dMouse),
              IsEmpty());
}

TEST(LaterDevices, KnowsTheVeryDeviceFromItsTwin) {
  const LaterDevices later({}, parse_device_id("1209:2:1"), {row("b", "usb-2/input0")});
  EXPECT_TRUE(later.wants(row("c", "usb-2/input0"))) << "under another node";
  EXPECT_FALSE(later.wants(row("b", "usb-1/input0"))) << "its twin";
  EXPECT_FALSE(later.wants(row("b", "usb-2/input1", 1)));
  EXPECT_FALSE(later.wants(event("e", "usb-2/input0", true))) << "another backend";
  EXPECT_THAT(later.backends(), ElementsAre(Backend::kHidraw));
}

TEST(LaterDevices, LeavesOtherInterfacesAlone) {
  const LaterDevices later({}, parse_device_id("1209:2"), {row("a", "usb-1/input0")});
  EXPECT_TRUE(later.wants(row("a", "usb-2/input0")));
  EXPECT_FALSE(later.wants(row("b", "usb-2/input1", 1)));
  const LaterDevices unknown({}, parse_device_id("1209:2"), {row("b", "usb-1/input1", 1)});
  EXPECT_TRUE(unknown.wants(row("b", "usb-2/input1", 1)));
}

TEST(LaterDevices, WhatWasReadByItsEventNodeComesBackByIt) {
  const LaterDevices later({}, {}, {event("e", "usb-1/input0", true)});
  EXPECT_THAT(later.backends(), ElementsAre(Backend::kHidraw, Backend::kEvdev));
  EXPECT_TRUE(later.wants(event("f", "usb-1/input0", true)));
  EXPECT_FALSE(later.wants(row("a", "usb-1/input0"))) << "or it were read twice";
  EXPECT_TRUE(later.wants(row("b", "usb-2/input0"))) << "a new one comes on hidraw";
  EXPECT_FALSE(later.wants(event("g", "usb-2/input0", true)));
}

TEST(LaterDevices, FollowsTheBackendThatWasAskedFor) {
  const LaterDevices usb(Backend::kUsb, {}, {});
  EXPECT_THAT(usb.backends(), ElementsAre(Backend::kUsb));
  const LaterDevices evdev(Backend::kEvdev, parse_device_id("1209:2"), {});
  EXPECT_TRUE(evdev.wants(event("e", "usb-1/input0", true)));
  EXPECT_FALSE(evdev.wants(event("e", "usb-1/input0", false)));
  const LaterDevices spnav(Backend::kSpnav, {}, {spacenavd()});
  EXPECT_THAT(spnav.backends(), IsEmpty()) << "nobody tells of those";
}

}  // namespace
}  // namespace limn::app
