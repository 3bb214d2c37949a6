#include "drivers/transport/sysfs.hpp"

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <utility>

namespace limn {
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostAttribute = 65536;

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMostAttribute, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return text;
}

/// Orders event9 before event10.
bool by_number(const SysfsDevice& a, const SysfsDevice& b) {
  const std::string one = a.name();
  const std::string other = b.name();
  return std::pair(one.size(), one) < std::pair(other.size(), other);
}

}  // namespace

std::optional<SysfsDevice> SysfsDevice::find(const std::string& root, const std::string& where,
                                             const std::string& name) {
  std::error_code error;
  fs::path folder = fs::canonical(root + "/sys" + where + "/" + name, error);
  if (error) return std::nullopt;
  return SysfsDevice(std::move(folder));
}

std::vector<SysfsDevice> SysfsDevice::list(const std::string& root, const std::string& where,
                                           std::string_view prefix) {
  std::vector<SysfsDevice> found;
  std::error_code error;
  const fs::path folder = (root + "/sys").append(where);
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(prefix)) continue;
    if (auto device = find(root, where, name)) found.push_back(*std::move(device));
  }
  std::sort(found.begin(), found.end(), by_number);
  return found;
}

std::string SysfsDevice::attribute(const std::string& name) const {
  std::string text = read_file(folder_ / name);
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text;
}

std::vector<std::uint8_t> SysfsDevice::bytes(const std::string& name) const {
  const std::string content = read_file(folder_ / name);
  return {content.begin(), content.end()};
}

std::uint16_t SysfsDevice::hexadecimal(const std::string& name) const {
  const std::string text = attribute(name);
  std::uint16_t value = 0;
  constexpr int kBase = 16;
  std::from_chars(text.data(), text.data() + text.size(), value, kBase);
  return value;
}

std::string SysfsDevice::property(std::string_view key) const {
  std::istringstream lines(read_file(folder_ / "uevent"));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(key) && line.size() > key.size() && line[key.size()] == '=') {
      return line.substr(key.size() + 1);
    }
  }
  return {};
}

std::optional<SysfsDevice> SysfsDevice::above(std::string_view subsystem,
                                              std::string_view devtype) const {
  for (fs::path path = folder_.parent_path(); path.has_relative_path(); path = path.parent_path()) {
    SysfsDevice device(path);
    if (device.subsystem() != subsystem) continue;
    if (devtype.empty() || device.property("DEVTYPE") == devtype) return device;
  }
  return std::nullopt;
}

std::string SysfsDevice::link(const char* name) const {
  std::error_code error;
  return fs::read_symlink(folder_ / name, error).filename().string();
}

bool has_capability(std::string_view bitmap, unsigned bit, unsigned word_bits) {
  unsigned word = bit / word_bits;  // from the end
  while (!bitmap.empty()) {
    const std::size_t begin = bitmap.find_last_of(' ') + 1;  // npos + 1 is 0
    if (word == 0) {
      std::uint64_t bits = 0;
      constexpr int kBase = 16;
      std::from_chars(bitmap.data() + begin, bitmap.data() + bitmap.size(), bits, kBase);
      return (bits >> (bit % word_bits) & 1) != 0;
    }
    --word;
    bitmap = bitmap.substr(0, begin == 0 ? 0 : begin - 1);
  }
  return false;
}

std::optional<std::string> usb_node(const SysfsDevice& usb) {
  const std::string bus = usb.attribute("busnum");
  const std::string address = usb.attribute("devnum");
  if (bus.empty() || address.empty()) return std::nullopt;
  std::array<char, 40> node{};
  std::snprintf(node.data(), node.size(), "/dev/bus/usb/%03d/%03d", std::atoi(bus.c_str()),
                std::atoi(address.c_str()));
  return node.data();
}

std::optional<SysfsDevice> device_of_node(const std::string& node) {
  struct stat status {};
  if (::stat(node.c_str(), &status) != 0 || !S_ISCHR(status.st_mode)) return std::nullopt;
  return SysfsDevice::find(
      "", "/dev/char",
      std::to_string(major(status.st_rdev)) + ":" + std::to_string(minor(status.st_rdev)));
}

}  // namespace limn
