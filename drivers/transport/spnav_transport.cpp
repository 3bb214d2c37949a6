#include "drivers/transport/spnav_transport.hpp"

#include <linux/input-event-codes.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <utility>

#include "drivers/devices/device_traits.hpp"
#include "drivers/transport/paced_reader.hpp"

// libspnav's other half speaks X11, whose header is not needed here.
#define SPNAV_CONFIG_H_
#include <spnav.h>

namespace limn {
namespace {

constexpr int kMotionAxes = 6;
constexpr int kMostButtons = KEY_MAX - BTN_0 + 1;
constexpr std::size_t kMessageBytes = 8 * sizeof(std::int32_t);

class SpnavTransport final : public Transport {
 public:
  explicit SpnavTransport(TraceDevice device) : device_(std::move(device)) {}
  ~SpnavTransport() override { spnav_close(); }

  const TraceDevice& device() const noexcept override { return device_; }
  int poll_descriptor() const noexcept override { return spnav_fd(); }

  State drain(TransportSink& sink) noexcept override {
    for (int count = 0; count < kMostReports;) {
      // libspnav answers "no event" and "no spacenavd" alike, and would wait for half a message.
      std::array<char, kMessageBytes> waiting;
      const ssize_t size =
          ::recv(spnav_fd(), waiting.data(), waiting.size(), MSG_PEEK | MSG_DONTWAIT);
      if (size < 0 && errno == EINTR) continue;
      if (size < 0 && errno == EAGAIN) return State::kOpen;
      if (size != static_cast<ssize_t>(kMessageBytes)) return State::kGone;
      spnav_event event{};
      const int type = spnav_poll_event(&event);
      const Timestamp now = monotonic_clock().now();
      if (type == SPNAV_EVENT_MOTION) {
        give_motion(event.motion, now, sink);
      } else if (type == SPNAV_EVENT_BUTTON) {
        give_button(event.button, now, sink);
      }
      ++count;
    }
    return State::kOpen;
  }

 private:
  static void give_motion(const spnav_event_motion& motion, Timestamp time,
                          TransportSink& sink) noexcept {
    const std::array<int, kMotionAxes> values = {motion.x,  motion.y,  motion.z,
                                                 motion.rx, motion.ry, motion.rz};
    std::array<EvdevEvent, kMotionAxes> events;
    for (std::size_t i = 0; i < values.size(); ++i) {
      events[i] = {time, EV_ABS, static_cast<std::uint16_t>(ABS_X + i), values[i]};
    }
    sink.frame(time, events);
  }

  static void give_button(const spnav_event_button& button, Timestamp time,
                          TransportSink& sink) noexcept {
    if (button.bnum < 0 || button.bnum >= kMostButtons) return;
    const EvdevEvent event{time, EV_KEY, static_cast<std::uint16_t>(BTN_0 + button.bnum),
                           button.press};
    sink.frame(time, {&event, 1});
  }

  TraceDevice device_;
};

/// Lets libspnav look for its socket at a place of ours, which it takes from the environment.
class ChosenSocket {
 public:
  explicit ChosenSocket(const std::string& socket) {
    if (socket.empty()) return;
    const char* const before = std::getenv(kVariable);
    if (before != nullptr) before_ = before;
    changed_ = ::setenv(kVariable, socket.c_str(), 1) == 0;
  }
  ~ChosenSocket() {
    if (!changed_) return;
    if (before_) {
      ::setenv(kVariable, before_->c_str(), 1);
    } else {
      ::unsetenv(kVariable);
    }
  }
  ChosenSocket(const ChosenSocket&) = delete;
  ChosenSocket& operator=(const ChosenSocket&) = delete;

 private:
  static constexpr const char* kVariable = "SPNAV_SOCKET";
  std::optional<std::string> before_;
  bool changed_ = false;
};

TraceDevice describe() {
  TraceDevice device;
  device.name = "3D mouse of spacenavd";
  device.physical_path = kSpacenavdPath;
  for (std::uint16_t code = ABS_X; code <= ABS_RZ; ++code) device.axes.push_back({code});
  if (spnav_protocol() < 1) return device;
  unsigned vendor = 0;
  unsigned product = 0;
  constexpr std::uint16_t kUsbBus = 3;
  if (spnav_dev_usbid(&vendor, &product) == 0 && vendor != 0) {
    device.bus = kUsbBus;
    device.vendor = static_cast<std::uint16_t>(vendor);
    device.product = static_cast<std::uint16_t>(product);
  }
  std::array<char, 256> name{};
  if (spnav_dev_name(name.data(), static_cast<int>(name.size())) > 0) device.name = name.data();
  return device;
}

}  // namespace

Expected<std::unique_ptr<Transport>> open_spnav(const std::string& socket) {
  if (spnav_fd() != -1) {
    return fail(ErrorCode::kIo, socket, "a connection to spacenavd is open already",
                "close it first: libspnav has room for one");
  }
  const ChosenSocket chosen(socket);
  if (spnav_open() != 0) {
    return fail(ErrorCode::kIo, socket, "spacenavd does not answer",
                "start it (systemctl start spacenavd), or name the device itself");
  }
  return std::make_unique<SpnavTransport>(describe());
}

}  // namespace limn
