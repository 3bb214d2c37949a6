#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "firmware_sim/usb/bus_device.hpp"
#include "input/base/byte_stream.hpp"
#include "input/trace/trace.hpp"

namespace limn::test {

/// A host at the other end of a simulated device's cable, as a driver in front of limn would be: it
/// enumerates, reads the report descriptors, does limn's own initialisation of the pen, polls, and
/// keeps what comes as a hid-recorder trace. DeviceIndex is the interface's number. An endpoint
/// that halts is cleared; a device that goes away is noted, and enumerated anew when it is back.
class RecordingHost {
 public:
  explicit RecordingHost(firmware::BusDevice& bus) : bus_(bus) {}

  /// Polls every millisecond up to `until`, each endpoint until it has nothing more.
  void run(std::chrono::microseconds until);

  /// What was recorded, as text.
  const std::string& trace() const { return sink_.text(); }

  struct Taken {
    std::uint8_t interface = 0;
    std::chrono::microseconds time{};
    std::vector<std::uint8_t> bytes;
  };
  const std::vector<Taken>& reports() const { return reports_; }

  /// The report descriptor of an interface as the device gave it last.
  const std::vector<std::uint8_t>& report_descriptor(std::uint8_t interface) const {
    return descriptors_.at(interface);
  }

  int plugged_in() const { return plugged_in_; }  ///< times that it was enumerated
  int stalls() const { return stalls_; }          ///< of interrupt-in endpoints

 private:
  class Control;

  void enumerate();
  void set_up();
  void poll();
  std::vector<std::uint8_t> read_report_descriptor(std::uint16_t interface);

  firmware::BusDevice& bus_;
  StringSink sink_;
  std::chrono::microseconds now_{};
  bool plugged_ = false;
  int plugged_in_ = 0;
  int stalls_ = 0;
  std::vector<std::vector<std::uint8_t>> descriptors_;
  std::vector<Taken> reports_;
};

/// A control transfer to the host; empty where the device refuses.
std::vector<std::uint8_t> ask(firmware::BusDevice& bus, const firmware::SetupPacket& setup,
                              std::chrono::microseconds now = {});

}  // namespace limn::test
