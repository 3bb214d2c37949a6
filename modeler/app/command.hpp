#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "drivers/devices/device_traits.hpp"
#include "drivers/transport/device_listing.hpp"
#include "input/base/error.hpp"
#include "input/stroke/drag_velocity.hpp"
#include "modeler/app/output_format.hpp"

namespace limn::app {

/// An Error and the file it is about ("-" for a standard stream, empty for none).
struct Failure {
  std::string file;
  Error error;
  bool usage = false;  ///< the command line is wrong, not the data
};

/// How a command ends. main() prints a failure as one line and exits with 1, or 2 for usage.
using Outcome = tl::expected<void, Failure>;

/// A wrong command line: what is wrong, and what to write instead.
inline tl::unexpected<Failure> usage_error(std::string what, std::string remedy) {
  return tl::unexpected<Failure>(
      Failure{"", Error{ErrorCode::kUnknown, "", std::move(what), std::move(remedy)}, true});
}

/// Gives an Expected of a library the file that it is about.
template <class T>
tl::expected<T, Failure> in_file(const std::string& file, Expected<T> result) {
  if (result) {
    if constexpr (std::is_void_v<T>) {
      return {};
    } else {
      return std::move(*result);
    }
  }
  return tl::unexpected<Failure>(Failure{file, std::move(result.error()), false});
}

/// Which recording to read, and what to know of it beforehand.
struct TraceArguments {
  std::string path;
  std::string descriptor_path;  ///< --descriptor, empty for none
  std::uint16_t vendor = 0;     ///< --id
  std::uint16_t product = 0;
  bool salvage = false;
};

struct DescriptorArguments {
  std::string path;
  OutputFormat format = OutputFormat::kText;
};

struct DecodeArguments {
  TraceArguments trace;
  DragOptions drag;  ///< of 3D mice
  OutputFormat format = OutputFormat::kText;
};

struct ConvertArguments {
  TraceArguments trace;
  std::string output;
  std::optional<std::uint32_t>
      device;  ///< the recording's number of the one to keep; all unless set
};

struct DevicesArguments {
  bool all = false;  ///< what is no pen, too
  OutputFormat format = OutputFormat::kText;
};

struct DoctorArguments {
  OutputFormat format = OutputFormat::kText;
};

/// Which devices to open, and how.
struct LiveArguments {
  std::string device;                  ///< VID:PID[:N] or a node; empty for all of `kind`
  DeviceKind kind = DeviceKind::kPen;  ///< what is wanted where no device is named
  std::optional<Backend> backend;      ///< none: hidraw where it may be read, else what can be
  bool initialize = true;
  bool from_spacenavd = true;  ///< false: its motions are of no use
  bool waits = false;          ///< for the first one, where none is here yet
};

struct MonitorArguments {
  LiveArguments live;
  DragOptions drag;    ///< of 3D mice
  double seconds = 0;  ///< 0: until a signal
  OutputFormat format = OutputFormat::kText;
};

struct RecordArguments {
  LiveArguments live;
  std::string output;
  double seconds = 0;  ///< 0: until a signal
};

/// How other programs get a device: at most one way.
struct LinkArguments {
  bool uhid = false;
  std::optional<std::uint16_t> usbip_port;  ///< 0: any that is free
  bool wanted() const noexcept { return uhid || usbip_port; }
};

struct ReplayArguments {
  TraceArguments trace;
  DragOptions drag;  ///< of 3D mice
  double speed = 1;
  LinkArguments link;  ///< none: samples go to standard output
  OutputFormat format = OutputFormat::kText;
};

struct PlotArguments {
  TraceArguments trace;
  DragOptions drag;  ///< of 3D mice
  std::string output;
};

struct SpnavServerArguments {
  LiveArguments live;
  DragOptions drag;      ///< but for its speeds
  std::string socket;    ///< --socket; empty: where this user may
  TraceArguments trace;  ///< --replay; no path: live devices
  double speed = 1;
};

struct SketchArguments {
  TraceArguments trace;
  double tolerance_mm = 0.1;
  std::vector<std::string> outputs;
  OutputFormat format = OutputFormat::kText;
};

struct SimulateArguments {
  std::string device;
  std::string drawing;  ///< empty: "signature" of pens
  std::string motion;   ///< empty: the first of 3D mice
  std::vector<std::string> faults;
  std::uint64_t seed = 1;
  bool list = false;
  LinkArguments link;
  std::string output;  ///< none where there is a link
  OutputFormat format = OutputFormat::kText;
};

Outcome run_descriptor(const DescriptorArguments& arguments);
Outcome run_convert(const ConvertArguments& arguments);
Outcome run_decode(const DecodeArguments& arguments);
Outcome run_devices(const DevicesArguments& arguments);
Outcome run_doctor(const DoctorArguments& arguments);
Outcome run_monitor(const MonitorArguments& arguments);
Outcome run_plot(const PlotArguments& arguments);
Outcome run_record(const RecordArguments& arguments);
Outcome run_replay(const ReplayArguments& arguments);
Outcome run_sketch(const SketchArguments& arguments);
Outcome run_simulate(const SimulateArguments& arguments);
Outcome run_spnav_server(const SpnavServerArguments& arguments);

}  // namespace limn::app
