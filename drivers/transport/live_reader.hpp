#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/transport/transport.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// Open devices as a stream of events, which reads like a recording of them.
///
/// One thread sleeps in poll over all devices and drains whichever has something into one lock-free
/// ring; next() takes events out of it in the caller's thread. From a report's bytes to its event
/// nothing is allocated. A second thread closes devices that have gone, which may take a dead one a
/// second. When the caller is slow and the ring is full, reports are dropped,
/// counted, and told by a note "lost N" before the next one. Notes, as hid-recorder files keep
/// them:
///
///   - "lost N": N reports of the device are missing here: the ring was full, or the device says so
///   - "lost? N": some are missing, at least N (0: a queue was full): nobody counts them
///   - "gone": the device went away; it is described again, under its index, when it comes back
///   - "string I ..", right after a description: what the device answered when it was opened
///     (noted_string.hpp), and whatever else its Transport notes
///
/// A device that comes back is known by its ids, its name, its place (physical path) and its own
/// number, where it has one: over Bluetooth the place is the adapter's.
class LiveReader final : public TraceReader {
 public:
  /// Starts reading. `hotplug` may be nothing: then what goes away stays away, and the stream ends
  /// when the last device has gone. Error: kIo where the system refuses a thread or descriptor;
  /// kLimit for more than kMaxTraceDevices devices.
  static Expected<std::unique_ptr<LiveReader>> start(
      std::vector<std::unique_ptr<Transport>> devices, std::unique_ptr<Hotplug> hotplug = nullptr);
  ~LiveReader() override;
  LiveReader(const LiveReader&) = delete;
  LiveReader& operator=(const LiveReader&) = delete;

  /// As if a hid-recorder file were read.
  TraceFormat format() const noexcept override { return TraceFormat::kHidRecorder; }

  /// Waits for the next event. TraceEnd after stop() or the last device's end.
  Expected<TraceEvent> next() override;

  /// Waits no longer than until `deadline` (CLOCK_MONOTONIC, as the times of what is stamped when
  /// it is read) and for what is being read just then. Never an error.
  Expected<std::optional<TraceEvent>> next_until(Timestamp deadline) override;

  std::string place() const override;

  /// What is asked of a device while it is streamed, as Transport::open_control(): the device that
  /// is there now; when it comes back, open it again. From any thread while this lives. Errors:
  /// kMissing: it is away, or is read in a way that asks nothing; kIo: no permission.
  Expected<std::unique_ptr<DeviceControl>> open_control(DeviceIndex device);

  /// Ends the stream: next() gives what has come and then TraceEnd. From any thread or signal
  /// handler.
  void stop() noexcept;

 private:
  class Reading;

  LiveReader();
  std::optional<TraceEvent> take();

  std::unique_ptr<Reading> reading_;
  bool holds_record_ = false;  // the record behind the event last given
  bool ended_ = false;
  DeviceIndex last_device_ = 0;
  std::vector<EvdevEvent> frame_;
  std::string note_;
  std::shared_ptr<const TraceDevice> described_;
};

}  // namespace limn
