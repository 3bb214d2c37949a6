#include "drivers/transport/device_listing.hpp"

#include <hidapi/hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "drivers/transport/sysfs.hpp"

namespace limn {
namespace {

/// UTF-8 of a wide string; unpaired or oversized code points become '?'.
std::string narrow(const wchar_t* wide) {
  std::string out;
  for (; wide != nullptr && *wide != L'\0'; ++wide) {
    const char32_t c{static_cast<char32_t>(*wide)};
    if (c < 0x80) {
      out += static_cast<char>(c);
    } else if (c < 0x800) {
      out += static_cast<char>(0xC0 | (c >> 6));
      out += static_cast<char>(0x80 | (c & 0x3F));
    } else if (c < 0x10000 && (c < 0xD800 || c > 0xDFFF)) {
      out += static_cast<char>(0xE0 | (c >> 12));
      out += static_cast<char>(0x80 | ((c >> 6) & 0x3F));
      out += static_cast<char>(0x80 | (c & 0x3F));
    } else {
      out += '?';
    }
  }
  return out;
}

ListedDevice listed_from(const hid_device_info& info) {
  ListedDevice listed;
  listed.node = info.path;
  listed.device.vendor = info.vendor_id;
  listed.device.product = info.product_id;
  listed.device.version = info.release_number;
  listed.device.name = narrow(info.product_string);
  listed.serial = narrow(info.serial_number);
  listed.interface_number = info.interface_number;
  listed.readable = ::access(info.path, R_OK) == 0;
  add_from_sysfs(listed);
  return listed;
}

struct Ids {
  unsigned short vendor = 0;
  unsigned short product = 0;
};

/// Of a node; zeros, which stand for any, where sysfs does not say.
Ids ids_of(const std::string& node) {
  Ids ids;
  const auto found = SysfsDevice::find("", "/class/hidraw", node.substr(node.rfind('/') + 1));
  const auto hid = found ? found->above("hid") : std::nullopt;
  unsigned vendor = 0;
  unsigned product = 0;
  if (hid && std::sscanf(hid->property("HID_ID").c_str(), "%*x:%x:%x", &vendor, &product) == 2) {
    ids = {static_cast<unsigned short>(vendor), static_cast<unsigned short>(product)};
  }
  return ids;
}

/// Orders /dev/hidraw9 before /dev/hidraw10.
bool by_number(const ListedDevice& a, const ListedDevice& b) {
  return std::pair(a.node.size(), a.node) < std::pair(b.node.size(), b.node);
}

}  // namespace

Expected<std::vector<ListedDevice>> list_hid_devices(const std::string& node) {
  std::vector<ListedDevice> out;
  const Ids ids = node.empty() ? Ids() : ids_of(node);
  // Nothing where there are none.
  hid_device_info* const first = hid_enumerate(ids.vendor, ids.product);
  for (const hid_device_info* info = first; info != nullptr; info = info->next) {
    if (!node.empty() && node != info->path) continue;
    // One entry a collection of the descriptor; the node is what counts.
    const bool known = std::any_of(out.begin(), out.end(), [info](const ListedDevice& listed) {
      return listed.node == info->path;
    });
    if (!known) out.push_back(listed_from(*info));
  }
  hid_free_enumeration(first);
  std::sort(out.begin(), out.end(), by_number);
  return out;
}

}  // namespace limn
