#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "drivers/transport/control_request.hpp"
#include "drivers/transport/device_control.hpp"
#include "drivers/transport/usb_device.hpp"
#include "input/base/error.hpp"

namespace limn {

/// What is asked of an interface of a USB device, as control transfers. Who makes them, and in
/// which thread, is for those to say who derive from this.
class UsbControl : public DeviceControl {
 public:
  Expected<std::vector<std::uint8_t>> read_string(std::uint8_t index, std::uint16_t language,
                                                  std::uint16_t length) final;
  Expected<void> set_output(std::span<const std::uint8_t> bytes) final;
  Expected<void> set_feature(std::span<const std::uint8_t> bytes) final;
  Expected<std::vector<std::uint8_t>> get_feature(std::uint8_t id, std::size_t length) final;

 protected:
  /// The interface's number.
  explicit UsbControl(std::uint8_t number) : number_(number) {}

  std::uint8_t number() const noexcept { return number_; }

 private:
  /// As UsbDevice::read() and write().
  virtual Expected<std::vector<std::uint8_t>> read(const ControlRequest& request,
                                                   std::uint16_t length,
                                                   UsbDevice::Silence silence) = 0;
  virtual Expected<void> write(const ControlRequest& request,
                               std::span<const std::uint8_t> bytes) = 0;

  std::uint8_t number_;
};

}  // namespace limn
