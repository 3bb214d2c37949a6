#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
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

/// Also by another name, such as /var/run/spnav.sock.
bool is_standard(const std::string& socket) {
  std::error_code error;
  const auto real = std::filesystem::weakly_canonical(std::filesystem::absolute(socket), error);
  return !error && real == std::filesystem::weakly_canonical(kStandardSocket, error);
}

tl::expected<std::unique_ptr<SpnavServer>, Failure> listen(const std::string& socket) {
  const bool standard = is_standard(socket);
  auto server = in_file("", SpnavServer::listen({socket, standard ? kForAll : kForUser}));
  if (!server) return server;
  remove_on_signal(socket);
  std::fprintf(stderr, "listening on %s%s; Ctrl-C ends it\n", socket.c_str(),
               standard ? ", where programs look"
                        : (", for programs started with SPNAV_SOCKET=" + socket).c_str());
  return server;
}

/// A clock whose waits end soon after it is stopped.
class StoppableClock final : public WaitingClock {
 public:
  Timestamp now() noexcept override { return monotonic_clock().now(); }
  void wait_until(Timestamp time) noexcept override {
    constexpr Timestamp kLook = std::chrono::milliseconds(50);
    while (!stopped_ && now() < time) monotonic_clock().wait_until(std::min(time, now() + kLook));
  }

  /// A signal handler may call it.
  void stop() noexcept { stopped_ = true; }
  bool is_stopped() const noexcept { return stopped_; }

 private:
  std::atomic<bool> stopped_ = false;
};

/// A reader that ends when its clock is stopped.
class StoppableReader final : public TraceReader {
 public:
  StoppableReader(std::unique_ptr<TraceReader> reader, const StoppableClock& clock)
      : reader_(std::move(reader)), clock_(clock) {}

  TraceFormat format() const noexcept override { return reader_->format(); }
  std::string place() const override { return reader_->place(); }
  Expected<TraceEvent> next() override {
    auto event = reader_->next();
    if (clock_.is_stopped()) return TraceEnd();
    return event;
  }
  Expected<std::optional<TraceEvent>> next_until(Timestamp deadline) override {
    auto event = reader_->next_until(deadline);
    if (event && clock_.is_stopped()) event->emplace(std::in_place_type<TraceEnd>);
    return event;
  }

 private:
  std::unique_ptr<TraceReader> reader_;
  const StoppableClock& clock_;
};

/// Hands events on, and tells the server of the 3D mice among the devices: of one that has gone
/// once its motion has ended and its buttons are up, which is when the next event is asked for.
class TellingReader final : public TraceReader {
 public:
  TellingReader(TraceReader& reader, SpnavServer& server, SpnavEvents& events, bool& any_mouse)
      : reader_(reader), server_(server), events_(events), any_mouse_(any_mouse) {}

  TraceFormat format() const noexcept override { return reader_.format(); }
  std::string place() const override { return reader_.place(); }
  Expected<TraceEvent> next() override {
    remove_gone();
    auto event = reader_.next();
    if (event) tell(*event);
    return event;
  }
  Expected<std::optional<TraceEvent>> next_until(Timestamp deadline) override {
    remove_gone();
    auto event = reader_.next_until(deadline);
    if (event && *event) tell(**event);
    return event;
  }

 private:
  void tell(const TraceEvent& event) {
    if (const auto* const described = std::get_if<DeviceDescribed>(&event)) {
      const TraceDevice& device = *described->device;
      if (!is_3d_mouse(device)) return;
      any_mouse_ = true;
      SpnavDevice served{device.index, device.name, "", device.vendor, device.product, {}, {}};
      served.full_deflection = relative_full_counts(device).value_or(kSpnavFull);
      const MotionSpec* const spec = find_motion_spec(device.vendor, device.product);
      constexpr unsigned kUsualButtons = 2;
      served.buttons = spec != nullptr && spec->buttons > 0 ? spec->buttons : kUsualButtons;
      events_.describe(served);
      server_.add_device(std::move(served));
    } else if (const auto* const note = std::get_if<TraceNote>(&event)) {
      if (note->text == "gone") gone_ = note->device;
    }
  }
  void remove_gone() {
    if (gone_) server_.remove_device(*gone_);
    gone_.reset();
  }

  TraceReader& reader_;
  SpnavServer& server_;
  SpnavEvents& events_;
  bool& any_mouse_;
  std::optional<DeviceIndex> gone_;
};

/// Velocities, of full speeds of 1.
SpnavEvents::Six six_of(const Drag& drag) {
  SpnavEvents::Six six{};
  std::copy(drag.mm_per_s.begin(), drag.mm_per_s.end(), six.begin());
  std::copy(drag.rad_per_s.begin(), drag.rad_per_s.end(), six.begin() + 3);
  return six;
}

/// Until the reader's end. Failure: a recording has no 3D mouse.
Outcome serve(TraceReader& reader, bool salvage, SpnavServer& server,
              const SpnavServerArguments& arguments) {
  bool any_mouse = false;
  SpnavEvents events(server);
  TraceDecoder decoder(std::make_unique<TellingReader>(reader, server, events, any_mouse),
                       {.salvage = salvage});
  DragOptions in_parts = arguments.drag;
  in_parts.mm_per_s = in_parts.rad_per_s = 1;
  DragSampler drags(in_parts);
  for (;;) {
    auto sample = decoder.next_any();
    if (!sample) {
      events.end();
      return in_file(arguments.trace.path, Expected<void>(tl::unexpected(sample.error())));
    }
    if (std::holds_alternative<std::monostate>(*sample)) break;
    if (const auto* const motion = std::get_if<const MotionSample*>(&*sample)) {
      any_mouse = true;
      events.push(**motion, six_of(drags.push(**motion)));
    }
  }
  events.end();
  std::fprintf(stderr, "%s\n", summarise(decoder.summary()).c_str());
  if (!any_mouse && !arguments.trace.path.empty()) {
    return in_file(arguments.trace.path,
                   Expected<void>(fail(ErrorCode::kMissing, "", "holds no 3D mouse",
                                       "give a recording of a 3D mouse in use")));
  }
  return {};
}

Outcome serve_recording(const SpnavServerArguments& arguments, const std::string& socket) {
  auto reader = open_trace_input(arguments.trace);
  if (!reader) return tl::unexpected(std::move(reader.error()));
  auto server = listen(socket);
  if (!server) return tl::unexpected(std::move(server.error()));
  while (!(*server)->wait_for_client(std::chrono::hours(1))) {
  }
  StoppableClock clock;
  StoppableReader paced(std::make_unique<PacedReader>(std::move(*reader), arguments.speed, clock),
                        clock);
  const StopOnSignal stop(clock);
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
  const StopOnSignal stop(**reader);  // before anybody is told that it listens
  auto server = listen(socket);
  if (!server) return tl::unexpected(std::move(server.error()));
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
