#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "input/trace_import/libinput_record.hpp"
#include "input/trace_import/stepped_trace_reader.hpp"

namespace limn {

/// Reads libinput recordings, see TraceFormat::kLibinputRecord.
class LibinputReader final : public SteppedTraceReader {
 public:
  LibinputReader(LibinputRecord record, TraceOptions options);
  TraceFormat format() const noexcept override { return TraceFormat::kLibinputRecord; }

 private:
  /// A hidraw node: the device it was recorded with, described as one of its own.
  struct Node {
    std::uint32_t recorded_with = 0;
    TraceDevice description;
    bool announced = false;
    std::optional<Timestamp> last;
  };

  Expected<bool> step() override;
  Expected<void> take(const LibinputRecord::Item& item);
  Expected<void> take_frame(const LibinputRecord::Item& item);
  Expected<void> take_report(const LibinputRecord::Item& item);
  void announce_up_to(std::size_t count, std::uint64_t line);
  void supply(TraceDevice& device) const;

  LibinputRecord record_;
  SuppliedDevice supplied_;
  std::size_t item_ = 0;
  std::size_t announced_ = 0;                         // of record_.devices
  std::vector<std::optional<Timestamp>> last_frame_;  // by device
  std::map<std::uint32_t, Node> nodes_;               // by source
};

}  // namespace limn
