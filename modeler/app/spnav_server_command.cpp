#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include "drivers/devices/device_traits.hpp"
#include "drivers/devices/motion_spec.hpp"
#include "drivers/devices/trace_decoder.hpp"
#include "drivers/spnav_server/spnav_server.hpp"
#include "drivers/transport/open_device.hpp"
#include "drivers/transport/paced_reader.hpp"
#include "input/stroke/drag_sampler.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/live_input.hpp"
#include "modeler/app/stop_on_signal.hpp"
#include "modeler/app/temporary_files.hpp"
#include "modeler/app/trace_input.hpp"

namespace limn::app {
namespace {

/// Where libspnav looks by itself.
constexpr const char* kStandardSocket = "/run/spnav.sock";

/// Who may connect: everybody where a system's spacenavd would be, as there; else this user.
constexpr unsigned kForAll = 0666;
constexpr unsigned kForUser = 0600;

tl::expected<std::string, Failure> choose_socket(const std::string& wanted) {
  if (!wanted.empty()) return wanted;
  if (::access("/run", W_OK) == 0) return kStandardSocket;
  const char* const folder = std::getenv("XDG_RUNTIME_DIR");
  if (folder != nullptr && *folder == '/') return std::string(folder) + "/spnav.sock";
  return tl::unexpected(Failure{
      "", Error{ErrorCode::kMissing, "", "/run may not be written and XDG_RUNTIME_DIR is not set",
                "say where to listen: --socket PATH"}});
}

tl::expected<std::unique_ptr<SpnavServer>, Failure> listen(const std::string& socket) {
  const bool standard = socket == kStandardSocket;
  auto server = in_file("", SpnavServer::listen({socket, standard ? kForAll : kForUser}));
  if (!server) return server;
  remove_on_signal(socket);
  std::fprintf(stderr, "listening on %s%s; Ctrl-C ends it\n", socket.c_str(),
               standard ? ", where programs look"
                        : (", for programs started with SPNAV_SOCKET=" + socket).c_str());
  return server;
}

/// Hands events on, and tells the server of the 3D mice among the devices.
class TellingReader final : public TraceReader {
 public:
  TellingReader(TraceReader& reader, SpnavServer& server) : reader_(reader), server_(server) {}

  TraceFormat format() const noexcept override { return reader_.format(); }
  std::string place() const override { return reader_.place(); }
  Expected<TraceEvent> next() override {
    auto event = reader_.next();
    if (event) tell(*event);
    return event;
  }
  Expected<std::optional<TraceEvent>> next_until(Timestamp deadline) override {
    auto event = reader_.next_until(deadline);
    if (event && *event) tell(**event);
    return event;
  }

 private:
  void tell(const TraceEvent& event) {
    if (const auto* const described = std::get_if<DeviceDescribed>(&event)) {
      const TraceDevice& device = *described->device;
      if (!is_3d_mouse(device)) return;
      SpnavDevice served{device.index,  device.name,    device.physical_path,
                         device.vendor, device.product, {}};
      const MotionSpec* const spec = find_motion_spec(device.vendor, device.product);
      constexpr unsigned kUsualButtons = 2;
      served.buttons = spec != nullptr && spec->buttons > 0 ? spec->buttons : kUsualButtons;
      server_.add_device(std::move(served));
    } else if (const auto* const note = std::get_if<TraceNote>(&event)) {
      if (note->text == "gone") server_.remove_device(note->device);
    }
  }

  TraceReader& reader_;
  SpnavServer& server_;
};

/// In parts of full deflection.
SpnavEvents::Six share_of(const Drag& drag, const DragOptions& options) {
  SpnavEvents::Six share{};
  for (std::size_t i = 0; i < 3; ++i) {
    share[i] = drag.mm_per_s[i] / options.mm_per_s;
    share[i + 3] = drag.rad_per_s[i] / options.rad_per_s;
  }
  return share;
}

/// Until the reader's end.
Outcome serve(TraceReader& reader, bool salvage, SpnavServer& server,
              const SpnavServerArguments& arguments) {
  TraceDecoder decoder(std::make_unique<TellingReader>(reader, server), {.salvage = salvage});
  DragSampler drags(arguments.drag);
  SpnavEvents events(server);
  for (;;) {
    auto sample = decoder.next_any();
    if (!sample) {
      events.end();
      return in_file(arguments.trace.path, Expected<void>(tl::unexpected(sample.error())));
    }
    if (std::holds_alternative<std::monostate>(*sample)) break;
    if (const auto* const motion = std::get_if<const MotionSample*>(&*sample)) {
      events.push(**motion, share_of(drags.push(**motion), arguments.drag));
    }
  }
  events.end();
  std::fprintf(stderr, "%s\n", summarise(decoder.summary()).c_str());
  return {};
}

Outcome serve_recording(const SpnavServerArguments& arguments, const std::string& socket) {
  auto reader = open_trace_input(arguments.trace);
  if (!reader) return tl::unexpected(std::move(reader.error()));
  auto server = listen(socket);
  if (!server) return tl::unexpected(std::move(server.error()));
  while (!(*server)->wait_for_client(std::chrono::hours(1))) {
  }
  PacedReader paced(std::move(*reader), arguments.speed, monotonic_clock());
  return serve(paced, arguments.trace.salvage, **server, arguments);
}

Outcome serve_devices(const SpnavServerArguments& arguments, const std::string& socket) {
  const LiveArguments& live = arguments.live;
  const bool by_socket =
      live.device.find('/') != std::string::npos && backend_of_node(live.device) == Backend::kSpnav;
  if (live.backend == Backend::kSpnav || by_socket) {
    return usage_error("what spacenavd serves needs no other server",
                       "let programs use spacenavd, or stop it and name the device itself");
  }
  auto reader = open_live_input(live);
  if (!reader) return tl::unexpected(std::move(reader.error()));
  auto server = listen(socket);
  if (!server) return tl::unexpected(std::move(server.error()));
  const StopOnSignal stop(**reader);
  return serve(**reader, true, **server, arguments);
}

}  // namespace

Outcome run_spnav_server(const SpnavServerArguments& arguments) {
  const auto socket = choose_socket(arguments.socket);
  if (!socket) return tl::unexpected(socket.error());
  Outcome outcome = arguments.trace.path.empty() ? serve_devices(arguments, *socket)
                                                 : serve_recording(arguments, *socket);
  keep_on_signal(*socket);
  return outcome;
}

}  // namespace limn::app
