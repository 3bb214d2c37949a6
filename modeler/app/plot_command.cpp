#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "drivers/devices/trace_decoder.hpp"
#include "input/stroke/drag_velocity.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/output_file.hpp"
#include "modeler/app/terminal_text.hpp"
#include "modeler/app/trace_input.hpp"
#include "modeler/view/plot.hpp"

namespace limn::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct PlotFileType {
  const char* extension;
  Expected<std::string> (*draw)(const Plot& plot);
};
constexpr std::array kFileTypes = {PlotFileType{".png", plot_to_png},
                                   PlotFileType{".svg", plot_to_svg},
                                   PlotFileType{".pdf", plot_to_pdf}};

/// What stands for missing samples, and other trouble of the stream.
bool is_disturbed(std::uint32_t lost, bool estimated, Disturbances disturbances) {
  disturbances.remove(Disturbance::kRepaired);
  return lost > 0 || estimated || !disturbances.empty();
}

/// A pen's channels over time. The states out of range have none.
class PenPlot {
 public:
  void push(const PenSample& sample) {
    if (sample.tool == Tool::kTabletMouse && sample.state == PenState::kOutOfRange) return;
    const bool away = sample.state == PenState::kOutOfRange;
    const auto value = [&](PenAxis axis, double number) {
      if (away || !sample.axes.has(axis)) return kNone;
      seen_.add(axis);
      return number;
    };
    const std::array<double, kChannels> values = {
        value(PenAxis::kX, sample.x_mm),
        value(PenAxis::kY, sample.y_mm),
        value(PenAxis::kPressure, sample.pressure),
        value(PenAxis::kTiltX, sample.tilt_x_rad / kDegree),
        value(PenAxis::kTiltY, sample.tilt_y_rad / kDegree),
        value(PenAxis::kTwist, sample.twist_rad / kDegree),
        value(PenAxis::kDistance, sample.distance)};
    const bool marked = is_disturbed(sample.lost, sample.lost_estimated, sample.disturbances);
    track_.push(to_seconds(sample.time), values,
                {.begins_anew = away, .shaded = in_contact(sample.state), .marked = marked});
  }

  PlotDevice take(std::string name) && {
    PlotDevice device{std::move(name), std::move(track_), "in contact", "reports lost", {}, {}};
    device.panels.push_back({"position, mm", {{"x", 0}, {"y", 1}}, {}, {}, {}});
    if (seen_.has(PenAxis::kPressure)) {
      device.panels.push_back({"pressure, of the largest", {{"pressure", 2}}, {}, {}, {{0, 1}}});
    }
    if (seen_.has(PenAxis::kTiltX) || seen_.has(PenAxis::kTiltY)) {
      device.panels.push_back(
          {"tilt, degrees", {{"tilt x", 3}, {"tilt y", 4}}, {}, {}, {{-60, 60}}});
    }
    if (seen_.has(PenAxis::kTwist)) {
      device.panels.push_back({"twist, degrees", {{"twist", 5}}, {}, {}, {{0, 360}}});
    }
    if (seen_.has(PenAxis::kDistance)) {
      device.panels.push_back({"distance, of the range", {{"distance", 6}}, {}, {}, {{0, 1}}});
    }
    return device;
  }

 private:
  static constexpr std::size_t kChannels = 7;
  PlotTrack track_{kChannels};
  PenAxes seen_;
};

/// Deflection and velocity of a 3D mouse over time, and the way that it led.
class MousePlot {
 public:
  explicit MousePlot(const DragOptions& options) : options_(options), drag_(options) {}

  void push(const MotionSample& sample) {
    const bool anew = sample.disturbances.has(Disturbance::kReset);
    if (anew) drag_ = DragVelocity(options_);
    const Drag drag = drag_.push(sample);
    std::array<double, kChannels> values{};
    for (std::size_t i = 0; i < kMotionAxes; ++i) {
      values[i] = sample.deflection[i] - drag_.rest().bias(i);  // as the dead zone lies around it
      values[kMotionAxes + i] = i < 3 ? drag.mm_per_s[i] : drag.rad_per_s[i - 3];
      noise_[i] = std::max(noise_[i], drag_.rest().noise(i));
    }
    // As DragVelocity has it: what was not told for longer was held until this report.
    if (last_ && !anew && sample.time - *last_ > DragVelocity::kLongestStep) {
      track_.push(to_seconds(sample.time), before_);
    }
    last_ = sample.time;
    before_ = values;
    const bool marked = is_disturbed(sample.lost, sample.lost_estimated, sample.disturbances);
    track_.push(to_seconds(sample.time), values,
                {.begins_anew = anew, .shaded = !sample.buttons.empty(), .marked = marked});
    at_ += Eigen::Vector3d(drag.mm[0], drag.mm[1], drag.mm[2]);
    from_above_.push({at_.x(), at_.y()});
    from_front_.push({at_.x(), at_.z()});
  }

