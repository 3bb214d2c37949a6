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

Finding node_finding(const ListedDevice& listed) {
  if (listed.readable) return {Finding::State::kGood, listed.node, listed.device.name, ""};
  return {Finding::State::kTrouble, listed.node, listed.device.name + ": no permission",
          "install the udev rules and plug the device in again"};
}

/// The command name of a process, "" where it has gone.
std::string command_of(const fs::path& process) {
  std::ifstream comm(process / "comm");
  std::string name;
  std::getline(comm, name);
  return name;
}

/// One finding a process that has one of the nodes open. Others may read a hidraw node beside limn,
/// but a program that sets the device up can change what its reports mean.
std::vector<Finding> holders(const std::vector<ListedDevice>& devices, const std::string& root) {
  std::set<std::string> nodes;
  for (const ListedDevice& listed : devices) nodes.insert(listed.node);
  std::vector<Finding> out;
  std::error_code error;
  for (fs::directory_iterator process(root + "/proc", error), end; !error && process != end;
       process.increment(error)) {
    const std::string pid = process->path().filename().string();
    if (pid.empty() || !std::all_of(pid.begin(), pid.end(),
                                    [](unsigned char c) { return std::isdigit(c) != 0; })) {
      continue;
    }
    std::error_code refused;  // of other users' processes: passed over
    std::set<std::string> open;
    for (fs::directory_iterator file(process->path() / "fd", refused), last;
         !refused && file != last; file.increment(refused)) {
      std::error_code gone;
      const std::string target = fs::read_symlink(file->path(), gone).string();
      if (nodes.contains(target)) open.insert(target);
    }
    for (const std::string& node : open) {
      out.push_back({Finding::State::kNotice, node,
                     command_of(process->path()) + " (process " + pid + ") has it open",
                     "end that program if values look wrong"});
    }
  }
  return out;
}

Finding spacenavd_finding(const std::string& root) {
  if (exists(root + "/run/spnav.sock") || exists(root + "/var/run/spnav.sock")) {
    return {Finding::State::kNotice, "spacenavd", "it runs and reads the 3D mice",
            "stop it (systemctl stop spacenavd) if motions come twice"};
  }
  return {Finding::State::kGood, "spacenavd", "it does not run", ""};
}

}  // namespace

std::vector<Finding> diagnose(const std::vector<ListedDevice>& devices, const std::string& root) {
  std::vector<Finding> out;
  if (devices.empty()) {
    out.push_back({Finding::State::kNotice, "devices", "no HID device is here", "plug one in"});
  }
  for (const ListedDevice& listed : devices) out.push_back(node_finding(listed));
  out.push_back(rules_finding(root));
  auto open = holders(devices, root);
  out.insert(out.end(), open.begin(), open.end());
  out.push_back(spacenavd_finding(root));
  return out;
}

}  // namespace limn
