#include <algorithm>
#include <vector>

#include "firmware_sim/devices/drawings.hpp"
#include "firmware_sim/devices/pen_session.hpp"
#include "input/trace/hid_recorder_writer.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/nearest_name.hpp"
#include "modeler/app/output_file.hpp"
#include "modeler/app/standard_output.hpp"
#include "modeler/app/table.hpp"

namespace limn::app {
namespace {

constexpr std::string_view kPen = "pen";

Outcome print_list(OutputFormat format) {
  Table table({{"kind", "kind"}, {"name", "name"}, {"description", "description"}});
  table.add({std::string("device"), std::string(kPen),
             std::string("generic HID pen tablet: 210 x 148 mm, 5080 lpi, tilt, 200 Hz")});
  for (const firmware::DrawingInfo& drawing : firmware::drawings()) {
    table.add(
        {std::string("drawing"), std::string(drawing.name), std::string(drawing.description)});
  }
  return print(table.print(format));
}

/// The head of the recording: what USB tells of the device before its first report.
TraceDevice pen_device() {
  const auto descriptor = firmware::HidPen::report_descriptor();
  TraceDevice device;
  device.name = firmware::HidPen::kIdentity.name;
  device.physical_path = "limn/simulated/input0";
  device.bus = 3;  // USB
  device.vendor = firmware::HidPen::kIdentity.vendor;
  device.product = firmware::HidPen::kIdentity.product;
  device.report_descriptor.assign(descriptor.begin(), descriptor.end());
  return device;
}

Expected<void> record(firmware::PenSession session, ByteSink& sink) {
  HidRecorderWriter writer(sink);
  if (auto written = writer.describe(pen_device()); !written) return written;
  firmware::TimedReport report;
  while (session.next(report)) {
    if (auto written = writer.write(Report{0, report.time, report.bytes}); !written) return written;
  }
  return {};
}

}  // namespace

Outcome run_simulate(const SimulateArguments& arguments) {
  if (!arguments.device.empty() && arguments.device != kPen) {
    return usage_error("there is no simulated device '" + arguments.device + "'",
                       suggest(arguments.device, std::span(&kPen, 1)));
  }
  if (arguments.list) return print_list(arguments.format);
  if (arguments.device.empty()) return usage_error("no device is named", "limn simulate pen ..");
  if (arguments.output.empty()) {
    return usage_error("no file is named", "add -o FILE, or -o - for standard output");
  }
  const auto drawing = firmware::find_drawing(arguments.drawing);
  if (!drawing) {
    std::vector<std::string_view> names;
    for (const firmware::DrawingInfo& known : firmware::drawings()) names.push_back(known.name);
    return usage_error("there is no drawing '" + arguments.drawing + "'",
                       suggest(arguments.drawing, names));
  }

  auto file = in_file(arguments.output, OutputFile::open(arguments.output));
  if (!file) return tl::unexpected(std::move(file.error()));
  // The recording goes to the file in one write: a pipe or a full disk is told once, at its end.
  StringSink recording;
  auto written = record(firmware::PenSession(*drawing, arguments.seed), recording)
                     .and_then([&] { return file->write(recording.text()); })
                     .and_then([&] { return file->commit(); });
  return in_file(arguments.output, written);
}

}  // namespace limn::app
