#include "firmware_sim/link/in_memory.hpp"

#include <algorithm>
#include <utility>

#include "firmware_sim/link/frames.hpp"
#include "firmware_sim/link/standard_requests.hpp"

namespace limn::firmware {
namespace {

using std::chrono::microseconds;

constexpr microseconds kTryPeriod{100'000};   // Linux, too, waits before it tries a device again
constexpr int kMostAtOnce = 4096;             // of a device that never has nothing to say
constexpr std::size_t kMostTransfer = 65535;  // wLength has 16 bits
constexpr std::uint8_t kAddress = 1;
constexpr std::uint8_t kConfiguration = 1;

}  // namespace

InMemoryHost::InMemoryHost(BusDevice& device, Polling polling, std::vector<HostRequest> requests)
    : device_(device), polling_(polling), requests_(std::move(requests)), data_(kMostTransfer) {
  const auto interfaces = device.spec().interfaces;
  for (std::size_t i = 0; i < interfaces.size(); ++i) {
    for (const EndpointSpec& endpoint : interfaces[i].endpoints) {
      if ((endpoint.address & kToHost) == 0) continue;
      const int frames = polling == Polling::kWhenDue ? 1 : std::max<int>(1, endpoint.interval_ms);
      endpoints_.push_back(
          {static_cast<std::uint8_t>(i), endpoint.address, frames * kFrame, {}, 0});
    }
  }
}

std::optional<HostEvent> InMemoryHost::next(microseconds end) {
  while (next_look() <= end) {
    time_ = std::max(time_, next_look());
    if (next_cable_ <= time_) {
      if (const auto event = look_at_cable()) return event;
      continue;
    }
    for (Endpoint& endpoint : endpoints_) {
      if (endpoint.next_poll > time_) continue;
      if (const auto event = poll(endpoint)) return event;
    }
  }
  time_ = std::max(time_, end);
  return std::nullopt;
}

microseconds InMemoryHost::next_look() const noexcept {
  microseconds next = next_cable_;
  if (!configured_) return next;
  for (const Endpoint& endpoint : endpoints_) next = std::min(next, endpoint.next_poll);
  return next;
}

std::optional<HostEvent> InMemoryHost::look_at_cable() {
  next_cable_ = skip_silence(time_ + kFrame);
  const bool was_there = std::exchange(there_, device_.plugged(time_));
  if (!there_) {
    if (!std::exchange(configured_, false)) return std::nullopt;
    return HostEvent{HostEvent::Kind::kUnplugged, time_, 0, {}};
  }
  if (configured_ || (was_there && time_ < next_try_)) return std::nullopt;
  next_try_ = time_ + kTryPeriod;
  if (!configure()) return std::nullopt;
  configured_ = true;
  for (Endpoint& endpoint : endpoints_) {
    endpoint.next_poll = time_ + endpoint.interval;
    endpoint.at_once = 0;
  }
  return HostEvent{HostEvent::Kind::kPlugged, time_, 0, {}};
}

bool InMemoryHost::configure() {
  device_.reset();
  for (const SetupPacket& setup : {set_address(kAddress), set_configuration(kConfiguration)}) {
    if (control(setup, data_).status != TransferStatus::kDone) return false;
  }
  if (!read_descriptors()) return false;
  for (std::size_t i = 0; i < device_.spec().interfaces.size(); ++i) {
    control(set_idle_forever(static_cast<std::uint8_t>(i)), data_);  // devices may refuse it
  }
  for (const HostRequest& request : requests_) {
    std::fill(data_.begin(), data_.end(), std::uint8_t{0});
    std::copy_n(request.data.begin(), std::min(request.data.size(), data_.size()), data_.begin());
    control(request.setup, data_);
  }
  return true;
}

bool InMemoryHost::read_descriptors() {
  const auto interfaces = device_.spec().interfaces;
  descriptors_.assign(interfaces.size(), {});
  for (std::size_t i = 0; i < interfaces.size(); ++i) {
    const std::size_t length = std::min(interfaces[i].report_descriptor.size(), data_.size());
    const auto setup =
        get_report_descriptor(static_cast<std::uint8_t>(i), static_cast<std::uint16_t>(length));
    const TransferResult got = control(setup, data_);
    if (got.status != TransferStatus::kDone) return false;
    const auto bytes = std::span(data_).first(std::min(got.bytes, data_.size()));
    descriptors_[i].assign(bytes.begin(), bytes.end());
  }
  return true;
}

std::optional<HostEvent> InMemoryHost::poll(Endpoint& endpoint) {
  const TransferResult got = device_.interrupt_in(endpoint.address, time_, data_);
  const bool more = got.status == TransferStatus::kDone && polling_ == Polling::kWhenDue;
  if (!more || ++endpoint.at_once == kMostAtOnce) {
    endpoint.next_poll += endpoint.interval;
    endpoint.at_once = 0;
  }
  if (got.status == TransferStatus::kNak) endpoint.next_poll = skip_silence(endpoint.next_poll);
  if (got.status == TransferStatus::kStall) control(clear_halt(endpoint.address), {});
  // An empty packet is no report to any host.
  if (got.status != TransferStatus::kDone || got.bytes == 0) return std::nullopt;
  return HostEvent{HostEvent::Kind::kReport, time_, endpoint.interface,
                   std::span(data_).first(std::min(got.bytes, data_.size()))};
}

TransferResult InMemoryHost::control(const SetupPacket& setup,
                                     std::span<std::uint8_t> data) noexcept {
  end_silence();
  return device_.control(setup, time_, data);
}

microseconds InMemoryHost::skip_silence(microseconds next) noexcept {
  // By interval, what a transfer wakes would be polled at other times than it is on a bus.
  if (polling_ != Polling::kWhenDue) return next;
  return after_silence(next, time_, device_.silent_until(time_));
}

/// What is told to a device may make it speak in the next frame.
void InMemoryHost::end_silence() noexcept {
  if (polling_ != Polling::kWhenDue) return;
  const auto wake = [this](microseconds& next) {
    if (next > time_) next -= (next - time_ - microseconds(1)) / kFrame * kFrame;
  };
  wake(next_cable_);
  for (Endpoint& endpoint : endpoints_) wake(endpoint.next_poll);
}

bool InMemoryHost::send_output(std::uint8_t interface, std::uint8_t id,
                               std::span<const std::uint8_t> bytes) noexcept {
  const auto interfaces = device_.spec().interfaces;
  if (interface >= interfaces.size() || bytes.size() > kMostTransfer) return false;
  for (const EndpointSpec& endpoint : interfaces[interface].endpoints) {
    if ((endpoint.address & kToHost) != 0) continue;
    end_silence();
    return device_.interrupt_out(endpoint.address, time_, bytes).status == TransferStatus::kDone;
  }
  std::copy(bytes.begin(), bytes.end(), data_.begin());
  const auto length = static_cast<std::uint16_t>(bytes.size());
  return control(set_report(interface, ReportKind::kOutput, id, length), data_).status ==
         TransferStatus::kDone;
}

}  // namespace limn::firmware