  PlotDevice take(std::string name) && {
    PlotDevice device{
        std::move(name), std::move(track_), "a button pressed", "reports lost", {}, {}};
    const auto panel = [&](const char* title, std::size_t first, bool rotation) {
      const std::array<const char*, 6> labels = {"x", "y", "z", "rx", "ry", "rz"};
      PlotPanel out{title, {}, {}, {}, {}};
      for (std::size_t i = 0; i < 3; ++i) {
        out.lines.push_back({labels[i + (rotation ? 3 : 0)], first + i});
      }
      return out;
    };
    device.panels.push_back(panel("translation, of full deflection", 0, false));
    device.panels.push_back(panel("rotation, of full deflection", 3, true));
    for (PlotPanel& one : device.panels) {
      double noise = 0;
      for (const PlotLine& line : one.lines) noise = std::max(noise, noise_[line.channel]);
      const double edge = std::max(options_.dead_zone, noise);
      if (edge > 0) one.levels = {-edge, edge};
      one.level_label = noise > options_.dead_zone ? "most noise at rest" : "dead zone";
    }
    device.panels.push_back(panel("velocity, mm/s", 6, false));
    device.panels.push_back(panel("angular velocity, rad/s", 9, true));
    device.ways.push_back(
        {"path from above, mm (from green to orange)", "x", "y (away)", from_above_.points()});
    device.ways.push_back(
        {"path from the front, mm (from green to orange)", "x", "z", from_front_.points()});
    return device;
  }

 private:
  static constexpr std::size_t kChannels = 2 * kMotionAxes;
  DragOptions options_;
  DragVelocity drag_;
  PlotTrack track_{kChannels};
  std::optional<Timestamp> last_;
  std::array<double, kChannels> before_{};
  PlotPath from_above_;
  PlotPath from_front_;
  Eigen::Vector3d at_ = Eigen::Vector3d::Zero();
  std::array<double, kMotionAxes> noise_{};
};

/// "Huion H610 Pro (256c:006e), 2100 samples".
std::string title_of(const TraceDeviceSummary& device) {
  std::string text = device.name.empty() ? device.kind : printable(device.name);
  if (device.vendor != 0 || device.product != 0) {
    char ids[16];
    std::snprintf(ids, sizeof ids, "%04x:%04x", device.vendor, device.product);
    text += std::string(" (") + ids + ")";
  }
  return text + ", " + count_of(device.samples, "sample") + losses_text(device.losses);
}

tl::expected<Plot, Failure> make_plot(const PlotArguments& arguments) {
  auto reader = open_trace_input(arguments.trace);
  if (!reader) return tl::unexpected(std::move(reader.error()));
  TraceDecoder decoder(std::move(*reader), {.salvage = arguments.trace.salvage});
  std::map<DeviceIndex, PenPlot> pens;
  std::map<DeviceIndex, MousePlot> mice;
  for (;;) {
    auto sample = decoder.next_any();
    if (!sample) {
      return in_file(arguments.trace.path, Expected<Plot>(tl::unexpected(sample.error())));
    }
    if (const auto* const pen = std::get_if<const PenSample*>(&*sample)) {
      pens[(*pen)->device].push(**pen);
    } else if (const auto* const motion = std::get_if<const MotionSample*>(&*sample)) {
      mice.try_emplace((*motion)->device, arguments.drag).first->second.push(**motion);
    } else {
      break;
    }
  }
  const TraceSummary summary = decoder.summary();
  Plot plot;
  plot.title = arguments.trace.path == "-"
                   ? "standard input"
                   : printable(std::filesystem::path(arguments.trace.path).filename().string());
  for (const TraceDeviceSummary& device : summary.devices) {
    if (const auto pen = pens.extract(device.index)) {
      plot.devices.push_back(std::move(pen.mapped()).take(title_of(device)));
    }
    if (const auto mouse = mice.extract(device.index)) {
      plot.devices.push_back(std::move(mouse.mapped()).take(title_of(device)));
    }
  }
  for (auto& [index, pen] : pens) {  // of a file that has no devices
    plot.devices.push_back(std::move(pen).take("pen"));
  }
  std::fprintf(stderr, "%s\n", summarise(summary).c_str());
  if (plot.devices.empty()) {
    return in_file(arguments.trace.path,
                   Expected<Plot>(fail(ErrorCode::kMissing, "", "holds no samples to plot",
                                       "give a recording of a pen or a 3D mouse in use")));
  }
  return plot;
}

}  // namespace

Outcome run_plot(const PlotArguments& arguments) {
  const std::string extension = std::filesystem::path(arguments.output).extension().string();
  const auto* const type =
      std::find_if(kFileTypes.begin(), kFileTypes.end(),
                   [&](const PlotFileType& one) { return one.extension == extension; });
  if (type == kFileTypes.end()) {
    return usage_error("'" + arguments.output + "' has no extension of a picture",
                       "choose .png, .svg or .pdf");
  }
  auto file = in_file(arguments.output, OutputFile::open(arguments.output));
  if (!file) return tl::unexpected(std::move(file.error()));
  const auto plot = make_plot(arguments);
  if (!plot) return tl::unexpected(plot.error());
  return in_file(arguments.output,
                 type->draw(*plot)
                     .and_then([&](const std::string& bytes) { return file->write(bytes); })
                     .and_then([&] { return file->commit(); }));
}

}  // namespace limn::app
