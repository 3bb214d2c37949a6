#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "firmware_sim/usb/usb_function.hpp"
#include "input/base/error.hpp"
#include "input/trace/trace.hpp"

namespace limn::app {

/// A recording as the code of a USB device: each recorded device is an interface, with its report
/// descriptor; its reports come at their times, from the first one's on. String descriptors that
/// the recording notes are answered as they were. No report is ever lost here: those that the host
/// does not take wait. Where the recording notes that the device went, and reports come later, it
/// is unplugged between (plugged()).
class RecordedDevice final : public firmware::UsbFunction {
 public:
  /// Reads the whole recording. Times are divided by `speed`.
  /// Errors: the reader's; kMissing for a recording without descriptor, ids or reports; kLimit for
  /// one of several devices (different ids), and for what USB or the simulated core has no room
  /// for.
  static Expected<std::unique_ptr<RecordedDevice>> read(TraceReader& reader, double speed);

  RecordedDevice(const RecordedDevice&) = delete;  // spec_ points into it
  RecordedDevice& operator=(const RecordedDevice&) = delete;

  /// When the last report comes.
  std::chrono::microseconds duration() const noexcept { return duration_; }

  /// Whether the recorded device hung on its cable then. It goes kLastPoll after its last report (a
  /// quarter of the gap at most), as notes have no time of their own, and is back kSettling before
  /// its next one (at the middle of the gap at the earliest), so that a host has found it by then.
  bool plugged(std::chrono::microseconds now) const noexcept;
  static constexpr std::chrono::milliseconds kLastPoll{20};
  static constexpr std::chrono::milliseconds kSettling{1000};

  const firmware::DeviceSpec& spec() const noexcept override { return spec_; }
  void reset() noexcept override {}  // a recording goes on
  std::size_t next_report(std::uint8_t interface, std::chrono::microseconds now,
                          std::span<std::uint8_t> report) noexcept override;
  int string_descriptor(std::uint8_t index, std::uint16_t language,
                        std::span<std::uint8_t> out) noexcept override;

 private:
  struct Recorded {
    std::chrono::microseconds time{};
    std::size_t begin = 0;  // in bytes_
    std::size_t size = 0;
  };
  struct Interface {
    DeviceIndex index = 0;
    std::vector<std::uint8_t> descriptor;
    std::vector<Recorded> reports;
    std::size_t next = 0;
    std::array<firmware::EndpointSpec, 1> endpoint;
  };
  struct Absence {
    std::chrono::microseconds begin{};
    std::chrono::microseconds end{};
  };
  class Reading;

  RecordedDevice() = default;
  void make_spec();

  std::vector<Interface> interfaces_;
  std::vector<std::uint8_t> bytes_;
  std::vector<Absence> absences_;  // in order, apart from each other
  std::map<std::uint8_t, std::vector<std::uint8_t>> strings_;
  std::string name_;
  std::uint16_t vendor_ = 0;
  std::uint16_t product_ = 0;
  std::uint16_t version_ = 0;
  std::vector<firmware::InterfaceSpec> interface_specs_;
  firmware::DeviceSpec spec_;
  std::chrono::microseconds duration_{};
};

}  // namespace limn::app
