#include "drivers/transport/live_reader.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "drivers/transport/file_handle.hpp"
#include "drivers/transport/paced_reader.hpp"
#include "drivers/transport/transport_closer.hpp"
#include "input/base/record_ring.hpp"

namespace limn {
namespace {

enum class RecordKind : std::uint32_t { kReport, kFrame, kDescribed, kNote, kLost, kGone, kEnd };

/// Before the bytes of each record in the ring.
struct RecordHead {
  RecordKind kind = RecordKind::kEnd;
  DeviceIndex device = 0;
  std::int64_t time_ns = 0;
  std::uint32_t count = 0;
  std::uint32_t estimated = 0;
};

constexpr std::size_t kRingBytes = std::size_t{1} << 20;  // 5 s of ten devices at 1 kHz
constexpr std::size_t kControlBytes = 4096;               // kept free for what is no report

void signal_descriptor(int descriptor) noexcept {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(descriptor, &one, sizeof one);
}

void clear_descriptor(int descriptor) noexcept {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t size = ::read(descriptor, &count, sizeof count);
}

bool same_device(const TraceDevice& a, const TraceDevice& b) {
  return a.bus == b.bus && a.vendor == b.vendor && a.product == b.product && a.name == b.name &&
         a.physical_path == b.physical_path && a.unique_id == b.unique_id;
}

}  // namespace

/// The reading thread and what it shares with the consumer.
class LiveReader::Reading {
 public:
  struct Slot {
    std::unique_ptr<Transport> transport;  // nothing while the device is away
    std::shared_ptr<const TraceDevice> device;
    bool more = false;          // it has more than poll may show
    std::uint32_t dropped = 0;  // not told yet
    bool dropped_estimated = false;

    bool owes_loss() const noexcept { return dropped > 0 || dropped_estimated; }
  };

  Expected<void> start(std::vector<std::unique_ptr<Transport>> devices,
                       std::unique_ptr<Hotplug> hotplug) {
    if (!wake_ || !ready_) {
      return fail(ErrorCode::kIo, "", "the system gives no event descriptor",
                  "close other programs");
    }
    if (devices.size() > kMaxTraceDevices) {
      return fail(ErrorCode::kLimit, "", std::to_string(devices.size()) + " devices are too many",
                  "name those to read");
    }
    hotplug_ = std::move(hotplug);
    for (auto& device : devices) add(std::move(device));
    try {
      closer_.start();
      thread_ = std::thread([this] { run(); });
    } catch (const std::system_error& error) {
      return fail(ErrorCode::kIo, "", std::string("no thread: ") + error.what(),
                  "close other programs");
    }
    return {};
  }

  ~Reading() {
    stop();
    if (thread_.joinable()) thread_.join();
  }

  void stop() noexcept {
    stopping_.store(true, std::memory_order_relaxed);
    signal_descriptor(wake_.get());
  }

  RecordRing& ring() noexcept { return ring_; }
  int ready_descriptor() const noexcept { return ready_.get(); }
  /// Whether the thread is stamping and pushing; it signals when it has done so.
  bool in_round() const noexcept { return in_round_.load(); }
  std::shared_ptr<const TraceDevice> described(DeviceIndex index) {
    const std::lock_guard lock(devices_mutex_);
    return index < slots_.size() ? slots_[index].device : nullptr;
  }
  Expected<std::unique_ptr<DeviceControl>> open_control(DeviceIndex index) {
    const std::lock_guard lock(devices_mutex_);
    if (index < slots_.size() && slots_[index].transport) {
      return slots_[index].transport->open_control();
    }
    return fail(ErrorCode::kMissing, "device " + std::to_string(index), "is not there",
                "plug it in");
  }

 private:
  /// A device's transport speaks through this into the ring.
  class Sink final : public TransportSink {
   public:
    Sink(Reading& reading, DeviceIndex index) : reading_(reading), index_(index) {}
    void report(Timestamp time, std::span<const std::uint8_t> bytes) noexcept override {
      reading_.push_data({RecordKind::kReport, index_, time.count()}, bytes.data(), bytes.size());
    }
    void frame(Timestamp time, std::span<const EvdevEvent> events) noexcept override {
      reading_.push_data({RecordKind::kFrame, index_, time.count()}, events.data(),
                         events.size_bytes());
    }
    void lost(std::uint32_t count, bool estimated) noexcept override {
      reading_.lose(index_, count, estimated);
    }

   private:
    Reading& reading_;
    DeviceIndex index_;
  };

