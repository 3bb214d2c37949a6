// For builds without libusb: hidraw works, but what needs the USB device itself does not.

#include "drivers/transport/usb_transport.hpp"

namespace limn {
namespace {

tl::unexpected<Error> absent(const std::string& node) {
  return fail(ErrorCode::kMissing, node, "this build has no libusb, which asks USB devices",
              "build limn where libusb-1.0-0-dev is installed");
}

}  // namespace

Expected<std::unique_ptr<UsbDevice>> UsbDevice::open(const std::string& node) {
  return absent(node);
}
UsbDevice::~UsbDevice() = default;
Expected<std::vector<std::uint8_t>> UsbDevice::read_string(std::uint8_t, std::uint16_t,
                                                           std::uint16_t) {
  return absent(node_);
}

Expected<std::unique_ptr<UsbInterface>> UsbInterface::claim(const ListedDevice& listed) {
  return absent(listed.node);
}
UsbInterface::~UsbInterface() = default;
Expected<std::vector<std::uint8_t>> UsbInterface::read(const ControlRequest&, std::uint16_t,
                                                       UsbDevice::Silence) {
  return absent(usb_->node());
}
Expected<void> UsbInterface::write(const ControlRequest&, std::span<const std::uint8_t>) {
  return absent(usb_->node());
}
Expected<void> UsbInterface::write_interrupt(std::uint8_t, std::span<const std::uint8_t>) {
  return absent(usb_->node());
}

Expected<std::unique_ptr<Transport>> open_usb(std::unique_ptr<UsbInterface>) { return absent(""); }

}  // namespace limn
