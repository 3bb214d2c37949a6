#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/devices/pen_output.hpp"
#include "drivers/devices/report_class.hpp"
#include "drivers/devices/scan_time.hpp"
#include "drivers/hid/pen_layout.hpp"
#include "input/base/time.hpp"

namespace limn {

/// Decodes the pen reports that a descriptor itself explains, with the meaning that the Windows pen
/// guidelines give to the switches:
///
///     In Range or Sense, else any report    in range (a device without In Range never leaves)
///     Tip Switch, else pressure above 0     in contact
///     Invert                                the eraser's end is down, in range
///     Eraser                                the eraser touches
///
/// Data Valid 0, and Null State, take the values away. Positions in mm from the descriptor's
/// physical ranges. Reports that a sequence number, or else a Scan Time, shows missing are a gap
/// and counted as `lost`; a Scan Time that disagrees with the reports' times is a clock jump.
class GenericPen {
 public:
  GenericPen() = default;
  /// Layouts in the order of hid::pen_layouts: the first one in range speaks where several match.
  explicit GenericPen(std::vector<hid::PenLayout> layouts);

  /// The layouts whose positions have a physical size: those that give samples.
  std::span<const hid::PenLayout> layouts() const noexcept { return {layouts_.data(), sized_}; }

  /// Pushes at most one sample. kUnknownId where no layout has the report's ID, kNoSize where it
  /// has no physical size, kTooShort where the report ends before the position.
  ReportClass decode(std::span<const std::uint8_t> report, Timestamp time, PenOutput& out) noexcept;

 private:
  using Bytes = std::span<const std::uint8_t>;

  std::vector<hid::PenLayout> layouts_;  // those with a size first
  std::size_t sized_ = 0;
  std::optional<std::int64_t> last_sequence_;
  ScanTime scan_time_;

  const hid::PenLayout* layout_for(Bytes report) const noexcept;
  std::uint32_t count_lost(const hid::PenLayout& layout, Bytes report) noexcept;
  void read_scan_time(const hid::PenLayout& layout, Bytes report, PenSample& sample) noexcept;
};

}  // namespace limn
