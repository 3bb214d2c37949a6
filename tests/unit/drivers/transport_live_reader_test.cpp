#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <mutex>
#include <thread>

#include "drivers/devices/trace_decoder.hpp"
#include "drivers/transport/hidraw_transport.hpp"
#include "drivers/transport/live_reader.hpp"
#include "drivers/transport/paced_reader.hpp"
#include "input/trace/hid_recorder_writer.hpp"
#include "tests/support/alloc_guard.hpp"
#include "tests/unit/drivers/counting_sink.hpp"

namespace limn::test {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

/// The device's end of a transport.
class FarEnd {
 public:
  /// Makes both ends; the transport goes to the caller.
  explicit FarEnd(TraceDevice device, std::unique_ptr<Transport>& transport) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) != 0) std::abort();
    descriptor_ = ends[0];
    transport = open_messages(ends[1], std::move(device));
  }
  ~FarEnd() { leave(); }
  FarEnd(const FarEnd&) = delete;
  FarEnd& operator=(const FarEnd&) = delete;

  void send(std::vector<std::uint8_t> bytes) const {
    ASSERT_EQ(::write(descriptor_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  bool try_send(std::span<const std::uint8_t> bytes) const {
    return ::send(descriptor_, bytes.data(), bytes.size(), MSG_DONTWAIT) > 0;
  }
  void leave() {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
  }

 private:
  int descriptor_ = -1;
};

TraceDevice pen(std::string path = "usb-1") {
  TraceDevice device;
  device.name = "A Pen";
  device.physical_path = std::move(path);
  device.bus = 3;
  device.vendor = 0x1209;
  device.product = 1;
  device.report_descriptor = {0x05, 0x0d};
  return device;
}

std::unique_ptr<LiveReader> start(std::unique_ptr<Transport> transport,
                                  std::unique_ptr<Hotplug> hotplug = nullptr) {
  std::vector<std::unique_ptr<Transport>> devices;
  if (transport) devices.push_back(std::move(transport));
  return *LiveReader::start(std::move(devices), std::move(hotplug));
}

/// One event as text: "described 0 A Pen", "report 0 01 02", "note 0 gone", "end".
std::string text_of(const TraceEvent& event) {
  if (const auto* described = std::get_if<DeviceDescribed>(&event)) {
    return "described " + std::to_string(described->device->index) + ' ' + described->device->name;
  }
  if (const auto* report = std::get_if<Report>(&event)) {
    std::string text = "report " + std::to_string(report->device);
    for (const auto byte : report->bytes) text += ' ' + std::to_string(byte);
    return text;
  }
  if (const auto* note = std::get_if<TraceNote>(&event)) {
    return "note " + std::to_string(note->device) + ' ' + std::string(note->text);
  }
  return std::holds_alternative<TraceEnd>(event) ? "end" : "other";
}

std::string next(LiveReader& reader) { return text_of(*reader.next()); }

/// Devices that the test plugs in.
class TestHotplug final : public Hotplug {
 public:
  TestHotplug() {
    if (::pipe(ends_) != 0) std::abort();
  }
  ~TestHotplug() override {
    ::close(ends_[0]);
    ::close(ends_[1]);
  }
  int poll_descriptor() const noexcept override { return ends_[0]; }
  std::vector<std::unique_ptr<Transport>> arrived() override {
    const std::lock_guard lock(mutex_);
    char byte = 0;
    EXPECT_EQ(::read(ends_[0], &byte, 1), 1);
    return std::move(waiting_);
  }
  void plug_in(std::unique_ptr<Transport> transport) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(transport));
    EXPECT_EQ(::write(ends_[1], "x", 1), 1);
  }

 private:
  int ends_[2];
  std::mutex mutex_;
  std::vector<std::unique_ptr<Transport>> waiting_;
};

TEST(LiveReader, GivesWhatADeviceSends) {
  std::unique_ptr<Transport> transport;
  FarEnd device(pen(), transport);
  const auto reader = start(std::move(transport));
  EXPECT_EQ(next(*reader), "described 0 A Pen");
  device.send({1, 2, 3});
  device.send({4});
  EXPECT_EQ(next(*reader), "report 0 1 2 3");
  EXPECT_EQ(next(*reader), "report 0 4");
  device.send({5});
  device.leave();
  EXPECT_EQ(next(*reader), "report 0 5");
  EXPECT_EQ(next(*reader), "note 0 gone");
  EXPECT_EQ(next(*reader), "end");
  EXPECT_EQ(next(*reader), "end");
}

