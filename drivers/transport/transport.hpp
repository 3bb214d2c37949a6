#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "drivers/transport/device_control.hpp"
#include "input/base/error.hpp"
#include "input/base/time.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// What a transport tells while it is drained. Times are of CLOCK_MONOTONIC.
class TransportSink {
 public:
  virtual ~TransportSink() = default;
  virtual void report(Timestamp time, std::span<const std::uint8_t> bytes) noexcept = 0;
  virtual void frame(Timestamp time, std::span<const EvdevEvent> events) noexcept = 0;
  /// The device, the kernel or limn dropped so many reports (frames) here; where nobody counts,
  /// `estimated` and at least that many: 0 where a queue was full and perhaps none was dropped.
  virtual void lost(std::uint32_t count, bool estimated) noexcept = 0;
};

/// One open device, whatever brings its bytes. Used by one thread at a time, but for
/// open_control().
class Transport {
 public:
  virtual ~Transport() = default;

  /// What it says of itself; `index` is for the owner to give.
  virtual const TraceDevice& device() const noexcept = 0;

  /// Readable (poll) when drain() has something to do.
  virtual int poll_descriptor() const noexcept = 0;

  enum class State { kOpen, kMore, kGone };

  /// Gives what has come, without waiting, until there is no more or a device that floods has had
  /// its share of kMostReports. Allocates nothing. kMore: there is more, which the poll descriptor
  /// need not show; drain again when others have had their turn. kGone: the device went away; only
  /// destruction makes sense then.
  virtual State drain(TransportSink& sink) noexcept = 0;

  /// What was given since the last drain() did not all arrive: where reports tell changes only, the
  /// next one must tell the whole state. Nothing to do where each report stands for itself.
  virtual void tell_whole_state() noexcept {}

  /// What is asked of the device while it is streamed, from any thread while this lives. The
  /// control may be used in another thread than drain() and outlive this: then the device is gone.
  /// Over USB its requests are answered only while somebody drains. Errors: kMissing where there is
  /// no such way; kIo as open_hidraw_control().
  virtual Expected<std::unique_ptr<DeviceControl>> open_control() const {
    return fail(ErrorCode::kMissing, device().name, "can be read this way, but not asked",
                "read it by hidraw or USB");
  }

  static constexpr int kMostReports = 128;

  /// What was learnt when it was opened, as notes of a recording (TraceNote) that follow its
  /// description: decoding a recording needs no device.
  const std::vector<std::string>& notes() const noexcept { return notes_; }
  void add_note(std::string note) { notes_.push_back(std::move(note)); }

 private:
  std::vector<std::string> notes_;
};

/// Devices that come while others are read.
class Hotplug {
 public:
  virtual ~Hotplug() = default;
  virtual int poll_descriptor() const noexcept = 0;
  /// What has come since, opened. A device that cannot be opened (yet) is left out.
  virtual std::vector<std::unique_ptr<Transport>> arrived() = 0;
};

}  // namespace limn
