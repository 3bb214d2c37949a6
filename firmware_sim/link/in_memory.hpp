#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "firmware_sim/usb/bus_device.hpp"

namespace limn::firmware {

/// A control transfer that a host makes; `data` is what it sends.
struct HostRequest {
  SetupPacket setup;
  std::vector<std::uint8_t> data = {};
};

/// What happens at the host's end of the cable.
struct HostEvent {
  enum class Kind : std::uint8_t {
    kPlugged,   ///< the device is there and configured
    kReport,    ///< an input report
    kUnplugged  ///< the device has gone
  };
  Kind kind = Kind::kReport;
  std::chrono::microseconds time{};
  std::uint8_t interface = 0;           ///< of a report
  std::span<const std::uint8_t> bytes;  ///< of a report; borrowed until the next call
};

/// A USB host without a kernel and without a clock: it configures the device as Linux does, polls
/// each interrupt-in endpoint at its interval, clears what has halted, and sees the device go and
/// come back. Time passes only by next(), so the same device gives the same events everywhere.
///
/// Endpoints are polled at `time of plugging + k * interval`, k = 1, 2, ..; of one time, in the
/// order of the interfaces. The cable is looked at once a millisecond.
class InMemoryHost {
 public:
  enum class Polling : std::uint8_t {
    kByInterval,  ///< as a bus does: a report may wait as long as its endpoint's interval
    /// Every millisecond until it has no more, so that reports come when they are due; not while
    /// the device says that it is silent.
    kWhenDue
  };

  /// `device` must outlive this. `requests` are made whenever the device has been configured, as
  /// drivers do that switch a tablet into its full mode; what it answers to them is dropped.
  explicit InMemoryHost(BusDevice& device, Polling polling = Polling::kByInterval,
                        std::vector<HostRequest> requests = {});

  /// The next event at or before `end`; nothing where there is none, and then it is `end`.
  std::optional<HostEvent> next(std::chrono::microseconds end);

  /// A control transfer at time(). As BusDevice::control.
  TransferResult control(const SetupPacket& setup, std::span<std::uint8_t> data) noexcept;

  /// Sends an output report, by interrupt where the interface has an endpoint for that, else by
  /// SET_REPORT; its ID, `id`, comes first in `bytes` where reports are numbered. False: refused.
  bool send_output(std::uint8_t interface, std::uint8_t id,
                   std::span<const std::uint8_t> bytes) noexcept;

  /// The report descriptor of an interface, as the device gave it when it was configured last.
  std::span<const std::uint8_t> report_descriptor(std::uint8_t interface) const noexcept {
    return descriptors_[interface];
  }

  std::chrono::microseconds time() const noexcept { return time_; }

  /// When next() will look at the device again, later than time() or at it.
  std::chrono::microseconds next_look() const noexcept;

 private:
  struct Endpoint {
    std::uint8_t interface = 0;
    std::uint8_t address = 0;
    std::chrono::microseconds interval{};
    std::chrono::microseconds next_poll{};
    int at_once = 0;  // reports since then
  };

  std::optional<HostEvent> look_at_cable();
  bool configure();
  bool read_descriptors();
  std::optional<HostEvent> poll(Endpoint& endpoint);
  std::chrono::microseconds skip_silence(std::chrono::microseconds next) noexcept;
  void end_silence() noexcept;

  BusDevice& device_;
  Polling polling_;
  std::vector<HostRequest> requests_;
  std::vector<std::vector<std::uint8_t>> descriptors_;  // of reports, one an interface
  std::vector<Endpoint> endpoints_;  // interrupt-in, in the order of the interfaces
  std::chrono::microseconds time_{};
  std::chrono::microseconds next_cable_{};
  std::chrono::microseconds next_try_{};  // to configure it
  bool there_ = false;
  bool configured_ = false;
  std::vector<std::uint8_t> data_;
};

}  // namespace limn::firmware