TEST(LiveReader, TellsNotesRightAfterTheDescriptionEachTimeADeviceComes) {
  std::unique_ptr<Transport> transport;
  FarEnd device(pen(), transport);
  transport->add_note("string 201");
  transport->add_note("string 200 12 03");
  auto hotplug = std::make_unique<TestHotplug>();
  TestHotplug& port = *hotplug;
  device.send({1});
  const auto reader = start(std::move(transport), std::move(hotplug));
  EXPECT_EQ(next(*reader), "described 0 A Pen");
  EXPECT_EQ(next(*reader), "note 0 string 201");
  EXPECT_EQ(next(*reader), "note 0 string 200 12 03");
  EXPECT_EQ(next(*reader), "report 0 1");
  device.leave();
  EXPECT_EQ(next(*reader), "note 0 gone");
  std::unique_ptr<Transport> back;
  FarEnd again(pen(), back);
  back->add_note("string 201 04 03 41 00");
  port.plug_in(std::move(back));
  EXPECT_EQ(next(*reader), "described 0 A Pen");
  EXPECT_EQ(next(*reader), "note 0 string 201 04 03 41 00");
}

// Recorded: probe of Huion New 1060 Plus; no table knows product 0999.
TEST(LiveReader, ARecordingOfAnInitialisedPenDecodesWithoutIt) {
  TraceDevice described = pen();
  described.vendor = 0x256C;
  described.product = 0x0999;
  described.report_descriptor = {};
  std::unique_ptr<Transport> transport;
  FarEnd device(described, transport);
  transport->add_note("string 201 04 03 41 00");
  transport->add_note("string 200 12 03 70 c6 00 06 7c 00 ff 1f d8 13 03 0c 10 00 01 00");
  device.send({8, 0x80, 0x70, 0xC6, 0x06, 0x7C, 0, 0, 0, 0, 0, 0});
  device.leave();
  auto live = start(std::move(transport));
  StringSink file;
  HidRecorderWriter writer(file);
  for (bool ended = false; !ended;) {
    const auto event = *live->next();
    if (const auto* one = std::get_if<DeviceDescribed>(&event)) {
      ASSERT_TRUE(writer.describe(*one->device));
    } else if (const auto* note = std::get_if<TraceNote>(&event)) {
      ASSERT_TRUE(writer.note(note->text, note->device));
    } else if (const auto* report = std::get_if<Report>(&event)) {
      ASSERT_TRUE(writer.write(*report));
    }
    ended = std::holds_alternative<TraceEnd>(event);
  }
  TraceDecoder decoder(*open_trace(memory_bytes(file.text())));
  const auto sample = decoder.next();
  ASSERT_TRUE(sample) << sample.error().what;
  ASSERT_NE(*sample, nullptr);
  EXPECT_EQ((*sample)->x_mm, 254);
  EXPECT_EQ((*sample)->y_mm, 158.75);
  EXPECT_EQ(decoder.summary().devices[0].kind, "UC-Logic v2");
}

TEST(LiveReader, StampsWhenItReads) {
  std::unique_ptr<Transport> transport;
  FarEnd device(pen(), transport);
  const auto reader = start(std::move(transport));
  const Timestamp before = monotonic_clock().now();
  device.send({1});
  EXPECT_EQ(next(*reader), "described 0 A Pen");
  const auto event = *reader->next();
  EXPECT_GE(std::get<Report>(event).time, before);
  EXPECT_LE(std::get<Report>(event).time, monotonic_clock().now());
}

TEST(LiveReader, ReadsSeveralDevicesUnderTheirIndices) {
  std::vector<std::unique_ptr<Transport>> devices(2);
  FarEnd first(pen("a"), devices[0]);
  FarEnd second(pen("b"), devices[1]);
  const auto reader = *LiveReader::start(std::move(devices));
  EXPECT_EQ(next(*reader), "described 0 A Pen");
  EXPECT_EQ(next(*reader), "described 1 A Pen");
  second.send({2});
  EXPECT_EQ(next(*reader), "report 1 2");
  first.send({1});
  EXPECT_EQ(next(*reader), "report 0 1");
}

TEST(LiveReader, StopsFromAnywhereAndEndsCleanly) {
  std::unique_ptr<Transport> transport;
  FarEnd device(pen(), transport);
  const auto reader = start(std::move(transport));
  EXPECT_EQ(next(*reader), "described 0 A Pen");
  std::thread other([&reader] { reader->stop(); });
  EXPECT_EQ(next(*reader), "end");
  other.join();
}

