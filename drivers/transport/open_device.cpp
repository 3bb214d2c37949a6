#include "drivers/transport/open_device.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

#include "drivers/transport/diagnosis.hpp"
#include "drivers/transport/evdev_transport.hpp"
#include "drivers/transport/hidraw_control.hpp"
#include "drivers/transport/hidraw_transport.hpp"
#include "drivers/transport/pen_setup.hpp"
#include "drivers/transport/spnav_transport.hpp"
#include "drivers/transport/sysfs.hpp"
#include "drivers/transport/usb_transport.hpp"

namespace limn {
namespace {

/// The sequence to which this interface of the device reports, if any.
const PenInitialization* initialization_of(const ListedDevice& listed) {
  const PenInitialization* sequence =
      find_pen_initialization(listed.device.vendor, listed.device.product);
  const bool here = sequence != nullptr && listed.interface_number == sequence->interface_number;
  return here ? sequence : nullptr;
}

/// What a set-up leaves for the stream.
struct Learnt {
  std::vector<std::string> notes;
  std::optional<Error> trouble;
};

Learnt set_up(const PenInitialization* sequence, DeviceControl& control) {
  if (sequence == nullptr) return {};
  PenSetup setup = set_up_pen(*sequence, control);
  return {std::move(setup.notes), std::move(setup.trouble)};
}

OpenedDevice told(std::unique_ptr<Transport> transport, Learnt learnt) {
  for (std::string& note : learnt.notes) transport->add_note(std::move(note));
  return {std::move(transport), std::move(learnt.trouble)};
}

Expected<OpenedDevice> open_by_hidraw(const ListedDevice& listed,
                                      const PenInitialization* sequence) {
  // A driver of the device's own has set it up, and its reports pass through that driver.
  if (listed.driver != "hid-generic") sequence = nullptr;
  Learnt learnt;
  if (sequence != nullptr) {
    auto control = open_hidraw_control(listed.node);
    if (control) {
      learnt = set_up(sequence, **control);
    } else {
      learnt.trouble = std::move(control.error());
    }
  }
  auto transport = open_hidraw(listed.node);  // last: no report from before the set-up
  if (!transport) return tl::unexpected(std::move(transport.error()));
  return told(*std::move(transport), std::move(learnt));
}

Expected<OpenedDevice> open_by_usb(const ListedDevice& listed, const PenInitialization* sequence) {
  auto interface = UsbInterface::claim(listed);
  if (!interface) return tl::unexpected(std::move(interface.error()));
  Learnt learnt = set_up(sequence, **interface);
  auto transport = open_usb(*std::move(interface));
  if (!transport) return tl::unexpected(std::move(transport.error()));
  return told(*std::move(transport), std::move(learnt));
}

bool is_socket(const std::string& node) {
  struct stat status {};
  return ::stat(node.c_str(), &status) == 0 && S_ISSOCK(status.st_mode);
}

/// By the name that the system gives it, whatever link led there.
bool is_event_node(const std::string& node) {
  const auto device = device_of_node(node);
  return (device ? device->name() : node.substr(node.rfind('/') + 1)).starts_with("event");
}

Expected<OpenedDevice> opened(Expected<std::unique_ptr<Transport>> transport) {
  if (!transport) return tl::unexpected(std::move(transport.error()));
  return OpenedDevice{*std::move(transport), std::nullopt};
}

std::string label(const ListedDevice& listed) { return listed.node + ", " + listed.device.name; }

}  // namespace

Expected<std::vector<ListedDevice>> list_devices_of(Backend backend) {
  switch (backend) {
    case Backend::kUsb:
      return list_usb_devices();
    case Backend::kEvdev:
      return list_evdev_devices();
    case Backend::kSpnav: {
      auto spacenavd = find_spacenavd();
      return spacenavd ? std::vector{*std::move(spacenavd)} : std::vector<ListedDevice>();
    }
    case Backend::kHidraw:
      break;
  }
  return list_hid_devices();
}

Backend backend_of_node(const std::string& node) {
  if (is_socket(node)) return Backend::kSpnav;
  if (node.starts_with("/dev/bus/usb/")) return Backend::kUsb;
  if (const auto device = device_of_node(node); device && device->subsystem() == "usb") {
    return Backend::kUsb;  // by a link
  }
  return is_event_node(node) ? Backend::kEvdev : Backend::kHidraw;
}

bool is_same_node(const std::string& one, const std::string& other) {
  std::error_code error;
  return one == other || std::filesystem::equivalent(one, other, error);
}

Expected<OpenedDevice> open_device(const ListedDevice& listed, bool initialize) {
  const PenInitialization* sequence = initialize ? initialization_of(listed) : nullptr;
  switch (listed.backend) {
    case Backend::kUsb:
      return open_by_usb(listed, sequence);
    case Backend::kEvdev:
      return opened(open_evdev(listed.node));
    case Backend::kSpnav:
      return opened(open_spnav(listed.node));
    case Backend::kHidraw:
      break;
  }
  return open_by_hidraw(listed, sequence);
}

Expected<DeviceChoice> choose_rows(const std::vector<ListedDevice>& wanted,
                                   const ListedDevice* spacenavd) {
  DeviceChoice choice;
  bool spacenavd_taken = false;
  const auto by_hidraw = [&wanted](const std::string& node) {
    return std::any_of(wanted.begin(), wanted.end(), [&node](const ListedDevice& other) {
      return other.backend == Backend::kHidraw && other.node == node;
    });
  };
  for (const ListedDevice& row : wanted) {
    if (row.backend == Backend::kEvdev && !by_hidraw(row.same_as)) choice.rows.push_back(row);
    if (row.backend != Backend::kHidraw) continue;
    if (row.readable) {
      choice.rows.push_back(row);
      if (spacenavd != nullptr) {
        choice.notes.push_back(label(row) + ": spacenavd uses it, too; both get its motions");
      }
      continue;
    }
    if (spacenavd != nullptr) {
      if (!spacenavd_taken) choice.rows.push_back(*spacenavd);
      spacenavd_taken = true;
      choice.notes.push_back(label(row) + ": no permission; spacenavd's motions are used instead");
      continue;
    }
    const std::size_t before = choice.rows.size();
    std::copy_if(wanted.begin(), wanted.end(), std::back_inserter(choice.rows),
                 [&row](const ListedDevice& other) {
                   return other.backend == Backend::kEvdev && other.same_as == row.node &&
                          other.readable;
                 });
    if (choice.rows.size() == before) {
      choice.rows.push_back(row);
      continue;
    }
    choice.notes.push_back(label(row) + ": no permission; " + choice.rows[before].node +
                           " is used instead");
  }
  if (choice.rows.empty() && !wanted.empty()) {
    Finding finding = look_at(wanted.front());
    return fail(ErrorCode::kMissing, std::move(finding.subject), std::move(finding.what),
                std::move(finding.remedy));
  }
  return choice;
}

}  // namespace limn
