#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "drivers/transport/device_listing.hpp"
#include "drivers/transport/open_device.hpp"
#include "drivers/transport/sysfs.hpp"
#include "tests/support/temp_folder.hpp"

namespace limn::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

/// A folder that plays "/", with devices as Linux would show them.
class FakeSystem {
 public:
  std::string root() const { return folder_.path().string(); }

  void file(const std::string& path, std::string_view content) const {
    const fs::path whole = folder_.path() / path.substr(1);
    fs::create_directories(whole.parent_path());
    folder_.write(path.substr(1), content);
  }
  void link(const std::string& from, const std::string& to) const {
    const fs::path whole = folder_.path() / from.substr(1);
    fs::create_directories(whole.parent_path());
    fs::create_symlink(to, whole);
  }
  /// A device, and its link in a class or bus.
  void device(const std::string& path, const std::string& subsystem, const std::string& where,
              const std::string& uevent = "") const {
    file("/sys" + path + "/uevent", uevent);
    link("/sys" + path + "/subsystem", "/sys/class/" + subsystem);
    link("/sys" + where + "/" + fs::path(path).filename().string(), root() + "/sys" + path);
  }

  static constexpr const char* kUsb = "/devices/pci0/usb1/1-1";
  static constexpr const char* kInterface = "/devices/pci0/usb1/1-1/1-1:1.2";
  static constexpr const char* kHid = "/devices/pci0/usb1/1-1/1-1:1.2/0003:1209:0001.0001";
  static constexpr const char* kInput =
      "/devices/pci0/usb1/1-1/1-1:1.2/0003:1209:0001.0001/input/input7";

  void usb_device() const {
    device(kUsb, "usb", "/bus/usb/devices", "DEVTYPE=usb_device\n");
    const std::string path = std::string("/sys") + kUsb;
    file(path + "/busnum", "1\n");
    file(path + "/devnum", "12\n");
    file(path + "/idVendor", "1209\n");
    file(path + "/idProduct", "0001\n");
    file(path + "/bcdDevice", "0102\n");
    file(path + "/product", "Small Pen\n");
    file(path + "/serial", "S1\n");
    device(kInterface, "usb", "/bus/usb/devices", "DEVTYPE=usb_interface\n");
    const std::string interface_path = std::string("/sys") + kInterface;
    file(interface_path + "/bInterfaceNumber", "02\n");
    file(interface_path + "/bInterfaceClass", "03\n");
    file(interface_path + "/ep_81/interval", "2ms\n");
    file(interface_path + "/ep_82/interval", "125us\n");
    file(interface_path + "/ep_03/interval", "1us\n");
  }
  void hid_device() const {
    usb_device();
    link(std::string("/sys") + kInterface + "/driver", "../drivers/usbhid");
    device(kHid, "hid", "/bus/hid/devices",
           "DRIVER=hid-generic\nHID_ID=0003:00001209:00000001\nHID_NAME=Small Pen\n"
           "HID_PHYS=usb-1/input2\n");
    file(std::string("/sys") + kHid + "/report_descriptor",
         std::string_view("\x05\x0d\x20\x0a", 4));
    link(std::string("/sys") + kHid + "/driver", "/sys/bus/hid/drivers/hid-generic");
    device(std::string(kHid) + "/hidraw/hidraw4", "hidraw", "/class/hidraw");
  }
  void event_node() const {
    device(kInput, "input", "/class/input");
    const std::string path = std::string("/sys") + kInput;
    file(path + "/name", "Small Pen Pen\n");
    file(path + "/phys", "usb-1/input2\n");
    file(path + "/id/bustype", "0003\n");
    file(path + "/id/vendor", "1209\n");
    file(path + "/id/product", "0001\n");
    file(path + "/id/version", "0110\n");
    file(path + "/capabilities/abs", "1000003\n");
    // Words of the kernel's long, as this program would be shown them: BTN_TOOL_PEN is bit 320.
    file(path + "/capabilities/key",
         sizeof(long) == 8 ? "1c01 0 0 0 0 0\n" : "1c01 0 0 0 0 0 0 0 0 0 0\n");
    device(std::string(kInput) + "/event9", "input", "/class/input");
    file(path + "/event9/dev", "13:73\n");
  }
  void udev_note(const std::string& lines) const { file("/run/udev/data/c13:73", lines); }

