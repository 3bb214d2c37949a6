#include "drivers/transport/diagnosis.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "drivers/devices/pen_initialization.hpp"

namespace limn {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRules = "70-limn.rules";

bool exists(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

Finding rules_finding(const std::string& root) {
  // Where udev looks (udev(7)).
  constexpr std::array<std::string_view, 5> kFolders = {
      "/etc/udev/rules.d", "/run/udev/rules.d", "/usr/local/lib/udev/rules.d",
      "/usr/lib/udev/rules.d", "/lib/udev/rules.d"};
  for (const std::string_view folder : kFolders) {
    const std::string file = std::string(folder) + '/' + std::string(kRules);
    if (exists(root + file)) return {Finding::State::kGood, "udev rules", file, ""};
  }
  return {
      Finding::State::kTrouble, "udev rules", std::string(kRules) + " is not installed",
      "copy drivers/transport/70-limn.rules to /etc/udev/rules.d, run 'udevadm control --reload' "
      "and plug the devices in again"};
}

/// The command name of a process, "" where it has gone.
std::string command_of(const fs::path& process) {
  std::ifstream comm(process / "comm");
  std::string name;
  std::getline(comm, name);
  return name;
}

struct Process {
  std::string pid;
  std::string command;
  std::set<std::string> open;  // nodes of ours
};

/// All processes; `open` is empty of those of other users, whose files are not shown.
std::vector<Process> processes(const std::vector<ListedDevice>& devices, const std::string& root) {
  std::set<std::string> nodes;
  for (const ListedDevice& listed : devices) nodes.insert(listed.node);
  std::vector<Process> out;
  std::error_code error;
  for (fs::directory_iterator entry(root + "/proc", error), end; !error && entry != end;
       entry.increment(error)) {
    Process process;
    process.pid = entry->path().filename().string();
    if (!std::all_of(process.pid.begin(), process.pid.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; })) {
      continue;
    }
    process.command = command_of(entry->path());
    std::error_code refused;
    for (fs::directory_iterator file(entry->path() / "fd", refused), last; !refused && file != last;
         file.increment(refused)) {
      std::error_code gone;
      const std::string target = fs::read_symlink(file->path(), gone).string();
      if (nodes.contains(target)) process.open.insert(target);
    }
    out.push_back(std::move(process));
  }
  std::sort(out.begin(), out.end(), [](const Process& a, const Process& b) {
    return std::pair(a.pid.size(), a.pid) < std::pair(b.pid.size(), b.pid);
  });
  return out;
}

std::string told(const Process& process) {
  return process.command + " (process " + process.pid + ")";
}

/// Others may read a node beside limn, but a program that sets the device up can change what its
/// reports mean.
void add_holders(const std::vector<Process>& all, std::vector<Finding>& out) {
  for (const Process& process : all) {
    for (const std::string& node : process.open) {
      out.push_back({Finding::State::kNotice, node, told(process) + " has it open",
                     "end that program if values look wrong"});
    }
  }
}

/// Drivers of tablets outside the kernel. X.Org's and Wayland's (xf86-input-wacom, libinput) are
/// no processes of their own, and libwacom is a list of devices: none of them disturbs limn.
void add_tablet_drivers(const std::vector<Process>& all, std::vector<Finding>& out) {
  struct Driver {
    std::string_view command;  // as /proc/PID/comm has it: 15 characters at most
    std::string_view what;
  };
  constexpr auto kDrivers = std::to_array<Driver>({
      {"OpenTabletDrive", "OpenTabletDriver sets tablets up and takes them from the kernel"},
      {"PenTablet", "XP-Pen's driver sets tablets up"},
      {"xp-pen", "XP-Pen's driver sets tablets up"},
      {"huiontablet", "Huion's driver sets tablets up"},
      {"huionCore", "Huion's driver sets tablets up"},
  });
  for (const Process& process : all) {
    for (const Driver& driver : kDrivers) {
      if (!process.command.starts_with(driver.command)) continue;
      out.push_back({Finding::State::kNotice, told(process), std::string(driver.what),
                     "end it if reports are missing or values look wrong"});
    }
  }
}

/// spacenavd takes the event nodes of 3D mice for itself; hidraw it leaves to others.
Finding spacenavd_finding(const std::vector<Process>& all, const std::string& root) {
  const auto socket = find_spacenavd(root);
  const auto process = std::find_if(all.begin(), all.end(),
                                    [](const Process& p) { return p.command == "spacenavd"; });
  if (socket) {
    return {Finding::State::kNotice, "spacenavd",
            "it runs and holds the event nodes of 3D mice; " + socket->node.substr(root.size()) +
                " gives its motions",
            "read the 3D mouse on hidraw or that socket, or stop spacenavd (systemctl stop "
            "spacenavd)"};
  }
  if (process != all.end()) {
    return {Finding::State::kTrouble, "spacenavd",
            told(*process) + " holds 3D mice, but its socket is not there",
            "start it again (systemctl restart spacenavd) or stop it"};
  }
  return {Finding::State::kGood, "spacenavd", "it does not run", ""};
}

/// Of a device that limn would read on hidraw: what Linux's driver does to its reports.
void add_driver(const ListedDevice& listed, std::vector<Finding>& out) {
  if (listed.backend != Backend::kHidraw || listed.driver.empty()) return;
  const std::string what = "Linux's driver " + listed.driver + " has it";
  if (listed.driver == "uclogic") {
    out.push_back({Finding::State::kNotice, listed.node,
                   what + ": it has set the tablet up and put its own descriptor in place",
                   "nothing: limn decodes it either way"});
  } else if (listed.driver == "wacom") {
    out.push_back({Finding::State::kGood, listed.node, what + ", beside which limn reads", ""});
  } else {
    out.push_back({Finding::State::kGood, listed.node, what, ""});
  }
}

Finding queues_finding() {
  return {Finding::State::kGood, "queues",
          "the kernel keeps 63 reports a reader on hidraw and tells nobody of more; 'limn monitor' "
          "and 'limn record' count what may be lost, and the overruns that event nodes tell of",
          "where they count losses, end what keeps this machine busy, or record to a faster disk"};
}

/// Whether Linux leaves it to limn to ask the device before it reports as its tables say.
bool needs_requests(const ListedDevice& listed) {
  const PenInitialization* sequence =
      find_pen_initialization(listed.device.vendor, listed.device.product);
  return listed.backend == Backend::kHidraw && listed.driver == "hid-generic" &&
         sequence != nullptr && sequence->interface_number == listed.interface_number;
}

std::string permission_remedy(const ListedDevice& listed) {
  if (is_in_rules(listed)) return "install the udev rules and plug the device in again";
  if (listed.backend == Backend::kEvdev) {
    return "log in at this machine's own screen, or read the device on hidraw";
  }
  if (listed.backend == Backend::kSpnav) return "ask who runs spacenavd for access to its socket";
  return "no line of 70-limn.rules is about it: add one for its vendor, as those there";
}

}  // namespace

