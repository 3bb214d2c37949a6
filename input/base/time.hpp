#pragma once

#include <chrono>
#include <cstdint>

namespace limn {

/// A point in a stream's own time: what its clock or file says. Only differences mean anything.
/// Nanoseconds in 64 bits: recordings have microseconds, batches are spread more finely.
using Timestamp = std::chrono::nanoseconds;

constexpr double to_seconds(Timestamp t) noexcept { return static_cast<double>(t.count()) * 1e-9; }

}  // namespace limn
