#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "input/trace/device_table.hpp"
#include "input/trace/line_trace_reader.hpp"

namespace limn {

/// Reads evemu files, see TraceFormat::kEvemu: one device, index 0.
class EvemuReader final : public LineTraceReader {
 public:
  EvemuReader(std::unique_ptr<ByteSource> bytes, TraceOptions options);
  TraceFormat format() const noexcept override { return TraceFormat::kEvemu; }

 private:
  Expected<void> take(const Line& line) override;
  Expected<void> finish() override;
  void skipped(const Line& line) override;

  Expected<void> take_name(std::string_view rest);
  Expected<void> take_ids(std::string_view rest);
  Expected<void> take_descriptor(std::string_view rest);
  Expected<void> take_axis(std::string_view rest);
  Expected<void> take_event(std::string_view rest, bool terminated);
  Expected<void> add_to_frame(const EvdevEvent& event);
  TraceDevice& description();
  void announce();

  DeviceTable devices_;
  TrackedDevice& device_;
  std::vector<EvdevEvent> frame_;
  bool frame_sent_ = false;     // frame_ is borrowed by an event; the next E: begins a new one
  bool frame_damaged_ = false;  // salvage: what follows until SYN_REPORT is part of a torn frame
};

}  // namespace limn