 private:
  TempFolder folder_;
};

ListedDevice hidraw(std::string node = "/dev/hidraw4") {
  ListedDevice listed;
  listed.node = std::move(node);
  return listed;
}

TEST(HasCapability, CountsWordsFromTheEnd) {
  EXPECT_TRUE(has_capability("1", 0, 64));
  EXPECT_FALSE(has_capability("1", 1, 64));
  EXPECT_FALSE(has_capability("1", 64, 64));
  EXPECT_TRUE(has_capability("8000000000000000 0 1", 191, 64));
  EXPECT_TRUE(has_capability("80000000 0 1", 95, 32));
  EXPECT_FALSE(has_capability("80000000 0 1", 95, 64));
  EXPECT_FALSE(has_capability("", 0, 64));
  EXPECT_FALSE(has_capability("zz  x", 3, 64));
}

TEST(AddFromSysfs, TellsAHidrawNodesDeviceDriverAndRate) {
  const FakeSystem system;
  system.hid_device();
  ListedDevice listed = hidraw();
  add_from_sysfs(listed, system.root());
  EXPECT_EQ(listed.device.name, "Small Pen");
  EXPECT_EQ(listed.device.physical_path, "usb-1/input2");
  EXPECT_EQ(listed.device.bus, 3);
  EXPECT_EQ(listed.device.report_descriptor, (std::vector<std::uint8_t>{0x05, 0x0D, 0x20, 0x0A}))
      << "with the bytes at its end that would be a line's end in a text";
  EXPECT_EQ(listed.driver, "hid-generic");
  EXPECT_EQ(listed.interface_number, 2);
  EXPECT_EQ(listed.most_reports_per_second, 8000) << "of the fastest endpoint towards us";
  EXPECT_EQ(listed.hid_folder, system.root() + "/sys" + FakeSystem::kHid);
  EXPECT_EQ(listed.usb_folder, system.root() + "/sys" + FakeSystem::kUsb);
}

TEST(AddFromSysfs, LeavesAloneWhatSysfsDoesNotShow) {
  const FakeSystem system;
  ListedDevice listed = hidraw();
  listed.device.name = "by its bus";
  add_from_sysfs(listed, system.root());
  EXPECT_EQ(listed.device.name, "by its bus");
  EXPECT_EQ(listed.driver, "");
  EXPECT_EQ(listed.most_reports_per_second, 0);
}

TEST(ListEvdevDevices, DescribesANodeByItsFolders) {
  const FakeSystem system;
  system.hid_device();
  system.event_node();
  const auto listed = list_evdev_devices(system.root());
  ASSERT_EQ(listed.size(), 1u);
  EXPECT_EQ(listed[0].node, system.root() + "/dev/input/event9");
  EXPECT_EQ(listed[0].backend, Backend::kEvdev);
  EXPECT_FALSE(listed[0].readable) << "there is no such node";
  EXPECT_EQ(listed[0].device.name, "Small Pen Pen");
  EXPECT_EQ(listed[0].device.vendor, 0x1209);
  EXPECT_EQ(listed[0].device.version, 0x0110);
  EXPECT_EQ(listed[0].device.report_descriptor.size(), 4u);
  ASSERT_EQ(listed[0].device.axes.size(), 3u);
  EXPECT_EQ(listed[0].device.axes[2].code, 0x18);
  EXPECT_EQ(listed[0].device.axes[2].maximum, 0) << "nobody could be asked";
  EXPECT_EQ(listed[0].driver, "hid-generic");
  EXPECT_EQ(listed[0].most_reports_per_second, 8000);
  EXPECT_TRUE(listed[0].tablet) << "it has BTN_TOOL_PEN";
}

