#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/transport/control_request.hpp"
#include "drivers/transport/device_control.hpp"
#include "input/base/error.hpp"

struct libusb_context;
struct libusb_device_handle;

namespace limn {

/// A USB device, opened by libusb; nothing of it is claimed, so Linux's drivers keep it. Requests
/// to the device as a whole disturb nobody; those to an interface need it claimed.
class UsbDevice {
 public:
  /// `node`: "/dev/bus/usb/001/004". Errors: kIo: no such device, no permission; kSyntax: no such
  /// name; kMissing in a build without libusb.
  static Expected<std::unique_ptr<UsbDevice>> open(const std::string& node);

  ~UsbDevice();
  UsbDevice(const UsbDevice&) = delete;
  UsbDevice& operator=(const UsbDevice&) = delete;

  const std::string& node() const noexcept { return node_; }
  libusb_context* context() const noexcept { return context_; }
  libusb_device_handle* handle() const noexcept { return handle_; }

  /// Whether a stall, a timeout or a disturbed transfer is an error or an empty answer.
  enum class Silence { kIsAnError, kIsAnAnswer };

  /// What the device sends back, at most `length` bytes; the direction bit of `request` must fit
  /// read() or write().
  Expected<std::vector<std::uint8_t>> read(const ControlRequest& request, std::uint16_t length,
                                           Silence silence);

  Expected<void> write(const ControlRequest& request, std::span<const std::uint8_t> bytes);

  /// As DeviceControl::read_string.
  Expected<std::vector<std::uint8_t>> read_string(std::uint8_t index, std::uint16_t language,
                                                  std::uint16_t length);

  /// The error for one of libusb's codes. `doing` as of node_error().
  tl::unexpected<Error> error(const std::string& doing, int code) const {
    return error(node_, doing, code);
  }
  static tl::unexpected<Error> error(const std::string& node, const std::string& doing, int code);

  /// What a transfer has read into `bytes`; `size`: so many of them, or one of libusb's codes.
  static Expected<std::vector<std::uint8_t>> answer(const std::string& node,
                                                    std::vector<std::uint8_t> bytes, int size,
                                                    Silence silence);

  /// Of `bytes` written to an interrupt-out endpoint; `size` as above.
  static Expected<void> written(const std::string& node, std::uint8_t endpoint, std::size_t bytes,
                                int size);

  /// Closes the handle: transfers under way end, and the system has the device back.
  void close() noexcept;

 private:
  UsbDevice() = default;

  std::string node_;
  libusb_context* context_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
};

}  // namespace limn
