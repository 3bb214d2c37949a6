#include "drivers/transport/usb_transport.hpp"

#include <libusb-1.0/libusb.h>
#include <sys/epoll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <utility>

#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/transport/file_handle.hpp"
#include "drivers/transport/node_error.hpp"
#include "drivers/transport/paced_reader.hpp"
#include "drivers/transport/usb_requests.hpp"

namespace limn {
namespace {

constexpr std::size_t kFlights = 32;
constexpr std::chrono::seconds kLongestGoodbye{1};
constexpr int kMostHalts = 3;                                   // in a row, without a report
constexpr Timestamp kLongestInHalts = std::chrono::seconds(6);  // over a stream's life
constexpr int kMostFailures = 1000;  // the same; a second's worth at full speed

/// A transfer ends with a short packet or when it is full, so its length is the longest report,
/// rounded up to whole packets: what is longer than a packet stays one report, and two that fill
/// their packets stay two. Tablets also send reports that they do not declare.
std::size_t transfer_bytes(std::span<const std::uint8_t> descriptor, std::size_t packet) {
  std::size_t longest = 1;
  if (const auto parsed = hid::parse_descriptor(descriptor)) {
    for (const hid::ReportShape& report : parsed->reports) {
      if (report.kind == hid::ReportKind::kInput) {
        longest = std::max<std::size_t>(longest, report.byte_length);
      }
    }
  }
  longest = std::min(longest, kMaxReportBytes);
  return (longest + packet - 1) / packet * packet;
}

}  // namespace

/// All of it but open_control(), callbacks included, runs in drain(): nobody else handles events of
/// its context.
class UsbTransport final : public Transport {
 public:
  explicit UsbTransport(std::unique_ptr<UsbInterface> interface)
      : interface_(std::move(interface)),
        requests_(std::make_shared<UsbRequests>(node(), interface_->usb_->handle())) {}
  UsbTransport(const UsbTransport&) = delete;
  UsbTransport& operator=(const UsbTransport&) = delete;