TEST(ListEvdevDevices, UdevKnowsPensFromPads) {
  const FakeSystem system;
  system.hid_device();
  system.event_node();
  system.udev_note("I:1\nE:ID_INPUT=1\nE:ID_INPUT_TABLET=1\n");
  EXPECT_TRUE(list_evdev_devices(system.root()).at(0).tablet);
  system.udev_note("E:ID_INPUT_TABLET=1\nE:ID_INPUT_TABLET_PAD=1\n");
  EXPECT_FALSE(list_evdev_devices(system.root()).at(0).tablet);
  system.udev_note("E:ID_INPUT=1\nE:ID_INPUT_TOUCHSCREEN=1\n");
  EXPECT_FALSE(list_evdev_devices(system.root()).at(0).tablet);
}

TEST(ListEvdevDevices, LeavesOutWhatHasNoAxes) {
  const FakeSystem system;
  system.event_node();
  system.file(std::string("/sys") + FakeSystem::kInput + "/capabilities/abs", "0\n");
  EXPECT_THAT(list_evdev_devices(system.root()), IsEmpty());
  EXPECT_THAT(list_evdev_devices(system.root() + "/nowhere"), IsEmpty());
}

TEST(ListEvdevDevices, KnowsA3dMouseWhoseAxesAreRelative) {
  const FakeSystem system;
  system.event_node();
  const std::string input = std::string("/sys") + FakeSystem::kInput;
  system.file(input + "/capabilities/abs", "0\n");
  system.file(input + "/capabilities/rel", "3f\n");
  const auto listed = list_evdev_devices(system.root());
  ASSERT_EQ(listed.size(), 1U);
  EXPECT_THAT(listed[0].device.axes, IsEmpty());
  EXPECT_THAT(listed[0].device.relative_axes, ElementsAre(0, 1, 2, 3, 4, 5));
  system.file(input + "/capabilities/rel", "143\n");  // X, Y, wheels: an ordinary mouse
  EXPECT_THAT(list_evdev_devices(system.root()), IsEmpty());
}

TEST(ListFreeUsbDevices, NamesDevicesWhoseHidInterfaceNobodyHas) {
  const FakeSystem system;
  system.usb_device();
  const auto listed = list_free_usb_devices(system.root());
  ASSERT_EQ(listed.size(), 1u);
  EXPECT_EQ(listed[0].node, system.root() + "/dev/bus/usb/001/012");
  EXPECT_EQ(listed[0].backend, Backend::kUsb);
  EXPECT_EQ(listed[0].device.vendor, 0x1209);
  EXPECT_EQ(listed[0].device.product, 1);
  EXPECT_EQ(listed[0].device.version, 0x0102);
  EXPECT_EQ(listed[0].device.name, "Small Pen");
  EXPECT_EQ(listed[0].serial, "S1");
  EXPECT_EQ(listed[0].interface_number, 2);
  EXPECT_EQ(listed[0].most_reports_per_second, 8000);
  EXPECT_EQ(listed[0].driver, "");
}

TEST(ListFreeUsbDevices, LeavesOutBoundAndOtherInterfaces) {
  const FakeSystem bound;
  bound.hid_device();
  EXPECT_THAT(list_free_usb_devices(bound.root()), IsEmpty());
  const FakeSystem printer;
  printer.usb_device();
  printer.file(std::string("/sys") + FakeSystem::kInterface + "/bInterfaceClass", "07\n");
  EXPECT_THAT(list_free_usb_devices(printer.root()), IsEmpty());
  const FakeSystem held;
  held.usb_device();
  held.link(std::string("/sys") + FakeSystem::kInterface + "/driver", "/sys/bus/usb/drivers/usbfs");
  EXPECT_EQ(list_free_usb_devices(held.root()).at(0).driver, "usbfs");
}

TEST(ListUsbDevices, HasARowForEachHidInterfaceWhoeverDrivesIt) {
  const FakeSystem system;
  system.hid_device();
  const std::string second = std::string(FakeSystem::kUsb) + "/1-1:1.3";
  system.device(second, "usb", "/bus/usb/devices", "DEVTYPE=usb_interface\n");
  system.file("/sys" + second + "/bInterfaceNumber", "03\n");
  system.file("/sys" + second + "/bInterfaceClass", "03\n");
  const auto listed = list_usb_devices(system.root());
  ASSERT_EQ(listed.size(), 2u);
  EXPECT_EQ(listed[0].interface_number, 2);
  EXPECT_EQ(listed[0].driver, "usbhid");
  EXPECT_EQ(listed[0].device.report_descriptor.size(), 4u) << "as its driver knows it";
  EXPECT_EQ(listed[0].device.physical_path, "usb-pci0-1/input2");
  EXPECT_EQ(listed[0].usb_node, system.root() + "/dev/bus/usb/001/012");
  EXPECT_EQ(listed[1].interface_number, 3);
  EXPECT_EQ(listed[1].node, listed[0].node);
  EXPECT_EQ(listed[1].driver, "");
  const auto free = list_free_usb_devices(system.root());
  ASSERT_EQ(free.size(), 1u);
  EXPECT_EQ(free[0].interface_number, 3);
  EXPECT_THAT(list_usb_devices(system.root() + "/nowhere"), IsEmpty());
}

