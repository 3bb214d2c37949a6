#include <libusb-1.0/libusb.h>

#include <string>
#include <utility>

#include "drivers/transport/usb_transport.hpp"

namespace limn {
namespace {

constexpr std::size_t kMostReportDescriptor = 4096;  // Linux takes no more
constexpr std::uint8_t kHidDescriptor = 0x21;
constexpr std::uint16_t kReportDescriptor = 0x22;
constexpr std::uint8_t kGetDescriptor = 6;
// bmRequestType: direction, type and recipient (USB 2.0, 9.3).
constexpr std::uint8_t kFromInterface = 0x81;

/// wDescriptorLength of the report descriptor that a HID descriptor (HID 1.11, 6.2.1) announces
/// first; 0 where `extra`, the descriptors behind the interface's, holds none.
std::size_t announced_descriptor(std::span<const std::uint8_t> extra) {
  while (extra.size() >= 2 && extra[0] >= 2 && extra[0] <= extra.size()) {
    if (extra[1] == kHidDescriptor && extra[0] >= 9 && extra[6] == kReportDescriptor) {
      return static_cast<std::size_t>(extra[7] | extra[8] << 8);
    }
    extra = extra.subspan(extra[0]);
  }
  return 0;
}

/// Bytes of a packet: high-speed endpoints send up to three a microframe (USB 2.0, 9.6.6).
std::size_t packet_bytes(std::uint16_t max_packet_size) {
  return (max_packet_size & 0x7FFU) * (1U + (max_packet_size >> 11 & 3U));
}

}  // namespace

Expected<std::unique_ptr<UsbInterface>> UsbInterface::claim(const ListedDevice& listed) {
  auto usb = UsbDevice::open(listed.node);
  if (!usb) return tl::unexpected(std::move(usb.error()));
  const auto number = static_cast<std::uint8_t>(listed.interface_number);
  std::unique_ptr<UsbInterface> interface(new UsbInterface(*std::move(usb), number));
  interface->device_ = listed.device;
  for (auto step : {&UsbInterface::find_endpoint, &UsbInterface::claim_it,
                    &UsbInterface::read_report_descriptor}) {
    if (auto done = (interface.get()->*step)(); !done) {
      return tl::unexpected(std::move(done.error()));
    }
  }
  return interface;
}

Expected<void> UsbInterface::find_endpoint() {
  libusb_config_descriptor* config = nullptr;
  const int code = libusb_get_active_config_descriptor(libusb_get_device(usb_->handle()), &config);
  if (code != 0) return usb_->error("asked for its configuration", code);
  for (int i = 0; i < config->bNumInterfaces; ++i) {
    const libusb_interface& one = config->interface[i];
    if (one.num_altsetting < 1 || one.altsetting[0].bInterfaceNumber != number()) continue;
    const libusb_interface_descriptor& setting = one.altsetting[0];
    if (setting.extra_length > 0) {
      descriptor_bytes_ =
          announced_descriptor({setting.extra, static_cast<std::size_t>(setting.extra_length)});
    }
    for (int k = 0; k < setting.bNumEndpoints && endpoint_in_ == 0; ++k) {
      const libusb_endpoint_descriptor& endpoint = setting.endpoint[k];
      const bool in = (endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0;
      const bool interrupt = (endpoint.bmAttributes & 3) == LIBUSB_TRANSFER_TYPE_INTERRUPT;
      if (!in || !interrupt) continue;
      endpoint_in_ = endpoint.bEndpointAddress;
      packet_bytes_ = packet_bytes(endpoint.wMaxPacketSize);
    }
  }
  libusb_free_config_descriptor(config);
  if (endpoint_in_ == 0 || packet_bytes_ == 0) {
    return fail(ErrorCode::kIo, usb_->node(),
                "interface " + std::to_string(number()) + " sends no reports",
                "give one that 'limn devices' names");
  }
  if (descriptor_bytes_ > kMostReportDescriptor) {
    return fail(
        ErrorCode::kLimit, usb_->node(),
        "a report descriptor of " + std::to_string(descriptor_bytes_) + " bytes is above 4 KiB",
        "this is no device that Linux supports");
  }
  return {};
}

Expected<void> UsbInterface::claim_it() {
  // Linux's driver goes, and comes back when the interface is released.
  libusb_set_auto_detach_kernel_driver(usb_->handle(), 1);
  int code = libusb_claim_interface(usb_->handle(), number());
  if (code != 0 && code != LIBUSB_ERROR_BUSY && code != LIBUSB_ERROR_NO_DEVICE) {
    // Where drivers cannot be detached, there may be none.
    libusb_set_auto_detach_kernel_driver(usb_->handle(), 0);
    code = libusb_claim_interface(usb_->handle(), number());
  }
  if (code != 0) {
    return usb_->error("claimed at interface " + std::to_string(number()), code);
  }
  claimed_ = true;
  return {};
}

/// A device that keeps its descriptor to itself may still have a row in the tables.
Expected<void> UsbInterface::read_report_descriptor() {
  if (descriptor_bytes_ == 0) return {};
  auto answer =
      read({kFromInterface, kGetDescriptor, kReportDescriptor << 8, number()},
           static_cast<std::uint16_t>(descriptor_bytes_), UsbDevice::Silence::kIsAnAnswer);
  if (!answer) return tl::unexpected(std::move(answer.error()));
  if (!answer->empty()) device_.report_descriptor = *std::move(answer);
  return {};
}

UsbInterface::~UsbInterface() { close(); }

void UsbInterface::close() noexcept {
  if (claimed_) libusb_release_interface(usb_->handle(), number());
  claimed_ = false;
  usb_->close();
}

Expected<std::vector<std::uint8_t>> UsbInterface::read(const ControlRequest& request,
                                                       std::uint16_t length,
                                                       UsbDevice::Silence silence) {
  return usb_->read(request, length, silence);
}

Expected<void> UsbInterface::write(const ControlRequest& request,
                                   std::span<const std::uint8_t> bytes) {
  return usb_->write(request, bytes);
}

Expected<void> UsbInterface::write_interrupt(std::uint8_t endpoint,
                                             std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> sent(bytes.begin(), bytes.end());  // libusb takes no constant bytes
  int written = 0;
  const int code = libusb_interrupt_transfer(usb_->handle(), endpoint, sent.data(),
                                             static_cast<int>(sent.size()), &written,
                                             static_cast<unsigned>(kRequestTimeout.count()));
  return UsbDevice::written(usb_->node(), endpoint, sent.size(), code == 0 ? written : code);
}

}  // namespace limn
