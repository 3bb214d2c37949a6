// Live devices that umockdev plays below the C library, plugged in and unplugged while limn reads
// them. Runs under umockdev-wrapper.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <umockdev.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <thread>

#include "drivers/devices/evdev_pen_decoder.hpp"
#include "drivers/devices/pen_decoder.hpp"
#include "drivers/devices/trace_decoder.hpp"
#include "drivers/transport/device_listing.hpp"
#include "drivers/transport/diagnosis.hpp"
#include "drivers/transport/evdev_transport.hpp"
#include "drivers/transport/hidraw_transport.hpp"
#include "drivers/transport/live_reader.hpp"
#include "drivers/transport/open_device.hpp"
#include "drivers/transport/paced_reader.hpp"
#include "drivers/transport/udev_hotplug.hpp"
#include "tests/support/alloc_guard.hpp"
#include "tests/support/simulated_tablet.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/unit/drivers/counting_sink.hpp"

namespace limn::test {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;
using Tablet = SimulatedTablet;

/// Frames and losses as text: "3.0=5 1.330=1", "lost? 1".
class TextSink final : public TransportSink {
 public:
  void report(Timestamp, std::span<const std::uint8_t> bytes) noexcept override {
    told.push_back("report of " + std::to_string(bytes.size()));
  }
  void frame(Timestamp time, std::span<const EvdevEvent> events) noexcept override {
    std::string text;
    for (const EvdevEvent& event : events) {
      EXPECT_LE(event.time, time);
      text += (text.empty() ? "" : " ") + std::to_string(event.type) + "." +
              std::to_string(event.code) + "=" + std::to_string(event.value);
    }
    told.push_back(text);
    kept.emplace_back(events.begin(), events.end());
    longest = std::max(longest, events.size());
  }
  void lost(std::uint32_t count, bool estimated) noexcept override {
    told.push_back((estimated ? "lost? " : "lost ") + std::to_string(count));
  }
  std::vector<std::string> told;
  std::vector<std::vector<EvdevEvent>> kept;
  std::size_t longest = 0;
};

class SimulatedNodes : public testing::Test {
 protected:
  void SetUp() override {
    const char* preloaded = std::getenv("LD_PRELOAD");
    if (preloaded == nullptr ||
        std::string_view(preloaded).find("umockdev") == std::string_view::npos) {
      GTEST_SKIP() << "umockdev-wrapper did not start this program";
    }
    testbed_ = umockdev_testbed_new();
    add(Tablet::usb_and_hid_devices());
  }
  void TearDown() override {
    if (testbed_ != nullptr) g_object_unref(testbed_);
  }

