#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "firmware_sim/link/file_descriptor.hpp"
#include "firmware_sim/link/waiter.hpp"
#include "firmware_sim/usb/bus_device.hpp"

namespace limn::test {

/// How a simulated device reaches Linux.
enum class Cable { kUhid, kUsbip };

/// "UHID", "USB/IP".
const char* name(Cable cable);

/// A simulated device that hangs on the Linux that the test runs on, served by a thread of its own
/// until this goes. By USB/IP it is plugged in again whenever it comes back.
class PluggedDevice {
 public:
  /// `device` must outlive this. Fails the test where the link cannot be made. With `wait` the
  /// device's time begins when a program opens it.
  PluggedDevice(firmware::BusDevice& device, Cable cable, bool wait = true);
  ~PluggedDevice();
  PluggedDevice(const PluggedDevice&) = delete;

 private:
  void serve_uhid(firmware::BusDevice& device, bool wait);
  void serve_usbip(firmware::BusDevice& device, bool wait);

  std::unique_ptr<firmware::Waiter> waiter_;
  std::thread thread_;
};

/// One end of a socket pair, whose other end Linux's virtual USB controller has: on its first free
/// port. Fails the test where it has none.
firmware::FileDescriptor plug_into_vhci();

}  // namespace limn::test
