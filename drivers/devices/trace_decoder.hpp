#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "drivers/devices/evdev_pen_decoder.hpp"
#include "drivers/devices/loss_tracker.hpp"
#include "drivers/devices/pen_decoder.hpp"
#include "drivers/devices/report_class.hpp"
#include "input/base/error.hpp"
#include "input/sample/motion_sample.hpp"
#include "input/sample/pen_sample.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// What one device of a trace was and did.
struct TraceDeviceSummary {
  DeviceIndex index = 0;
  std::string name;
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  /// Family of the table's row, "HID pen", "kernel pen", "3D mouse", "no pen", or "unknown".
  std::string kind = "unknown";
  PenRange range;
  std::uint64_t samples = 0;
  std::uint64_t repaired_transitions = 0;
  std::uint64_t frames = 0;                                ///< evemu frames
  std::array<std::uint64_t, kReportClassCount> reports{};  ///< by ReportClass
  std::uint64_t undecodable_reports = 0;  ///< salvaged: of a device that limn knows nothing of
  StreamLosses losses;

  std::uint64_t count(ReportClass kind_of_report) const noexcept {
    return reports[static_cast<std::size_t>(kind_of_report)];
  }
  std::uint64_t all_reports() const noexcept;
};

struct TraceSummary {
  std::vector<TraceDeviceSummary> devices;  ///< in the order of their first mention
  std::uint64_t samples = 0;                ///< of all devices, those of stroke CSV included
  std::uint64_t damaged_parts = 0;
  std::vector<Error> damage;  ///< the first kDamageKept of them

  static constexpr std::size_t kDamageKept = 16;
  std::uint64_t repaired_transitions() const noexcept;
  StreamLosses losses() const noexcept;
};

struct TraceDecoderOptions {
  /// Count reports that cannot be decoded instead of stopping at them with an error.
  bool salvage = false;
};

/// A sample of some device, or the end.
using AnySample = std::variant<std::monostate, const PenSample*, const MotionSample*>;

/// Trace -> samples of all its devices, pens and 3D mice, in file order, pulled one by one. Sample
/// times are the file's minus that of its first report, frame or sample. What the trace tells of
/// missing reports (TraceDamage, "lost N" notes) and of replugs is told with their device's next
/// sample, and so are gaps and clocks that jump (LossTracker); a "gone" note takes what is in range
/// out of it; "string" notes before its first report are what the device answered when it was
/// initialised, and its decoder goes by them. Constant memory.
///
/// A pen that leaves silently (PenDecoder) leaves, and the motion of a 3D mouse that falls silent
/// (MotionDecoder) ends, before its device's next report, or at the end,
/// or as soon as a reader that waits says that it was silent for so long (next_until): what each
/// device gives is the same whether it is live, replayed at any speed or decoded at once. Between
/// devices the order is that of the reader's events, and a silent leaving comes out when it shows.
///
///     TraceDecoder decoder(std::move(reader));
///     for (;;) {
///       auto sample = decoder.next();
///       if (!sample) return sample.error();
///       if (*sample == nullptr) break;
///       use(**sample);
///     }
class TraceDecoder {
 public:
  explicit TraceDecoder(std::unique_ptr<TraceReader> reader, TraceDecoderOptions options = {});
  TraceDecoder(TraceDecoder&&) noexcept;
  TraceDecoder& operator=(TraceDecoder&&) noexcept;
  ~TraceDecoder();

  /// The next sample of a pen, valid until the next call, or nullptr at the end. 3D mice are passed
  /// over.
  ///
  /// Errors: the reader's; kMissing for a report of a device without descriptor or table row, and
  /// for a pen's report without a physical size; kUnknown for a report ID that neither descriptor
  /// nor table knows; kLimit for more than kMaxDevices devices; a broken descriptor's. `at` names
  /// the place in the file. After an error the decoder is spent and gives the same error again.
  Expected<const PenSample*> next();

  /// The next sample of any device, valid until the next call. Errors: next()'s.
  Expected<AnySample> next_any();

  /// What was seen so far.
  TraceSummary summary() const;

  static constexpr std::size_t kMaxDevices = kMaxTraceDevices;

 private:
  struct Device;
  using Step = Expected<void>;

  std::unique_ptr<TraceReader> reader_;
  TraceDecoderOptions options_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::span<const PenSample> pending_;
  std::span<const MotionSample> pending_motions_;
  Device* pending_from_ = nullptr;
  PenSample sample_;
  MotionSample motion_;
  std::optional<Timestamp> start_;
  std::optional<Error> error_;
  std::uint64_t samples_ = 0;
  std::uint64_t damaged_parts_ = 0;
  std::vector<Error> damage_;
  bool ended_ = false;

  Step advance();
  Device* next_to_leave() const noexcept;
  void leave_silently(Device& device) noexcept;

  Step take(TraceEnd);
  Step take(const DeviceDescribed& described);
  Step take(const Report& report);
  Step take(const EvdevFrame& frame);
  Step take(const PenSample& sample);
  Step take(const TraceNote& note);
  Step take(const TraceDamage& damage);

  void leave(Device& device) noexcept;
  Expected<Device*> device(DeviceIndex index);
  static void begin_anew(Device& device) noexcept;
  Step prepare(Device& device);
  Step prepare_kernel(Device& device);
  Step refuse(Device& device, Error error);
  Step check(const Device& device, ReportClass kind, std::span<const std::uint8_t> report) const;
  Error located(Error error) const;
  std::string label(const Device& device) const;
  void start_at(Timestamp time) noexcept;
  void give(Device& device, std::span<const PenSample> samples, Timestamp time) noexcept;
  void give(Device& device, std::span<const MotionSample> samples, Timestamp time) noexcept;
};

}  // namespace limn
