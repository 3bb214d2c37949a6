#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "input/trace/device_table.hpp"
#include "input/trace_import/stepped_trace_reader.hpp"
#include "input/trace_import/usb_capture.hpp"
#include "input/trace_import/usb_descriptors.hpp"

namespace limn {

/// Reads USB captures, see TraceFormat::kUsbCapture.
class UsbCaptureReader final : public SteppedTraceReader {
 public:
  UsbCaptureReader(UsbCapture capture, TraceOptions options);
  TraceFormat format() const noexcept override { return TraceFormat::kUsbCapture; }

 private:
  /// One address of a bus.
  struct Address {
    std::uint16_t bus = 0;
    std::uint16_t number = 0;
    UsbDescriptors descriptors;
    std::optional<DeviceIndex> first_index;         // given when it first has a traced device
    std::map<std::uint8_t, TrackedDevice*> traced;  // by interface, or kByEndpoint + endpoint
  };

  Expected<bool> step() override;
  Expected<void> take(const UsbPacket& packet);
  Expected<void> take_answer(const UsbPacket& packet);
  Expected<void> take_report(const UsbPacket& packet);
  Expected<Address*> address(const UsbPacket& packet);
  Expected<TrackedDevice*> traced(Address& address, std::uint8_t interface);
  void announce(const Address& address, std::uint8_t interface, TrackedDevice& device);
  void finish();

  UsbCapture capture_;
  UsbDescriptorRequests requests_;
  DeviceTable devices_;
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::unique_ptr<Address>> addresses_;
  DeviceIndex next_index_ = 0;
  std::uint64_t number_ = 0;        // of the packet in hand
  std::vector<std::string> notes_;  // that this step emitted
};

}  // namespace limn
