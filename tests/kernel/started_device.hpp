#pragma once

#include <atomic>
#include <chrono>
#include <optional>

#include "firmware_sim/usb/bus_device.hpp"

namespace limn::test {

/// A device whose hand waits for start(): whoever is to read it has opened it by then, and Linux's
/// own looks at it cost nothing.
class StartedDevice final : public firmware::BusDevice {
 public:
  /// `device` must outlive this.
  explicit StartedDevice(firmware::BusDevice& device) : device_(device) {}

  /// From any thread.
  void start() noexcept { started_ = true; }

  const firmware::DeviceSpec& spec() const noexcept override { return device_.spec(); }
  bool plugged(std::chrono::microseconds now) noexcept override {
    return device_.plugged(since_start(now));
  }
  void reset() noexcept override { device_.reset(); }
  firmware::TransferResult control(const firmware::SetupPacket& setup,
                                   std::chrono::microseconds now,
                                   std::span<std::uint8_t> data) noexcept override {
    return device_.control(setup, since_start(now), data);
  }
  firmware::TransferResult interrupt_in(std::uint8_t endpoint, std::chrono::microseconds now,
                                        std::span<std::uint8_t> data) noexcept override {
    return device_.interrupt_in(endpoint, since_start(now), data);
  }
  firmware::TransferResult interrupt_out(std::uint8_t endpoint, std::chrono::microseconds now,
                                         std::span<const std::uint8_t> data) noexcept override {
    return device_.interrupt_out(endpoint, since_start(now), data);
  }
  std::chrono::microseconds silent_until(std::chrono::microseconds now) noexcept override {
    constexpr std::chrono::milliseconds kLook{20};  // whether it has been started
    if (!start_) return now + kLook;
    return *start_ + device_.silent_until(now - *start_);
  }

 private:
  std::chrono::microseconds since_start(std::chrono::microseconds now) noexcept {
    if (!started_) return {};
    if (!start_) start_ = now;
    return now - *start_;
  }

  firmware::BusDevice& device_;
  std::atomic<bool> started_ = false;
  std::optional<std::chrono::microseconds> start_;
};

}  // namespace limn::test
