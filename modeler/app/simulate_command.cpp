#include <algorithm>
#include <vector>

#include "drivers/devices/pen_initialization.hpp"
#include "drivers/transport/pen_setup.hpp"
#include "firmware_sim/devices/catalogue.hpp"
#include "firmware_sim/devices/drawings.hpp"
#include "firmware_sim/devices/faults.hpp"
#include "firmware_sim/devices/faulty_device.hpp"
#include "firmware_sim/devices/motions.hpp"
#include "firmware_sim/devices/pen_session.hpp"
#include "firmware_sim/link/in_memory.hpp"
#include "firmware_sim/link/linux_name.hpp"
#include "firmware_sim/link/standard_requests.hpp"
#include "input/trace/hid_recorder_writer.hpp"
#include "modeler/app/bus_control.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/device_link.hpp"
#include "modeler/app/nearest_name.hpp"
#include "modeler/app/output_file.hpp"
#include "modeler/app/standard_output.hpp"
#include "modeler/app/table.hpp"

namespace limn::app {
namespace {

using firmware::HostEvent;
using firmware::InMemoryHost;
using std::chrono::microseconds;

/// So that a report that is due with the hand's last movement is still polled for.
constexpr microseconds kLastPoll{100'000};

constexpr std::string_view kPen = "pen";
constexpr const char* kUsualDrawing = "signature";

Outcome print_list(OutputFormat format) {
  Table table({{"kind", "kind"}, {"name", "name"}, {"description", "description"}});
  const auto add = [&table](const char* kind, const auto& infos) {
    for (const auto& info : infos) {
      table.add({std::string(kind), std::string(info.name), std::string(info.description)});
    }
  };
  add("device", firmware::simulated_devices());
  add("drawing", firmware::drawings());
  add("motion", firmware::motions());
  add("fault", firmware::faults());
  return print(table.print(format));
}

template <class Infos>
std::vector<std::string_view> names_of(const Infos& infos) {
  std::vector<std::string_view> names;
  for (const auto& info : infos) names.push_back(info.name);
  return names;
}

/// The device that the arguments name, with its hand.
tl::expected<std::unique_ptr<firmware::SimulatedDevice>, Failure> make_device(
    const SimulateArguments& arguments) {
  const auto devices = firmware::simulated_devices();
  const auto info = std::find_if(devices.begin(), devices.end(),
                                 [&](const auto& one) { return one.name == arguments.device; });
  if (info == devices.end()) {
    return usage_error("there is no simulated device '" + arguments.device + "'",
                       suggest(arguments.device, names_of(devices)));
  }
  const bool pen = info->kind == firmware::SimulatedKind::kPen;
  if (pen && !arguments.motion.empty()) {
    return usage_error("'" + arguments.device + "' is a pen, which has no motions",
                       "say what it draws with --drawing");
  }
  if (!pen && !arguments.drawing.empty()) {
    return usage_error("'" + arguments.device + "' is a 3D mouse, which does not draw",
                       "say how it moves with --motion");
  }
  std::string movement = pen ? arguments.drawing : arguments.motion;
  const auto known = pen ? names_of(firmware::drawings()) : names_of(firmware::motions());
  if (movement.empty()) movement = pen ? kUsualDrawing : known.front();
  if (std::find(known.begin(), known.end(), movement) == known.end()) {
    return usage_error(
        std::string("there is no ") + (pen ? "drawing '" : "motion '") + movement + "'",
        suggest(movement, known));
  }
  return firmware::make_simulated_device(arguments.device, movement, arguments.seed);
}

tl::expected<std::vector<firmware::FaultSpec>, Failure> parse_faults(
    const std::vector<std::string>& texts) {
  std::vector<firmware::FaultSpec> faults;
  for (const std::string& text : texts) {
    const auto parsed = firmware::parse_fault(text);
    if (parsed.unknown_name) {
      const std::string name = text.substr(0, text.find(','));
      return usage_error("there is no fault '" + name + "'",
                         suggest(name, names_of(firmware::faults())));
    }
    if (!parsed.fault) {
      return usage_error("--fault " + parsed.error,
                         "NAME[,at=SECONDS][,p=PROBABILITY][,n=COUNT][,seed=N]");
    }
    faults.push_back(*parsed.fault);
  }
  return faults;
}

/// What Linux's wacom driver asks of a tablet that is a mouse until then: feature report 2, mode 2.
std::vector<firmware::HostRequest> driver_requests(const firmware::DeviceSpec& spec) {
  constexpr std::uint16_t kWacom = 0x056A;
  if (spec.vendor != kWacom) return {};
  return {{firmware::set_report(0, firmware::ReportKind::kFeature, 2, 2), {2, 2}}};
}

/// The head of a recording's device: what USB tells of an interface before its first report.
TraceDevice described(const firmware::DeviceSpec& spec, std::uint8_t interface,
                      std::span<const std::uint8_t> descriptor) {
  TraceDevice device;
  device.index = interface;
  device.name = firmware::linux_name(spec);
  device.physical_path = firmware::physical_path(interface);
  device.bus = static_cast<std::uint16_t>(spec.bus);
  device.vendor = spec.vendor;
  device.product = spec.product;
  device.report_descriptor.assign(descriptor.begin(), descriptor.end());
  return device;
}

/// Precondition: there is such a drawing.
firmware::PenSession session_of(const SimulateArguments& arguments) {
  const std::string& drawing = arguments.drawing;
  return {*firmware::find_drawing(drawing.empty() ? kUsualDrawing : drawing), arguments.seed};
}

/// The pen on its own, without a bus before it: its bytes for a seed are promised not to change.
Expected<void> record_pen(const firmware::DeviceSpec& spec, firmware::PenSession session,
                          ByteSink& sink) {
  HidRecorderWriter writer(sink);
  if (auto written = writer.describe(described(spec, 0, firmware::HidPen::report_descriptor()));
      !written)
    return written;
  firmware::TimedReport report;
  while (session.next(report)) {
    if (auto written = writer.write(Report{0, report.time, report.bytes}); !written) return written;
  }
  return {};
}

/// Records what a host sees of a device, as `limn record` would.
class Recorder {
 public:
  Recorder(firmware::BusDevice& device, ByteSink& sink)
      : spec_(device.spec()),
        host_(device, InMemoryHost::Polling::kWhenDue, driver_requests(spec_)),
        writer_(sink) {}

  Expected<void> record(microseconds end) {
    Expected<void> written;
    while (written) {
      const auto event = host_.next(end);
      if (!event) break;
      if (event->kind == HostEvent::Kind::kReport) {
        written = writer_.write(Report{event->interface, event->time, event->bytes});
      } else {
        written = event->kind == HostEvent::Kind::kPlugged ? plugged() : unplugged();
      }
    }
    return written;
  }

 private:
  /// What USB tells of the device before its first report, and what its initialisation learnt.
  Expected<void> plugged() {
    for (std::size_t i = 0; i < spec_.interfaces.size(); ++i) {
      const auto number = static_cast<std::uint8_t>(i);
      if (auto written =
              writer_.describe(described(spec_, number, host_.report_descriptor(number)));
          !written)
        return written;
    }
    const PenInitialization* const sequence = find_pen_initialization(spec_.vendor, spec_.product);
    if (sequence == nullptr || sequence->interface_number >= spec_.interfaces.size()) return {};
    BusControl control(host_, sequence->interface_number);
    for (const std::string& note : set_up_pen(*sequence, control).notes) {
      if (auto written = writer_.note(note, sequence->interface_number); !written) return written;
    }
    return {};
  }

  Expected<void> unplugged() {
    for (DeviceIndex i = 0; i < spec_.interfaces.size(); ++i) {
      if (auto written = writer_.note("gone", i); !written) return written;
    }
    return {};
  }

  const firmware::DeviceSpec& spec_;
  InMemoryHost host_;
  HidRecorderWriter writer_;
};

}  // namespace

Outcome run_simulate(const SimulateArguments& arguments) {
  if (arguments.list && arguments.device.empty()) return print_list(arguments.format);
  if (arguments.device.empty()) return usage_error("no device is named", "limn simulate pen ..");
  auto device = make_device(arguments);
  if (!device) return tl::unexpected(std::move(device.error()));
  if (arguments.list) return print_list(arguments.format);
  const auto faults = parse_faults(arguments.faults);
  if (!faults) return tl::unexpected(faults.error());
  firmware::FaultyDevice bus((*device)->bus(), *faults);
  const microseconds end = (*device)->duration();
  if (arguments.link.wanted()) return run_device_link(bus, end, arguments.link);
  if (arguments.output.empty()) {
    return usage_error("nothing says where its reports go",
                       "add -o FILE, or -o - for standard output, --uhid or --usbip PORT");
  }

  auto file = in_file(arguments.output, OutputFile::open(arguments.output));
  if (!file) return tl::unexpected(std::move(file.error()));
  // The recording goes to the file in one write: a pipe or a full disk is told once, at its end.
  StringSink recording;
  auto written = arguments.device == kPen && faults->empty()
                     ? record_pen(bus.spec(), session_of(arguments), recording)
                     : Recorder(bus, recording).record(end + kLastPoll);
  written = written.and_then([&] { return file->write(recording.text()); }).and_then([&] {
    return file->commit();
  });
  return in_file(arguments.output, written);
}

}  // namespace limn::app
