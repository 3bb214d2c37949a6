#include "firmware_sim/link/usbip_session.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "firmware_sim/link/frames.hpp"
#include "firmware_sim/link/standard_requests.hpp"

namespace limn::firmware {
namespace {

using std::chrono::microseconds;
using usbip::OperationStatus;

constexpr std::uint32_t kNoPackets = 0xFFFFFFFF;
constexpr std::uint32_t kMostEndpoint = 15;

/// By number, those to the host behind the others.
constexpr std::size_t place(std::uint8_t endpoint) {
  return (endpoint & 0x0FU) + ((endpoint & kToHost) != 0 ? 16U : 0U);
}

tl::unexpected<LinkError> malformed(std::string what) {
  return link_fail(std::move(what), "use a client that speaks USB/IP 1.1.1");
}

std::string hex(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%04x", value);
  return text;
}

std::string_view bus_id(std::span<const std::uint8_t> bytes) {
  const auto end = std::find(bytes.begin(), bytes.end(), std::uint8_t{0});
  return {reinterpret_cast<const char*>(bytes.data()),
          static_cast<std::size_t>(end - bytes.begin())};
}

}  // namespace

UsbipSession::UsbipSession(UsbipExport& exported)
    : exported_(exported), transfer_(kMostTransferBytes) {}

UsbipSession::~UsbipSession() {
  if (imported()) exported_.user = nullptr;
}

LinkResult<void> UsbipSession::receive(std::span<const std::uint8_t> bytes, microseconds now) {
  input_.insert(input_.end(), bytes.begin(), bytes.end());
  std::size_t taken = 0;
  while (takes_input()) {
    const auto packet = take_packet(std::span(input_).subspan(taken), now);
    if (!packet) return tl::unexpected(packet.error());
    if (*packet == 0) break;
    taken += *packet;
  }
  input_.erase(input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(taken));
  return {};
}

LinkResult<std::size_t> UsbipSession::take_packet(std::span<const std::uint8_t> bytes,
                                                  microseconds now) {
  return imported() ? take_urb(bytes, now) : take_operation(bytes, now);
}

LinkResult<std::size_t> UsbipSession::take_operation(std::span<const std::uint8_t> bytes,
                                                     microseconds now) {
  if (bytes.size() < usbip::kOperationBytes) return 0;
  const auto header = usbip::read_operation(bytes.first<usbip::kOperationBytes>());
  if (header.version != usbip::kVersion) {
    return malformed("a client speaks version " + hex(header.version) + " of USB/IP");
  }
  const DeviceSpec& spec = exported_.device.spec();
  if (header.code == static_cast<std::uint16_t>(usbip::Operation::kRequestList)) {
    const bool there = exported_.device.plugged(now);
    usbip::append_operation(output_, usbip::Operation::kReplyList, OperationStatus::kDone);
    usbip::append_number(output_, std::uint32_t{there ? 1U : 0U});
    if (there) {
      usbip::append_device(output_, spec);
      usbip::append_interfaces(output_, spec);
    }
    done_ = true;
    return usbip::kOperationBytes;
  }
  if (header.code != static_cast<std::uint16_t>(usbip::Operation::kRequestImport)) {
    return malformed("a client asks for operation " + hex(header.code) +
                     ", which is none of USB/IP");
  }
  constexpr std::size_t kBytes = usbip::kOperationBytes + usbip::kBusIdBytes;
  if (bytes.size() < kBytes) return 0;
  OperationStatus status = OperationStatus::kDone;
  if (bus_id(bytes.subspan(usbip::kOperationBytes, usbip::kBusIdBytes)) != usbip::kBusId ||
      !exported_.device.plugged(now)) {
    status = OperationStatus::kNoDevice;
  } else if (exported_.user != nullptr) {
    status = OperationStatus::kBusy;
  }
  usbip::append_operation(output_, usbip::Operation::kReplyImport, status);
  if (status == OperationStatus::kDone) {
    usbip::append_device(output_, spec);
    import(now);
  } else {
    done_ = true;
  }
  return kBytes;
}

void UsbipSession::import(microseconds now) {
  exported_.user = this;
  // A client never gives an address: its side of the bus is virtual.
  exported_.device.reset();
  exported_.device.control(set_address(usbip::kDeviceNumber), now, {});
}

LinkResult<std::size_t> UsbipSession::take_urb(std::span<const std::uint8_t> bytes,
                                               microseconds now) {
  if (bytes.size() < usbip::kUrbBytes) return 0;
  const auto urb = usbip::read_urb(bytes.first<usbip::kUrbBytes>());
  if (urb.command == static_cast<std::uint32_t>(usbip::Command::kUnlink)) {
    unlink(urb);
    return usbip::kUrbBytes;
  }
  if (urb.command != static_cast<std::uint32_t>(usbip::Command::kSubmit)) {
    return malformed("a client gives command " + hex(urb.command) + ", which is none of USB/IP");
  }
  if (urb.direction > 1 || urb.endpoint > kMostEndpoint) {
    return malformed("a client submits to endpoint " + std::to_string(urb.endpoint) +
                     ", direction " + std::to_string(urb.direction));
  }
  if (urb.packets != 0 && urb.packets != kNoPackets) {
    return malformed("a client submits an isochronous transfer, which no HID device has");
  }
  if (urb.length > kMostTransferBytes) {
    return malformed("a client submits a transfer of " + std::to_string(urb.length) +
                     " bytes, more than 65536");
  }
  const std::size_t data = urb.direction == 0 ? urb.length : 0;
  if (bytes.size() < usbip::kUrbBytes + data) return 0;
  if (auto done = submit(urb, bytes.subspan(usbip::kUrbBytes, data), now); !done) {
    return tl::unexpected(std::move(done.error()));
  }
  return usbip::kUrbBytes + data;
}

LinkResult<void> UsbipSession::submit(const usbip::UrbHeader& urb,
                                      std::span<const std::uint8_t> data, microseconds now) {
  if (urb.endpoint == 0) return control(urb, data, now);
  Waiting waiting;
  waiting.sequence = urb.sequence;
  waiting.endpoint = static_cast<std::uint8_t>(urb.endpoint | (urb.direction == 1 ? kToHost : 0U));
  waiting.length = urb.length;
  waiting.data.assign(data.begin(), data.end());
  auto done = wait(std::move(waiting));
  if (done) advance(now);
  return done;
}

LinkResult<void> UsbipSession::control(const usbip::UrbHeader& urb,
                                       std::span<const std::uint8_t> data, microseconds now) {
  const SetupPacket& setup = urb.setup;
  const bool to_host = (setup.request_type & kToHost) != 0;
  // Without data there is no direction to disagree on.
  if (setup.length > 0 && to_host != (urb.direction == 1)) {
    return malformed("a client's setup packet contradicts the direction of its transfer");
  }
  if (!to_host && setup.length > data.size()) {
    return malformed("a client's setup packet says " + std::to_string(setup.length) +
                     " bytes, and " + std::to_string(data.size()) + " follow");
  }
  end_silence(now);
  std::fill_n(transfer_.begin(), setup.length, std::uint8_t{0});
  if (!to_host) std::copy_n(data.begin(), setup.length, transfer_.begin());
  const TransferResult result =
      exported_.device.control(setup, now, std::span(transfer_).first(setup.length));
  if (result.status == TransferStatus::kNak) return wait({urb.sequence, 0, 0, {}});
  if (result.status != TransferStatus::kDone) {
    usbip::append_returned_submit(
        output_, urb.sequence,
        result.status == TransferStatus::kStall ? usbip::kStallStatus : usbip::kNoDeviceStatus, 0,
        {});
    return {};
  }
  const std::size_t answered =
      to_host ? std::min<std::size_t>({result.bytes, setup.length, urb.length}) : 0;
  usbip::append_returned_submit(output_, urb.sequence, 0,
                                to_host ? static_cast<std::uint32_t>(answered) : setup.length,
                                std::span(transfer_).first(answered));
  return {};
}

LinkResult<void> UsbipSession::wait(Waiting waiting) {
  if (waiting_.size() >= kMostWaiting || waiting_bytes_ + waiting.data.size() > kMostWaitingBytes) {
    return link_fail("a client submits more than " + std::to_string(kMostWaiting) +
                         " transfers, or 256 kB, before it takes an answer",
                     "let it wait for answers");
  }
  waiting_bytes_ += waiting.data.size();
  waiting_.push_back(std::move(waiting));
  return {};
}

void UsbipSession::unlink(const usbip::UrbHeader& urb) {
  const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&urb](const Waiting& one) {
    return one.sequence == urb.unlinked;
  });
  const bool waited = found != waiting_.end();
  if (waited) {
    waiting_bytes_ -= found->data.size();
    waiting_.erase(found);
  }
  usbip::append_returned_unlink(output_, urb.sequence, waited ? usbip::kUnlinkedStatus : 0);
}

