#pragma once

#include <memory>
#include <thread>

#include "firmware_sim/link/waiter.hpp"
#include "firmware_sim/usb/bus_device.hpp"

namespace limn::test {

/// How a simulated device reaches Linux.
enum class Cable { kUhid, kUsbip };

/// "UHID", "USB/IP".
const char* name(Cable cable);

/// A simulated device that hangs on the Linux that the test runs on, served by a thread of its own
/// until this goes. Its time begins at once. By USB/IP it is plugged in again whenever it comes
/// back, on the first free port of Linux's virtual controller.
class PluggedDevice {
 public:
  /// `device` must outlive this. Fails the test where the link cannot be made.
  PluggedDevice(firmware::BusDevice& device, Cable cable);
  ~PluggedDevice();
  PluggedDevice(const PluggedDevice&) = delete;

 private:
  void serve_uhid(firmware::BusDevice& device);
  void serve_usbip(firmware::BusDevice& device);

  std::unique_ptr<firmware::Waiter> waiter_;
  std::thread thread_;
};

}  // namespace limn::test
