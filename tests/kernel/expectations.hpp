#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "firmware_sim/devices/catalogue.hpp"
#include "tests/kernel/device_paths.hpp"
#include "tests/kernel/started_device.hpp"

namespace limn::test {

/// A simulated device, its hand's start held back.
struct Held {
  Held(std::string_view device_name, std::string_view movement);

  std::string name;
  std::unique_ptr<firmware::SimulatedDevice> made;
  StartedDevice device;
};

/// What such a device gives to a host without a kernel.
Taken expected_from(std::string_view name, std::string_view movement, std::size_t enough,
                    Setup setup);

/// Fails unless `enough` reports came, those of each interface the ones that the device gives
/// first.
void expect_reports(const Taken& taken, const Taken& expected, std::size_t enough);

/// Fails unless the motions of these reports, decoded, are those that the device gives first, but
/// for their times.
void expect_motions(const Taken& taken, const Taken& expected);

/// Fails unless what an event node told of a pen in range is what changes from one of `expected`'s
/// samples to the next, each within one count (one degree of tilt), and at least `at_least` of it.
void expect_changes(const Taken& kernel, const Taken& expected, std::size_t at_least);

}  // namespace limn::test