TEST(MarkSameDevices, TiesRowsOfOneDeviceToTheHidrawOne) {
  std::vector<ListedDevice> rows(6);
  rows[0] = hidraw("/dev/hidraw0");
  rows[0].hid_folder = "/sys/a";
  rows[0].usb_folder = "/sys/usb1";
  rows[1].backend = Backend::kEvdev;
  rows[1].hid_folder = "/sys/a";
  rows[1].usb_folder = "/sys/usb1";
  rows[2].backend = Backend::kEvdev;
  rows[2].hid_folder = "/sys/b";
  rows[2].usb_folder = "/sys/usb1";  // another interface, with no hidraw node
  rows[3].backend = Backend::kUsb;
  rows[3].usb_folder = "/sys/usb1";
  rows[4].backend = Backend::kEvdev;  // no HID device
  rows[0].interface_number = 1;
  rows[3].interface_number = 1;
  rows[5] = rows[3];
  rows[5].interface_number = 2;  // no hidraw node
  mark_same_devices(rows);
  std::vector<std::string> same;
  for (const auto& row : rows) same.push_back(row.same_as);
  EXPECT_THAT(same, ElementsAre("", "/dev/hidraw0", "", "/dev/hidraw0", "", ""));
}

TEST(FindSpacenavd, LooksForItsSocket) {
  ::unsetenv("SPNAV_SOCKET");
  const FakeSystem system;
  EXPECT_FALSE(find_spacenavd(system.root()));
  system.file("/run/spnav.sock", "");
  const auto found = find_spacenavd(system.root());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->backend, Backend::kSpnav);
  EXPECT_EQ(found->node, system.root() + "/run/spnav.sock");
  system.file("/elsewhere/s", "");
  ::setenv("SPNAV_SOCKET", "/elsewhere/s", 1);
  EXPECT_EQ(find_spacenavd(system.root())->node, system.root() + "/elsewhere/s");
  ::unsetenv("SPNAV_SOCKET");
}

std::vector<std::string> nodes(const DeviceChoice& choice) {
  std::vector<std::string> out;
  for (const auto& row : choice.rows) out.push_back(row.node);
  return out;
}

/// hidraw0 and two event nodes of one tablet, and an event node of another device.
std::vector<ListedDevice> tablet_rows(bool hidraw_readable, bool events_readable) {
  std::vector<ListedDevice> rows(4);
  rows[0].node = "/dev/hidraw0";
  rows[0].device.name = "A Pen";
  rows[0].readable = hidraw_readable;
  for (std::size_t i = 1; i < 4; ++i) {
    rows[i].backend = Backend::kEvdev;
    rows[i].node = "/dev/input/event" + std::to_string(i);
    rows[i].readable = events_readable;
    if (i < 3) rows[i].same_as = "/dev/hidraw0";
  }
  return rows;
}

TEST(ChooseRows, PrefersHidrawAndFallsBackToEventNodes) {
  const DeviceChoice plain = *choose_rows(tablet_rows(true, true));
  EXPECT_THAT(nodes(plain), ElementsAre("/dev/hidraw0", "/dev/input/event3"));
  EXPECT_THAT(plain.notes, IsEmpty());
  const DeviceChoice fallback = *choose_rows(tablet_rows(false, true));
  EXPECT_THAT(nodes(fallback),
              ElementsAre("/dev/input/event1", "/dev/input/event2", "/dev/input/event3"));
  EXPECT_THAT(fallback.notes,
              ElementsAre("/dev/hidraw0, A Pen: no permission; /dev/input/event1 is used instead"));
  EXPECT_THAT(nodes(*choose_rows(tablet_rows(false, false))),
              ElementsAre("/dev/hidraw0", "/dev/input/event3"))
      << "whose error then says why";
}