  void run() noexcept {
    std::vector<pollfd> polled;
    std::vector<DeviceIndex> owners;
    while (!stopping_.load(std::memory_order_relaxed)) {
      polled.assign({{wake_.get(), POLLIN, 0}});
      if (hotplug_) polled.push_back({hotplug_->poll_descriptor(), POLLIN, 0});
      const std::size_t first = polled.size();
      owners.clear();
      for (DeviceIndex i = 0; i < slots_.size(); ++i) {
        if (!slots_[i].transport) continue;
        polled.push_back({slots_[i].transport->poll_descriptor(), POLLIN, 0});
        owners.push_back(i);
      }
      if (owners.empty() && !hotplug_) break;
      const bool more =
          std::any_of(slots_.begin(), slots_.end(), [](const Slot& slot) { return slot.more; });
      if (::poll(polled.data(), polled.size(), more ? 0 : -1) < 0 && errno != EINTR) break;
      in_round_.store(true);
      if (polled[0].revents != 0) clear_descriptor(wake_.get());
      for (std::size_t k = 0; k < owners.size(); ++k) {
        if (polled[first + k].revents != 0 || slots_[owners[k]].more) drain(owners[k]);
      }
      if (hotplug_ && polled[1].revents != 0) {
        for (auto& device : hotplug_->arrived()) {
          if (!reads(device->device())) add(std::move(device));
        }
      }
      in_round_.store(false);
      signal_descriptor(ready_.get());
    }
    for (DeviceIndex i = 0; i < slots_.size(); ++i) {
      if (slots_[i].owes_loss()) push_control(take_loss(i));
    }
    push_control({RecordKind::kEnd, 0, 0});
    signal_descriptor(ready_.get());
  }

  void drain(DeviceIndex index) noexcept {
    Slot& slot = slots_[index];
    Sink sink(*this, index);
    const Transport::State state = slot.transport->drain(sink);
    slot.more = state == Transport::State::kMore;
    if (state != Transport::State::kGone) return;
    std::unique_ptr<Transport> gone;
    {
      const std::lock_guard lock(devices_mutex_);
      gone = std::move(slot.transport);
    }
    closer_.close(std::move(gone));
    if (slot.owes_loss()) push_control(take_loss(index));
    push_control({RecordKind::kGone, index, monotonic_clock().now().count()});
  }

  /// Whether the device is being read: udev may tell of it again (udevadm trigger). Devices without
  /// a place cannot be told from their twins.
  bool reads(const TraceDevice& device) const {
    return !device.physical_path.empty() &&
           std::any_of(slots_.begin(), slots_.end(), [&device](const Slot& slot) {
             return slot.transport && same_device(*slot.device, device);
           });
  }

  void add(std::unique_ptr<Transport> transport) {
    TraceDevice device = transport->device();
    const std::vector<std::string> notes = transport->notes();
    DeviceIndex index = 0;
    {
      const std::lock_guard lock(devices_mutex_);
      while (index < slots_.size() &&
             (slots_[index].transport || !same_device(*slots_[index].device, device))) {
        ++index;
      }
      if (index == slots_.size()) {
        if (index == kMaxTraceDevices) return;
        slots_.emplace_back();
      }
      device.index = index;
      slots_[index].device = std::make_shared<const TraceDevice>(std::move(device));
      slots_[index].transport = std::move(transport);
    }
    const std::int64_t now = monotonic_clock().now().count();
    push_control({RecordKind::kDescribed, index, now});
    for (const std::string& note : notes) push_control({RecordKind::kNote, index, now}, note);
  }

  void lose(DeviceIndex index, std::uint32_t count, bool estimated) noexcept {
    slots_[index].dropped += count;
    slots_[index].dropped_estimated |= estimated;
  }

  void push_data(RecordHead head, const void* data, std::size_t size) noexcept {
    Slot& slot = slots_[head.device];
    if (slot.owes_loss()) {
      if (ring_.reserve(2 * sizeof head + size + kControlBytes).empty()) {
        drop(slot);
        return;
      }
      push(take_loss(head.device), nullptr, 0, 0);
    }
    if (!push(head, data, size, kControlBytes)) drop(slot);
  }

  static void drop(Slot& slot) noexcept {
    ++slot.dropped;
    if (slot.transport) slot.transport->tell_whole_state();
  }

  RecordHead take_loss(DeviceIndex index) noexcept {
    Slot& slot = slots_[index];
    return {RecordKind::kLost, index, monotonic_clock().now().count(),
            std::exchange(slot.dropped, 0), std::exchange(slot.dropped_estimated, false) ? 1U : 0U};
  }

  /// What is no report has room kept free for it. Where even that is gone (a device that comes and
  /// goes faster than anybody reads), it waits for the consumer.
  void push_control(const RecordHead& head, std::string_view note = {}) noexcept {
    while (!push(head, note.data(), note.size(), 0) && !closed_.load(std::memory_order_relaxed)) {
      signal_descriptor(ready_.get());
      ::usleep(1000);
    }
  }