bool is_in_rules(const ListedDevice& listed) noexcept {
  if (listed.backend == Backend::kEvdev) return listed.tablet;
  if (listed.backend == Backend::kSpnav) return false;
  constexpr std::array<std::uint16_t, 7> kVendors = {0x056A, 0x256C, 0x28BD, 0x5543,
                                                     0x0458, 0x2FEB, 0x256F};
  constexpr std::uint16_t kLogitech = 0x046D;  // 3Dconnexion's older ones
  const std::uint16_t vendor = listed.device.vendor;
  return std::find(kVendors.begin(), kVendors.end(), vendor) != kVendors.end() ||
         (vendor == kLogitech && listed.device.product >> 8 == 0xC6);
}

Finding look_at(const ListedDevice& listed) {
  using State = Finding::State;
  if (listed.backend == Backend::kUsb) {
    if (listed.driver == "usbfs") {
      return {State::kTrouble, listed.node, listed.device.name + ": another program holds it",
              "end that program"};
    }
    if (!listed.readable) {
      return {State::kTrouble, listed.node,
              listed.device.name + ": no driver of Linux has it, and no permission",
              permission_remedy(listed)};
    }
    return {State::kNotice, listed.node, listed.device.name + ": no driver of Linux has it",
            "read it with --backend usb, plug it in again, or load the module usbhid"};
  }
  if (listed.readable && needs_requests(listed)) {
    for (const std::string& node : {listed.usb_node, listed.node}) {
      if (!node.empty() && ::access(node.c_str(), R_OK | W_OK) != 0) {
        return {State::kNotice, listed.node,
                listed.device.name + ": cannot be set up, as " + node + " may not be written",
                permission_remedy(listed)};
      }
    }
  }
  if (listed.readable) return {State::kGood, listed.node, listed.device.name, ""};
  // Event nodes need no permission of their own where hidraw brings the same device.
  const bool needed = listed.backend == Backend::kHidraw || listed.same_as.empty();
  return {needed ? State::kTrouble : State::kNotice, listed.node,
          listed.device.name + ": no permission", permission_remedy(listed)};
}

std::vector<Finding> diagnose(const std::vector<ListedDevice>& devices, const std::string& root) {
  std::vector<Finding> out;
  if (devices.empty()) {
    out.push_back({Finding::State::kNotice, "devices", "no HID device is here", "plug one in"});
  }
  for (const ListedDevice& listed : devices) {
    if (listed.backend == Backend::kSpnav) continue;  // has a finding of its own
    out.push_back(look_at(listed));
    add_driver(listed, out);
  }
  out.push_back(rules_finding(root));
  const auto running = processes(devices, root);
  add_holders(running, out);
  add_tablet_drivers(running, out);
  out.push_back(spacenavd_finding(running, root));
  out.push_back(queues_finding());
  return out;
}

}  // namespace limn
