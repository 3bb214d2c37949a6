#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/devices/pen_output.hpp"
#include "drivers/devices/pen_spec.hpp"
#include "drivers/devices/report_class.hpp"
#include "input/base/time.hpp"

namespace limn {

/// Silence after which a pen that never reports its leaving has left. In the recordings of such
/// tablets a pen in range falls silent for 46 ms at most (Star 06, VEIKK A30), while it changes its
/// frequency for a barrel switch; one that went away, for 250 ms at least.
inline constexpr Timestamp kLeavingTimeout = std::chrono::milliseconds(100);

/// Decodes the vendor reports of one tablet of the UC-Logic line and its kin: UC-Logic, Huion,
/// XP-Pen, UGEE, VEIKK, KYE. Layouts stand with each family's function; units and ranges come from
/// the rows, one a report ID. Facts: public recordings and the public drivers that the rows name.
///
/// Tilt comes in whole degrees and is turned into the HID frame (positive to the right and towards
/// the user). Where a row promises none, it is given from the first report on that has some: one
/// row may stand for several models. A sample out of range has no position: some of these tablets
/// repeat the last one when the pen is back.
class VendorPenDecoder {
 public:
  /// Precondition: 1 to kMaxPenForms rows, none of Wacom's.
  explicit VendorPenDecoder(std::span<const PenSpec> forms) noexcept;

  /// Pushes the samples of `report`, the ID byte first, into `out`: one, or none where the pen
  /// stays out of range. kUnknownId where no row has its ID.
  ReportClass decode(std::span<const std::uint8_t> report, Timestamp time, PenOutput& out) noexcept;

  /// When the pen will have left if nothing more comes; nothing while it is out of range, where the
  /// tablet reports its leaving, or once it was overtaken().
  std::optional<Timestamp> due() const noexcept;

  /// A report in none of the rows' forms told of the pen last: it decides whether that is in range,
  /// and silence tells nothing of it.
  void overtaken() noexcept { present_ = false; }

  /// The pen lifts and leaves, at `time`.
  void leave(Timestamp time, PenOutput& out) noexcept;

  /// Of the reports that came last; before the first, the first row.
  const PenSpec& spec() const noexcept { return forms_[active_]; }

 private:
  using Bytes = std::span<const std::uint8_t>;

  std::array<PenSpec, kMaxPenForms> forms_;
  std::size_t count_ = 0;
  std::size_t active_ = 0;
  bool tilt_seen_ = false;
  bool bit6_in_range_ = false;  // kUcLogicV1
  bool present_ = false;        // in range, as its own reports told last
  Timestamp last_time_{};

  ReportClass decode_form(Bytes report, Timestamp time, PenOutput& out) noexcept;
  ReportClass uclogic_v1(Bytes report, Timestamp time, PenOutput& out) noexcept;
  ReportClass uclogic_v2(Bytes report, Timestamp time, PenOutput& out) noexcept;
  ReportClass ugee(Bytes report, Timestamp time, PenOutput& out) noexcept;
  ReportClass veikk(Bytes report, Timestamp time, PenOutput& out) noexcept;
  ReportClass kye(Bytes report, Timestamp time, PenOutput& out) noexcept;
  ReportClass kye_mouse(Bytes report, Timestamp time, PenOutput& out) noexcept;
  ReportClass pen_as_mouse(Bytes report, Timestamp time, PenOutput& out) noexcept;

  ReportClass plain_pen(Bytes report, Timestamp time, PenOutput& out) noexcept;
  PenSample start(Timestamp time, Tool tool, bool tip, PenButtons pressed) const noexcept;
  void set_position(PenSample& sample, std::int32_t x, std::int32_t y) const noexcept;
  void set_pressure(PenSample& sample, std::int32_t counts) const noexcept;
  void set_tilt(PenSample& sample, std::int32_t x_degrees, std::int32_t y_degrees) noexcept;
  ReportClass in_range(const PenSample& sample, PenOutput& out) noexcept;
  ReportClass out_of_range(Timestamp time, PenOutput& out) noexcept;
};

}  // namespace limn
