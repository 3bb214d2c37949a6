#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input/base/error.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// Who brings a device's reports.
enum class Backend : std::uint8_t {
  kHidraw,  ///< Linux's hidraw nodes: reports as the device sent them
  kUsb,     ///< USB devices, taken from the driver of Linux that has them, if one does
  kEvdev,   ///< Linux's event nodes: what its drivers decoded
  kSpnav,   ///< 3D mice, by spacenavd
};

inline constexpr std::array kBackends = {Backend::kHidraw, Backend::kUsb, Backend::kEvdev,
                                         Backend::kSpnav};

/// "hidraw", "usb", "evdev", "spnav".
std::string_view name(Backend backend) noexcept;

/// A device as one backend shows it, opened or not: a HID device (one USB interface), an event
/// node, a USB device, or spacenavd.
struct ListedDevice {
  std::string node;  ///< e.g. "/dev/hidraw3", "/dev/input/event5", "/dev/bus/usb/001/004"
  /// report_descriptor is empty where sysfs does not show it; axes, of evdev, have no ranges where
  /// the node may not be read.
  TraceDevice device;
  std::string serial;         ///< the device's own serial number, where it has one
  int interface_number = -1;  ///< of USB; -1 elsewhere
  bool readable = false;      ///< whether this user may read the node
  Backend backend = Backend::kHidraw;
  std::string driver;  ///< Linux's driver of it: "hid-generic", "wacom" ..; empty: none, not known
  /// Most reports a second, by the interval at which USB asks for them; 0: not known.
  double most_reports_per_second = 0;
  /// evdev: udev, or where it says nothing the kernel's keys, take it for a pen; elsewhere unknown.
  bool tablet = false;
  /// In sysfs, of the HID device behind it: ties hidraw and evdev together.
  std::string hid_folder;
  std::string usb_folder;  ///< in sysfs, of the USB device
  std::string usb_node;    ///< the USB device's; empty where there is none
  /// The node of a row of the same device that limn prefers (hidraw to evdev and USB); empty: this
  /// is it.
  std::string same_as;
};

/// The HID devices of the system on hidraw, by node; with a node that one alone, for less. Reads
/// sysfs and opens none of them.
/// Error: kIo where the system cannot be asked; kMissing in a build without hidapi.
Expected<std::vector<ListedDevice>> list_hid_devices(const std::string& node = {});

/// All that the system has: hidraw, then event nodes, USB devices with a HID interface that no
/// driver has, and spacenavd's socket where it runs; `same_as` filled in. Error: as above, and only
/// where the others have nothing either.
Expected<std::vector<ListedDevice>> list_devices();

/// Fills in what sysfs knows of a hidraw node: descriptor, names, driver, interval, folders. `root`
/// is before "/sys" ("" is the system's own; tests have others).
void add_from_sysfs(ListedDevice& listed, const std::string& root = {});

/// Event nodes with absolute axes. Nodes that this user may read are opened for a moment,
/// read-only, to ask for the axes' ranges.
std::vector<ListedDevice> list_evdev_devices(const std::string& root = {});

/// The HID interfaces of all USB devices, whoever drives them, in the order of their nodes
/// (/dev/bus/usb/..). Reads sysfs and opens none of them.
std::vector<ListedDevice> list_usb_devices(const std::string& root = {});

/// Of these the ones that no driver of Linux has, or that a program holds (usbfs).
std::vector<ListedDevice> list_free_usb_devices(const std::string& root = {});

/// spacenavd's socket: of $SPNAV_SOCKET, else where it usually is; nothing where there is none.
std::optional<ListedDevice> find_spacenavd(const std::string& root = {});

/// Fills in same_as: rows of one HID device, or of one interface of a USB device, are one device.
/// Of several event nodes of a HID device each has the hidraw row as its same.
void mark_same_devices(std::vector<ListedDevice>& devices);

/// Which of the listed devices somebody wants.
using DeviceFilter = std::function<bool(const ListedDevice&)>;

}  // namespace limn
