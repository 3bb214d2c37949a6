#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/devices/pen_output.hpp"
#include "drivers/devices/pen_spec.hpp"
#include "drivers/devices/report_class.hpp"
#include "input/base/time.hpp"

namespace limn {

/// Decodes the vendor reports of one Wacom tablet, whose descriptors call them vendor data. Layouts
/// stand with each family's function; units and ranges come from the table's row. Facts: public
/// recordings and the Linux kernel's wacom driver.
///
/// Positions and tilts are in the HID frame as the devices send them: tilt X positive to the right,
/// tilt Y positive towards the user, in whole degrees. A tool's serial number, announced when it
/// enters, goes with all its samples. Where packets of one tool carry different axes in turn (art
/// pen, airbrush), a sample keeps the other packet's last values.
///
/// Before a tool has said what it is, hovering is not told (an eraser would start as a pen), but a
/// packet with tool data, as in a recording that starts amid a stroke, is taken for the pen's, or
/// the mouse's if it has a mouse's form; the serial stays absent.
class WacomDecoder {
 public:
  /// `spec` must outlive the decoder (pen_specs() does).
  explicit WacomDecoder(const PenSpec& spec) noexcept : spec_(&spec) {}

  /// Pushes the samples of `report`, the ID byte first, into `out`. kUnknownId where the family
  /// has no such report.
  ReportClass decode(std::span<const std::uint8_t> report, Timestamp time, PenOutput& out) noexcept;

  const PenSpec& spec() const noexcept { return *spec_; }

 private:
  using Bytes = std::span<const std::uint8_t>;

  // A tool that has told its id: two at once on the first Intuos, else one.
  struct ToolSlot {
    bool known = false;
    std::uint32_t id = 0;
    std::uint64_t serial = 0;
    Tool tool = Tool::kPen;
  };

  const PenSpec* spec_;
  PenSample held_;           // the axes that hold until the tool leaves
  bool present_ = false;     // a tool is in range and was told
  bool identified_ = false;  // held_'s tool is what it said it is, not assumed
  std::uint8_t active_slot_ = 0;
  std::array<ToolSlot, 2> slots_;
  Timestamp bundle_time_{};  // of the last bundled report
  bool has_bundle_time_ = false;

  ReportClass decode_pen(Bytes report, Timestamp time, PenOutput& out) noexcept;

  // wacom_graphire.cpp
  void penpartner(Bytes report, Timestamp time, PenOutput& out) noexcept;
  void graphire(Bytes report, Timestamp time, PenOutput& out) noexcept;
  void graphire_tool(Bytes report, PenSample& sample) const noexcept;
  void graphire_mouse(Bytes report, PenSample& sample) const noexcept;
  // wacom_displays.cpp
  void pl(Bytes report, Timestamp time, PenOutput& out) noexcept;
  void ptu(Bytes report, Timestamp time, PenOutput& out) noexcept;
  void dtu(Bytes report, Timestamp time, PenOutput& out) noexcept;
  void dtus(Bytes report, Timestamp time, PenOutput& out) noexcept;
  void tablet_pc(Bytes report, Timestamp time, PenOutput& out) noexcept;
  // wacom_bamboo.cpp
  void bamboo(Bytes report, Timestamp time, PenOutput& out) noexcept;
  // wacom_intuos.cpp
  void intuos(Bytes packet, Timestamp time, PenOutput& out) noexcept;
  void intuos_enter(Bytes packet, std::uint8_t slot, Timestamp time, PenOutput& out) noexcept;
  void intuos_leave(std::uint8_t slot, Timestamp time, PenOutput& out) noexcept;
  void intuos_general(Bytes packet, std::uint8_t slot, Timestamp time, PenOutput& out) noexcept;
  bool intuos_take_tool(std::uint8_t slot, unsigned packet_type, Timestamp time,
                        PenOutput& out) noexcept;
  void intuos_pen_axes(Bytes packet, PenSample& sample) const noexcept;
  // wacom_bluetooth.cpp
  void intuos4_bundle(Bytes report, Timestamp time, PenOutput& out) noexcept;
  void frame_bundle(Bytes report, Timestamp time, PenOutput& out) noexcept;
  void frame(Bytes bytes, std::uint32_t tool_id, Timestamp time, PenOutput& out) noexcept;
  Timestamp bundle_period(Timestamp time, int frames) noexcept;

  // wacom_decoder.cpp: what all families share
  void set_position(PenSample& sample, std::int32_t x, std::int32_t y) const noexcept;
  void set_pressure(PenSample& sample, std::int32_t counts) const noexcept;
  void set_distance(PenSample& sample, std::int32_t counts) const noexcept;
  void hold(const PenSample& sample, PenOutput& out) noexcept;
  void leave(Timestamp time, PenOutput& out) noexcept;
  void leave_at(Tool tool, std::int32_t x, std::int32_t y, Timestamp time, PenOutput& out) noexcept;
};

/// What an Intuos tool id (20 bits) stands for: mice and lens cursors by the list of known ids,
/// else the eraser by bit 3.
Tool wacom_tool(std::uint32_t id) noexcept;

/// Whether the tool knows its rotation about its own axis.
bool is_wacom_art_pen(std::uint32_t id) noexcept;

}  // namespace limn
