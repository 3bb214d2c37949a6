#include "drivers/transport/evdev_transport.hpp"

#include <fcntl.h>
#include <libevdev/libevdev.h>
#include <poll.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdarg>
#include <optional>
#include <utility>

#include "drivers/transport/file_handle.hpp"
#include "drivers/transport/node_error.hpp"
#include "drivers/transport/paced_reader.hpp"
#include "drivers/transport/sysfs.hpp"

namespace limn {
namespace {

struct FreeDevice {
  void operator()(libevdev* device) const noexcept { libevdev_free(device); }
};
using Device = std::unique_ptr<libevdev, FreeDevice>;

/// A key or axis that the device has.
struct Control {
  std::uint16_t type = 0;
  std::uint16_t code = 0;
};

class EvdevTransport final : public Transport {
 public:
  EvdevTransport(FileHandle file, Device evdev, TraceDevice device, bool kernel_stamps)
      : file_(std::move(file)),
        evdev_(std::move(evdev)),
        device_(std::move(device)),
        kernel_stamps_(kernel_stamps) {
    const auto add = [this](unsigned type, unsigned end) {
      for (unsigned code = 0; code < end; ++code) {
        if (libevdev_has_event_code(evdev_.get(), type, code) == 0) continue;
        controls_.push_back({static_cast<std::uint16_t>(type), static_cast<std::uint16_t>(code)});
      }
    };
    add(EV_ABS, ABS_MT_SLOT);
    add(EV_KEY, KEY_CNT);
  }

  const TraceDevice& device() const noexcept override { return device_; }
  int poll_descriptor() const noexcept override { return file_.get(); }
  void tell_whole_state() noexcept override { whole_ = true; }

  State drain(TransportSink& sink) noexcept override {
    for (int given = 0; given < kMostEvents; ++given) {
      input_event event{};
      const int status = libevdev_next_event(evdev_.get(), LIBEVDEV_READ_FLAG_NORMAL, &event);
      if (status == LIBEVDEV_READ_STATUS_SUCCESS) {
        take(event, sink);
      } else if (status == LIBEVDEV_READ_STATUS_SYNC) {
        resynchronise(sink);
      } else if (status == -EAGAIN) {
        return hung_up() ? State::kGone : State::kOpen;
      } else if (status != -EINTR) {
        return State::kGone;
      }
    }
    return State::kMore;  // libevdev may have read ahead
  }

 private:
  bool hung_up() const noexcept {
    pollfd polled{file_.get(), POLLIN, 0};
    return ::poll(&polled, 1, 0) > 0 && (polled.revents & (POLLHUP | POLLERR)) != 0;
  }

  Timestamp time_of(const input_event& event) const noexcept {
    if (!kernel_stamps_) return monotonic_clock().now();
    constexpr std::int64_t kSecond = 1'000'000'000;
    constexpr std::int64_t kMicrosecond = 1'000;
    return Timestamp(static_cast<std::int64_t>(event.input_event_sec) * kSecond +
                     static_cast<std::int64_t>(event.input_event_usec) * kMicrosecond);
  }

  void take(const input_event& event, TransportSink& sink) noexcept {
    const Timestamp time = time_of(event);
    if (event.type != EV_SYN) {
      add({time, event.type, event.code, event.value});
    } else if (event.code == SYN_REPORT) {
      end_frame(time, sink);
    }
  }

  void add(const EvdevEvent& event) noexcept {
    if (count_ == events_.size()) {
      overflowed_ = true;
      return;
    }
    events_[count_++] = event;
  }

  void end_frame(Timestamp time, TransportSink& sink) noexcept {
    if (std::exchange(overflowed_, false)) {
      sink.lost(1, true);
      whole_ = true;
    }
    if (count_ > 0 && std::exchange(whole_, false)) gather_state(time);
    sink.frame(time, {events_.data(), count_});
    count_ = 0;
  }