  ~UsbTransport() override {
    closing_ = true;
    for (Flight& flight : flights_) {
      if (flight.in_the_air) libusb_cancel_transfer(flight.transfer);
    }
    requests_->cancel();
    WaitingClock& clock = monotonic_clock();
    const Timestamp latest = clock.now() + kLongestGoodbye;
    while ((any_in_the_air() || requests_->any_in_the_air()) && clock.now() < latest) {
      timeval wait{0, 100'000};
      libusb_handle_events_timeout_completed(context(), &wait, nullptr);
    }
    libusb_set_pollfd_notifiers(context(), nullptr, nullptr, nullptr);
    interface_->close();  // ends those that would not end, too
    requests_->release();
    for (Flight& flight : flights_) libusb_free_transfer(flight.transfer);
  }

  Expected<void> start() {
    if (!epoll_) return node_error(node(), "polled", errno);
    libusb_set_pollfd_notifiers(context(), descriptor_came, descriptor_went, this);
    const libusb_pollfd** polled = libusb_get_pollfds(context());
    for (auto at = polled; at != nullptr && *at != nullptr; ++at) watch((*at)->fd, (*at)->events);
    libusb_free_pollfds(polled);
    if (watch_error_ != 0) return node_error(node(), "polled", watch_error_);
    const std::size_t size =
        transfer_bytes(interface_->device_.report_descriptor, interface_->packet_bytes_);
    for (Flight& flight : flights_) {
      flight.owner = this;
      flight.bytes.resize(size);
      flight.transfer = libusb_alloc_transfer(0);
      if (flight.transfer == nullptr) return node_error(node(), "read", ENOMEM);
      libusb_fill_interrupt_transfer(flight.transfer, interface_->usb_->handle(),
                                     interface_->endpoint_in_, flight.bytes.data(),
                                     static_cast<int>(size), landed, &flight, 0);
    }
    submit_all();
    if (gone_) return node_error(node(), "read", ENODEV);
    return {};
  }

  const TraceDevice& device() const noexcept override { return interface_->device_; }
  int poll_descriptor() const noexcept override { return epoll_.get(); }

  Expected<std::unique_ptr<DeviceControl>> open_control() const override {
    return control_by(requests_, interface_->number());
  }

  State drain(TransportSink& sink) noexcept override {
    if (gone_) return State::kGone;
    sink_ = &sink;
    landings_ = 0;
    timeval none{0, 0};
    libusb_handle_events_timeout_completed(context(), &none, nullptr);
    sink_ = nullptr;
    if (halted_ && !gone_) clear_halt();
    if (!gone_) submit_all();
    return gone_ ? State::kGone : State::kOpen;
  }

 private:
  /// One transfer and where its bytes go.
  struct Flight {
    UsbTransport* owner = nullptr;
    libusb_transfer* transfer = nullptr;
    bool in_the_air = false;
    std::vector<std::uint8_t> bytes;
  };

  libusb_context* context() const noexcept { return interface_->usb_->context(); }
  const std::string& node() const noexcept { return interface_->usb_->node(); }

  bool any_in_the_air() const noexcept {
    return std::any_of(flights_.begin(), flights_.end(),
                       [](const Flight& flight) { return flight.in_the_air; });
  }

  static void LIBUSB_CALL landed(libusb_transfer* transfer) {
    auto& flight = *static_cast<Flight*>(transfer->user_data);
    flight.in_the_air = false;
    flight.owner->take(flight);
  }

  void take(Flight& flight) noexcept {
    if (closing_ || sink_ == nullptr) return;
    switch (flight.transfer->status) {
      case LIBUSB_TRANSFER_COMPLETED: {
        const auto size = static_cast<std::size_t>(std::max(flight.transfer->actual_length, 0));
        if (size > 0) {
          sink_->report(monotonic_clock().now(),
                        {flight.bytes.data(), std::min(size, flight.bytes.size())});
          halts_ = 0;
        }
        failures_ = 0;
        break;
      }
      case LIBUSB_TRANSFER_STALL:
        halted_ = true;
        break;
      case LIBUSB_TRANSFER_NO_DEVICE:
        gone_ = true;
        break;
      case LIBUSB_TRANSFER_OVERFLOW:  // it sent more than it declares
        sink_->lost(1, false);
        fail_once();
        break;
      case LIBUSB_TRANSFER_ERROR:
      case LIBUSB_TRANSFER_TIMED_OUT:
      case LIBUSB_TRANSFER_CANCELLED:
        fail_once();
        break;
    }
    // A flood, of empty reports as well, waits for the next drain.
    if (++landings_ < kMostReports && !halted_ && !gone_) submit(flight);
  }

  void fail_once() noexcept { gone_ |= ++failures_ > kMostFailures; }

  void submit(Flight& flight) noexcept {
    const int code = libusb_submit_transfer(flight.transfer);
    flight.in_the_air = code == 0;
    if (code == LIBUSB_ERROR_NO_DEVICE) gone_ = true;
  }

  /// Some may find no room in the kernel; without any nothing would ever come again.
  void submit_all() noexcept {
    for (Flight& flight : flights_) {
      if (!flight.in_the_air && !gone_) submit(flight);
    }
    gone_ |= !any_in_the_air();
  }

  /// The request waits for the device, up to 5 s, and everybody with it: what a device may waste
  /// is bounded over its life.
  void clear_halt() noexcept {
    halted_ = false;
    const Timestamp begin = monotonic_clock().now();
    const bool cleared =
        libusb_clear_halt(interface_->usb_->handle(), interface_->endpoint_in_) == 0;
    in_halts_ += monotonic_clock().now() - begin;
    gone_ |= !cleared || ++halts_ > kMostHalts || in_halts_ > kLongestInHalts;
  }

  static void LIBUSB_CALL descriptor_came(int descriptor, short events, void* self) {
    static_cast<UsbTransport*>(self)->watch(descriptor, events);
  }
  static void LIBUSB_CALL descriptor_went(int descriptor, void* self) {
    ::epoll_ctl(static_cast<UsbTransport*>(self)->epoll_.get(), EPOLL_CTL_DEL, descriptor, nullptr);
  }

  void watch(int descriptor, short events) noexcept {
    epoll_event event{};
    event.events = static_cast<std::uint32_t>(events);  // the bits of poll are those of epoll
    if (::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, descriptor, &event) != 0) watch_error_ = errno;
  }

  FileHandle epoll_{::epoll_create1(EPOLL_CLOEXEC)};
  std::unique_ptr<UsbInterface> interface_;
  std::shared_ptr<UsbRequests> requests_;  // shared with the controls
  std::array<Flight, kFlights> flights_;
  TransportSink* sink_ = nullptr;  // during a drain
  int landings_ = 0;               // in this drain
  int failures_ = 0;
  int halts_ = 0;
  Timestamp in_halts_{};  // time that went into clearing them
  int watch_error_ = 0;   // errno
  bool halted_ = false;
  bool gone_ = false;
  bool closing_ = false;
};

Expected<std::unique_ptr<Transport>> open_usb(std::unique_ptr<UsbInterface> interface) {
  auto transport = std::make_unique<UsbTransport>(std::move(interface));
  if (auto started = transport->start(); !started) {
    return tl::unexpected(std::move(started.error()));
  }
  return transport;
}

}  // namespace limn