  void add(const std::string& devices) {
    GError* error = nullptr;
    ASSERT_TRUE(umockdev_testbed_add_from_string(testbed_, devices.c_str(), &error))
        << error->message;
  }
  void answer(const char* node, const std::string& ioctls) {
    const std::string file = folder_.write("ioctls" + std::to_string(++files_), ioctls).string();
    GError* error = nullptr;
    ASSERT_TRUE(umockdev_testbed_load_ioctl(testbed_, node, file.c_str(), &error))
        << error->message;
  }
  void plug_in_hidraw(int number = 0) {
    add(Tablet::hidraw_device(number));
    answer(("/dev/hidraw" + std::to_string(number)).c_str(), Tablet::hidraw_ioctls(number));
  }
  void plug_in_event_node(const PenAction& state) {
    add(Tablet::event_device());
    answer(Tablet::kEvent, Tablet::event_ioctls(state));
  }
  void unplug(const std::string& node, const std::string& path) {
    umockdev_testbed_uevent(testbed_, ("/sys" + path).c_str(), "remove");
    umockdev_testbed_remove_device(testbed_, ("/sys" + path).c_str());
    // umockdev leaves these behind, and stumbles over them when another device comes.
    g_autofree char* root = umockdev_testbed_get_root_dir(testbed_);
    for (const std::string& left :
         {node, "/ioctl" + node, std::string("/dev/.node"), std::string("/dev/.ptymap")}) {
      std::filesystem::remove_all(root + left);
    }
    ::close(umockdev_testbed_get_dev_fd(testbed_, node.c_str()));
  }
  void send(const std::string& node, const std::vector<std::uint8_t>& bytes) {
    ASSERT_EQ(
        ::write(umockdev_testbed_get_dev_fd(testbed_, node.c_str()), bytes.data(), bytes.size()),
        static_cast<ssize_t>(bytes.size()));
  }
  void step(const PenAction& before, const PenAction& after) {
    send(Tablet::kEvent, Tablet::bytes(Tablet::events(before, after)));
  }
  /// The hovering pen reports, unmoved: the first frame.
  void begin() { send(Tablet::kEvent, Tablet::bytes({{3, 0, 1000}, {0, 0, 0}})); }
  std::unique_ptr<Transport> open_event_node() {
    auto opened = open_evdev(Tablet::kEvent);
    EXPECT_TRUE(opened.has_value()) << opened.error().what;
    return opened ? *std::move(opened) : nullptr;
  }
  /// Drains until the sink was told `count` things in all.
  static void drain(Transport& transport, TextSink& sink, std::size_t count) {
    while (sink.told.size() < count) {
      pollfd polled{transport.poll_descriptor(), POLLIN, 0};
      ASSERT_EQ(::poll(&polled, 1, 10'000), 1) << "nothing came";
      ASSERT_EQ(transport.drain(sink), Transport::State::kOpen);
    }
  }

  TempFolder folder_;
  UMockdevTestbed* testbed_ = nullptr;
  int files_ = 0;
};

constexpr PenAction kHover{true, false, false, 1000, 2000, 0, 10, -20};
constexpr PenAction kTouch{true, true, false, 1005, 2000, 300, 10, -20};

TEST_F(SimulatedNodes, EvdevDescribesItsDevice) {
  plug_in_event_node({});
  const auto transport = open_event_node();
  ASSERT_NE(transport, nullptr);
  const TraceDevice& device = transport->device();
  EXPECT_EQ(device.name, "Simulated Tablet");
  EXPECT_EQ(device.physical_path, "usb-1/input0");
  EXPECT_EQ(device.bus, 3);
  EXPECT_EQ(device.vendor, 0x1209);
  EXPECT_EQ(device.product, 2);
  EXPECT_EQ(device.version, 0x100);
  EXPECT_EQ(device.report_descriptor, Tablet::report_descriptor()) << "of the HID device behind it";
  ASSERT_EQ(device.axes.size(), 5u);
  EXPECT_EQ(device.axes[0].code, 0);
  EXPECT_EQ(device.axes[0].maximum, 20000);
  EXPECT_EQ(device.axes[0].resolution, 190);
  const auto decoder = EvdevPenDecoder::make(device);
  ASSERT_TRUE(decoder.has_value());
  EXPECT_NEAR(decoder->range().width_mm, 105.3, 1e-9) << "not 20000 / 190";
}

TEST_F(SimulatedNodes, EvdevsFirstFrameIsTheWholeState) {
  plug_in_event_node(kHover);
  const auto transport = open_event_node();
  ASSERT_NE(transport, nullptr);
  TextSink sink;
  PenAction moved = kHover;
  moved.x = 1001;
  step(kHover, moved);
  drain(*transport, sink, 1);
  moved.y = 2001;
  PenAction further = moved;
  step({kHover.in_range, false, false, 1001, 2000, 0, 10, -20}, further);
  drain(*transport, sink, 2);
  EXPECT_THAT(
      sink.told,
      ElementsAre("3.0=1001 3.1=2000 3.24=0 3.26=10 3.27=-20 1.320=1 1.330=0 1.331=0", "3.1=2001"))
      << "and then changes only";
}

TEST_F(SimulatedNodes, EvdevGivesTheWholeStateAgainWhenAsked) {
  plug_in_event_node(kHover);
  const auto transport = open_event_node();
  ASSERT_NE(transport, nullptr);
  TextSink sink;
  begin();
  drain(*transport, sink, 1);
  transport->tell_whole_state();
  send(Tablet::kEvent, Tablet::bytes({{4, 0, 77}, {3, 0, 1005}, {0, 0, 0}}));
  drain(*transport, sink, 2);
  EXPECT_EQ(sink.told[1],
            "3.0=1005 3.1=2000 3.24=0 3.26=10 3.27=-20 1.320=1 1.330=0 1.331=0 4.0=77")
      << "a serial is no state";
}

TEST_F(SimulatedNodes, EvdevAsksForTheStateWhereTheKernelDroppedEvents) {
  plug_in_event_node(kHover);
  const auto transport = open_event_node();
  ASSERT_NE(transport, nullptr);
  TextSink sink;
  begin();
  drain(*transport, sink, 1);
  step(kHover, kTouch);
  drain(*transport, sink, 2);
  // The queue overran amid a frame; meanwhile the pen has lifted and gone back: what umockdev
  // answers is the hovering state.
  send(Tablet::kEvent, Tablet::bytes({{3, 0x18, 200}, {0, 3, 0}, {3, 1, 1}, {0, 0, 0}}));
  drain(*transport, sink, 4);
  EXPECT_EQ(sink.told[2], "lost? 1");

  // Whatever order the events came in, a decoder knows the state, and counts nothing itself.
  auto decoder = EvdevPenDecoder::make(transport->device());
  ASSERT_TRUE(decoder.has_value());
  PenSample last;
  std::uint32_t lost = 0;
  for (const auto& events : sink.kept) {
    for (const PenSample& sample : decoder->decode({0, Timestamp(1), events})) {
      last = sample;
      lost += sample.lost;
    }
  }
  EXPECT_EQ(last.state, PenState::kInRange);
  EXPECT_EQ(last.raw, (RawCounts{1000, 2000, 0}));
  EXPECT_EQ(lost, 0u) << "the transport has told it";
  EXPECT_EQ(decoder->repaired_transitions(), 0u);
}

TEST_F(SimulatedNodes, EvdevBoundsAFrameWithoutEnd) {
  plug_in_event_node(kHover);
  const auto transport = open_event_node();
  ASSERT_NE(transport, nullptr);
  TextSink sink;
  begin();
  drain(*transport, sink, 1);
  for (int i = 0; i < 5000; i += 50) {
    std::vector<KernelEvent> part;
    for (int k = 0; k < 50; ++k) part.push_back({3, 0, i + k});
    send(Tablet::kEvent, Tablet::bytes(part));
    pollfd polled{transport->poll_descriptor(), POLLIN, 0};
    ASSERT_EQ(::poll(&polled, 1, 10'000), 1);
    ASSERT_EQ(transport->drain(sink), Transport::State::kOpen);
  }
  send(Tablet::kEvent, Tablet::bytes({{0, 0, 0}}));
  drain(*transport, sink, 3);
  EXPECT_EQ(sink.told[1], "lost? 1");
  EXPECT_EQ(sink.told[2], "3.0=4999 3.1=2000 3.24=0 3.26=10 3.27=-20 1.320=1 1.330=0 1.331=0")
      << "the whole state in its place";
  EXPECT_LE(sink.longest, kMaxFrameEvents);
}

TEST_F(SimulatedNodes, EvdevDrainsWithoutAllocating) {
  plug_in_event_node(kHover);
  const auto transport = open_event_node();
  ASSERT_NE(transport, nullptr);
  CountingSink sink;
  std::vector<KernelEvent> events;
  for (int i = 0; i < 20; ++i) events.insert(events.end(), {{3, 0, i}, {0, 0, 0}});
  send(Tablet::kEvent, Tablet::bytes(events));
  pollfd polled{transport->poll_descriptor(), POLLIN, 0};
  ASSERT_EQ(::poll(&polled, 1, 10'000), 1);
  const AllocGuard guard;
  (void)transport->drain(sink);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(sink.frames, 0);
}

TEST_F(SimulatedNodes, EvdevGoesWithItsDevice) {
  plug_in_event_node(kHover);
  const auto transport = open_event_node();
  ASSERT_NE(transport, nullptr);
  unplug(Tablet::kEvent, Tablet::event_path());
  TextSink sink;
  pollfd polled{transport->poll_descriptor(), POLLIN, 0};
  ASSERT_EQ(::poll(&polled, 1, 10'000), 1);
  EXPECT_EQ(transport->drain(sink), Transport::State::kGone);
}

/// A stroke: in from afar, down, along with the barrel switch, up, away.
std::vector<PenAction> stroke() {
  std::vector<PenAction> actions = {kHover};
  for (int i = 0; i < 20; ++i) {
    actions.push_back({true, i > 2 && (i < 17), (i > 9), 1000 + 37 * i, 2000 + 11 * i,
                       i > 2 && i < 17 ? 50 * i : 0, i - 10, 20 - i});
  }
  actions.push_back({false, false, false, 1703, 2209, 0, 9, 1});
  return actions;
}

TEST_F(SimulatedNodes, BothSidesOfLinuxGiveTheSameSamples) {
  plug_in_hidraw();
  plug_in_event_node({});
  const auto evdev = open_event_node();
  ASSERT_NE(evdev, nullptr);
  auto frames = EvdevPenDecoder::make(evdev->device());
  auto reports = PenDecoder::make(0x1209, 2, Tablet::report_descriptor());
  ASSERT_TRUE(frames.has_value());
  ASSERT_TRUE(reports.has_value());
  PenAction before;
  TextSink sink;
  int compared = 0;
  for (const PenAction& action : stroke()) {
    step(before, action);
    before = action;
    drain(*evdev, sink, sink.told.size() + 1);
    const auto kernel = frames->decode({0, Timestamp(1), sink.kept.back()});
    const auto bytes = Tablet::report(action);
    const auto own = reports->decode({0, Timestamp(1), bytes}).samples;
    ASSERT_EQ(kernel.size(), own.size());
    for (std::size_t i = 0; i < own.size(); ++i) {
      EXPECT_EQ(kernel[i].state, own[i].state);
      EXPECT_EQ(kernel[i].tool, own[i].tool);
      EXPECT_EQ(kernel[i].buttons, own[i].buttons);
      if (own[i].state == PenState::kOutOfRange) continue;
      constexpr double kRounding = 1e-9;  // a factor here is its reciprocal there
      EXPECT_EQ(kernel[i].axes, own[i].axes);
      EXPECT_NEAR(kernel[i].x_mm, own[i].x_mm, kRounding);
      EXPECT_NEAR(kernel[i].y_mm, own[i].y_mm, kRounding);
      EXPECT_NEAR(kernel[i].tilt_x_rad, own[i].tilt_x_rad, kRounding);
      EXPECT_NEAR(kernel[i].tilt_y_rad, own[i].tilt_y_rad, kRounding);
      EXPECT_EQ(kernel[i].pressure, own[i].pressure);
      EXPECT_EQ(kernel[i].raw, own[i].raw);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 21);
}

Expected<std::unique_ptr<Hotplug>> watch_tablets(std::shared_ptr<DeviceNews> heard = {},
                                                 std::vector<Backend> backends = {
                                                     Backend::kHidraw}) {
  DeviceWatch watch;
  watch.backends = std::move(backends);
  watch.wanted = [](const ListedDevice& one) { return one.device.vendor == 0x1209; };
  watch.open = [](const ListedDevice& one) {
    auto opened = open_device(one);
    return opened ? std::move(opened->transport) : nullptr;
  };
  return watch_devices(std::move(watch), std::move(heard));
}

/// One event of a live reader as text; "nothing" where none comes in ten seconds.
std::string next(LiveReader& reader) {
  const auto read = reader.next_until(monotonic_clock().now() + 10s);
  if (!read) return read.error().what;
  const auto& event = *read;
  if (!event) return "nothing";
  if (const auto* described = std::get_if<DeviceDescribed>(&*event)) {
    return "described " + std::to_string(described->device->index) + ' ' + described->device->name;
  }
  if (const auto* report = std::get_if<Report>(&*event)) {
    return "report " + std::to_string(report->device) + " of " +
           std::to_string(report->bytes.size());
  }
  if (const auto* frame = std::get_if<EvdevFrame>(&*event)) {
    return "frame " + std::to_string(frame->device) + " of " + std::to_string(frame->events.size());
  }
  if (const auto* note = std::get_if<TraceNote>(&*event)) {
    return "note " + std::to_string(note->device) + ' ' + std::string(note->text);
  }
  return std::holds_alternative<TraceEnd>(*event) ? "end" : "other";
}

TEST_F(SimulatedNodes, ADeviceMayComeAndGoWhileLimnReads) {
  // Each node is told twice below. Opened a second time just before it goes, it would come back
  // for a moment: what becomes of that is another test's.
  DeviceWatch watch;
  watch.wanted = [](const ListedDevice& one) { return one.device.vendor == 0x1209; };
  watch.open = [known = std::set<std::string>()](const ListedDevice& one) mutable {
    auto opened = open_device(one);
    if (!opened || !known.insert(one.node).second) return std::unique_ptr<Transport>();
    return std::move(opened->transport);
  };
  auto hotplug = watch_devices(std::move(watch));
  ASSERT_TRUE(hotplug.has_value()) << hotplug.error().what;
  const auto reader = *LiveReader::start({}, *std::move(hotplug));
  for (int round = 0; round < 3; ++round) {
    // Under another node each time, as Linux may do while somebody still has the old one open.
    const std::string node = "/dev/hidraw" + std::to_string(round);
    plug_in_hidraw(round);  // tells it, too; its ioctls are answered only now
    umockdev_testbed_uevent(testbed_, ("/sys" + Tablet::hidraw_path(round)).c_str(), "add");
    ASSERT_EQ(next(*reader), "described 0 Simulated Tablet") << "round " << round;
    send(node, Tablet::report(kHover));
    ASSERT_EQ(next(*reader), "report 0 of 10");
    send(node, Tablet::report(kTouch));
    ASSERT_EQ(next(*reader), "report 0 of 10");
    unplug(node, Tablet::hidraw_path(round));
    ASSERT_EQ(next(*reader), "note 0 gone");
  }
  reader->stop();
  EXPECT_EQ(next(*reader), "end");
}

TEST_F(SimulatedNodes, WhatComesBeforeTheWatchIsHeard) {
  auto heard = listen_for_devices();
  ASSERT_TRUE(heard.has_value()) << heard.error().what;
  plug_in_hidraw();
  umockdev_testbed_uevent(testbed_, ("/sys" + Tablet::hidraw_path()).c_str(), "add");
  auto hotplug = watch_tablets(*std::move(heard));
  ASSERT_TRUE(hotplug.has_value()) << hotplug.error().what;
  const auto reader = *LiveReader::start({}, *std::move(hotplug));
  EXPECT_EQ(next(*reader), "described 0 Simulated Tablet");
  reader->stop();
}

TEST_F(SimulatedNodes, AWatchFollowsItsBackends) {
  auto hotplug = watch_tablets({}, {Backend::kHidraw, Backend::kEvdev});
  ASSERT_TRUE(hotplug.has_value()) << hotplug.error().what;
  const auto reader = *LiveReader::start({}, *std::move(hotplug));
  plug_in_event_node(kHover);
  umockdev_testbed_uevent(testbed_, ("/sys" + Tablet::event_path()).c_str(), "add");
  ASSERT_EQ(next(*reader), "described 0 Simulated Tablet");
  step(kHover, kTouch);
  EXPECT_EQ(next(*reader), "frame 0 of 8");
  reader->stop();
}

TEST_F(SimulatedNodes, NoMoreDevicesWaitThanMayBeRead) {
  plug_in_hidraw();
  std::atomic<std::size_t> asked = 0;
  std::atomic<std::size_t> opened = 0;
  DeviceWatch watch;
  watch.wanted = [&asked](const ListedDevice&) {
    ++asked;
    return true;
  };
  watch.open = [&opened](const ListedDevice& one) -> std::unique_ptr<Transport> {
    ++opened;
    int ends[2];  // in place of the node: umockdev keeps account of few open ones
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) != 0) return nullptr;
    ::close(ends[0]);
    return open_messages(ends[1], one.device);
  };
  auto hotplug = watch_devices(std::move(watch));
  ASSERT_TRUE(hotplug.has_value()) << hotplug.error().what;
  for (std::size_t i = 1; i <= kMaxTraceDevices + 3; ++i) {
    umockdev_testbed_uevent(testbed_, ("/sys" + Tablet::hidraw_path()).c_str(), "add");
    const auto deadline = monotonic_clock().now() + 10s;
    while (asked < i && monotonic_clock().now() < deadline) std::this_thread::yield();
    ASSERT_GE(asked, i);
  }
  EXPECT_EQ((*hotplug)->arrived().size(), kMaxTraceDevices);
  EXPECT_EQ(opened, kMaxTraceDevices);
}

TEST_F(SimulatedNodes, ADeviceThatIsToldTwiceIsReadOnce) {
  plug_in_hidraw();
  std::vector<std::unique_ptr<Transport>> devices;
  devices.push_back(*open_hidraw(Tablet::kHidraw));
  int ends[2];  // of what the watch opens: the far end shows when the reader has let go of it
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends), 0);
  DeviceWatch watch;
  watch.wanted = [](const ListedDevice&) { return true; };
  watch.open = [&ends](const ListedDevice& one) { return open_messages(ends[1], one.device); };
  auto hotplug = watch_devices(std::move(watch));
  ASSERT_TRUE(hotplug.has_value()) << hotplug.error().what;
  const auto reader = *LiveReader::start(std::move(devices), *std::move(hotplug));
  ASSERT_EQ(next(*reader), "described 0 Simulated Tablet");
  umockdev_testbed_uevent(testbed_, ("/sys" + Tablet::hidraw_path()).c_str(), "add");
  pollfd far_end{ends[0], POLLIN, 0};
  ASSERT_EQ(::poll(&far_end, 1, 10000), 1) << "the second one is still there";
  ::close(ends[0]);
  unplug(Tablet::kHidraw, Tablet::hidraw_path());
  EXPECT_EQ(next(*reader), "note 0 gone");
  reader->stop();
  EXPECT_EQ(next(*reader), "end") << "and no second device";
}

TEST_F(SimulatedNodes, EventNodesReadLikeOtherLiveDevices) {
  plug_in_event_node(kHover);
  std::vector<std::unique_ptr<Transport>> devices;
  devices.push_back(open_event_node());
  ASSERT_NE(devices[0], nullptr);
  const auto reader = *LiveReader::start(std::move(devices));
  EXPECT_EQ(next(*reader), "described 0 Simulated Tablet");
  step(kHover, kTouch);
  EXPECT_EQ(next(*reader), "frame 0 of 8");
  step(kTouch, kHover);
  EXPECT_EQ(next(*reader), "frame 0 of 3");
  unplug(Tablet::kEvent, Tablet::event_path());
  EXPECT_EQ(next(*reader), "note 0 gone");
  EXPECT_EQ(next(*reader), "end");
}

TEST_F(SimulatedNodes, ListingKnowsBothSidesForOneDevice) {
  plug_in_hidraw();
  plug_in_event_node({});
  const auto listed = list_devices();
  ASSERT_TRUE(listed.has_value()) << listed.error().what;
  std::vector<ListedDevice> ours;
  for (const ListedDevice& one : *listed) {
    if (one.device.vendor == 0x1209) ours.push_back(one);
  }
  ASSERT_EQ(ours.size(), 2u);
  EXPECT_EQ(ours[0].node, Tablet::kHidraw);
  EXPECT_EQ(ours[0].driver, "hid-generic");
  EXPECT_EQ(ours[0].most_reports_per_second, 200);
  EXPECT_EQ(ours[0].same_as, "");
  EXPECT_EQ(ours[1].node, Tablet::kEvent);
  EXPECT_TRUE(ours[1].tablet);
  EXPECT_EQ(ours[1].same_as, Tablet::kHidraw);
  ASSERT_EQ(ours[1].device.axes.size(), 5u);
  EXPECT_EQ(ours[1].device.axes[0].maximum, 20000) << "asked, as it may be read";
}

TEST_F(SimulatedNodes, ADeviceMayVanishBetweenListingAndOpening) {
  plug_in_hidraw();
  plug_in_event_node({});
  const auto listed = list_devices();
  ASSERT_TRUE(listed.has_value());
  unplug(Tablet::kHidraw, Tablet::hidraw_path());
  unplug(Tablet::kEvent, Tablet::event_path());
  int tried = 0;
  for (const ListedDevice& one : *listed) {
    if (one.device.vendor != 0x1209) continue;
    const auto opened = open_device(one);
    ASSERT_FALSE(opened.has_value());
    EXPECT_EQ(opened.error().at, one.node);
    EXPECT_EQ(opened.error().what, "cannot be opened: No such file or directory");
    EXPECT_EQ(opened.error().remedy, "plug the device in and see 'limn devices'");
    ++tried;
  }
  EXPECT_EQ(tried, 2);
}

/// Runs `check` as a user without any rights; the first line that it gives, or "".
template <class Check>
std::string as_nobody(Check check) {
  int ends[2];
  if (::pipe(ends) != 0) return "no pipe";
  const pid_t child = ::fork();
  if (child == 0) {
    constexpr unsigned kNobody = 65534;
    const bool dropped = ::geteuid() != 0 || (::setgid(kNobody) == 0 && ::setuid(kNobody) == 0);
    const std::string text = dropped ? check() : "privileges cannot be dropped";
    [[maybe_unused]] const ssize_t written = ::write(ends[1], text.data(), text.size());
    ::_exit(0);
  }
  ::close(ends[1]);
  std::string text;
  char buffer[512];
  for (ssize_t size = 0; (size = ::read(ends[0], buffer, sizeof buffer)) > 0;) {
    text.append(buffer, static_cast<std::size_t>(size));
  }
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return text;
}

TEST_F(SimulatedNodes, TellsWhatMayNotBeReadAndReadsTheOtherSide) {
  plug_in_hidraw();
  plug_in_event_node({});
  g_autofree char* root = umockdev_testbed_get_root_dir(testbed_);
  ASSERT_EQ(::chmod(root, 0755), 0);
  for (const std::string node : {Tablet::kHidraw, Tablet::kEvent}) {  // umockdev's own connections
    ASSERT_EQ(::chmod((root + ("/ioctl" + node)).c_str(), 0777), 0);
  }
  ASSERT_EQ(::chmod(Tablet::kHidraw, 0600), 0);
  ASSERT_EQ(::chmod(Tablet::kEvent, 0666), 0);
  const std::string told = as_nobody([] {
    if (::geteuid() == 0) return std::string("still root");
    const auto opened = open_hidraw(Tablet::kHidraw);
    return opened ? std::string("opened") : opened.error().what + "; " + opened.error().remedy;
  });
  EXPECT_EQ(told,
            "cannot be opened: Permission denied; install limn's udev rules and plug the device in "
            "again, or see 'limn doctor'");
  const std::string chosen = as_nobody([] {
    const auto listed = list_devices();
    if (!listed) return listed.error().what;
    std::vector<ListedDevice> ours;
    for (const ListedDevice& one : *listed) {
      if (one.device.vendor == 0x1209) ours.push_back(one);
    }
    const DeviceChoice choice = *choose_rows(ours);
    std::string text;
    for (const auto& row : choice.rows) text += row.node + '\n';
    for (const auto& note : choice.notes) text += note + '\n';
    return text + look_at(ours.at(0)).what;
  });
  EXPECT_EQ(chosen,
            "/dev/input/event300\n/dev/hidraw0, Simulated Tablet: no permission; "
            "/dev/input/event300 is used instead\nSimulated Tablet: no permission");
}

}  // namespace
}  // namespace limn::test
