#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "drivers/hid/descriptor_parser.hpp"
#include "drivers/hid/field_reader.hpp"
#include "drivers/hid/units.hpp"

namespace limn::hid {

/// Who writes in a digitizer collection.
enum class Transducer : std::uint8_t {
  kStylus,
  kPuck,  ///< a tablet mouse: in range and buttons, no pressure
  kFinger,
};

/// A measured axis: its reader (may be absent) and the way from its counts to limn's unit.
struct AxisReader {
  FieldReader reader;
  LinearMap map;
  /// Whether `map` rests on a unit that the descriptor declares. Without it: positions stay in
  /// counts from the Logical Minimum (the size must come from elsewhere), angles are taken as
  /// degrees, tenths or hundredths (angle_map).
  bool has_unit = false;

  explicit operator bool() const noexcept { return reader.present(); }
};

/// Where one input report carries one transducer. Absent members have absent readers, which read
/// nothing, so a decoder needs no cases. Plain data after compilation: reading allocates nothing.
///
/// Vendor pages count as the standard usages that they repeat (standard_usage); Wacom's usages
/// without a twin have members of their own.
struct PenLayout {
  Transducer transducer = Transducer::kStylus;
  std::uint8_t report_id = 0;
  bool numbered = false;
  std::uint32_t byte_length = 0;               ///< of the declared report, ID byte included
  CollectionIndex collection = kNoCollection;  ///< the stylus, pen or finger collection
  Usage application;                           ///< usage of the top-level collection around it

  AxisReader x;                ///< mm, 0 at the Logical Minimum; counts without has_unit
  AxisReader y;                ///< mm, like x
  AxisReader pressure;         ///< 0 to 1 over the logical range (Tip Pressure)
  AxisReader barrel_pressure;  ///< 0 to 1
  AxisReader tilt_x;           ///< rad
  AxisReader tilt_y;           ///< rad
  AxisReader azimuth;          ///< rad
  AxisReader altitude;         ///< rad
  AxisReader twist;            ///< rad, as declared (Wacom: -180 to 180 degrees)
  AxisReader distance;         ///< 0 (touching) to 1 (Wacom's Distance, or Z, which falls with it)
  AxisReader scan_time;        ///< s
  AxisReader wheel;            ///< 0 to 1 (Wacom's airbrush finger wheel)

  FieldReader tip_switch;
  FieldReader in_range;
  FieldReader barrel_switch;
  FieldReader secondary_barrel_switch;
  FieldReader barrel_switch3;  ///< Wacom
  FieldReader eraser;
  FieldReader invert;
  FieldReader sense;       ///< Wacom: in the wider proximity in which the tool id is known
  FieldReader data_valid;  ///< 0 means: ignore the coordinates
  FieldReader confidence;
  FieldReader contact_count;
  FieldReader battery;      ///< percent where its logical maximum is 100
  FieldReader serial;       ///< up to 64 bits: read_bits
  FieldReader serial_high;  ///< the upper 32 bits where `serial` has the lower 32
  FieldReader tool_type;    ///< Wacom
  FieldReader sequence;     ///< Wacom: counts reports, wraps at its size
  /// Buttons 1 to 5: of a puck left, right, middle ..; absent in most stylus collections. Where a
  /// pen declares no Tip Switch but Button 1 (pens in a mouse's collection), tip_switch and the
  /// barrel switches read Buttons 1 to 3.
  std::array<FieldReader, 5> buttons;

  /// Whether `report` is this layout's: by its first byte where reports are numbered, else always.
  bool matches(std::span<const std::uint8_t> report) const noexcept {
    return !numbered || (!report.empty() && report[0] == report_id);
  }
};

/// Every transducer with absolute X and Y in an input report, by report, then place: pens, tablet
/// mice, and the fingers of touch screens and pads.
///
/// One collection that the tables call Stylus, Pen, Puck or Finger is one transducer (a Stylus in a
/// touch screen with nothing but a contact is a finger, too). Where a top-level collection holds
/// none of these, it is one itself: of fingers if it is a touch screen or touch pad, else a pen if
/// it has a tip pressure (real pens pose as mice or on vendor pages) or is a digitizer with a tip
/// switch or in-range bit. Usages directly in the top-level collection (scan time, contact count)
/// belong to each transducer of their report. At most kMaxTransducers.
std::vector<PenLayout> transducer_layouts(const ReportDescriptor& descriptor);

/// The pens and tablet mice among them: what limn decodes to pen samples. Those on standard pages
/// come before those on vendor pages, these before those that pose as mice.
std::vector<PenLayout> pen_layouts(const ReportDescriptor& descriptor);

/// Real descriptors have up to 16.
inline constexpr std::size_t kMaxTransducers = 256;

}  // namespace limn::hid
