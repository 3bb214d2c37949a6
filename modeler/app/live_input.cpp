#include "modeler/app/live_input.hpp"

#include <signal.h>  // sigaction is POSIX

#include <algorithm>
#include <atomic>
#include <charconv>
#include <iterator>
#include <optional>
#include <utility>

#include "drivers/devices/pen_decoder.hpp"
#include "drivers/devices/pen_spec.hpp"
#include "drivers/transport/hidraw_transport.hpp"
#include "drivers/transport/udev_hotplug.hpp"
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

/// Opens what can be opened; where nothing can, the first reason.
tl::expected<std::vector<std::unique_ptr<Transport>>, Failure> open_all(
    const std::vector<std::string>& nodes) {
  std::vector<std::unique_ptr<Transport>> opened;
  std::optional<Error> first;
  for (const std::string& node : nodes) {
    auto transport = open_hidraw(node);
    if (transport) {
      opened.push_back(*std::move(transport));
    } else if (!first) {
      first = std::move(transport.error());
    }
  }
  if (opened.empty() && first) return tl::unexpected(Failure{"", *std::move(first)});
  return opened;
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

std::string pen_kind(const ListedDevice& listed) {
  const auto decoder = PenDecoder::make(listed.device.vendor, listed.device.product,
                                        listed.device.report_descriptor);
  if (!decoder || !decoder->has_pen()) return {};
  return decoder->spec() != nullptr ? std::string(name(decoder->spec()->family)) : "HID pen";
}

tl::expected<std::unique_ptr<LiveReader>, Failure> open_live_input(const std::string& device) {
  if (device.find('/') != std::string::npos) {
    auto transport = open_hidraw(device);
    if (!transport) return tl::unexpected(Failure{"", std::move(transport.error())});
    std::vector<std::unique_ptr<Transport>> one;
    one.push_back(*std::move(transport));
    return in_file("", LiveReader::start(std::move(one)));
  }
  std::optional<DeviceId> id;
  if (!device.empty()) {
    id = parse_device_id(device);
    if (!id) {
      return usage_error("'" + device + "' is no device",
                         "give VID:PID, VID:PID:N or a node, as 'limn devices' shows them");
    }
  }
  auto listed = in_file("", list_hid_devices());
  if (!listed) return tl::unexpected(std::move(listed.error()));
  const auto wanted = [id](const ListedDevice& one) {
    return id ? one.device.vendor == id->vendor && one.device.product == id->product
              : !pen_kind(one).empty();
  };
  std::vector<ListedDevice> chosen;
  std::copy_if(listed->begin(), listed->end(), std::back_inserter(chosen), wanted);
  std::optional<int> interface_number;  // of the one that N names, for when it comes back
  if (id && id->ordinal) {
    const std::size_t found = chosen.size();
    chosen = *id->ordinal < found ? std::vector{chosen[*id->ordinal]} : std::vector<ListedDevice>();
    if (!chosen.empty()) interface_number = chosen.front().interface_number;
  }
  std::vector<std::string> nodes;
  for (const ListedDevice& one : chosen) nodes.push_back(one.node);
  if (nodes.empty()) {
    return no_device(ErrorCode::kMissing,
                     id ? "no device " + device + " is here" : "no pen is here",
                     "plug it in and see 'limn devices'");
  }
  auto opened = open_all(nodes);
  if (!opened) return tl::unexpected(std::move(opened.error()));
  // Without udev what goes away stays away; everything else still works.
  DeviceWatch watch;
  watch.wanted = [wanted, interface_number](const ListedDevice& one) {
    return wanted(one) && (!interface_number || one.interface_number == *interface_number);
  };
  watch.open = [](const ListedDevice& one) {
    auto opened = open_hidraw(one.node);
    return opened ? *std::move(opened) : std::unique_ptr<Transport>();
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
