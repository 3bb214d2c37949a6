#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "input/trace/trace.hpp"

namespace limn {

/// One device of a recording while it is read.
struct TrackedDevice {
  TraceDevice description;
  bool announced = false;         ///< its description, as it stands, was sent
  std::optional<Timestamp> last;  ///< time of its last report
};

/// The devices of a recording, at most kMaxTraceDevices; addresses stay.
class DeviceTable {
 public:
  explicit DeviceTable(SuppliedDevice supplied) : supplied_(std::move(supplied)) {}

  /// The device of this index, made if it is new; null when there are too many.
  TrackedDevice* find_or_add(DeviceIndex index);

  std::size_t size() const noexcept { return devices_.size(); }

  /// Marks the device as announced and completes its description: what the trace does not give is
  /// taken from the supplied device.
  DeviceDescribed announce(TrackedDevice& device) const;

 private:
  SuppliedDevice supplied_;
  std::vector<std::unique_ptr<TrackedDevice>> devices_;
};

}  // namespace limn
