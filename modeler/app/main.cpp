// The command line: its words, nothing else. Each subcommand's work is a run_*() of command.hpp.

#include <signal.h>  // SIGXFSZ is POSIX

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "modeler/app/command.hpp"
#include "modeler/app/option_values.hpp"
#include "modeler/app/terminal_text.hpp"

namespace limn::app {
namespace {

constexpr int kFailed = 1;
constexpr int kUsage = 2;

/// An option whose text `parse` turns into a value: see option_values.hpp for what it returns.
template <class Parse>
CLI::Option* add_value(CLI::App& command, const std::string& name, Parse parse,
                       const std::string& description) {
  return command.add_option_function<std::string>(
      name,
      [name, parse](const std::string& text) {
        if (const std::string wrong = parse(text); !wrong.empty()) {
          throw CLI::ValidationError(name, wrong);
        }
      },
      description);
}

void add_format(CLI::App& command, OutputFormat& format) {
  add_value(
      command, "--format",
      [&format](const std::string& text) { return parse_format(text, format); },
      "What goes to standard output: text, json, jsonl or csv")
      ->type_name("FORMAT")
      ->default_str("text");
}

constexpr const char* kTraces =
    "A hid-recorder, usbhid-dump, evemu or stroke CSV (t,x,y,p[,alt,az]) recording, told apart by "
    "content; - is standard input";
constexpr const char* kForeignTraces =
    "A USB capture (pcap, pcapng), a recording by libinput, hid-recorder, usbhid-dump or evemu, or "
    "a CSV file of a 3D mouse, told apart by content; - is standard input";

void add_trace(CLI::App& command, TraceArguments& trace, const char* what = kTraces) {
  command.add_option("TRACE", trace.path, what)->required()->type_name("");
  command
      .add_option("--descriptor", trace.descriptor_path,
                  "The report descriptor, for recordings without one (usbhid-dump)")
      ->type_name("FILE");
  add_value(
      command, "--id",
      [&trace](const std::string& text) { return parse_id(text, trace.vendor, trace.product); },
      "USB vendor and product, for recordings without them")
      ->type_name("VID:PID");
  command.add_flag("--salvage", trace.salvage,
                   "Skip what is damaged and say how much, instead of stopping there");
}

void add_live(CLI::App& command, LiveArguments& live) {
  command
      .add_option("DEVICE", live.device,
                  std::string("VID:PID, VID:PID:N (the N-th of them from 0) or a node, as limn "
                              "devices shows them; all ") +
                      (live.kind == DeviceKind::k3dMouse ? "3D mice" : "pens") + " unless given")
      ->type_name("");
  add_value(
      command, "--backend",
      [&live](const std::string& text) { return parse_backend(text, live.backend.emplace()); },
      "How to read them: hidraw, evdev, spnav, or usb, which takes them from Linux's drivers; "
      "hidraw "
      "where possible unless given")
      ->type_name("BACKEND");
  command.add_flag(
      "--no-init", [&live](std::int64_t) { live.initialize = false; },
      "Read devices as they are, without the requests that set them up");
}

/// How 3D mice become velocities: in parts of that at full deflection, or, with `speeds`, in mm/s
/// and rad/s.
void add_drag(CLI::App& command, DragOptions& drag, bool speeds = true) {
  const auto option = [&command](const char* name, const char* type, auto parse,
                                 const char* description) {
    return add_value(command, name, parse, description)->type_name(type)->group("3D mice");
  };
  if (speeds) {
    option(
        "--mm-per-s", "V",
        [&drag](const std::string& text) { return parse_full_speed(text, drag.mm_per_s); },
        "Velocity at full deflection")
        ->default_str("100");
    option(
        "--rad-per-s", "W",
        [&drag](const std::string& text) { return parse_full_speed(text, drag.rad_per_s); },
        "Angular velocity at full deflection")
        ->default_str("1");
  }
  option(
      "--dead-zone", "F",
      [&drag](const std::string& text) { return parse_fraction(text, 0.9, drag.dead_zone); },
      "Deflections up to this part of the full one count as none")
      ->default_str("0");
  option(
      "--curve", "F",
      [&drag](const std::string& text) { return parse_fraction(text, 1, drag.curve); },
      "From 0, velocity proportional to deflection, to 1, to its cube")
      ->default_str("0");
  option(
      "--sensitivity", "F[,F..]",
      [&drag](const std::string& text) { return parse_factors(text, drag.sensitivity); },
      "A factor of all six axes, or six")
      ->default_str("1");
  option(
      "--axes", "LIST",
      [&drag](const std::string& text) { return parse_axes(text, drag.source, drag.inverted); },
      "Which axis of the device drives each of the six, - inverts it")
      ->default_str("x,y,z,rx,ry,rz");
  command.add_flag("--dominant", drag.dominant_axis, "Only the axis deflected most counts")
      ->group("3D mice");
}

void add_seconds(CLI::App& command, double& seconds) {
  add_value(
      command, "--seconds",
      [&seconds](const std::string& text) { return parse_seconds(text, seconds); },
      "End after so long; by Ctrl-C unless given")
      ->type_name("S");
}

/// --uhid and --usbip; gives both, for what they exclude.
std::vector<CLI::Option*> add_link(CLI::App& command, LinkArguments& link) {
  CLI::Option* uhid = command.add_flag(
      "--uhid", link.uhid, "Give the device to the programs of this machine by /dev/uhid");
  CLI::Option* usbip = add_value(
      command, "--usbip",
      [&link](const std::string& text) { return parse_port(text, link.usbip_port.emplace()); },
      "Serve the device by USB/IP on 127.0.0.1; 0 is any free port, 3240 what usbip expects");
  usbip->type_name("PORT")->excludes(uhid);
  return {uhid, usbip};
}

int run(int argc, char** argv) {
  CLI::App app{
      "limn turns the bytes of pens into samples, strokes and exact B-spline curves.\n"
      "See limn(1) for the formats it writes."};
  app.set_version_flag("--version", "limn " LIMN_VERSION);
  app.require_subcommand(1);
  app.name("limn");
  Outcome outcome;

  DescriptorArguments descriptor;
  CLI::App* descriptor_command = app.add_subcommand(
      "descriptor", "Explain a HID report descriptor: reports, fields, usages, ranges, units");
  descriptor_command
      ->add_option("FILE", descriptor.path,
                   "Raw bytes (.bin), hex text, or a recording that holds descriptors; - is "
                   "standard input")
      ->required()
      ->type_name("");
  add_format(*descriptor_command, descriptor.format);
  descriptor_command->callback([&] { outcome = run_descriptor(descriptor); });

  DecodeArguments decode;
  CLI::App* decode_command = app.add_subcommand(
      "decode", "Print a recording's samples of pens and 3D mice, one line a sample");
  add_trace(*decode_command, decode.trace);
  add_drag(*decode_command, decode.drag);
  add_format(*decode_command, decode.format);
  decode_command->callback([&] { outcome = run_decode(decode); });

  ConvertArguments convert;
  CLI::App* convert_command = app.add_subcommand(
      "convert-trace",
      "Make a hid-recorder file of another program's recording; an evemu file where it holds only "
      "what the kernel decoded");
  add_trace(*convert_command, convert.trace, kForeignTraces);
  convert_command
      ->add_option("-o,--output", convert.output, "The file to write; - is standard output")
      ->required()
      ->type_name("FILE");
  add_value(
      *convert_command, "--device",
      [&convert](const std::string& text) { return parse_index(text, convert.device.emplace()); },
      "The one device to keep, by its number in the recording; all unless given")
      ->type_name("N");
  convert_command->callback([&] { outcome = run_convert(convert); });

  DevicesArguments devices;
  CLI::App* devices_command =
      app.add_subcommand("devices", "List the pens and 3D mice that are plugged in");
  devices_command->add_flag("--all", devices.all, "List every input device");
  add_format(*devices_command, devices.format);
  devices_command->callback([&] { outcome = run_devices(devices); });

  DoctorArguments doctor;
  CLI::App* doctor_command = app.add_subcommand(
      "doctor", "Look for what keeps devices from limn: permissions, rules, other programs");
  add_format(*doctor_command, doctor.format);
  doctor_command->callback([&] { outcome = run_doctor(doctor); });

  MonitorArguments monitor;
  CLI::App* monitor_command =
      app.add_subcommand("monitor", "Watch devices: values, rate, jitter, lost reports, latency");
  add_live(*monitor_command, monitor.live);
  add_seconds(*monitor_command, monitor.seconds);
  add_drag(*monitor_command, monitor.drag);
  add_format(*monitor_command, monitor.format);
  monitor_command->callback([&] { outcome = run_monitor(monitor); });

  RecordArguments record;
  CLI::App* record_command = app.add_subcommand(
      "record", "Record what devices send, as a hid-recorder (event nodes: evemu) file");
  add_live(*record_command, record.live);
  record_command
      ->add_option("-o,--output", record.output,
                   "The file to create; - is standard output. It grows while recording, so a crash "
                   "leaves what came before")
      ->required()
      ->type_name("FILE");
  add_seconds(*record_command, record.seconds);
  record_command->callback([&] { outcome = run_record(record); });

  ReplayArguments replay;
  CLI::App* replay_command = app.add_subcommand(
      "replay",
      "Print a recording's samples at the times at which they were made, or be its device for "
      "other programs");
  add_trace(*replay_command, replay.trace);
  add_value(
      *replay_command, "--speed",
      [&replay](const std::string& text) { return parse_speed(text, replay.speed); },
      "So many times as fast as it was made")
      ->type_name("X")
      ->default_str("1");
  add_link(*replay_command, replay.link);
  add_drag(*replay_command, replay.drag);
  add_format(*replay_command, replay.format);
  replay_command->callback([&] { outcome = run_replay(replay); });

  SketchArguments sketch;
  CLI::App* sketch_command = app.add_subcommand(
      "sketch", "Fit B-spline curves to a recording's strokes; draw them and export them");
  add_trace(*sketch_command, sketch.trace);
  add_value(
      *sketch_command, "--tolerance",
      [&sketch](const std::string& text) { return parse_length(text, sketch.tolerance_mm); },
      "Largest distance of a curve from any of its samples, in mm")
      ->type_name("MM")
      ->default_str("0.1");
  sketch_command
      ->add_option("-o,--output", sketch.outputs,
                   "Write a file, its type by extension: .svg .pdf .png .step .json; may be given "
                   "several times; - writes the JSON to standard output instead of the table")
      ->type_name("FILE")
      ->type_size(1)
      ->expected(1)
      ->take_all();
  add_format(*sketch_command, sketch.format);
  sketch_command->callback([&] { outcome = run_sketch(sketch); });

  SimulateArguments simulate;
  CLI::App* simulate_command =
      app.add_subcommand("simulate",
                         "Let a simulated device draw or move: record it, or give it "
                         "to other programs");
  simulate_command->add_option("DEVICE", simulate.device, "The device; see --list")->type_name("");
  CLI::Option* drawing =
      simulate_command
          ->add_option("--drawing", simulate.drawing, "What a pen draws; signature unless given")
          ->type_name("NAME");
  CLI::Option* motion =
      simulate_command->add_option("--motion", simulate.motion, "How a 3D mouse is moved")
          ->type_name("NAME")
          ->excludes(drawing);
  CLI::Option* fault =
      simulate_command
          ->add_option("--fault", simulate.faults,
                       "What goes wrong: NAME[,at=SECONDS][,p=PROBABILITY][,n=COUNT][,seed=N]; may "
                       "be given several times")
          ->type_name("SPEC")
          ->type_size(1)
          ->expected(1)
          ->take_all();
  CLI::Option* seed = add_value(
      *simulate_command, "--seed",
      [&simulate](const std::string& text) { return parse_seed(text, simulate.seed); },
      "The same seed gives the same sensor noise, so the same bytes");
  seed->type_name("N")->default_str("1");
  CLI::Option* output = simulate_command
                            ->add_option("-o,--output", simulate.output,
                                         "The hid-recorder file to write; - is standard output")
                            ->type_name("TRACE");
  std::vector<CLI::Option*> others = add_link(*simulate_command, simulate.link);
  for (CLI::Option* link : others) link->excludes(output);
  others.insert(others.end(), {drawing, motion, fault, seed, output});
  CLI::Option* list = simulate_command->add_flag("--list", simulate.list,
                                                 "List devices, drawings, motions and faults");
  for (CLI::Option* other : others) list->excludes(other);
  add_format(*simulate_command, simulate.format);
  simulate_command->callback([&] { outcome = run_simulate(simulate); });

  PlotArguments plot;
  CLI::App* plot_command = app.add_subcommand(
      "plot", "Draw a recording over time: a pen's axes; a 3D mouse's axes, velocity and path");
  add_trace(*plot_command, plot.trace);
  plot_command
      ->add_option("-o,--output", plot.output, "The picture, its type by extension: .png .svg .pdf")
      ->required()
      ->type_name("FILE");
  add_drag(*plot_command, plot.drag);
  plot_command->callback([&] { outcome = run_plot(plot); });

  SpnavServerArguments server;
  server.live.kind = DeviceKind::k3dMouse;
  server.live.from_spacenavd = false;
  server.live.waits = true;
  CLI::App* server_command = app.add_subcommand(
      "spnav-server", "Serve 3D mice to programs that know spacenavd, in its place");
  add_live(*server_command, server.live);
  server_command
      ->add_option("--socket", server.socket,
                   "Where to listen; unless given /run/spnav.sock where this user may, else "
                   "$XDG_RUNTIME_DIR/spnav.sock")
      ->type_name("PATH");
  CLI::Option* from_recording =
      server_command
          ->add_option("--replay", server.trace.path,
                       "Serve a recording, at its pace, from the first client on, instead of "
                       "devices")
          ->type_name("TRACE")
          ->excludes(server_command->get_option("DEVICE"))
          ->excludes(server_command->get_option("--backend"));
  add_value(
      *server_command, "--speed",
      [&server](const std::string& text) { return parse_speed(text, server.speed); },
      "A recording, so many times as fast as it was made")
      ->type_name("X")
      ->default_str("1")
      ->needs(from_recording);
  add_drag(*server_command, server.drag, false);
  server_command->callback([&] { outcome = run_spnav_server(server); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& wanted) {  // --help, --version
    return app.exit(wanted);
  } catch (const CLI::ParseError& error) {
    const auto commands = app.get_subcommands();
    const std::string where = commands.empty() ? "limn" : "limn " + commands[0]->get_name();
    print_error(std::string(error.what()) + "; see " + where + " --help");
    return kUsage;
  }
  if (!outcome) {
    print_error(outcome.error());
    return outcome.error().usage ? kUsage : kFailed;
  }
  return 0;
}

}  // namespace
}  // namespace limn::app

int main(int argc, char** argv) {
  // A limit of file sizes is told as a full disk is: by write(2), not by a signal that would leave
  // temporary files behind.
  ::signal(SIGXFSZ, SIG_IGN);
  try {
    return limn::app::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "limn: %s; free some memory or give less input\n", error.what());
    return limn::app::kFailed;
  }
}
