#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <tuple>
#include <utility>

#include "drivers/transport/usb_transport.hpp"

namespace limn {
namespace {

namespace fs = std::filesystem;

constexpr std::uint16_t kBusUsb = 3;
constexpr std::size_t kMostDescriptor = 4096;  // Linux takes no more

/// The first line of a file of sysfs; empty where there is none.
std::string line_of(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line.substr(0, kMaxDeviceTextBytes);
}

int number_of(const fs::path& file, int base) {
  const std::string line = line_of(file);
  int number = -1;
  std::from_chars(line.data(), line.data() + line.size(), number, base);
  return number;
}

/// As Linux names what a HID device hangs on: "usb-0000:00:14.0-1.2/input0". `folder` is the
/// device's in sysfs, ../0000:00:14.0/usb1/1-1/1-1.2.
std::string physical_path(const fs::path& folder, int interface_number) {
  fs::path hub = folder;
  while (hub.has_relative_path() && !hub.filename().string().starts_with("usb")) {
    hub = hub.parent_path();
  }
  const std::string name = folder.filename().string();
  return "usb-" + hub.parent_path().filename().string() +
         name.substr(std::min(name.find('-'), name.size())) + "/input" +
         std::to_string(interface_number);
}

/// What the HID driver that has the interface read from it, if one has.
std::vector<std::uint8_t> known_descriptor(const fs::path& interface) {
  std::error_code error;
  for (fs::directory_iterator at(interface, error), end; !error && at != end; at.increment(error)) {
    std::ifstream file(at->path() / "report_descriptor", std::ios::binary);
    std::vector<char> bytes(kMostDescriptor);
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (file.gcount() > 0) return {bytes.begin(), bytes.begin() + file.gcount()};
  }
  return {};
}

ListedDevice listed_from(const fs::path& interface, const fs::path& folder) {
  ListedDevice listed;
  listed.backend = Backend::kUsb;
  listed.interface_number = number_of(interface / "bInterfaceNumber", 16);
  char node[32];
  std::snprintf(node, sizeof node, "/dev/bus/usb/%03d/%03d", number_of(folder / "busnum", 10),
                number_of(folder / "devnum", 10));
  listed.node = node;
  listed.readable = ::access(node, R_OK | W_OK) == 0;
  listed.serial = line_of(folder / "serial");
  TraceDevice& device = listed.device;
  device.bus = kBusUsb;
  device.vendor = static_cast<std::uint16_t>(number_of(folder / "idVendor", 16));
  device.product = static_cast<std::uint16_t>(number_of(folder / "idProduct", 16));
  device.version = static_cast<std::uint16_t>(number_of(folder / "bcdDevice", 16));
  device.name = line_of(folder / "manufacturer");  // as Linux names it on hidraw
  const std::string product = line_of(folder / "product");
  if (!device.name.empty() && !product.empty()) device.name += ' ';
  device.name += product;
  device.physical_path = physical_path(folder, listed.interface_number);
  device.report_descriptor = known_descriptor(interface);
  std::error_code none;
  listed.driver = fs::read_symlink(interface / "driver", none).filename().string();
  return listed;
}

}  // namespace

Expected<std::vector<ListedDevice>> list_usb_devices() {
  constexpr int kHid = 3;
  std::vector<ListedDevice> out;
  std::error_code error;  // no such folder: no USB here
  for (fs::directory_iterator at("/sys/bus/usb/devices", error), end; !error && at != end;
       at.increment(error)) {
    if (number_of(at->path() / "bInterfaceClass", 16) != kHid) continue;
    std::error_code gone;
    const fs::path interface = fs::canonical(at->path(), gone);
    if (gone) continue;
    ListedDevice listed = listed_from(interface, interface.parent_path());
    if (listed.interface_number >= 0) out.push_back(std::move(listed));
  }
  std::sort(out.begin(), out.end(), [](const ListedDevice& a, const ListedDevice& b) {
    return std::tie(a.node, a.interface_number) < std::tie(b.node, b.interface_number);
  });
  return out;
}

}  // namespace limn
