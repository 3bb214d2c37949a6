#include "modeler/app/device_link.hpp"

#include <cinttypes>
#include <cstdio>
#include <utility>

#include "firmware_sim/link/linux_name.hpp"
#include "firmware_sim/link/uhid.hpp"
#include "firmware_sim/link/usbip_server.hpp"
#include "modeler/app/stop_on_signal.hpp"
#include "modeler/app/trace_input.hpp"

namespace limn::app {
namespace {

using std::chrono::microseconds;

/// So that programs read the last reports before the device goes.
constexpr microseconds kLinger{1'000'000};

tl::unexpected<Failure> failure_of(firmware::LinkError error) {
  return tl::unexpected(
      Failure{"", Error{ErrorCode::kIo, "", std::move(error.what), std::move(error.remedy)}});
}

/// A line on standard error, at once.
void say(const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }

std::string usbip_command(std::uint16_t port) {
  std::string command = "usbip ";
  if (port != firmware::usbip::kDefaultPort) command += "--tcp-port " + std::to_string(port) + " ";
  return command + "attach -r 127.0.0.1 -b " + std::string(firmware::usbip::kBusId);
}

Outcome run_uhid(firmware::BusDevice& device, microseconds end, firmware::Waiter& waiter) {
  auto link = firmware::UhidLink::open(device);
  if (!link) return failure_of(std::move(link.error()));
  const firmware::DeviceSpec& spec = device.spec();
  char ids[16];
  std::snprintf(ids, sizeof ids, "%04x:%04x", spec.vendor, spec.product);
  say(firmware::linux_name(spec) + " is plugged in by UHID, and begins once a program opens it: " +
      "limn monitor " + ids + "; Ctrl-C ends it");
  const auto ended = link->run(end, waiter);
  if (!ended) return failure_of(ended.error());
  say(count_of(link->reports(), "report") +
      (link->refused() > 0 ? ", and Linux refused " + std::to_string(link->refused()) +
                                 ": no driver took the device, see dmesg"
                           : ""));
  return {};
}

Outcome run_usbip(firmware::BusDevice& device, microseconds end, std::uint16_t wanted,
                  firmware::Waiter& waiter) {
  using Kind = firmware::UsbipNotice::Kind;
  std::uint16_t port = 0;
  firmware::UsbipServer server(device, {}, [&port](const firmware::UsbipNotice& notice) {
    say(notice.text + (notice.kind == Kind::kPlugged ? ": " + usbip_command(port) : ""));
  });
  const auto listening = server.listen(wanted);
  if (!listening) return failure_of(listening.error());
  port = *listening;
  say(firmware::linux_name(device.spec()) + " waits on 127.0.0.1:" + std::to_string(port) +
      "; plug it in as root: modprobe vhci-hcd; " + usbip_command(port));
  say("it begins once a program opens it; Ctrl-C ends it");
  const auto ended = server.run(end, waiter);
  if (!ended) return failure_of(ended.error());
  say(count_of(server.reports(), "report"));
  return {};
}

}  // namespace

Outcome run_device_link(firmware::BusDevice& device, microseconds end,
                        const LinkArguments& arguments) {
  auto waiter = firmware::Waiter::make();
  if (!waiter) return failure_of(std::move(waiter.error()));
  const StopOnSignal stop(*waiter);
  if (arguments.uhid) return run_uhid(device, end + kLinger, *waiter);
  return run_usbip(device, end + kLinger, *arguments.usbip_port, *waiter);
}

}  // namespace limn::app