void UsbipSession::advance(microseconds now) {
  for (auto one = waiting_.begin(); one != waiting_.end();) {
    // A client that does not read: its device keeps its reports, as long as it can.
    if (pending_output() >= kMostOutput) return;
    if (one->endpoint == 0 || next_polls_[place(one->endpoint)] > now || !poll(*one, now)) {
      ++one;
      continue;
    }
    waiting_bytes_ -= one->data.size();
    one = waiting_.erase(one);
  }
}

bool UsbipSession::poll(const Waiting& waiting, microseconds now) {
  BusDevice& device = exported_.device;
  const bool to_host = (waiting.endpoint & kToHost) != 0;
  const TransferResult result =
      to_host
          ? device.interrupt_in(waiting.endpoint, now, std::span(transfer_).first(waiting.length))
          : device.interrupt_out(waiting.endpoint, now, waiting.data);
  microseconds& next = next_polls_[place(waiting.endpoint)];
  if (result.status == TransferStatus::kNak) {
    next = (now / kFrame + 1) * kFrame;
    if (to_host) next = after_silence(next, now, device.silent_until(now));
    return false;
  }
  if (!to_host) end_silence(now);
  next = std::max(next, now - kMostCredit * kFrame) + kFrame;
  if (result.status != TransferStatus::kDone) {
    usbip::append_returned_submit(
        output_, waiting.sequence,
        result.status == TransferStatus::kStall ? usbip::kStallStatus : usbip::kNoDeviceStatus, 0,
        {});
    return true;
  }
  const std::size_t bytes = std::min(result.bytes, waiting.length);
  if (to_host) ++reports_;
  usbip::append_returned_submit(output_, waiting.sequence, 0, static_cast<std::uint32_t>(bytes),
                                std::span(transfer_).first(to_host ? bytes : 0));
  return true;
}

