#include "drivers/transport/usb_requests.hpp"

#include <libusb-1.0/libusb.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "drivers/transport/usb_control.hpp"
#include "drivers/transport/usb_device.hpp"

namespace limn {
namespace {

constexpr unsigned kTimeoutMs = static_cast<unsigned>(kRequestTimeout.count());
/// libusb ends a request in time where its events are handled.
constexpr std::chrono::milliseconds kLongestWait = kRequestTimeout + std::chrono::milliseconds(500);

/// What libusb's synchronous transfers give.
int result_of(const libusb_transfer& transfer) noexcept {
  switch (transfer.status) {
    case LIBUSB_TRANSFER_COMPLETED:
      return transfer.actual_length;
    case LIBUSB_TRANSFER_TIMED_OUT:
      return LIBUSB_ERROR_TIMEOUT;
    case LIBUSB_TRANSFER_STALL:
      return LIBUSB_ERROR_PIPE;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return LIBUSB_ERROR_NO_DEVICE;
    case LIBUSB_TRANSFER_OVERFLOW:
      return LIBUSB_ERROR_OVERFLOW;
    case LIBUSB_TRANSFER_ERROR:
    case LIBUSB_TRANSFER_CANCELLED:
      break;
  }
  return LIBUSB_ERROR_IO;
}

class StreamedControl final : public UsbControl {
 public:
  StreamedControl(std::shared_ptr<UsbRequests> requests, std::uint8_t number)
      : UsbControl(number), requests_(std::move(requests)) {}

  Expected<void> write_interrupt(std::uint8_t endpoint,
                                 std::span<const std::uint8_t> bytes) override {
    std::vector<std::uint8_t> sent(bytes.begin(), bytes.end());  // libusb takes no constant bytes
    const auto size = requests_->interrupt(endpoint, sent);
    if (!size) return tl::unexpected(size.error());
    return UsbDevice::written(requests_->node(), endpoint, sent.size(), *size);
  }

 private:
  Expected<std::vector<std::uint8_t>> read(const ControlRequest& request, std::uint16_t length,
                                           UsbDevice::Silence silence) override {
    std::vector<std::uint8_t> bytes(length);
    const auto size = requests_->control(request, bytes);
    if (!size) return tl::unexpected(size.error());
    return UsbDevice::answer(requests_->node(), std::move(bytes), *size, silence);
  }

  Expected<void> write(const ControlRequest& request,
                       std::span<const std::uint8_t> bytes) override {
    std::vector<std::uint8_t> sent(bytes.begin(), bytes.end());
    const auto size = requests_->control(request, sent);
    if (!size) return tl::unexpected(size.error());
    if (*size < 0) return UsbDevice::error(requests_->node(), "told", *size);
    return {};
  }

  std::shared_ptr<UsbRequests> requests_;
};

}  // namespace

/// A transfer, its bytes (a setup packet ahead where it has one) and what it came to. Whoever waits
/// for it and the list of those in the air hold it: the last of them frees it.
struct UsbRequests::Flight {
  Flight(UsbRequests& requests, std::size_t size) : owner(requests), bytes(size) {}
  Flight(const Flight&) = delete;
  Flight& operator=(const Flight&) = delete;
  ~Flight() { libusb_free_transfer(transfer); }

  static void LIBUSB_CALL landed(libusb_transfer* transfer) {
    auto& flight = *static_cast<Flight*>(transfer->user_data);
    flight.owner.land(flight);
  }

  UsbRequests& owner;
  std::vector<std::uint8_t> bytes;
  libusb_transfer* transfer = libusb_alloc_transfer(0);
  std::optional<int> result;  // when it has landed
};

UsbRequests::UsbRequests(std::string node, libusb_device_handle* handle)
    : node_(std::move(node)), handle_(handle) {}

UsbRequests::~UsbRequests() = default;

Expected<int> UsbRequests::control(const ControlRequest& request, std::span<std::uint8_t> data) {
  const auto flight = std::make_shared<Flight>(*this, LIBUSB_CONTROL_SETUP_SIZE + data.size());
  if (flight->transfer == nullptr) return LIBUSB_ERROR_NO_MEM;
  libusb_fill_control_setup(flight->bytes.data(), request.type, request.request, request.value,
                            request.index, static_cast<std::uint16_t>(data.size()));
  std::copy(data.begin(), data.end(), flight->bytes.begin() + LIBUSB_CONTROL_SETUP_SIZE);
  libusb_fill_control_transfer(flight->transfer, nullptr, flight->bytes.data(), Flight::landed,
                               flight.get(), kTimeoutMs);
  auto size = fly(flight);
  // What has not landed may still be written to.
  if (size && *size > 0) {
    std::copy_n(flight->bytes.begin() + LIBUSB_CONTROL_SETUP_SIZE,
                std::min(data.size(), static_cast<std::size_t>(*size)), data.begin());
  }
  return size;
}

Expected<int> UsbRequests::interrupt(std::uint8_t endpoint, std::span<std::uint8_t> data) {
  const auto flight = std::make_shared<Flight>(*this, data.size());
  if (flight->transfer == nullptr) return LIBUSB_ERROR_NO_MEM;
  std::copy(data.begin(), data.end(), flight->bytes.begin());
  libusb_fill_interrupt_transfer(flight->transfer, nullptr, endpoint, flight->bytes.data(),
                                 static_cast<int>(data.size()), Flight::landed, flight.get(),
                                 kTimeoutMs);
  return fly(flight);
}

Expected<int> UsbRequests::fly(const std::shared_ptr<Flight>& flight) {
  std::unique_lock lock(mutex_);
  if (handle_ == nullptr) return LIBUSB_ERROR_NO_DEVICE;
  flight->transfer->dev_handle = handle_;
  in_the_air_.push_back(flight);
  if (const int code = libusb_submit_transfer(flight->transfer); code != 0) {
    in_the_air_.pop_back();
    return code;
  }
  changed_.wait_for(lock, kLongestWait, [&] { return flight->result || handle_ == nullptr; });
  if (flight->result) return *flight->result;
  if (handle_ == nullptr) return LIBUSB_ERROR_NO_DEVICE;
  libusb_cancel_transfer(flight->transfer);  // it lands when somebody reads again
  return fail(ErrorCode::kIo, node_, "gives no answer while nobody reads its stream",
              "read it in another thread while it is asked");
}

void UsbRequests::land(Flight& flight) noexcept {
  const std::lock_guard lock(mutex_);
  flight.result = result_of(*flight.transfer);
  std::erase_if(in_the_air_, [&flight](const auto& one) { return one.get() == &flight; });
  changed_.notify_all();
}

void UsbRequests::cancel() noexcept {
  const std::lock_guard lock(mutex_);
  handle_ = nullptr;
  for (const auto& flight : in_the_air_) libusb_cancel_transfer(flight->transfer);
  changed_.notify_all();
}

bool UsbRequests::any_in_the_air() const noexcept {
  const std::lock_guard lock(mutex_);
  return !in_the_air_.empty();
}

void UsbRequests::release() noexcept {
  const std::lock_guard lock(mutex_);
  in_the_air_.clear();
}

std::unique_ptr<DeviceControl> control_by(std::shared_ptr<UsbRequests> requests,
                                          std::uint8_t number) {
  return std::make_unique<StreamedControl>(std::move(requests), number);
}

}  // namespace limn
