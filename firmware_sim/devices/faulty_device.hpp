#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "firmware_sim/devices/faults.hpp"
#include "firmware_sim/usb/bus_device.hpp"

namespace limn::firmware {

/// A device with something wrong between it and the host: stands before another one and does to its
/// transfers what the faults say. The same faults, seeds and polls give the same bytes.
///
/// Faults of reports are decided report by report, in the order in which they were given; those of
/// the device (timeout, unplug, mode-change, time-jump) once a second from their time on.
/// Not firmware: it uses the heap. One thread at a time.
class FaultyDevice final : public BusDevice {
 public:
  static constexpr std::chrono::milliseconds kDeadTime{1000};      ///< of a timeout
  static constexpr std::chrono::milliseconds kUnpluggedTime{500};  ///< of an unplug
  static constexpr std::chrono::milliseconds kBatchTime{100};
  static constexpr std::chrono::seconds kJump{10};
  static constexpr std::size_t kFloodReports = 2000;

  /// `device` must outlive this.
  FaultyDevice(BusDevice& device, std::span<const FaultSpec> faults);

  const DeviceSpec& spec() const noexcept override { return device_.spec(); }
  bool plugged(std::chrono::microseconds now) noexcept override;
  void reset() noexcept override;
  TransferResult control(const SetupPacket& setup, std::chrono::microseconds now,
                         std::span<std::uint8_t> data) noexcept override;
  TransferResult interrupt_in(std::uint8_t endpoint, std::chrono::microseconds now,
                              std::span<std::uint8_t> data) noexcept override;
  TransferResult interrupt_out(std::uint8_t endpoint, std::chrono::microseconds now,
                               std::span<const std::uint8_t> data) noexcept override;

  /// How often a fault came to pass.
  std::uint64_t happened(FaultKind kind) const noexcept {
    return happened_[static_cast<std::size_t>(kind)];
  }

 private:
  struct Armed {
    FaultSpec spec;
    std::uint64_t random;            // state of its generator
    std::chrono::microseconds next;  // when a fault of the device is decided
    std::uint32_t done = 0;
  };

  /// A report that comes later than it was made, or again.
  struct Waiting {
    std::uint8_t endpoint = 0;
    std::chrono::microseconds due{};
    std::vector<std::uint8_t> bytes;
  };

  enum class Fate { kGiven, kTaken, kHalted };

  bool strikes(Armed& fault, std::chrono::microseconds now) noexcept;
  void happen_to_device(std::chrono::microseconds now) noexcept;
  Fate happen_to_report(std::uint8_t endpoint, std::chrono::microseconds now,
                        std::span<std::uint8_t> data, std::size_t& bytes) noexcept;
  Fate happen(Armed& fault, const Waiting& report, std::span<std::uint8_t> data,
              std::size_t& bytes) noexcept;
  bool take_waiting(std::uint8_t endpoint, std::chrono::microseconds now,
                    std::span<std::uint8_t> data, std::size_t& bytes) noexcept;
  bool take_late(std::uint8_t endpoint, std::chrono::microseconds now, std::span<std::uint8_t> data,
                 std::size_t& bytes) noexcept;
  void spoil_descriptor(std::span<std::uint8_t> descriptor) noexcept;

  BusDevice& device_;
  std::vector<Armed> faults_;
  std::array<std::uint64_t, kFaultKinds> happened_{};
  std::chrono::microseconds shift_{};  // of the device's clock
  std::chrono::microseconds dead_until_{};
  std::chrono::microseconds unplugged_until_{};
  std::chrono::microseconds batch_until_{};
  std::optional<std::uint8_t> halted_;  // endpoint
  std::deque<Waiting> waiting_;
  std::optional<Waiting> held_;    // comes after the next one
  std::optional<Waiting> orphan_;  // the last one so far, all others gone
  bool orphaning_ = false;
  std::optional<Waiting> stuck_;
};

}  // namespace limn::firmware
