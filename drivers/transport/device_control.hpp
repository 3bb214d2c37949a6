#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "input/base/error.hpp"

namespace limn {

/// How long one request to a device may take; a real one answers within some 10 ms. What Linux does
/// itself (a report to a hidraw node) takes up to 5 s where a device is dead.
inline constexpr std::chrono::milliseconds kRequestTimeout{1000};

/// What is asked of a device, and told it, beside its stream of reports. Every request ends in
/// bounded time, whatever the device does. Used by one thread at a time.
///
/// Errors of all members: kIo, with the remedy: no permission, the device is gone, it refuses.
class DeviceControl {
 public:
  virtual ~DeviceControl() = default;

  /// A string descriptor as it comes, at most `length` bytes: GET_DESCRIPTOR. A device that stalls
  /// or stays silent gives an empty one: that is an answer too.
  virtual Expected<std::vector<std::uint8_t>> read_string(std::uint8_t index,
                                                          std::uint16_t language,
                                                          std::uint16_t length) = 0;

  /// An output report, its ID the first byte where reports are numbered. Over USB: to this
  /// interrupt-out endpoint (its number, without the direction bit); hidraw has one way out for
  /// each interface and takes that.
  virtual Expected<void> write_interrupt(std::uint8_t endpoint,
                                         std::span<const std::uint8_t> bytes) = 0;

  /// An output report, its ID the first byte (0 where reports are not numbered), such as 04 01, the
  /// light of a 3D mouse. Over USB: SET_REPORT; hidraw: as Linux's driver sends them.
  virtual Expected<void> set_output(std::span<const std::uint8_t> bytes) = 0;

  /// A feature report, its ID the first byte (0 where reports are not numbered): SET_REPORT.
  virtual Expected<void> set_feature(std::span<const std::uint8_t> bytes) = 0;

  /// The feature report of this ID, which is its first byte, at most `length` bytes: GET_REPORT.
  virtual Expected<std::vector<std::uint8_t>> get_feature(std::uint8_t id, std::size_t length) = 0;
};

}  // namespace limn
