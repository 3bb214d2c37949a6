#include "modeler/app/live_input.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/transport/open_device.hpp"
#include "drivers/transport/udev_hotplug.hpp"
#include "modeler/app/device_selection.hpp"
#include "modeler/app/terminal_text.hpp"

namespace limn::app {
namespace {

tl::unexpected<Failure> no_device(ErrorCode code, std::string what, std::string remedy) {
  return tl::unexpected(Failure{"", Error{code, "", std::move(what), std::move(remedy)}});
}

void print_trouble(std::string at, const std::string& before, const Error& error) {
  print_error(Failure{"", Error{error.code, std::move(at), before + error.what, error.remedy}});
}

/// Opens a device; where it cannot be set up, says so and reads it as it is.
Expected<std::unique_ptr<Transport>> open_one(const ListedDevice& listed, bool initialize) {
  auto opened = open_device(listed, initialize);
  if (!opened) return tl::unexpected(std::move(opened.error()));
  if (const auto& trouble = opened->trouble) {
    const std::string place = trouble->at.empty() ? "" : trouble->at + " ";
    print_trouble(listed.node, "is read as it is, not set up: " + place, *trouble);
  }
  return std::move(opened->transport);
}

/// Opens what can be opened, and says on standard error what cannot; where nothing can, the first
/// reason is the failure.
tl::expected<std::vector<std::unique_ptr<Transport>>, Failure> open_all(
    const std::vector<ListedDevice>& rows, bool initialize) {
  std::vector<std::unique_ptr<Transport>> opened;
  std::vector<Error> refused;
  for (const ListedDevice& row : rows) {
    auto transport = open_one(row, initialize);
    if (transport) {
      opened.push_back(*std::move(transport));
    } else {
      refused.push_back(std::move(transport.error()));
    }
  }
  const bool nothing = opened.empty() && !refused.empty();
  for (std::size_t i = nothing ? 1 : 0; i < refused.size(); ++i) {
    print_trouble(refused[i].at, "", refused[i]);
  }
  if (nothing) return tl::unexpected(Failure{"", std::move(refused.front())});
  return opened;
}

/// Opens what lies behind a node, once: what goes away stays away.
tl::expected<std::unique_ptr<LiveReader>, Failure> open_node(const std::string& node,
                                                             const LiveArguments& live) {
  const Backend backend = live.backend.value_or(backend_of_node(node));
  std::vector<ListedDevice> chosen;
  if (const auto listed = list_devices_of(backend)) {
    std::copy_if(listed->begin(), listed->end(), std::back_inserter(chosen),
                 [&node](const ListedDevice& one) { return is_same_node(one.node, node); });
  }
  if (backend == Backend::kUsb) chosen = pen_interfaces(std::move(chosen));
  if (chosen.empty()) {  // let the backend say what is wrong with it
    chosen.emplace_back();
    chosen.back().node = node;
    chosen.back().backend = backend;
  }
  auto opened = open_all(chosen, live.initialize);
  if (!opened) return tl::unexpected(std::move(opened.error()));
  return in_file("", LiveReader::start(*std::move(opened)));
}

/// One row a device, and a line on standard error where the user should know of it.
tl::expected<std::vector<ListedDevice>, Failure> choose(const std::vector<ListedDevice>& wanted,
                                                        const std::vector<ListedDevice>& listed) {
  const bool mouse = std::any_of(wanted.begin(), wanted.end(), [](const ListedDevice& one) {
    return traits_of(one).kind == DeviceKind::k3dMouse;
  });
  const auto spacenavd = std::find_if(listed.begin(), listed.end(), [](const ListedDevice& one) {
    return one.backend == Backend::kSpnav;
  });
  auto choice =
      in_file("", choose_rows(wanted, mouse && spacenavd != listed.end() ? &*spacenavd : nullptr));
  if (!choice) return tl::unexpected(std::move(choice.error()));
  for (const std::string& note : choice->notes) print_error(note);
  return std::move(choice->rows);
}

/// Where nothing could be opened and a file of spacenavd's is there, that may be why.
Failure suspecting_spacenavd(Failure failure, const std::vector<ListedDevice>& listed) {
  const auto found = std::find_if(listed.begin(), listed.end(), [](const ListedDevice& one) {
    return one.backend == Backend::kSpnav;
  });
  if (found != listed.end()) {
    failure.error.remedy += "; where spacenavd (" + found->node + ") has it, stop that";
  }
  return failure;
}

/// Opens a device that has come; nothing where it cannot be, which standard error says.
std::unique_ptr<Transport> open_late(const ListedDevice& one, bool initialize) {
  auto transport = open_one(one, initialize);
  if (transport) return *std::move(transport);
  // A program that holds a USB interface is likely this one: udev may tell of a device again.
  if (one.driver != "usbfs") print_trouble(transport.error().at, "", transport.error());
  return nullptr;
}

std::string what_is_missing(const LiveArguments& live, bool by_id) {
  if (live.backend == Backend::kSpnav) return "spacenavd does not run";
  if (by_id) return "no device " + live.device + " is here";
  return live.kind == DeviceKind::k3dMouse ? "no 3D mouse is here" : "no pen is here";
}

}  // namespace

tl::expected<std::unique_ptr<LiveReader>, Failure> open_live_input(const LiveArguments& live) {
  const std::string& device = live.device;
  const bool initialize = live.initialize;
  const bool by_node = device.find('/') != std::string::npos;
  std::optional<DeviceId> id;
  if (!device.empty() && !by_node) {
    id = parse_device_id(device);
    if (!id) {
      return usage_error("'" + device + "' is no device",
                         "give VID:PID, VID:PID:N or a node, as 'limn devices' shows them");
    }
  }
  if (by_node) return open_node(device, live);
  auto heard = listen_for_devices();  // before listing, so that nothing is missed in between
  auto listed = in_file("", live.backend ? list_devices_of(*live.backend) : list_devices());
  if (!listed) return tl::unexpected(std::move(listed.error()));
  const std::vector<ListedDevice> all = *listed;
  if (!live.from_spacenavd) listed = without_spacenavd(*std::move(listed));
  auto chosen = devices_named(*listed, id, live.backend, live.kind);
  const bool waits = live.waits && heard;
  if (chosen.empty() && waits) {
    print_error(what_is_missing(live, id.has_value()) + " yet; it is waited for");
  } else if (chosen.empty()) {
    return no_device(ErrorCode::kMissing, what_is_missing(live, id.has_value()),
                     live.backend == Backend::kSpnav ? "start spacenavd, or name its socket"
                                                     : "plug it in and see 'limn devices'");
  }
  if (!live.backend && (!id || !id->ordinal)) {
    auto rows = choose(chosen, *listed);
    if (!rows) return tl::unexpected(std::move(rows.error()));
    chosen = *std::move(rows);
  }
  auto opened = open_all(chosen, initialize);
  if (!opened) {
    if (live.from_spacenavd) return tl::unexpected(std::move(opened.error()));
    return tl::unexpected(suspecting_spacenavd(std::move(opened.error()), all));
  }
  // Without udev what goes away stays away; everything else still works.
  std::unique_ptr<Hotplug> hotplug;
  const LaterDevices later(live.backend, id, std::move(chosen), live.kind);
  if (heard && !later.backends().empty()) {
    DeviceWatch watch;
    watch.backends = later.backends();
    watch.wanted = [later](const ListedDevice& one) { return later.wants(one); };
    watch.open = [initialize](const ListedDevice& one) { return open_late(one, initialize); };
    if (auto watched = watch_devices(std::move(watch), *std::move(heard))) {
      hotplug = *std::move(watched);
    }
  }
  return in_file("", LiveReader::start(*std::move(opened), std::move(hotplug)));
}

}  // namespace limn::app
