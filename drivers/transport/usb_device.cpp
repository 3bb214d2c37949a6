#include "drivers/transport/usb_device.hpp"

#include <libusb-1.0/libusb.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "drivers/transport/node_error.hpp"

namespace limn {
namespace {

/// Bus and address.
using UsbPlace = std::pair<unsigned, unsigned>;

std::optional<UsbPlace> place_of(std::string_view node) {
  constexpr std::string_view kFolder = "/dev/bus/usb/";
  if (!node.starts_with(kFolder)) return std::nullopt;
  node.remove_prefix(kFolder.size());
  const char* const end = node.data() + node.size();
  UsbPlace place;
  const auto bus = std::from_chars(node.data(), end, place.first);
  if (bus.ec != std::errc() || bus.ptr == end || *bus.ptr != '/') return std::nullopt;
  const auto address = std::from_chars(bus.ptr + 1, end, place.second);
  if (address.ec != std::errc() || address.ptr != end) return std::nullopt;
  return place;
}

/// The errno that says the same.
int errno_of(int code) noexcept {
  switch (code) {
    case LIBUSB_ERROR_ACCESS:
      return EACCES;
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return ENODEV;
    case LIBUSB_ERROR_BUSY:
      return EBUSY;
    case LIBUSB_ERROR_TIMEOUT:
      return ETIMEDOUT;
    case LIBUSB_ERROR_PIPE:
      return EPIPE;
    case LIBUSB_ERROR_NO_MEM:
      return ENOMEM;
    default:
      return EIO;
  }
}

constexpr unsigned kTimeoutMs = static_cast<unsigned>(kRequestTimeout.count());

}  // namespace

Expected<std::unique_ptr<UsbDevice>> UsbDevice::open(const std::string& node) {
  const auto place = place_of(node);
  if (!place) {
    return fail(ErrorCode::kSyntax, node, "is no node of a USB device",
                "give one like /dev/bus/usb/001/004");
  }
  std::unique_ptr<UsbDevice> opened(new UsbDevice());
  opened->node_ = node;
  if (const int code = libusb_init(&opened->context_); code != 0) {
    return fail(ErrorCode::kIo, node,
                std::string("libusb does not start: ") + libusb_error_name(code),
                "check that udev runs here, or read the device by hidraw");
  }
  libusb_device** devices = nullptr;
  const auto count = libusb_get_device_list(opened->context_, &devices);
  if (count < 0) return opened->error("listed by libusb", static_cast<int>(count));
  libusb_device** const end = devices + count;
  libusb_device** const found = std::find_if(devices, end, [&place](libusb_device* one) {
    return libusb_get_bus_number(one) == place->first &&
           libusb_get_device_address(one) == place->second;
  });
  const int code =
      found == end ? int{LIBUSB_ERROR_NO_DEVICE} : libusb_open(*found, &opened->handle_);
  libusb_free_device_list(devices, 1);
  if (code != 0) return opened->error("opened", code);
  return opened;
}

UsbDevice::~UsbDevice() {
  close();
  if (context_ != nullptr) libusb_exit(context_);
}

void UsbDevice::close() noexcept {
  if (handle_ != nullptr) libusb_close(handle_);
  handle_ = nullptr;
}

tl::unexpected<Error> UsbDevice::error(const std::string& node, const std::string& doing,
                                       int code) {
  return node_error(node, doing, errno_of(code));
}

Expected<std::vector<std::uint8_t>> UsbDevice::answer(const std::string& node,
                                                      std::vector<std::uint8_t> bytes, int size,
                                                      Silence silence) {
  const bool unanswered = size < 0 && size != LIBUSB_ERROR_NO_DEVICE && size != LIBUSB_ERROR_ACCESS;
  if (size < 0 && !(unanswered && silence == Silence::kIsAnAnswer)) {
    return error(node, "asked", size);
  }
  bytes.resize(std::min(bytes.size(), static_cast<std::size_t>(std::max(size, 0))));
  return bytes;
}

Expected<void> UsbDevice::written(const std::string& node, std::uint8_t endpoint, std::size_t bytes,
                                  int size) {
  if (size < 0) return error(node, "written to at endpoint " + std::to_string(endpoint), size);
  if (static_cast<std::size_t>(size) != bytes)
    return node_error(node, "written to as a whole", EIO);
  return {};
}

Expected<std::vector<std::uint8_t>> UsbDevice::read(const ControlRequest& request,
                                                    std::uint16_t length, Silence silence) {
  std::vector<std::uint8_t> bytes(length);
  const int size = libusb_control_transfer(handle_, request.type, request.request, request.value,
                                           request.index, bytes.data(), length, kTimeoutMs);
  return answer(node_, std::move(bytes), size, silence);
}

Expected<void> UsbDevice::write(const ControlRequest& request,
                                std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> sent(bytes.begin(), bytes.end());  // libusb takes no constant bytes
  const int size =
      libusb_control_transfer(handle_, request.type, request.request, request.value, request.index,
                              sent.data(), static_cast<std::uint16_t>(sent.size()), kTimeoutMs);
  if (size < 0) return error("told", size);
  return {};
}

Expected<std::vector<std::uint8_t>> UsbDevice::read_string(std::uint8_t index,
                                                           std::uint16_t language,
                                                           std::uint16_t length) {
  return read(string_request(index, language), length, Silence::kIsAnAnswer);
}

}  // namespace limn
