#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "input/trace/device_table.hpp"
#include "input/trace/line_trace_reader.hpp"

namespace limn {

/// Reads hid-recorder files, see TraceFormat::kHidRecorder.
class HidRecorderReader final : public LineTraceReader {
 public:
  HidRecorderReader(std::unique_ptr<ByteSource> bytes, TraceOptions options);
  TraceFormat format() const noexcept override { return TraceFormat::kHidRecorder; }

 private:
  Expected<void> take(const Line& line) override;
  Expected<void> finish() override;
  void skipped(const Line& line) override;

  Expected<void> take_keyed(char key, std::string_view rest, bool terminated);
  Expected<void> take_comment(const Line& line);
  Expected<void> take_device(std::string_view rest);
  Expected<void> take_descriptor(std::string_view rest);
  Expected<void> take_text(std::string TraceDevice::*member, std::string_view rest);
  Expected<void> take_ids(std::string_view rest, bool terminated);
  Expected<void> take_event(std::string_view rest);
  Expected<std::size_t> take_bytes(std::string_view rest, std::size_t limit);
  Expected<void> select(DeviceIndex index);
  Expected<TraceDevice*> description();
  DeviceIndex selected_index() const noexcept;
  void announce();

  DeviceTable devices_;
  TrackedDevice* device_ = nullptr;  // the selected one; null before the first line that needs one
  bool device_lost_ = false;         // salvage: a skipped line may have selected another device
  std::vector<std::uint8_t> bytes_;  // as many as the largest report or descriptor so far
};

}  // namespace limn
