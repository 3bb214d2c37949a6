#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "firmware_sim/usb/bus_device.hpp"

namespace limn::firmware {

enum class SimulatedKind : std::uint8_t { kPen, k3dMouse };

struct SimulatedInfo {
  std::string_view name;
  std::string_view description;  ///< one line
  SimulatedKind kind = SimulatedKind::kPen;
};

/// All simulated devices, in the order in which they should be listed.
std::span<const SimulatedInfo> simulated_devices() noexcept;

/// A device with the hand that moves it, as it hangs on a bus. Host side: it may use the heap.
class SimulatedDevice {
 public:
  virtual ~SimulatedDevice() = default;
  virtual BusDevice& bus() noexcept = 0;
  /// When the hand has done: later nothing more comes.
  virtual std::chrono::microseconds duration() const noexcept = 0;
};

/// The device `name`, moved by the drawing (pens) or motion (3D mice) `movement`, noise by `seed`:
/// the same arguments give the same bytes at the same times on every machine. Nothing where there
/// is no such device or movement.
std::unique_ptr<SimulatedDevice> make_simulated_device(std::string_view name,
                                                       std::string_view movement,
                                                       std::uint64_t seed);

}  // namespace limn::firmware