TEST(LiveReader, WaitsNoLongerThanAsked) {
  std::unique_ptr<Transport> transport;
  FarEnd device(pen(), transport);
  const auto reader = start(std::move(transport));
  EXPECT_EQ(next(*reader), "described 0 A Pen");
  const Timestamp deadline = monotonic_clock().now() + 5ms;
  EXPECT_FALSE(reader->next_until(deadline)->has_value());
  EXPECT_GE(monotonic_clock().now(), deadline);
}

TEST(LiveReader, SilenceTakesASilentPenOutOfRange) {
  // A New 1060 Plus, which never says that its pen leaves, and nothing more comes.
  TraceDevice tablet;
  tablet.vendor = 0x256C;
  tablet.product = 0x006E;
  std::unique_ptr<Transport> transport;
  FarEnd device(tablet, transport);
  TraceDecoder decoder(start(std::move(transport)));
  device.send({8, 0x80, 0x10, 0x27, 0x10, 0x27, 0, 0, 0, 0, 0, 0});
  device.send({8, 0x81, 0x10, 0x27, 0x10, 0x27, 9, 0, 0, 0, 0, 0});
  std::vector<PenSample> samples;
  for (int i = 0; i < 4; ++i) samples.push_back(**decoder.next());
  EXPECT_EQ(samples[0].state, PenState::kInRange);
  EXPECT_EQ(samples[1].state, PenState::kInContact);
  EXPECT_EQ(samples[2].state, PenState::kInRange);
  EXPECT_EQ(samples[3].state, PenState::kOutOfRange);
  EXPECT_EQ(samples[2].time, samples[1].time + kLeavingTimeout);
  EXPECT_EQ(samples[3].time, samples[1].time + kLeavingTimeout) << "not when it was noticed";
  device.send({8, 0x80, 0x10, 0x27, 0x10, 0x27, 0, 0, 0, 0, 0, 0});
  const PenSample back = **decoder.next();
  EXPECT_EQ(back.state, PenState::kInRange);
  EXPECT_GE(back.time, samples[3].time);
}

TEST(LiveReader, AnotherDevicesReportsAreNoSilenceAndHideNone) {
  TraceDevice tablet;
  tablet.vendor = 0x256C;
  tablet.product = 0x006E;
  TraceDevice graphire;
  graphire.vendor = 0x056A;
  graphire.product = 0x0013;
  std::vector<std::unique_ptr<Transport>> devices(2);
  FarEnd silent(tablet, devices[0]);
  FarEnd busy(graphire, devices[1]);
  TraceDecoder decoder(*LiveReader::start(std::move(devices)));
  silent.send({8, 0x80, 0x10, 0x27, 0x10, 0x27, 0, 0, 0, 0, 0, 0});
  std::vector<PenSample> of_silent;
  while (of_silent.size() < 2) {
    busy.send({2, 0x90, 0x40, 0x1f, 0x20, 0x03, 0, 0});
    const PenSample sample = **decoder.next();
    if (sample.device == 0) of_silent.push_back(sample);
  }
  EXPECT_EQ(of_silent[1].state, PenState::kOutOfRange);
  EXPECT_EQ(of_silent[1].time, of_silent[0].time + kLeavingTimeout);
}

TEST(LiveReader, CountsWhatAFloodDrops) {
  // Nobody takes events until far more was sent than the ring holds.
  std::unique_ptr<Transport> transport;
  FarEnd device(pen(), transport);
  const auto reader = start(std::move(transport));
  std::vector<std::uint8_t> report(1000, 7);
  constexpr std::uint64_t kSent = 5000;
  for (std::uint64_t i = 0; i < kSent;) {
    if (device.try_send(report)) {
      ++i;
    } else {
      std::this_thread::sleep_for(1ms);
    }
  }
  std::uint64_t given = 0;
  std::uint64_t lost = 0;
  device.send({1});
  device.leave();
  for (;;) {
    const auto event = *reader->next();
    if (std::holds_alternative<TraceEnd>(event)) break;
    given += std::holds_alternative<Report>(event) ? 1 : 0;
    if (const auto* note = std::get_if<TraceNote>(&event);
        note && note->text.starts_with("lost ")) {
      lost += std::stoull(std::string(note->text.substr(5)));
    }
  }
  EXPECT_GT(given, 0u);
  EXPECT_EQ(given + lost, kSent + 1);
}

