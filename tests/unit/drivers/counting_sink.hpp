#pragma once

#include "drivers/transport/transport.hpp"

namespace limn::test {

/// Counts what comes and keeps nothing.
class CountingSink final : public TransportSink {
 public:
  void report(Timestamp, std::span<const std::uint8_t>) noexcept override { ++reports; }
  void frame(Timestamp, std::span<const EvdevEvent>) noexcept override { ++frames; }
  void lost(std::uint32_t, bool) noexcept override {}
  int reports = 0;
  int frames = 0;
};

}  // namespace limn::test
