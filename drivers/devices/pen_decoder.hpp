#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "drivers/devices/generic_pen.hpp"
#include "drivers/devices/pen_output.hpp"
#include "drivers/devices/pen_parameters.hpp"
#include "drivers/devices/pen_spec.hpp"
#include "drivers/devices/report_class.hpp"
#include "drivers/devices/vendor_pen_decoder.hpp"
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
/// what the device said when it was initialised, else its row in the tables, else the pen that its
/// descriptor explains. Rows of reports that the descriptor does not declare count only once such a
/// report comes (another interface's pen), and UC-Logic's give way to a descriptor that explains
/// their report, sizes included: that of the tablet as it was plugged in, or one that the Linux
/// kernel put in its place. Only legal state transitions come out (PenStateMachine).
///
/// A pen that leaves silently (PenSpec::leaves_silently) is taken out of range kLeavingTimeout
/// after its last report, at that very time: a sample of the stream like any other, whoever asks
/// for it, decode() before a later report or advance().
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

  /// The same with all that is known. `identity.descriptor_bytes` 0: the descriptor's own length.
  static Expected<PenDecoder> make(const PenIdentity& identity,
                                   std::span<const std::uint8_t> report_descriptor,
                                   const PenParameters* parameters = nullptr);

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

  /// The samples that are due by `now`, in the time of the reports: to be called when none came
  /// until due(). Valid until the next call.
  std::span<const PenSample> advance(DeviceIndex device, Timestamp now) noexcept;

  /// When the next sample comes without a report, if one does.
  std::optional<Timestamp> due() const noexcept {
    return vendor_ ? vendor_->due() : std::optional<Timestamp>();
  }

  /// The device went away: what is in range leaves, at `time`.
  std::span<const PenSample> disconnect(DeviceIndex device, Timestamp time) noexcept;

  /// Whether samples can come at all.
  bool has_pen() const noexcept { return spec() != nullptr || !generic_.layouts().empty(); }

  /// The table's row (completed by what the device said), or nullptr where the descriptor decides.
  /// Where rows differ by report, that of the last report. Valid as long as the decoder stays.
  const PenSpec* spec() const noexcept {
    if (vendor_ && !speaks_for_itself_) return &vendor_->spec();
    return wacom_ ? &wacom_->spec() : nullptr;
  }

  /// All zero without a pen; of a device with several rows, of spec().
  PenRange range() const noexcept;

  /// What its samples can have, with the pen that can do most: of a table's row as its family gives
  /// it, else as the descriptor declares it. Empty without a pen.
  PenAxes axes() const noexcept;

  /// Illegal state transitions that the device made and that were repaired.
  std::uint64_t repaired_transitions() const noexcept { return output_->machine().repaired(); }

 private:
  PenDecoder();

  std::optional<WacomDecoder> wacom_;
  std::optional<VendorPenDecoder> vendor_;
  bool speaks_for_itself_ = false;  // the descriptor, of no report in vendor_'s rows, and none came
  GenericPen generic_;
  bool numbered_ = false;
  std::array<ReportClass, 256> classes_;  // of the descriptor's input reports, by ID
  std::unique_ptr<PenOutput> output_;

  bool declares(std::uint8_t report_id) const noexcept;
  void choose_rows(const PenIdentity& identity, const PenParameters* parameters,
                   bool has_descriptor);
  void push_due(Timestamp now) noexcept;
  ReportClass class_in_descriptor(std::span<const std::uint8_t> report) const noexcept;
};

}  // namespace limn