TEST(ChooseRows, TakesTheEventNodeOfAPenThatOnlyTheKernelDecodes) {
  std::vector<ListedDevice> rows = tablet_rows(true, true);
  rows.erase(rows.begin());  // its hidraw row is no pen to limn, so nobody wants it
  rows.resize(1);
  EXPECT_THAT(nodes(*choose_rows(rows)), ElementsAre("/dev/input/event1"));
}

TEST(ChooseRows, SaysWhyNothingIsLeft) {
  std::vector<ListedDevice> rows(1);
  rows[0].backend = Backend::kUsb;
  rows[0].node = "/dev/bus/usb/001/004";
  rows[0].device.name = "A Pen";
  rows[0].readable = true;
  const auto choice = choose_rows(rows);
  ASSERT_FALSE(choice.has_value());
  EXPECT_EQ(choice.error().at, "/dev/bus/usb/001/004");
  EXPECT_EQ(choice.error().what, "A Pen: no driver of Linux has it");
  EXPECT_EQ(choice.error().remedy,
            "read it with --backend usb, plug it in again, or load the module usbhid");
  EXPECT_TRUE(choose_rows({}).has_value()) << "nothing was wanted";
}

TEST(ChooseRows, SpacenavdStandsInForA3dMouseThatMayNotBeRead) {
  ListedDevice spacenavd;
  spacenavd.backend = Backend::kSpnav;
  spacenavd.node = "/run/spnav.sock";
  std::vector<ListedDevice> rows = tablet_rows(false, true);
  rows.resize(3);
  const DeviceChoice instead = *choose_rows(rows, &spacenavd);
  EXPECT_THAT(nodes(instead), ElementsAre("/run/spnav.sock"));
  EXPECT_THAT(
      instead.notes,
      ElementsAre("/dev/hidraw0, A Pen: no permission; spacenavd's motions are used instead"));
  rows[0].readable = true;
  const DeviceChoice beside = *choose_rows(rows, &spacenavd);
  EXPECT_THAT(nodes(beside), ElementsAre("/dev/hidraw0"));
  EXPECT_THAT(beside.notes,
              ElementsAre("/dev/hidraw0, A Pen: spacenavd uses it, too; both get its motions"));
}

TEST(OpenDevice, SaysWhatIsWrong) {
  ListedDevice gone = hidraw("/dev/hidraw-gone");
  for (const Backend backend : {Backend::kHidraw, Backend::kEvdev}) {
    gone.backend = backend;
    const auto opened = open_device(gone);
    ASSERT_FALSE(opened.has_value());
    EXPECT_EQ(opened.error().what, "cannot be opened: No such file or directory");
    EXPECT_EQ(opened.error().remedy, "plug the device in and see 'limn devices'");
  }
}

TEST(BackendOfNode, TellsNodesApartByTheirNames) {
  const TempFolder folder;
  EXPECT_EQ(backend_of_node(folder.write("event3", "")), Backend::kEvdev);
  EXPECT_EQ(backend_of_node(folder.write("hidraw3", "")), Backend::kHidraw);
  EXPECT_EQ(backend_of_node("/dev/input/event-absent"), Backend::kEvdev);
  EXPECT_EQ(backend_of_node("/dev/bus/usb/001/004"), Backend::kUsb);
}

TEST(IsSameNode, FollowsLinks) {
  const TempFolder folder;
  const std::string node = folder.write("hidraw3", "").string();
  const std::string link = (folder.path() / "tablet").string();
  std::filesystem::create_symlink(node, link);
  EXPECT_TRUE(is_same_node(node, link));
  EXPECT_FALSE(is_same_node(node, folder.write("hidraw4", "")));
  EXPECT_TRUE(is_same_node("/nowhere/a", "/nowhere/a"));
  EXPECT_FALSE(is_same_node("/nowhere/a", "/nowhere/b"));
}

}  // namespace
}  // namespace limn::test
