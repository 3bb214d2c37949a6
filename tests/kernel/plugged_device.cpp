#include "tests/kernel/plugged_device.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <fstream>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "firmware_sim/link/uhid.hpp"
#include "firmware_sim/link/usbip_server.hpp"
#include "firmware_sim/link/vhci.hpp"

namespace limn::test {

using firmware::FileDescriptor;

namespace {

constexpr std::chrono::hours kForever{24};

/// The first port for full speed that has no device, by vhci-hcd's table of "hs 0000 004 ..".
std::optional<std::uint32_t> free_port() {
  constexpr int kFree = 4;
  std::ifstream table(std::string(firmware::kVhciFolder) + "/status");
  for (std::string line; std::getline(table, line);) {
    std::istringstream words(line);
    std::string hub;
    std::uint32_t port = 0;
    int status = 0;
    if (words >> hub >> port >> status && hub == "hs" && status == kFree) return port;
  }
  return std::nullopt;
}

/// One end of a socket pair, whose other end Linux's virtual USB controller has.
FileDescriptor plug_into_vhci() {
  static std::mutex one_at_a_time;  // between looking at a port and having it
  const std::lock_guard lock(one_at_a_time);
  int ends[2] = {-1, -1};
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
  FileDescriptor ours(ends[0]);
  const FileDescriptor theirs(ends[1]);
  const auto port = free_port();
  EXPECT_TRUE(port) << "all ports of vhci-hcd are in use";
  if (!port) return ours;
  const auto attached = firmware::attach_to_vhci(theirs.get(), *port);
  EXPECT_TRUE(attached) << attached.error().what;
  return ours;
}

}  // namespace

const char* name(Cable cable) { return cable == Cable::kUhid ? "UHID" : "USB/IP"; }

PluggedDevice::PluggedDevice(firmware::BusDevice& device, Cable cable) {
  auto waiter = firmware::Waiter::make();
  if (!waiter) {
    ADD_FAILURE() << waiter.error().what;
    return;
  }
  waiter_ = std::make_unique<firmware::Waiter>(*std::move(waiter));
  thread_ = std::thread(
      [this, &device, cable] { cable == Cable::kUhid ? serve_uhid(device) : serve_usbip(device); });
}

PluggedDevice::~PluggedDevice() {
  if (waiter_) waiter_->stop();
  if (thread_.joinable()) thread_.join();
}

void PluggedDevice::serve_uhid(firmware::BusDevice& device) {
  firmware::UhidOptions options;
  options.wait_for_reader = false;
  auto link = firmware::UhidLink::open(device, options);
  ASSERT_TRUE(link) << link.error().what << "; " << link.error().remedy;
  const auto ended = link->run(kForever, *waiter_);
  EXPECT_TRUE(ended) << ended.error().what;
  EXPECT_EQ(link->refused(), 0U);
}

void PluggedDevice::serve_usbip(firmware::BusDevice& device) {
  using Kind = firmware::UsbipNotice::Kind;
  firmware::UsbipOptions options;
  options.wait_for_reader = false;
  firmware::UsbipServer* running = nullptr;
  firmware::UsbipServer server(device, options, [&running](const firmware::UsbipNotice& notice) {
    EXPECT_NE(notice.kind, Kind::kRefused) << notice.text;
    if (notice.kind == Kind::kPlugged) running->adopt(plug_into_vhci());
  });
  running = &server;
  server.adopt(plug_into_vhci());
  const auto ended = server.run(kForever, *waiter_);
  EXPECT_TRUE(ended) << ended.error().what;
}

}  // namespace limn::test
