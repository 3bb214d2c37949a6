#pragma once

#include <cstdint>

#include "drivers/transport/device_control.hpp"
#include "firmware_sim/link/in_memory.hpp"

namespace limn::app {

/// The requests of a simulated device's initialisation, made by the host at whose cable it hangs.
/// As over USB: strings that stall are empty answers.
class BusControl final : public DeviceControl {
 public:
  /// `host` must outlive this; reports are those of `interface`.
  BusControl(firmware::InMemoryHost& host, std::uint8_t interface)
      : host_(host), interface_(interface) {}

  Expected<std::vector<std::uint8_t>> read_string(std::uint8_t index, std::uint16_t language,
                                                  std::uint16_t length) override;
  Expected<void> write_interrupt(std::uint8_t endpoint,
                                 std::span<const std::uint8_t> bytes) override;
  Expected<void> set_output(std::span<const std::uint8_t> bytes) override;
  Expected<void> set_feature(std::span<const std::uint8_t> bytes) override;
  Expected<std::vector<std::uint8_t>> get_feature(std::uint8_t id, std::size_t length) override;

 private:
  Expected<void> set_report(firmware::ReportKind kind, std::span<const std::uint8_t> bytes,
                            const char* what);

  firmware::InMemoryHost& host_;
  std::uint8_t interface_;
};

}  // namespace limn::app