/// Gives more than the ring holds at once, and tells when the reader has had it all.
class Burst final : public Transport {
 public:
  Burst(int descriptor, std::atomic<bool>& given)
      : descriptor_(descriptor), given_(given), device_(pen()) {}
  ~Burst() override { ::close(descriptor_); }
  const TraceDevice& device() const noexcept override { return device_; }
  int poll_descriptor() const noexcept override { return descriptor_; }
  State drain(TransportSink& sink) noexcept override {
    std::uint8_t byte = 0;
    if (::recv(descriptor_, &byte, 1, MSG_DONTWAIT) != 1) return State::kOpen;
    constexpr std::array<std::uint8_t, 1000> kReport{};
    for (int i = 0; i < 3000; ++i) sink.report(monotonic_clock().now(), kReport);
    given_ = true;
    return State::kOpen;
  }

 private:
  int descriptor_;
  std::atomic<bool>& given_;
  TraceDevice device_;
};

TEST(LiveReader, TellsAtTheEndWhatItDropped) {
  // Nobody takes an event before all reports were given, so none finds room after the loss.
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends), 0);
  std::atomic<bool> given = false;
  const auto reader = start(std::make_unique<Burst>(ends[1], given));
  ASSERT_EQ(::write(ends[0], "x", 1), 1);
  while (!given) std::this_thread::sleep_for(1ms);
  reader->stop();
  int reports = 0;
  std::string last;
  for (std::string event = next(*reader); event != "end"; event = next(*reader)) {
    reports += event.starts_with("report 0 ") ? 1 : 0;
    last = event;
  }
  EXPECT_GT(reports, 0);
  EXPECT_EQ(last, "note 0 lost " + std::to_string(3000 - reports));
  ::close(ends[0]);
}

TEST(LiveReader, AllocatesNothingForAReport) {
  std::unique_ptr<Transport> transport;
  FarEnd device(pen(), transport);
  const auto reader = start(std::move(transport));
  EXPECT_EQ(next(*reader), "described 0 A Pen");
  const std::vector<std::uint8_t> report(20, 7);
  ASSERT_TRUE(device.try_send(report));
  (void)reader->next();  // the thread's own first round
  const AllocGuard guard;
  for (int i = 0; i < 1000; ++i) {
    if (!device.try_send(report)) continue;
    const auto event = reader->next();
    if (!event || !std::holds_alternative<Report>(*event)) ADD_FAILURE();
  }
  EXPECT_EQ(guard.count(), 0u) << "in the caller's thread";
}

TEST(LiveReader, AllocatesNothingFromAReportToItsSample) {
  TraceDevice graphire;
  graphire.vendor = 0x056A;
  graphire.product = 0x0013;
  std::unique_ptr<Transport> transport;
  FarEnd device(graphire, transport);
  TraceDecoder decoder(start(std::move(transport)));
  const std::vector<std::uint8_t> report = {2, 0x90, 0x40, 0x1f, 0x20, 0x03, 0, 0};
  ASSERT_TRUE(device.try_send(report));
  ASSERT_NE(*decoder.next(), nullptr);
  const AllocGuard guard;
  int samples = 0;
  for (int i = 0; i < 1000; ++i) {
    if (device.try_send(report) && *decoder.next() != nullptr) ++samples;
  }
  EXPECT_EQ(guard.count(), 0u) << "in the caller's thread";
  EXPECT_EQ(samples, 1000);
}

TEST(OpenMessages, DrainingAllocatesNothing) {
  CountingSink sink;
  std::unique_ptr<Transport> transport;
  FarEnd device(pen(), transport);
  for (std::uint8_t i = 0; i < 100; ++i) device.send({i, 2, 3});
  const AllocGuard guard;
  EXPECT_EQ(transport->drain(sink), Transport::State::kOpen);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_EQ(sink.reports, 100);
  device.leave();
  EXPECT_EQ(transport->drain(sink), Transport::State::kGone);
}

TEST(OpenMessages, AFloodHasNoMoreThanItsShare) {
  CountingSink sink;
  std::unique_ptr<Transport> transport;
  FarEnd device(pen(), transport);
  const std::vector<std::uint8_t> report(8, 1);
  int sent = 0;
  while (sent <= Transport::kMostReports && device.try_send(report)) ++sent;
  ASSERT_GT(sent, Transport::kMostReports);
  EXPECT_EQ(transport->drain(sink), Transport::State::kOpen);
  EXPECT_EQ(sink.reports, Transport::kMostReports);
}

