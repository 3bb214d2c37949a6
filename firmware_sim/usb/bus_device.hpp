#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware_sim/usb/usb_function.hpp"

namespace limn::firmware {

/// What a transfer came to.
enum class TransferStatus : std::uint8_t {
  kDone,
  kNak,      ///< nothing (yet): the host asks again; of a control transfer: it ran out of time
  kStall,    ///< refused (control), or halted (interrupt)
  kNoDevice  ///< it is not plugged in
};

struct TransferResult {
  TransferStatus status = TransferStatus::kDone;
  std::size_t bytes = 0;  ///< read, or taken
};

/// A device as a host sees it at the end of a cable: whole transfers at a time. Links
/// (firmware_sim/link) speak to this; UsbDevice is one, and so is one with faults before it.
/// `now` is the time since the simulation began, and never goes back.
class BusDevice {
 public:
  virtual const DeviceSpec& spec() const noexcept = 0;

  /// Whether it hangs on the bus. A link that sees it go unplugs it from the host, and plugs it in
  /// when it is back, which resets it.
  virtual bool plugged(std::chrono::microseconds now) noexcept = 0;

  /// The bus was reset: default state, address 0, not configured.
  virtual void reset() noexcept = 0;

  /// A control transfer on endpoint 0. `data` holds setup.length bytes at least: what the host
  /// sends, or room for what it wants.
  virtual TransferResult control(const SetupPacket& setup, std::chrono::microseconds now,
                                 std::span<std::uint8_t> data) noexcept = 0;

  /// The host polls an interrupt-in endpoint. A report longer than a packet takes several on the
  /// bus; here it is one transfer, cut to `data`. kStall: unknown or halted, or the device is not
  /// configured.
  virtual TransferResult interrupt_in(std::uint8_t endpoint, std::chrono::microseconds now,
                                      std::span<std::uint8_t> data) noexcept = 0;

  /// The host sends to an interrupt-out endpoint.
  virtual TransferResult interrupt_out(std::uint8_t endpoint, std::chrono::microseconds now,
                                       std::span<const std::uint8_t> data) noexcept = 0;

  /// Where every interrupt-in endpoint has said kNak at `now`, or none is polled: until then all go
  /// on saying it, and plugged() stays what it is, unless a transfer comes before. A link need not
  /// look earlier. `now`: that is not known.
  virtual std::chrono::microseconds silent_until(std::chrono::microseconds now) noexcept {
    return now;
  }

 protected:
  BusDevice() = default;
  BusDevice(const BusDevice&) = default;
  BusDevice& operator=(const BusDevice&) = default;
  ~BusDevice() = default;  // as UsbFunction's
};

}  // namespace limn::firmware