/// What is told to a device may make it speak in the next frame.
void UsbipSession::end_silence(microseconds now) noexcept {
  for (microseconds& next : next_polls_) next = std::min(next, (now / kFrame + 1) * kFrame);
}

std::optional<microseconds> UsbipSession::next_poll() const noexcept {
  std::optional<microseconds> next;
  if (pending_output() >= kMostOutput) return next;
  for (const Waiting& one : waiting_) {
    if (one.endpoint == 0) continue;
    const microseconds due = next_polls_[place(one.endpoint)];
    next = next ? std::min(*next, due) : due;
  }
  return next;
}

bool UsbipSession::listening() const noexcept {
  return std::any_of(waiting_.begin(), waiting_.end(),
                     [](const Waiting& one) { return (one.endpoint & kToHost) != 0; });
}

std::span<const std::uint8_t> UsbipSession::output() const noexcept {
  return std::span(output_).subspan(output_begin_);
}

void UsbipSession::sent(std::size_t count) {
  output_begin_ += count;
  if (output_begin_ == output_.size()) {
    output_.clear();
    output_begin_ = 0;
  } else if (output_begin_ >= kMostOutput) {
    output_.erase(output_.begin(), output_.begin() + static_cast<std::ptrdiff_t>(output_begin_));
    output_begin_ = 0;
  }
}

}  // namespace limn::firmware
