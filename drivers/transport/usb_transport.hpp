#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "drivers/transport/device_listing.hpp"
#include "drivers/transport/transport.hpp"
#include "drivers/transport/usb_control.hpp"
#include "drivers/transport/usb_device.hpp"
#include "input/base/error.hpp"

namespace limn {

/// An interface of a USB device that limn has for itself, before its stream is read. While this (or
/// the stream) lives, Linux's driver is away and its nodes are gone; then it comes back.
class UsbInterface final : public UsbControl {
 public:
  /// `listed`: a row of list_usb_devices(); its node and interface_number say which. The report
  /// descriptor is asked of the device itself. Errors: kIo: it is gone, no permission, a program
  /// has the interface, or it is none that sends reports; kLimit: a report descriptor above 4 KiB;
  /// kMissing in a build without libusb.
  static Expected<std::unique_ptr<UsbInterface>> claim(const ListedDevice& listed);

  ~UsbInterface() override;

  Expected<void> write_interrupt(std::uint8_t endpoint,
                                 std::span<const std::uint8_t> bytes) override;

 private:
  friend class UsbTransport;

  UsbInterface(std::unique_ptr<UsbDevice> usb, std::uint8_t number)
      : UsbControl(number), usb_(std::move(usb)) {}
  Expected<std::vector<std::uint8_t>> read(const ControlRequest& request, std::uint16_t length,
                                           UsbDevice::Silence silence) override;
  Expected<void> write(const ControlRequest& request, std::span<const std::uint8_t> bytes) override;
  Expected<void> find_endpoint();
  Expected<void> claim_it();
  Expected<void> read_report_descriptor();
  void close() noexcept;

  std::unique_ptr<UsbDevice> usb_;
  TraceDevice device_;
  std::uint8_t endpoint_in_ = 0;      // with the direction bit
  std::size_t packet_bytes_ = 0;      // of that endpoint
  std::size_t descriptor_bytes_ = 0;  // of reports, as the interface declares it; 0: it does not
  bool claimed_ = false;
};

/// Reads the interface's reports, whole, stamped when libusb has them. 32 transfers wait at a time,
/// so that a burst finds room while limn is elsewhere. A stalled endpoint is cleared (which takes
/// Linux up to 5 s where the device is dead); a device that only ever stalls or fails counts as
/// gone. libusb itself allocates for each transfer that it submits.
/// Errors: kIo: the system refuses a descriptor or the first transfer.
Expected<std::unique_ptr<Transport>> open_usb(std::unique_ptr<UsbInterface> interface);

}  // namespace limn
