#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <vector>

#include "firmware_sim/usb/usb_device.hpp"

namespace limn::firmware {

using Bytes = std::vector<std::uint8_t>;

/// Report 1, numbered from 1 in two bytes; feature report 2 of three bytes; output report 3.
inline constexpr std::uint8_t kCountingDescriptor[] = {
    0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x75, 0x08,  // vendor page, bytes
    0x85, 0x01, 0x95, 0x02, 0x09, 0x01, 0x81, 0x02,        // input
    0x85, 0x02, 0x95, 0x03, 0x09, 0x02, 0xB1, 0x02,        // feature
    0x85, 0x03, 0x95, 0x02, 0x09, 0x03, 0x91, 0x02, 0xC0};
inline constexpr EndpointSpec kCountingEndpoints[] = {{0x81, 8, 2}};
inline constexpr EndpointSpec kOtherEndpoints[] = {{0x82, 8, 1}, {0x02, 8, 1}};
inline constexpr InterfaceSpec kCountingInterfaces[] = {
    {kCountingDescriptor, 0, 0, kCountingEndpoints}, {kCountingDescriptor, 0, 0, kOtherEndpoints}};

constexpr DeviceSpec counting_spec() {
  DeviceSpec spec;
  spec.vendor = 0x1209;
  spec.product = 0x0002;
  spec.version = 0x0103;
  spec.manufacturer = "limn";
  spec.product_name = "Counter";
  spec.serial_number = "7";
  spec.interfaces = kCountingInterfaces;
  return spec;
}
inline constexpr DeviceSpec kCountingSpec = counting_spec();

/// Reports {1, n low, n high} at n * period, n = 1 .. count, by interface; keeps what it is told.
class CountingFunction final : public UsbFunction {
 public:
  const DeviceSpec& spec() const noexcept override { return kCountingSpec; }
  void reset() noexcept override { ++resets; }
  std::size_t next_report(std::uint8_t interface, std::chrono::microseconds now,
                          std::span<std::uint8_t> report) noexcept override {
    const int next = given[interface] + 1;
    if (next > count[interface] || next * period > now) return 0;
    given[interface] = next;
    report[0] = 1;
    report[1] = static_cast<std::uint8_t>(next & 0xFF);
    report[2] = static_cast<std::uint8_t>(next >> 8);
    return 3;
  }
  int get_report(std::uint8_t, ReportKind kind, std::uint8_t id,
                 std::span<std::uint8_t> out) noexcept override {
    if (kind != ReportKind::kFeature || id != 2 || out.size() < 4) return kStall;
    std::copy(feature.begin(), feature.end(), out.begin());
    return 4;
  }
  bool set_report(std::uint8_t interface, ReportKind kind, std::uint8_t id,
                  std::span<const std::uint8_t> bytes) noexcept override {
    told = {interface, static_cast<std::uint8_t>(kind), id};
    told.insert(told.end(), bytes.begin(), bytes.end());
    if (kind == ReportKind::kFeature && id == 2 && bytes.size() == 4) {
      std::copy(bytes.begin(), bytes.end(), feature.begin());
    }
    return id != 9;
  }

  std::chrono::microseconds period{5000};
  std::array<int, 2> count{};
  std::array<int, 2> given{};
  std::array<std::uint8_t, 4> feature{2, 0x11, 0x22, 0x33};
  Bytes told;  // interface, kind, id, bytes
  int resets = 0;
};

/// A counting device on a cable that is out from `gone` until `back`, and while a test pulls it;
/// vendor request 0x77 takes longer than any host waits.
class CountingDevice final : public BusDevice {
 public:
  const DeviceSpec& spec() const noexcept override { return usb.spec(); }
  bool plugged(std::chrono::microseconds now) noexcept override {
    return !pulled && (now < gone || now >= back);
  }
  void reset() noexcept override { usb.reset(); }
  TransferResult control(const SetupPacket& setup, std::chrono::microseconds now,
                         std::span<std::uint8_t> data) noexcept override {
    if (setup.request_type == 0x40 && setup.request == 0x77) return {TransferStatus::kNak, 0};
    return usb.control(setup, now, data);
  }
  TransferResult interrupt_in(std::uint8_t endpoint, std::chrono::microseconds now,
                              std::span<std::uint8_t> data) noexcept override {
    return usb.interrupt_in(endpoint, now, data);
  }
  TransferResult interrupt_out(std::uint8_t endpoint, std::chrono::microseconds now,
                               std::span<const std::uint8_t> data) noexcept override {
    return usb.interrupt_out(endpoint, now, data);
  }

  CountingFunction function;
  UsbDevice usb{function};
  std::atomic<bool> pulled = false;
  std::chrono::microseconds gone = std::chrono::microseconds::max();
  std::chrono::microseconds back = std::chrono::microseconds::max();
};

}  // namespace limn::firmware
