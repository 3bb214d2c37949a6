// What the command line does not show of devices, for tests that run it inside umockdev:
//
//     drain              reads the first USB device until it is gone; says how often that called
//                        operator new (libusb's callocs, one a transfer submitted, do not count);
//                        fails where a drain gave more reports than its share
//     feature [NODE]     asks it, or the device behind a hidraw node, for feature report 7
//     streamed           asks the first USB device for feature report 7, and tells it output report
//     4,
//                        while it is streamed; and once more when it is gone
//     hotplug TEXT PATH  plugs in the devices that the file TEXT describes, tells that the one at
//                        PATH in sysfs has come; its opening waits until a report of another device
//                        has come through

#include <dlfcn.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <future>
#include <string_view>
#include <utility>

#include "drivers/transport/hidraw_control.hpp"
#include "drivers/transport/hidraw_transport.hpp"
#include "drivers/transport/live_reader.hpp"
#include "drivers/transport/open_device.hpp"
#include "drivers/transport/udev_hotplug.hpp"
#include "drivers/transport/usb_transport.hpp"
#include "tests/support/alloc_guard.hpp"
#include "tests/support/recordings.hpp"
#include "tests/unit/drivers/counting_sink.hpp"

namespace limn::test {
namespace {

constexpr int kFailed = 1;

int refuse(const Error& error) {
  std::fprintf(stderr, "%s: %s; %s\n", error.at.c_str(), error.what.c_str(), error.remedy.c_str());
  return kFailed;
}

int drain(const ListedDevice& listed) {
  auto opened = open_device(listed);
  if (!opened) return refuse(opened.error());
  Transport& transport = *opened->transport;
  CountingSink sink;
  const AllocGuard guard;
  auto state = Transport::State::kOpen;
  int most = 0;
  while (state == Transport::State::kOpen) {
    pollfd ready{transport.poll_descriptor(), POLLIN, 0};
    const int before = sink.reports;
    if (::poll(&ready, 1, -1) > 0) state = transport.drain(sink);
    most = std::max(most, sink.reports - before);
  }
  const auto allocations = guard.count();
  std::printf("%d reports, %zu allocations, gone\n", sink.reports, allocations);
  constexpr int kAlreadyWaiting = 32;  // transfers that have come by then
  std::fprintf(stderr, "at most %d reports a drain\n", most);
  return most <= Transport::kMostReports + kAlreadyWaiting ? 0 : kFailed;
}

int ask_feature(DeviceControl& control) {
  const auto report = control.get_feature(7, 4);
  if (!report) return refuse(report.error());
  for (const std::uint8_t byte : *report) std::printf("%02x ", byte);
  std::printf("\n");
  return 0;
}

int ask_streamed(const ListedDevice& listed) {
  auto opened = open_device(listed);
  if (!opened) return refuse(opened.error());
  std::vector<std::unique_ptr<Transport>> devices;
  devices.push_back(std::move(opened->transport));
  const auto reader = LiveReader::start(std::move(devices));
  if (!reader) return refuse(reader.error());
  const auto control = (*reader)->open_control(0);
  if (!control) return refuse(control.error());
  int reports = 0;
  for (;;) {
    const auto event = (*reader)->next();
    if (std::holds_alternative<TraceEnd>(*event)) break;
    if (!std::holds_alternative<Report>(*event) || ++reports > 1) continue;
    if (const int failed = ask_feature(**control); failed != 0) return failed;
    constexpr std::uint8_t kLight[] = {4, 1};
    if (const auto told = (*control)->set_output(kLight); !told) return refuse(told.error());
  }
  std::printf("%d reports, gone\n", reports);
  return ask_feature(**control);
}

/// umockdev's library, whose headers are in no package that limn needs.
class Testbed {
 public:
  bool add(const std::string& text) const {
    const auto function = find<int(void*, const char*, void*)>("umockdev_testbed_add_from_string");
    return function != nullptr && function(testbed_, text.c_str(), nullptr) != 0;
  }
  bool tell(const std::string& device) const {
    const auto function = find<void(void*, const char*, const char*)>("umockdev_testbed_uevent");
    if (function != nullptr) function(testbed_, device.c_str(), "add");
    return function != nullptr;
  }

 private:
  template <class Function>
  Function* find(const char* name) const {
    void* const found = library_ != nullptr ? ::dlsym(library_, name) : nullptr;
    return reinterpret_cast<Function*>(found);
  }
  void* make() const {
    const auto function = find<void*()>("umockdev_testbed_new");
    return function != nullptr ? function() : nullptr;
  }

  void* library_ = ::dlopen("libumockdev.so.0", RTLD_NOW);
  void* testbed_ = make();
};

/// A device that is one end of a socket; `far_end` gets the other.
std::unique_ptr<Transport> socket_device(const std::string& name, int& far_end) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) != 0) return nullptr;
  far_end = ends[0];
  TraceDevice device;
  device.name = name;
  return open_messages(ends[1], std::move(device));
}

int hotplug(const std::string& text, const std::string& path) {
  const Testbed testbed;
  std::promise<void> opening;
  std::promise<void> report_came;
  int far_end = -1;
  int other_end = -1;
  DeviceWatch watch;
  if (path.find("hidraw") == std::string::npos) {
    watch.backends = {Backend::kUsb};
  }
  watch.wanted = [](const ListedDevice&) { return true; };
  watch.open = [&, opened = false](const ListedDevice& listed) mutable {
    // umockdev tells that it has come, too, perhaps before all of it is there.
    if (std::exchange(opened, true)) return std::unique_ptr<Transport>();
    opening.set_value();
    report_came.get_future().wait();
    return socket_device(listed.device.name, other_end);
  };
  auto hotplug = watch_devices(std::move(watch));
  if (!hotplug) return refuse(hotplug.error());
  std::vector<std::unique_ptr<Transport>> devices;
  devices.push_back(socket_device("first", far_end));
  const auto reader = LiveReader::start(std::move(devices), *std::move(hotplug));
  if (!reader || !testbed.add(text)) return kFailed;
  if (!testbed.tell(path)) return kFailed;
  opening.get_future().wait();
  if (::write(far_end, "r", 1) != 1) return kFailed;
  for (int events = 0; events < 3; ++events) {
    const auto event = (*reader)->next();
    if (const auto* described = std::get_if<DeviceDescribed>(&*event)) {
      std::printf("described %s\n", described->device->name.c_str());
    } else if (std::holds_alternative<Report>(*event)) {
      std::printf("report while opening\n");
      report_came.set_value();
    }
  }
  ::close(far_end);
  ::close(other_end);
  return 0;
}

int run(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "";
  if (what == "hotplug" && argc > 3) return hotplug(read_file(argv[2]), argv[3]);
  if (what == "feature" && argc > 2) {
    const auto control = open_hidraw_control(argv[2]);
    return control ? ask_feature(**control) : refuse(control.error());
  }
  const auto listed = list_devices_of(Backend::kUsb);
  if (!listed || listed->empty()) return kFailed;
  if (what == "drain") return drain(listed->front());
  if (what == "streamed") return ask_streamed(listed->front());
  const auto interface = UsbInterface::claim(listed->front());
  return interface ? ask_feature(**interface) : refuse(interface.error());
}

}  // namespace
}  // namespace limn::test

int main(int argc, char** argv) { return limn::test::run(argc, argv); }