TEST(LiveReader, AFullQueueOfTheKernelIsTold) {
  constexpr int kQueue = 5;
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends), 0);
  for (std::uint8_t i = 0; i < kQueue; ++i) ASSERT_EQ(::write(ends[0], &i, 1), 1);
  const auto reader = start(open_messages(ends[1], pen(), kQueue));
  std::vector<std::string> told;
  for (int i = 0; i < kQueue + 1; ++i) told.push_back(text_of(*reader->next()));
  EXPECT_EQ(told.back(), "report 0 4");
  const std::uint8_t more = 9;
  ASSERT_EQ(::write(ends[0], &more, 1), 1);
  EXPECT_EQ(text_of(*reader->next()), "note 0 lost? 0");
  EXPECT_EQ(text_of(*reader->next()), "report 0 9");
  ::close(ends[0]);
}

/// Has read three reports ahead of its descriptor, which shows one only.
class ReadingAhead final : public Transport {
 public:
  explicit ReadingAhead(int descriptor) : descriptor_(descriptor), device_(pen()) {}
  ~ReadingAhead() override { ::close(descriptor_); }
  const TraceDevice& device() const noexcept override { return device_; }
  int poll_descriptor() const noexcept override { return descriptor_; }
  State drain(TransportSink& sink) noexcept override {
    std::uint8_t byte = 0;
    if (::recv(descriptor_, &byte, 1, MSG_DONTWAIT) == 1) left_ = 3;
    if (left_ == 0) return State::kOpen;
    sink.report(monotonic_clock().now(), {&left_, 1});
    --left_;
    return left_ > 0 ? State::kMore : State::kOpen;
  }

 private:
  int descriptor_;
  TraceDevice device_;
  std::uint8_t left_ = 0;
};

TEST(LiveReader, DrainsWhatATransportHasReadAhead) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends), 0);
  const auto reader = start(std::make_unique<ReadingAhead>(ends[1]));
  ASSERT_EQ(::write(ends[0], "x", 1), 1);
  std::vector<std::string> told;
  for (int i = 0; i < 4; ++i) told.push_back(text_of(*reader->next()));
  EXPECT_THAT(told, ElementsAre("described 0 A Pen", "report 0 3", "report 0 2", "report 0 1"));
  ::close(ends[0]);
}

TEST(LiveReader, ADeviceThatComesBackKeepsItsIndex) {
  std::unique_ptr<Transport> transport;
  FarEnd device(pen(), transport);
  auto hotplug = std::make_unique<TestHotplug>();
  TestHotplug& port = *hotplug;
  const auto reader = start(std::move(transport), std::move(hotplug));
  EXPECT_EQ(next(*reader), "described 0 A Pen");
  device.leave();
  EXPECT_EQ(next(*reader), "note 0 gone");

  std::unique_ptr<Transport> other_transport;
  FarEnd other(pen("usb-2"), other_transport);
  port.plug_in(std::move(other_transport));
  EXPECT_EQ(next(*reader), "described 1 A Pen");
  TraceDevice numbered = pen();  // over Bluetooth all are at one place
  numbered.unique_id = "00:11:22:33:44:55";
  std::unique_ptr<Transport> twin_transport;
  FarEnd twin(numbered, twin_transport);
  port.plug_in(std::move(twin_transport));
  EXPECT_EQ(next(*reader), "described 2 A Pen");

  std::unique_ptr<Transport> back_transport;
  FarEnd back(pen(), back_transport);
  port.plug_in(std::move(back_transport));
  EXPECT_EQ(next(*reader), "described 0 A Pen");
  back.send({9});
  EXPECT_EQ(next(*reader), "report 0 9");
  reader->stop();
  EXPECT_EQ(next(*reader), "end");
}

TEST(LiveReader, MayBeDroppedWhileDevicesSend) {
  for (int i = 0; i < 20; ++i) {
    std::unique_ptr<Transport> transport;
    FarEnd device(pen(), transport);
    const auto reader = start(std::move(transport));
    device.send({1});
  }
}

TEST(OpenHidraw, NamesWhatIsWrong) {
  const auto absent = open_hidraw("/dev/hidraw-absent");
  ASSERT_FALSE(absent.has_value());
  EXPECT_EQ(absent.error().what, "cannot be opened: No such file or directory");
  EXPECT_EQ(absent.error().remedy, "plug the device in and see 'limn devices'");
  const auto other = open_hidraw("/dev/null");
  ASSERT_FALSE(other.has_value());
  EXPECT_EQ(other.error().what, "is no hidraw node");
}

}  // namespace
}  // namespace limn::test