  /// The frame in the making becomes all that libevdev knows; what is neither key nor axis stays.
  void gather_state(Timestamp time) noexcept {
    const auto passing = std::remove_if(
        events_.begin(), events_.begin() + static_cast<std::ptrdiff_t>(count_),
        [](const EvdevEvent& event) { return event.type == EV_KEY || event.type == EV_ABS; });
    std::array<EvdevEvent, kMostPassing> kept;
    const std::size_t kept_count =
        std::min<std::size_t>(kept.size(), static_cast<std::size_t>(passing - events_.begin()));
    std::copy_n(events_.begin(), kept_count, kept.begin());
    count_ = 0;
    for (const Control& control : controls_) {
      add({time, control.type, control.code,
           libevdev_get_event_value(evdev_.get(), control.type, control.code)});
    }
    for (std::size_t i = 0; i < kept_count; ++i) {
      kept[i].time = time;  // it stands behind the state
      add(kept[i]);
    }
  }

  /// libevdev's sync events are what differs from what it has given, the torn frame's events
  /// included: with those they are one frame.
  void resynchronise(TransportSink& sink) noexcept {
    sink.lost(1, true);
    for (;;) {
      input_event event{};
      const int status = libevdev_next_event(evdev_.get(), LIBEVDEV_READ_FLAG_SYNC, &event);
      if (status != LIBEVDEV_READ_STATUS_SYNC) return;
      take(event, sink);
    }
  }

  static constexpr int kMostEvents = kMostReports * 16;  // more than pens change at once
  static constexpr std::size_t kMostPassing = 64;        // serials and scan codes of one frame

  FileHandle file_;
  Device evdev_;
  TraceDevice device_;
  bool kernel_stamps_;
  std::vector<Control> controls_;
  bool whole_ = true;        // the next frame tells the whole state
  bool overflowed_ = false;  // the frame in the making does not fit
  std::size_t count_ = 0;
  std::array<EvdevEvent, kMaxFrameEvents> events_;
};

/// libevdev would print.
void say_nothing(const libevdev*, libevdev_log_priority, void*, const char*, int, const char*,
                 const char*, va_list) {}

std::string text_of(const char* text) { return text != nullptr ? text : ""; }

TraceDevice describe(const libevdev* evdev, const std::string& node) {
  TraceDevice device;
  device.name = text_of(libevdev_get_name(evdev));
  device.physical_path = text_of(libevdev_get_phys(evdev));
  device.unique_id = text_of(libevdev_get_uniq(evdev));
  device.bus = static_cast<std::uint16_t>(libevdev_get_id_bustype(evdev));
  device.vendor = static_cast<std::uint16_t>(libevdev_get_id_vendor(evdev));
  device.product = static_cast<std::uint16_t>(libevdev_get_id_product(evdev));
  device.version = static_cast<std::uint16_t>(libevdev_get_id_version(evdev));
  for (unsigned code = 0; code < ABS_CNT; ++code) {
    const input_absinfo* axis = libevdev_get_abs_info(evdev, code);
    if (axis == nullptr) continue;
    device.axes.push_back({static_cast<std::uint16_t>(code), axis->minimum, axis->maximum,
                           axis->fuzz, axis->flat, axis->resolution});
  }
  for (std::uint16_t code = REL_X; device.axes.empty() && code <= REL_RZ; ++code) {
    if (libevdev_has_event_code(evdev, EV_REL, code) != 0) device.relative_axes.push_back(code);
  }
  const auto event = device_of_node(node);
  if (const auto hid = event ? event->above("hid") : std::nullopt) {
    device.report_descriptor = hid->bytes("report_descriptor");
  }
  return device;
}

}  // namespace

Expected<std::unique_ptr<Transport>> open_evdev(const std::string& node) {
  FileHandle file(::open(node.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!file) return node_error(node, "opened", errno);
  Device evdev(libevdev_new());
  if (!evdev) return node_error(node, "opened", ENOMEM);
  libevdev_set_device_log_function(evdev.get(), say_nothing, LIBEVDEV_LOG_ERROR, nullptr);
  if (const int status = libevdev_set_fd(evdev.get(), file.get()); status < 0) {
    if (status == -ENODEV) return node_error(node, "opened", ENODEV);
    return fail(ErrorCode::kIo, node, "is no event node", "give one that 'limn devices' names");
  }
  // Every kernel since 3.4 can; where one cannot, its times are of another clock and useless here.
  const bool kernel_stamps = libevdev_set_clock_id(evdev.get(), CLOCK_MONOTONIC) == 0;
  TraceDevice device = describe(evdev.get(), node);
  return std::make_unique<EvdevTransport>(std::move(file), std::move(evdev), std::move(device),
                                          kernel_stamps);
}

}  // namespace limn
