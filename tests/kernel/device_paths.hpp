#pragma once

#include <cstddef>
#include <cstdint>
#include <future>
#include <map>
#include <string>
#include <vector>

#include "drivers/transport/device_listing.hpp"
#include "firmware_sim/usb/bus_device.hpp"
#include "input/sample/motion_sample.hpp"
#include "input/sample/pen_sample.hpp"
#include "tests/kernel/plugged_device.hpp"

namespace limn::test {

using Bytes = std::vector<std::uint8_t>;

/// What came of one device by one path.
struct Taken {
  std::map<int, std::vector<Bytes>> reports;  ///< by interface, in the order of their coming
  std::size_t report_count = 0;
  std::size_t frames = 0;                ///< of an event node
  std::map<int, std::vector<int>> axes;  ///< of an event node: each absolute axis, by code
  std::vector<std::string> notes;        ///< "lost 3"
  std::string trace;                     ///< all of it, as `limn record` would have it
};

/// The samples of a recording, decoded as `limn decode` does.
std::vector<PenSample> samples_of(const std::string& trace);
/// The same of 3D mice.
std::vector<MotionSample> motions_of(const std::string& trace);

/// The rows of `backend` that are of such a device on this cable, by interface; waits until Linux
/// has `count`.
std::vector<ListedDevice> wait_for_rows(Backend backend, const firmware::DeviceSpec& spec,
                                        Cable cable, std::size_t count);

struct WantedRows {
  const firmware::DeviceSpec& spec;
  std::size_t count = 0;
};

/// The same of several devices, for one look at them all: in the order of `wanted`.
std::vector<std::vector<ListedDevice>> wait_for_rows(Backend backend, Cable cable,
                                                     const std::vector<WantedRows>& wanted);

/// Waits until Linux has no simulated device left.
void wait_until_all_are_gone();

/// Opens rows and reads them, in a thread of its own, until `enough` reports (frames, of an event
/// node) have come or the devices have gone, at most 20 s. As `limn record` does it,
/// initialisation and all. Fails the test where one cannot be opened.
class Taking {
 public:
  Taking(std::vector<ListedDevice> rows, std::size_t enough);
  void wait_until_open() { open_.wait(); }
  Taken get() { return taken_.get(); }

 private:
  static Taken take(const std::vector<ListedDevice>& rows, std::size_t enough,
                    std::promise<void>& open);

  std::future<void> open_;
  std::future<Taken> taken_;
};

/// Who has told a device what it needs before it reports in full.
enum class Setup {
  kNone,
  kLimn,   ///< limn, by its tables (drivers/devices/pen_initialization.hpp)
  kWacom,  ///< Linux's wacom: feature report 2, mode 2
};

/// What the device gives to a host without a kernel, up to `enough` reports.
Taken expected_of(firmware::BusDevice& device, std::size_t enough, Setup setup);

}  // namespace limn::test
