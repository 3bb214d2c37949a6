// Pens that are unplugged and plugged in again in mid-stroke, on a stock Linux kernel.

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iterator>
#include <thread>

#include "drivers/devices/trace_decoder.hpp"
#include "drivers/transport/live_reader.hpp"
#include "drivers/transport/open_device.hpp"
#include "drivers/transport/udev_hotplug.hpp"
#include "firmware_sim/devices/hid_pen_tablet.hpp"
#include "firmware_sim/usb/usb_device.hpp"
#include "input/stroke/stroke_sampler.hpp"
#include "tests/kernel/device_paths.hpp"
#include "tests/kernel/plugged_device.hpp"

namespace limn::test {
namespace {

using namespace std::chrono_literals;
using std::chrono::microseconds;

/// A pen that drags over the tablet and never lifts.
class DraggedPen final : public firmware::PenSensor {
 public:
  firmware::PenPose measure(microseconds time) noexcept override {
    firmware::PenPose pose;
    pose.time = time;
    pose.proximity = firmware::Proximity::kTouching;
    pose.x_mm = 10 + static_cast<double>(time.count() % 1'000'000) * 1e-4;
    pose.y_mm = 50;
    pose.pressure = 0.5;
    return pose;
  }
};

/// How long a device is there, and away, how many times.
struct Cycles {
  microseconds there;
  microseconds away;
  int count = 0;
};

/// A device that is there for a while, then away, and so on, and away for good in the end.
class CycledDevice final : public firmware::BusDevice {
 public:
  CycledDevice(firmware::BusDevice& device, Cycles cycles) : device_(device), cycles_(cycles) {}

  bool done() const noexcept { return done_; }

  const firmware::DeviceSpec& spec() const noexcept override { return device_.spec(); }
  bool plugged(microseconds now) noexcept override {
    const microseconds cycle = cycles_.there + cycles_.away;
    if (now >= cycle * cycles_.count) done_ = true;
    return now < cycle * cycles_.count && now % cycle < cycles_.there;
  }
  void reset() noexcept override { device_.reset(); }
  firmware::TransferResult control(const firmware::SetupPacket& setup, microseconds now,
                                   std::span<std::uint8_t> data) noexcept override {
    if (!plugged(now)) return {firmware::TransferStatus::kNoDevice, 0};
    return device_.control(setup, now, data);
  }
  firmware::TransferResult interrupt_in(std::uint8_t endpoint, microseconds now,
                                        std::span<std::uint8_t> data) noexcept override {
    if (!plugged(now)) return {firmware::TransferStatus::kNoDevice, 0};
    return device_.interrupt_in(endpoint, now, data);
  }
  firmware::TransferResult interrupt_out(std::uint8_t endpoint, microseconds now,
                                         std::span<const std::uint8_t> data) noexcept override {
    if (!plugged(now)) return {firmware::TransferStatus::kNoDevice, 0};
    return device_.interrupt_out(endpoint, now, data);
  }
  microseconds silent_until(microseconds now) noexcept override {
    const microseconds cycle = cycles_.there + cycles_.away;
    const microseconds begun = now - now % cycle;
    if (!plugged(now)) return begun + cycle;
    return std::min(begun + cycles_.there, device_.silent_until(now));
  }

 private:
  firmware::BusDevice& device_;
  Cycles cycles_;
  std::atomic<bool> done_ = false;
};

/// A tablet of its own place, with its pen.
struct ReplugTablet {
  ReplugTablet(Cable cable, Cycles cycles)
      : device(tablet_device, cycles), plugged(device, cable) {}

  DraggedPen pen;
  firmware::HidPenTablet tablet{pen, firmware::HidPenTablet::Pace::kUsual};
  firmware::UsbDevice tablet_device{tablet};
  CycledDevice device;
  PluggedDevice plugged;
};

/// What limn makes of pens that come and go.
struct Seen {
  int strokes = 0;
  int left_open = 0;  ///< when all had gone
  std::uint64_t samples = 0;
};

Seen watch(const std::vector<std::unique_ptr<ReplugTablet>>& tablets) {
  DeviceWatch watch;
  watch.wanted = [](const ListedDevice&) { return true; };
  watch.open = [](const ListedDevice& listed) {
    auto opened = open_device(listed);
    return opened ? std::move(opened->transport) : nullptr;
  };
  auto hotplug = watch_devices(std::move(watch));
  EXPECT_TRUE(hotplug) << hotplug.error().what;
  auto reader = LiveReader::start({}, *std::move(hotplug));
  EXPECT_TRUE(reader) << reader.error().what;
  LiveReader& live = **reader;
  std::thread ending([&] {
    for (const auto& tablet : tablets) {
      while (!tablet->device.done()) std::this_thread::sleep_for(50ms);
    }
    std::this_thread::sleep_for(1s);
    live.stop();
  });
  Seen seen;
  TraceDecoder decoder(*std::move(reader), {.salvage = true});
  StrokeSampler strokes;
  const auto count = [&seen](const Stroke& stroke) {
    ++seen.strokes;
    EXPECT_GT(stroke.points.size(), 1U);
  };
  for (;;) {
    const auto sample = decoder.next();
    EXPECT_TRUE(sample) << sample.error().what;
    if (!sample || *sample == nullptr) break;
    ++seen.samples;
    strokes.push(**sample, count);
  }
  strokes.finish([&seen](const Stroke&) { ++seen.left_open; });
  ending.join();
  return seen;
}

int entries_of(const char* folder) {
  return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// Plugs in that many tablets, each `cycles.count` times, and watches them.
Seen replug(int by_uhid, Cycles uhid, int by_usbip, Cycles usbip) {
  std::vector<std::unique_ptr<ReplugTablet>> tablets;
  const auto add = [&tablets](int tablet_count, Cable cable, Cycles cycles) {
    for (int i = 0; i < tablet_count; ++i) {
      tablets.push_back(std::make_unique<ReplugTablet>(cable, cycles));
    }
  };
  add(by_uhid, Cable::kUhid, uhid);
  add(by_usbip, Cable::kUsbip, usbip);
  return watch(tablets);
}

TEST(KernelReplugs, EveryStrokeIsClosedAndNothingLeaks) {
  // First once, so that what is made once and kept is there.
  const Seen first = replug(1, {600ms, 300ms, 1}, 1, {1500ms, 500ms, 1});
  EXPECT_EQ(first.strokes, 2);
  wait_until_all_are_gone();
  const int files = entries_of("/proc/self/fd");
  const auto heap = ::mallinfo2().uordblks;

  const Seen seen = replug(5, {600ms, 300ms, 20}, 1, {1500ms, 500ms, 10});
  EXPECT_EQ(seen.strokes, 110) << "100 by UHID, 10 by USB/IP";
  EXPECT_EQ(seen.left_open, 0);
  EXPECT_GT(seen.samples, 110U * 10);
  wait_until_all_are_gone();
  EXPECT_EQ(entries_of("/proc/self/fd"), files);
  std::this_thread::sleep_for(100ms);  // a thread that was joined shows for a moment more
  EXPECT_EQ(entries_of("/proc/self/task"), 1);
  const auto grown = static_cast<long>(::mallinfo2().uordblks) - static_cast<long>(heap);
  std::printf("heap: %ld bytes more after 110 replugs, %lu samples\n", grown,
              static_cast<unsigned long>(seen.samples));
  EXPECT_LT(grown, 4096);
}

}  // namespace
}  // namespace limn::test
