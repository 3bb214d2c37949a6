#include "modeler/app/live_input.hpp"

#include <signal.h>  // sigaction is POSIX

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <iterator>
#include <optional>
#include <utility>

#include "drivers/devices/pen_initialization.hpp"
#include "drivers/devices/pen_spec.hpp"
#include "drivers/transport/open_device.hpp"
#include "drivers/transport/udev_hotplug.hpp"
#include "drivers/transport/usb_transport.hpp"
#include "modeler/app/option_values.hpp"

namespace limn::app {
namespace {

/// VID:PID[:N] as typed: N counts, from 0, those that `limn devices` lists with these ids.
struct DeviceId {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::optional<std::size_t> ordinal;
};

std::optional<DeviceId> parse_device_id(const std::string& text) {
  DeviceId id;
  std::string ids = text;
  const auto first = text.find(':');
  const auto second = first == std::string::npos ? first : text.find(':', first + 1);
  if (second != std::string::npos) {
    const char* const end = text.data() + text.size();
    std::size_t ordinal = 0;
    const auto parsed = std::from_chars(text.data() + second + 1, end, ordinal);
    if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
    id.ordinal = ordinal;
    ids = text.substr(0, second);
  }
  if (!parse_id(ids, id.vendor, id.product).empty()) return std::nullopt;
  return id;
}

tl::unexpected<Failure> no_device(ErrorCode code, std::string what, std::string remedy) {
  return tl::unexpected(Failure{"", Error{code, "", std::move(what), std::move(remedy)}});
}

/// Opens a device; where it cannot be set up, says so and reads it as it is.
Expected<std::unique_ptr<Transport>> open_one(const ListedDevice& listed, bool initialize) {
  auto opened = open_device(listed, initialize);
  if (!opened) return tl::unexpected(std::move(opened.error()));
  if (const auto& trouble = opened->trouble) {
    std::fprintf(stderr, "limn: %s: is read as it is, not set up: %s%s%s; %s\n",
                 listed.node.c_str(), trouble->at.c_str(), trouble->at.empty() ? "" : " ",
                 trouble->what.c_str(), trouble->remedy.c_str());
  }
  return std::move(opened->transport);
}

/// Opens what can be opened; where nothing can, the first reason.
tl::expected<std::vector<std::unique_ptr<Transport>>, Failure> open_all(
    const std::vector<ListedDevice>& rows, bool initialize) {
  std::vector<std::unique_ptr<Transport>> opened;
  std::optional<Error> first;
  for (const ListedDevice& row : rows) {
    auto transport = open_one(row, initialize);
    if (transport) {
      opened.push_back(*std::move(transport));
    } else if (!first) {
      first = std::move(transport.error());
    }
  }
  if (opened.empty() && first) return tl::unexpected(Failure{"", *std::move(first)});
  return opened;
}

/// Opens what lies behind a node, once: what goes away stays away.
tl::expected<std::unique_ptr<LiveReader>, Failure> open_node(
    const std::string& node, const LiveArguments& live, const std::vector<ListedDevice>& listed) {
  const Backend backend = live.backend.value_or(backend_of_node(node));
  std::vector<ListedDevice> chosen;
  std::copy_if(listed.begin(), listed.end(), std::back_inserter(chosen),
               [&](const ListedDevice& one) { return one.node == node && one.backend == backend; });
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
std::vector<ListedDevice> choose(const std::vector<ListedDevice>& wanted,
                                 const std::vector<ListedDevice>& listed) {
  const bool mouse = std::any_of(wanted.begin(), wanted.end(), [](const ListedDevice& one) {
    return traits_of(one).kind == DeviceKind::k3dMouse;
  });
  const auto spacenavd = std::find_if(listed.begin(), listed.end(), [](const ListedDevice& one) {
    return one.backend == Backend::kSpnav;
  });
  DeviceChoice choice =
      choose_rows(wanted, mouse && spacenavd != listed.end() ? &*spacenavd : nullptr);
  for (const std::string& note : choice.notes) std::fprintf(stderr, "limn: %s\n", note.c_str());
  return std::move(choice.rows);
}

/// Those that come later on the backend; on hidraw where none was asked for.
DeviceWatch watch_of(std::optional<Backend> backend) {
  DeviceWatch watch;
  if (backend == Backend::kUsb) watch.subsystem = "usb";
  if (backend == Backend::kEvdev) watch.subsystem = "input";
  if (backend) watch.list = [backend] { return list_devices_of(*backend); };
  return watch;
}

std::atomic<LiveReader*> stopped_by_signal = nullptr;

extern "C" void stop_reader(int) {
  if (LiveReader* reader = stopped_by_signal.load()) reader->stop();
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  ::sigaction(signal, nullptr, &action);
  if (action.sa_handler == SIG_IGN) return;  // as the caller wants it
  action.sa_handler = handler;
  ::sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second Ctrl-C ends the program at once
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

DeviceTraits traits_of(const ListedDevice& listed) {
  DeviceTraits traits = limn::traits_of(listed.device);
  if (listed.backend == Backend::kSpnav) traits = {DeviceKind::k3dMouse, "3D mouse", {}, {}};
  const bool mere_axes = listed.backend == Backend::kEvdev && !listed.tablet;
  if (mere_axes && traits.kind == DeviceKind::kPen) return {};
  if (traits.kind != DeviceKind::kOther) return traits;
  const PenInitialization* sequence =
      find_pen_initialization(listed.device.vendor, listed.device.product);
  const bool by_reports = listed.backend == Backend::kHidraw || listed.backend == Backend::kUsb;
  if (by_reports && sequence != nullptr && sequence->interface_number == listed.interface_number) {
    return {DeviceKind::kPen, name(sequence->family), {}, {}};
  }
  return traits;
}

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
  auto listed = in_file("", live.backend ? list_devices_of(*live.backend) : list_devices());
  if (!listed && !by_node) return tl::unexpected(std::move(listed.error()));
  if (!listed) listed.emplace();
  if (by_node) return open_node(device, live, *listed);
  const auto wanted = [id](const ListedDevice& one) {
    return id ? one.device.vendor == id->vendor && one.device.product == id->product
              : traits_of(one).kind == DeviceKind::kPen;
  };
  std::vector<ListedDevice> chosen;
  std::copy_if(listed->begin(), listed->end(), std::back_inserter(chosen), wanted);
  std::optional<int> interface_number;  // of the one that N names, for when it comes back
  if (id && id->ordinal) {
    const std::size_t found = chosen.size();
    chosen = *id->ordinal < found ? std::vector{chosen[*id->ordinal]} : std::vector<ListedDevice>();
    if (!chosen.empty()) interface_number = chosen.front().interface_number;
  }
  if (chosen.empty()) {
    return no_device(ErrorCode::kMissing,
                     id ? "no device " + device + " is here" : "no pen is here",
                     "plug it in and see 'limn devices'");
  }
  if (!live.backend && (!id || !id->ordinal)) chosen = choose(chosen, *listed);
  auto opened = open_all(chosen, initialize);
  if (!opened) return tl::unexpected(std::move(opened.error()));
  // Without udev what goes away stays away; everything else still works.
  DeviceWatch watch = watch_of(live.backend);
  watch.wanted = [wanted, interface_number](const ListedDevice& one) {
    return wanted(one) && (!interface_number || one.interface_number == *interface_number);
  };
  watch.open = [initialize](const ListedDevice& one) {
    auto transport = open_one(one, initialize);
    return transport ? *std::move(transport) : std::unique_ptr<Transport>();
  };
  auto hotplug = watch_devices(std::move(watch));
  return in_file("",
                 LiveReader::start(*std::move(opened), hotplug ? *std::move(hotplug) : nullptr));
}

StopOnSignal::StopOnSignal(LiveReader& reader) {
  stopped_by_signal.store(&reader);
  handle(SIGINT, stop_reader);
  handle(SIGTERM, stop_reader);
}

StopOnSignal::~StopOnSignal() {
  handle(SIGINT, SIG_DFL);
  handle(SIGTERM, SIG_DFL);
  stopped_by_signal.store(nullptr);
}

}  // namespace limn::app
