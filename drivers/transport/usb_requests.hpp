#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "drivers/transport/control_request.hpp"
#include "drivers/transport/device_control.hpp"
#include "input/base/error.hpp"

struct libusb_device_handle;

namespace limn {

/// Requests to a USB device whose stream another thread reads. They are submitted in the asking
/// thread and land in the reading one, which alone handles libusb's events: a synchronous request
/// would handle those of the stream, too, where nobody takes its reports.
class UsbRequests {
 public:
  UsbRequests(std::string node, libusb_device_handle* handle);
  ~UsbRequests();
  UsbRequests(const UsbRequests&) = delete;
  UsbRequests& operator=(const UsbRequests&) = delete;

  const std::string& node() const noexcept { return node_; }

  /// A control transfer, by its direction into `data` or out of it; or what is in `data` to an
  /// interrupt-out endpoint. From any thread but the reading one. The bytes that moved, or one of
  /// libusb's codes. Error: kIo: nobody reads the stream for longer than a request may take.
  Expected<int> control(const ControlRequest& request, std::span<std::uint8_t> data);
  Expected<int> interrupt(std::uint8_t endpoint, std::span<std::uint8_t> data);

  /// The device counts as gone from now on, also for those who wait. What is in the air lands soon,
  /// if events are handled; what does not is released when the handle is closed.
  void cancel() noexcept;
  bool any_in_the_air() const noexcept;
  void release() noexcept;

 private:
  struct Flight;

  Expected<int> fly(const std::shared_ptr<Flight>& flight);
  void land(Flight& flight) noexcept;

  std::string node_;
  mutable std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  libusb_device_handle* handle_;  // nothing: cancelled
  std::vector<std::shared_ptr<Flight>> in_the_air_;
};

/// The control of interface `number` by such requests, which may outlive the stream.
std::unique_ptr<DeviceControl> control_by(std::shared_ptr<UsbRequests> requests,
                                          std::uint8_t number);

}  // namespace limn
