#include "tests/kernel/plugged_device.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <utility>

#include "firmware_sim/link/uhid.hpp"
#include "firmware_sim/link/usbip_server.hpp"
#include "firmware_sim/link/vhci.hpp"

namespace limn::test {

using firmware::FileDescriptor;

namespace {

constexpr std::chrono::hours kForever{24};

}  // namespace

const char* name(Cable cable) { return cable == Cable::kUhid ? "UHID" : "USB/IP"; }

FileDescriptor plug_into_vhci() {
  constexpr std::uint32_t kFullSpeedPorts = 8;
  int ends[2] = {-1, -1};
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
  FileDescriptor ours(ends[0]);
  const FileDescriptor theirs(ends[1]);
  std::string why;
  for (std::uint32_t port = 0; port < kFullSpeedPorts; ++port) {
    const auto attached = firmware::attach_to_vhci(theirs.get(), port);
    if (attached) return ours;
    why = attached.error().what;
  }
  ADD_FAILURE() << why;
  return ours;
}

PluggedDevice::PluggedDevice(firmware::BusDevice& device, Cable cable, bool wait) {
  auto waiter = firmware::Waiter::make();
  if (!waiter) {
    ADD_FAILURE() << waiter.error().what;
    return;
  }
  waiter_ = std::make_unique<firmware::Waiter>(*std::move(waiter));
  thread_ = std::thread([this, &device, cable, wait] {
    cable == Cable::kUhid ? serve_uhid(device, wait) : serve_usbip(device, wait);
  });
}

PluggedDevice::~PluggedDevice() {
  if (waiter_) waiter_->stop();
  if (thread_.joinable()) thread_.join();
}

void PluggedDevice::serve_uhid(firmware::BusDevice& device, bool wait) {
  firmware::UhidOptions options;
  options.wait_for_reader = wait;
  auto link = firmware::UhidLink::open(device, options);
  ASSERT_TRUE(link) << link.error().what << "; " << link.error().remedy;
  const auto ended = link->run(kForever, *waiter_);
  EXPECT_TRUE(ended) << ended.error().what;
  EXPECT_EQ(link->refused(), 0U);
}

void PluggedDevice::serve_usbip(firmware::BusDevice& device, bool wait) {
  using Kind = firmware::UsbipNotice::Kind;
  firmware::UsbipOptions options;
  options.wait_for_reader = wait;
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
