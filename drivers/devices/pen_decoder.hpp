#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "drivers/devices/generic_pen.hpp"
#include "drivers/devices/pen_output.hpp"
#include "drivers/devices/pen_spec.hpp"
#include "drivers/devices/report_class.hpp"
#include "drivers/devices/wacom_decoder.hpp"
#include "input/base/error.hpp"
#include "input/sample/pen_sample.hpp"
#include "input/sample/report.hpp"

namespace limn {

/// The range of a device's samples as its table or its descriptor gives it.
struct PenRange {
  std::int64_t x_min = 0;  ///< counts, as in RawCounts
  std::int64_t x_max = 0;
  std::int64_t y_min = 0;
  std::int64_t y_max = 0;
  std::int64_t pressure_max = 0;  ///< counts; 0 where there is no pressure
  double width_mm = 0;
  double height_mm = 0;
};

/// Report -> PenSamples, one decoder a device (a USB interface). Chosen by what is most specific:
/// the device's row in the tables, else the pen that its descriptor explains. Only legal state
/// transitions come out (PenStateMachine).
///
/// decode() allocates nothing, never fails and uses + - * / and square roots only: the same reports
/// give samples of the same bits on every machine. Movable, not copyable. Not thread-safe.
class PenDecoder {
 public:
  /// A decoder for the device with these USB ids and this report descriptor (empty: unknown). A
  /// device that has no pen gets one too: it tells what its reports are and gives no samples.
  /// Error: kMissing where neither table nor descriptor knows the device; the parser's errors for a
  /// descriptor that is needed and broken.
  static Expected<PenDecoder> make(std::uint16_t vendor, std::uint16_t product,
                                   std::span<const std::uint8_t> report_descriptor);

  struct Decoded {
    ReportClass kind = ReportClass::kOther;
    std::span<const PenSample> samples;  ///< valid until the next call
  };

  /// The samples of one report: at most PenOutput::kCapacity, mostly one.
  Decoded decode(const Report& report) noexcept;

  /// The same, calling `sink(const PenSample&)` for each.
  template <class Sink>
  ReportClass decode(const Report& report, Sink&& sink) {
    const Decoded decoded = decode(report);
    for (const PenSample& sample : decoded.samples) sink(sample);
    return decoded.kind;
  }

  /// The device went away: what is in range leaves, at `time`.
  std::span<const PenSample> disconnect(DeviceIndex device, Timestamp time) noexcept;

  /// Whether samples can come at all.
  bool has_pen() const noexcept { return wacom_.has_value() || !generic_.layouts().empty(); }

  /// The table's row, or nullptr where the descriptor decides.
  const PenSpec* spec() const noexcept { return wacom_ ? &wacom_->spec() : nullptr; }

  /// All zero without a pen.
  PenRange range() const noexcept;

  /// Illegal state transitions that the device made and that were repaired.
  std::uint64_t repaired_transitions() const noexcept { return output_->machine().repaired(); }

 private:
  explicit PenDecoder(const PenSpec* spec);

  std::optional<WacomDecoder> wacom_;
  GenericPen generic_;
  bool numbered_ = false;
  std::array<ReportClass, 256> classes_;  // of the descriptor's input reports, by ID
  std::unique_ptr<PenOutput> output_;

  ReportClass class_in_descriptor(std::span<const std::uint8_t> report) const noexcept;
};

}  // namespace limn
