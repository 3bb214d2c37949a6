#pragma once

#include <cstdint>
#include <span>

#include "input/base/time.hpp"

namespace limn {

/// Number of a device within one stream (hid-recorder's D:, one a USB interface). Not a USB id.
using DeviceIndex = std::uint32_t;

/// One input report as the device sent it: the first byte is the report ID where the device's
/// descriptor numbers its reports. `bytes` is borrowed from the stream that made it, and valid
/// until that stream is asked for the next one.
struct Report {
  DeviceIndex device = 0;
  Timestamp time{};
  std::span<const std::uint8_t> bytes;
};

}  // namespace limn