  bool push(const RecordHead& head, const void* data, std::size_t size,
            std::size_t kept_free) noexcept {
    const auto room = ring_.reserve(sizeof head + size + kept_free);
    if (room.empty()) return false;
    const auto exact = ring_.reserve(sizeof head + size);
    std::memcpy(exact.data(), &head, sizeof head);
    if (size > 0) std::memcpy(exact.data() + sizeof head, data, size);
    ring_.commit();
    return true;
  }

 public:
  /// Nobody takes records any more.
  void close() noexcept { closed_.store(true, std::memory_order_relaxed); }

 private:
  FileHandle wake_{::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};   // to the thread: stop
  FileHandle ready_{::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};  // from the thread: records
  RecordRing ring_{kRingBytes};
  // Of slots_' growth, slots_[..].device, and which transport there is. The reading thread alone
  // changes them, and so looks at them without it.
  std::mutex devices_mutex_;
  std::vector<Slot> slots_;
  std::unique_ptr<Hotplug> hotplug_;
  TransportCloser closer_;
  std::atomic<bool> stopping_ = false;
  std::atomic<bool> closed_ = false;
  std::atomic<bool> in_round_ = false;
  std::thread thread_;
};

LiveReader::LiveReader() : reading_(std::make_unique<Reading>()) {}

LiveReader::~LiveReader() { reading_->close(); }

Expected<std::unique_ptr<LiveReader>> LiveReader::start(
    std::vector<std::unique_ptr<Transport>> devices, std::unique_ptr<Hotplug> hotplug) {
  std::unique_ptr<LiveReader> reader(new LiveReader());
  reader->frame_.reserve(kMaxFrameEvents);
  if (auto started = reader->reading_->start(std::move(devices), std::move(hotplug)); !started) {
    return tl::unexpected(std::move(started.error()));
  }
  return reader;
}

void LiveReader::stop() noexcept { reading_->stop(); }

Expected<std::unique_ptr<DeviceControl>> LiveReader::open_control(DeviceIndex device) {
  return reading_->open_control(device);
}

std::string LiveReader::place() const { return "device " + std::to_string(last_device_); }

Expected<TraceEvent> LiveReader::next() {
  for (;;) {
    if (auto event = *next_until(Timestamp::max())) return *std::move(event);
  }
}

Expected<std::optional<TraceEvent>> LiveReader::next_until(Timestamp deadline) {
  for (;;) {
    if (auto event = take()) return event;
    pollfd ready{reading_->ready_descriptor(), POLLIN, 0};
    int timeout_ms = -1;  // a round ends with a signal
    const auto left = deadline == Timestamp::max() ? deadline : deadline - monotonic_clock().now();
    if (left <= Timestamp::zero()) {
      // Between two rounds everything stamped before the deadline is in the ring.
      if (!reading_->in_round()) return take();
    } else if (left != Timestamp::max()) {
      constexpr std::int64_t kMostMs = 60'000;
      timeout_ms = static_cast<int>(
          std::min(kMostMs, std::chrono::ceil<std::chrono::milliseconds>(left).count()));
    }
    if (::poll(&ready, 1, timeout_ms) > 0) clear_descriptor(ready.fd);
  }
}

std::optional<TraceEvent> LiveReader::take() {
  RecordRing& ring = reading_->ring();
  if (holds_record_) ring.pop();
  holds_record_ = false;
  if (ended_) return TraceEnd{};
  const auto record = ring.front();
  if (record.empty()) return std::nullopt;
  holds_record_ = true;
  RecordHead head;
  std::memcpy(&head, record.data(), sizeof head);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(record.data()) + sizeof head;
  const std::size_t size = record.size() - sizeof head;
  const Timestamp time(head.time_ns);
  last_device_ = head.device;
  switch (head.kind) {
    case RecordKind::kReport:
      return Report{head.device, time, {bytes, size}};
    case RecordKind::kFrame:
      frame_.resize(size / sizeof(EvdevEvent));
      if (size > 0) std::memcpy(frame_.data(), bytes, size);
      return EvdevFrame{head.device, time, frame_};
    case RecordKind::kDescribed:
      described_ = reading_->described(head.device);
      return DeviceDescribed{described_.get()};
    case RecordKind::kNote:
      note_.assign(reinterpret_cast<const char*>(bytes), size);
      return TraceNote{note_, head.device};
    case RecordKind::kLost:
      note_ = (head.estimated != 0 ? "lost? " : "lost ") + std::to_string(head.count);
      return TraceNote{note_, head.device};
    case RecordKind::kGone:
      note_ = "gone";
      return TraceNote{note_, head.device};
    case RecordKind::kEnd:
      break;
  }
  ended_ = true;
  return TraceEnd{};
}

}  // namespace limn
