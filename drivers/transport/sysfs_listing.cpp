// What sysfs, udev's notes and the file system tell of devices, whatever finds them.

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <system_error>
#include <tuple>
#include <utility>

#include "drivers/transport/device_listing.hpp"
#include "drivers/transport/file_handle.hpp"
#include "drivers/transport/sysfs.hpp"

namespace limn {
namespace fs = std::filesystem;

namespace {

std::string node_name(const std::string& node) { return node.substr(node.rfind('/') + 1); }

bool is_readable(const std::string& node, int mode = R_OK) {
  return ::access(node.c_str(), mode) == 0;
}

/// Reports a second of an endpoint's interval, as sysfs writes it: "2ms", "125us". 0: none.
double rate_of(const std::string& interval) {
  double number = 0;
  const char* const end = interval.data() + interval.size();
  const auto [unit, error] = std::from_chars(interval.data(), end, number);
  if (error != std::errc() || !(number > 0)) return 0;
  const std::string_view name(unit, static_cast<std::size_t>(end - unit));
  if (name == "ms") return 1e3 / number;
  return name == "us" ? 1e6 / number : 0;
}

/// Of the fastest endpoint towards us.
double most_reports_per_second(const SysfsDevice& usb_interface) {
  double most = 0;
  std::error_code error;
  for (fs::directory_iterator entry(usb_interface.folder(), error), end; !error && entry != end;
       entry.increment(error)) {
    const SysfsDevice endpoint(entry->path());
    if (!endpoint.name().starts_with("ep_8")) continue;  // bit 7: in
    most = std::max(most, rate_of(endpoint.attribute("interval")));
  }
  return most;
}

/// What the USB interface and device above `device`, if there are any, tell.
void add_from_usb(const SysfsDevice& device, ListedDevice& listed, const std::string& root) {
  if (const auto usb_interface = device.above("usb", "usb_interface")) {
    listed.interface_number = usb_interface->hexadecimal("bInterfaceNumber");
    listed.most_reports_per_second = most_reports_per_second(*usb_interface);
  }
  if (const auto usb = device.above("usb", "usb_device")) {
    listed.usb_folder = usb->folder();
    if (auto node = usb_node(*usb)) listed.usb_node = root + *std::move(node);
  }
}

/// udev's note of a node's property; nothing where udev keeps none of the node.
std::optional<std::string> udev_property(const SysfsDevice& node, std::string_view key,
                                         const std::string& root) {
  std::ifstream notes(root + "/run/udev/data/c" + node.attribute("dev"));
  if (!notes) return std::nullopt;
  for (std::string line; std::getline(notes, line);) {
    if (line.starts_with("E:") && line.compare(2, key.size(), key) == 0 &&
        line.size() > key.size() + 2 && line[key.size() + 2] == '=') {
      return line.substr(key.size() + 3);
    }
  }
  return std::string();
}

/// udev knows pads and pens of one device apart; without it a pen is what has a pen's tool or
/// barrel switch.
bool is_tablet(const SysfsDevice& event, const SysfsDevice& input, const std::string& root) {
  if (const auto tablet = udev_property(event, "ID_INPUT_TABLET", root)) {
    return *tablet == "1" && udev_property(event, "ID_INPUT_TABLET_PAD", root) != "1";
  }
  const std::string keys = input.attribute("capabilities/key");
  return has_capability(keys, BTN_TOOL_PEN) || has_capability(keys, BTN_STYLUS);
}

/// The axes, with their ranges where the node can be asked.
std::vector<EvdevAxis> axes_of(const std::string& node, const SysfsDevice& input) {
  const std::string bitmap = input.attribute("capabilities/abs");
  const FileHandle file(::open(node.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  std::vector<EvdevAxis> axes;
  for (unsigned code = 0; code < ABS_CNT; ++code) {
    if (!has_capability(bitmap, code)) continue;
    input_absinfo range{};
    if (file) ::ioctl(file.get(), EVIOCGABS(code), &range);
    axes.push_back({static_cast<std::uint16_t>(code), range.minimum, range.maximum, range.fuzz,
                    range.flat, range.resolution});
  }
  return axes;
}

/// Old 3D mice call their axes relative. Ordinary mice have two of them and wheels.
std::vector<std::uint16_t> relative_axes_of(const SysfsDevice& input) {
  const std::string bitmap = input.attribute("capabilities/rel");
  std::vector<std::uint16_t> axes;
  for (std::uint16_t code = REL_X; code <= REL_RZ; ++code) {
    if (!has_capability(bitmap, code)) return {};
    axes.push_back(code);
  }
  return axes;
}

std::optional<ListedDevice> listed_event(const SysfsDevice& event, const std::string& root) {
  const auto input = event.above("input");
  if (!input) return std::nullopt;
  ListedDevice listed;
  listed.backend = Backend::kEvdev;
  listed.node = root + "/dev/input/" + event.name();
  listed.device.axes = axes_of(listed.node, *input);
  if (listed.device.axes.empty()) listed.device.relative_axes = relative_axes_of(*input);
  if (!listed.device.is_kernel_decoded()) return std::nullopt;
  listed.readable = is_readable(listed.node);
  listed.device.name = input->attribute("name");
  listed.device.physical_path = input->attribute("phys");
  listed.device.bus = input->hexadecimal("id/bustype");
  listed.device.vendor = input->hexadecimal("id/vendor");
  listed.device.product = input->hexadecimal("id/product");
  listed.device.version = input->hexadecimal("id/version");
  listed.serial = input->attribute("uniq");
  listed.tablet = is_tablet(event, *input, root);
  if (const auto hid = input->above("hid")) {
    listed.device.report_descriptor = hid->bytes("report_descriptor");
    listed.hid_folder = hid->folder();
    listed.driver = hid->driver();
  }
  add_from_usb(*input, listed, root);
  return listed;
}

/// As Linux names what a HID device hangs on: "usb-0000:00:14.0-1.2/input0". The USB device's
/// folder is ../0000:00:14.0/usb1/1-1/1-1.2.
std::string physical_path(const SysfsDevice& usb, int interface_number) {
  fs::path hub = usb.folder();
  while (hub.has_relative_path() && !hub.filename().string().starts_with("usb")) {
    hub = hub.parent_path();
  }
  const std::string name = usb.name();
  return "usb-" + hub.parent_path().filename().string() +
         name.substr(std::min(name.find('-'), name.size())) + "/input" +
         std::to_string(interface_number);
}

/// What the HID driver that has the interface read from it, if one has.
std::vector<std::uint8_t> known_descriptor(const SysfsDevice& usb_interface) {
  std::error_code error;
  for (fs::directory_iterator at(usb_interface.folder(), error), end; !error && at != end;
       at.increment(error)) {
    auto bytes = SysfsDevice(at->path()).bytes("report_descriptor");
    if (!bytes.empty()) return bytes;
  }
  return {};
}

ListedDevice listed_usb(const SysfsDevice& usb_interface, const SysfsDevice& usb,
                        const std::string& root) {
  constexpr std::uint16_t kUsbBus = 3;
  ListedDevice listed;
  listed.backend = Backend::kUsb;
  listed.interface_number = usb_interface.hexadecimal("bInterfaceNumber");
  listed.most_reports_per_second = most_reports_per_second(usb_interface);
  listed.driver = usb_interface.driver();
  listed.usb_folder = usb.folder();
  listed.node = root + usb_node(usb).value_or("");
  listed.usb_node = listed.node;
  listed.readable = is_readable(listed.node, R_OK | W_OK);
  listed.serial = usb.attribute("serial").substr(0, kMaxDeviceTextBytes);
  TraceDevice& device = listed.device;
  device.bus = kUsbBus;
  device.vendor = usb.hexadecimal("idVendor");
  device.product = usb.hexadecimal("idProduct");
  device.version = usb.hexadecimal("bcdDevice");
  device.name = usb.attribute("manufacturer");  // as Linux names it on hidraw
  const std::string product = usb.attribute("product");
  if (!device.name.empty() && !product.empty()) device.name += ' ';
  device.name = (device.name + product).substr(0, kMaxDeviceTextBytes);
  device.physical_path = physical_path(usb, listed.interface_number);
  device.report_descriptor = known_descriptor(usb_interface);
  return listed;
}

/// No driver of Linux has it; a program (usbfs) may.
bool is_free(const ListedDevice& listed) {
  return listed.driver.empty() || listed.driver == "usbfs";
}

}  // namespace

std::string_view name(Backend backend) noexcept {
  constexpr std::array<std::string_view, 4> kNames = {"hidraw", "usb", "evdev", "spnav"};
  return kNames[static_cast<std::size_t>(backend)];
}

void add_from_sysfs(ListedDevice& listed, const std::string& root) {
  const auto node = SysfsDevice::find(root, "/class/hidraw", node_name(listed.node));
  const auto hid = node ? node->above("hid") : std::nullopt;
  if (!hid) return;
  listed.device.report_descriptor = hid->bytes("report_descriptor");
  if (auto text = hid->property("HID_NAME"); !text.empty()) listed.device.name = std::move(text);
  listed.device.physical_path = hid->property("HID_PHYS");
  unsigned bus = 0;
  if (std::sscanf(hid->property("HID_ID").c_str(), "%x:", &bus) == 1) {
    listed.device.bus = static_cast<std::uint16_t>(bus);
  }
  listed.hid_folder = hid->folder();
  listed.driver = hid->driver();
  add_from_usb(*hid, listed, root);
}

std::vector<ListedDevice> list_evdev_devices(const std::string& root) {
  std::vector<ListedDevice> out;
  for (const SysfsDevice& event : SysfsDevice::list(root, "/class/input", "event")) {
    if (auto listed = listed_event(event, root)) out.push_back(*std::move(listed));
  }
  return out;
}

std::vector<ListedDevice> list_usb_devices(const std::string& root) {
  constexpr std::uint16_t kHidClass = 3;
  std::vector<ListedDevice> out;
  for (const SysfsDevice& one : SysfsDevice::list(root, "/bus/usb/devices")) {
    if (one.hexadecimal("bInterfaceClass") != kHidClass) continue;
    const auto usb = one.above("usb", "usb_device");
    if (usb && usb_node(*usb)) out.push_back(listed_usb(one, *usb, root));
  }
  std::sort(out.begin(), out.end(), [](const ListedDevice& a, const ListedDevice& b) {
    return std::tie(a.node, a.interface_number) < std::tie(b.node, b.interface_number);
  });
  return out;
}

std::vector<ListedDevice> list_free_usb_devices(const std::string& root) {
  std::vector<ListedDevice> out = list_usb_devices(root);
  std::erase_if(out, [](const ListedDevice& one) { return !is_free(one); });
  return out;
}

Expected<std::vector<ListedDevice>> list_devices() {
  std::vector<ListedDevice> devices;
  auto hid = list_hid_devices();
  if (hid) devices.swap(*hid);
  const auto add = [&devices](std::vector<ListedDevice> more) {
    std::move(more.begin(), more.end(), std::back_inserter(devices));
  };
  add(list_evdev_devices());
  add(list_free_usb_devices());
  if (auto spacenavd = find_spacenavd()) devices.push_back(*std::move(spacenavd));
  if (!hid && devices.empty()) return tl::unexpected(std::move(hid.error()));
  mark_same_devices(devices);
  return devices;
}

std::optional<ListedDevice> find_spacenavd(const std::string& root) {
  std::vector<std::string> places = {"/run/spnav.sock", "/var/run/spnav.sock"};
  if (const char* chosen = std::getenv("SPNAV_SOCKET")) places.insert(places.begin(), chosen);
  for (const std::string& place : places) {
    std::error_code error;
    if (!fs::exists(root + place, error)) continue;
    ListedDevice listed;
    listed.backend = Backend::kSpnav;
    listed.node = root + place;
    listed.device.name = "3D mouse of spacenavd";
    listed.readable = is_readable(listed.node, R_OK | W_OK);
    return listed;
  }
  return std::nullopt;
}

void mark_same_devices(std::vector<ListedDevice>& devices) {
  for (ListedDevice& listed : devices) {
    if (listed.backend == Backend::kHidraw) continue;
    const auto same = std::find_if(devices.begin(), devices.end(), [&](const ListedDevice& other) {
      if (other.backend != Backend::kHidraw) return false;
      return listed.backend == Backend::kEvdev
                 ? !listed.hid_folder.empty() && other.hid_folder == listed.hid_folder
                 : !listed.usb_folder.empty() && other.usb_folder == listed.usb_folder &&
                       other.interface_number == listed.interface_number;
    });
    if (same != devices.end()) listed.same_as = same->node;
  }
}

}  // namespace limn
