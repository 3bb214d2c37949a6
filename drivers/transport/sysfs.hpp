#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

/// A device as Linux's sysfs shows it: a folder below /sys/devices with attributes (files), a
/// uevent file of properties, and links to its driver and subsystem. Reads files only, opens no
/// device. What is not there reads as empty.
class SysfsDevice {
 public:
  explicit SysfsDevice(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The device `name` of a class or bus, e.g. "/class/input" and "event3"; `root` is before
  /// "/sys".
  static std::optional<SysfsDevice> find(const std::string& root, const std::string& where,
                                         const std::string& name);
  /// All devices of a class or bus whose name begins with `prefix`, in the order of their numbers.
  static std::vector<SysfsDevice> list(const std::string& root, const std::string& where,
                                       std::string_view prefix = {});

  const std::filesystem::path& folder() const noexcept { return folder_; }
  std::string name() const { return folder_.filename().string(); }

  /// The content of an attribute without the line end, at most 64 KiB.
  std::string attribute(const std::string& name) const;
  /// The same as bytes, whole.
  std::vector<std::uint8_t> bytes(const std::string& name) const;
  /// An attribute that is a hexadecimal number, else 0.
  std::uint16_t hexadecimal(const std::string& name) const;
  /// A value of the uevent file.
  std::string property(std::string_view key) const;
  /// By its link, else by the uevent file, which says the same.
  std::string driver() const {
    std::string linked = link("driver");
    return linked.empty() ? property("DRIVER") : linked;
  }
  std::string subsystem() const { return link("subsystem"); }

  /// The nearest device above (not this one) of a subsystem, and of a DEVTYPE where one is given.
  std::optional<SysfsDevice> above(std::string_view subsystem, std::string_view devtype = {}) const;

 private:
  std::string link(const char* name) const;

  std::filesystem::path folder_;
};

/// Whether a bit of a capability bitmap is set, as input devices show them: hexadecimal words of
/// `word_bits`, the highest first ("1 0 3" ); the kernel's words have the bits of its long.
bool has_capability(std::string_view bitmap, unsigned bit, unsigned word_bits = sizeof(long) * 8);

/// The node of a USB device, "/dev/bus/usb/001/004"; nothing for what is none.
std::optional<std::string> usb_node(const SysfsDevice& usb);

/// The device of a node in /dev, by its number, whatever links lead to it; nothing for what is no
/// character device, or none of this system.
std::optional<SysfsDevice> device_of_node(const std::string& node);

}  // namespace limn
