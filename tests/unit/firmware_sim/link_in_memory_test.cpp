#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_sim/devices/catalogue.hpp"
#include "firmware_sim/link/in_memory.hpp"
#include "firmware_sim/link/standard_requests.hpp"
#include "tests/unit/firmware_sim/counting_device.hpp"

namespace limn::firmware {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

/// "6000 report 0 #1", "0 plugged", ..: times in microseconds, then what.
std::vector<std::string> events(InMemoryHost& host, std::chrono::microseconds end) {
  std::vector<std::string> lines;
  while (const auto event = host.next(end)) {
    std::string line = std::to_string(event->time.count());
    if (event->kind == HostEvent::Kind::kPlugged) line += " plugged";
    if (event->kind == HostEvent::Kind::kUnplugged) line += " unplugged";
    if (event->kind == HostEvent::Kind::kReport) {
      line += " report " + std::to_string(event->interface) + " #" +
              std::to_string(event->bytes[1] | event->bytes[2] << 8);
    }
    lines.push_back(line);
  }
  return lines;
}

TEST(InMemoryHost, PollsEachEndpointAtItsInterval) {
  CountingDevice device;
  device.function.count = {3, 2};
  InMemoryHost host(device);
  // Due at 5, 10 and 15 ms; interface 0 is asked every 2 ms, interface 1 every one.
  EXPECT_THAT(events(host, 20ms),
              ElementsAre("0 plugged", "5000 report 1 #1", "6000 report 0 #1", "10000 report 0 #2",
                          "10000 report 1 #2", "16000 report 0 #3"));
  EXPECT_EQ(host.time(), 20ms);
}

TEST(InMemoryHost, MayPollSoThatReportsComeWhenTheyAreDue) {
  CountingDevice device;
  device.function.count = {2, 0};
  InMemoryHost host(device, InMemoryHost::Polling::kWhenDue);
  EXPECT_THAT(events(host, 20ms),
              ElementsAre("0 plugged", "5000 report 0 #1", "10000 report 0 #2"));
  EXPECT_THAT(host.report_descriptor(1), testing::ElementsAreArray(kCountingDescriptor));
}

TEST(InMemoryHost, ManyThatAreDueComeAtOnceAndNotForEver) {
  CountingDevice device;
  device.function.count = {3, 5000};
  device.function.period = 1us;
  InMemoryHost host(device, InMemoryHost::Polling::kWhenDue);
  EXPECT_THAT(events(host, 1ms), testing::SizeIs(1 + 3 + 1000));
  device.function.period = 0us;  // all of them, whenever it is asked
  EXPECT_EQ(events(host, 2ms).size(), 4000U);
  device.function.count[1] = 20'000;
  EXPECT_EQ(events(host, 3ms).size(), 4096U) << "the time goes on, whatever a device says";
}

TEST(InMemoryHost, AFasterDeviceThanTheHostWaitsItsTurn) {
  CountingDevice device;
  device.function.count = {3, 0};
  device.function.period = 1ms;
  InMemoryHost host(device);
  EXPECT_THAT(events(host, 20ms),
              ElementsAre("0 plugged", "2000 report 0 #1", "4000 report 0 #2", "6000 report 0 #3"));
}

TEST(InMemoryHost, IsAskedInPiecesAsInOne) {
  CountingDevice device;
  device.function.count = {3, 0};
  InMemoryHost host(device);
  std::vector<std::string> lines;
  for (auto end = 0us; end <= 20ms; end += 700us) {
    for (const std::string& line : events(host, end)) lines.push_back(line);
  }
  EXPECT_THAT(lines, ElementsAre("0 plugged", "6000 report 0 #1", "10000 report 0 #2",
                                 "16000 report 0 #3"));
}

TEST(InMemoryHost, MakesRequestsOnceTheDeviceIsConfigured) {
  CountingDevice device;
  InMemoryHost host(device, InMemoryHost::Polling::kByInterval,
                    {{set_report(1, ReportKind::kFeature, 2, 4), {2, 7, 8, 9}}});
  EXPECT_THAT(events(host, 1ms), ElementsAre("0 plugged"));
  EXPECT_THAT(device.function.told, ElementsAre(1, 3, 2, 2, 7, 8, 9));
  EXPECT_EQ(device.usb.configuration(), 1);
  EXPECT_EQ(device.function.resets, 1);
}

TEST(InMemoryHost, SeesTheDeviceGoAndComeBack) {
  CountingDevice device;
  device.function.count = {9, 0};
  device.gone = 12ms;
  device.back = 31ms;
  InMemoryHost host(device, InMemoryHost::Polling::kByInterval,
                    {{set_report(0, ReportKind::kFeature, 2, 4), {2, 1, 1, 1}}});
  EXPECT_THAT(events(host, 36ms),
              ElementsAre("0 plugged", "6000 report 0 #1", "10000 report 0 #2", "12000 unplugged",
                          "31000 plugged", "33000 report 0 #3", "35000 report 0 #4"));
  EXPECT_EQ(device.function.resets, 2);
  EXPECT_EQ(device.function.feature[1], 1) << "asked again";
}

TEST(InMemoryHost, ClearsAHaltedEndpoint) {
  CountingDevice device;
  device.function.count = {2, 0};
  InMemoryHost host(device);
  EXPECT_THAT(events(host, 6ms), ElementsAre("0 plugged", "6000 report 0 #1"));
  const SetupPacket halt = {0x02, 3, 0, 0x81, 0};
  EXPECT_EQ(host.control(halt, {}).status, TransferStatus::kDone);
  Bytes data(8);
  EXPECT_EQ(device.interrupt_in(0x81, 6ms, data).status, TransferStatus::kStall);
  EXPECT_THAT(events(host, 12ms), ElementsAre("10000 report 0 #2"));
}

TEST(InMemoryHost, SendsOutputByInterruptOrElseByControl) {
  CountingDevice device;
  InMemoryHost host(device);
  events(host, 1ms);
  const Bytes report = {3, 5, 6};
  EXPECT_TRUE(host.send_output(0, 3, report));
  EXPECT_THAT(device.function.told, ElementsAre(0, 2, 3, 3, 5, 6));
  EXPECT_TRUE(host.send_output(1, 3, report));
  EXPECT_THAT(device.function.told, ElementsAre(1, 2, 3, 3, 5, 6));
  EXPECT_FALSE(host.send_output(2, 3, report)) << "there is no such interface";
  EXPECT_FALSE(host.send_output(0, 9, Bytes{9, 1, 1})) << "the device refuses it";
}

/// A device that tells how long it is silent, or not; and how often it is looked at.
class LookedAt final : public BusDevice {
 public:
  LookedAt(BusDevice& device, bool tells) : device_(device), tells_(tells) {}

  const DeviceSpec& spec() const noexcept override { return device_.spec(); }
  bool plugged(std::chrono::microseconds now) noexcept override { return device_.plugged(now); }
  void reset() noexcept override { device_.reset(); }
  TransferResult control(const SetupPacket& setup, std::chrono::microseconds now,
                         std::span<std::uint8_t> data) noexcept override {
    return device_.control(setup, now, data);
  }
  TransferResult interrupt_in(std::uint8_t endpoint, std::chrono::microseconds now,
                              std::span<std::uint8_t> data) noexcept override {
    ++looks;
    return device_.interrupt_in(endpoint, now, data);
  }
  TransferResult interrupt_out(std::uint8_t endpoint, std::chrono::microseconds now,
                               std::span<const std::uint8_t> data) noexcept override {
    return device_.interrupt_out(endpoint, now, data);
  }
  std::chrono::microseconds silent_until(std::chrono::microseconds now) noexcept override {
    return tells_ ? device_.silent_until(now) : now;
  }

  int looks = 0;

 private:
  BusDevice& device_;
  bool tells_;
};

/// Two seconds of a device, which is told something in the middle, off a frame; reports as bytes.
std::vector<std::string> two_seconds(std::string_view name, bool tells, int& looks) {
  const auto made =
      make_simulated_device(name, name.starts_with("space") ? std::string_view("push") : "star", 1);
  LookedAt device(made->bus(), tells);
  InMemoryHost host(device, InMemoryHost::Polling::kWhenDue);
  std::vector<std::string> lines;
  for (const auto end : {1000300us, 2000000us}) {
    while (const auto event = host.next(end)) {
      lines.push_back(
          std::to_string(event->time.count()) + " " +
          testing::PrintToString(std::vector<int>(event->bytes.begin(), event->bytes.end())));
    }
    std::uint8_t mode[] = {2, 2};  // of which the Intuos begins to speak
    host.control(set_report(0, ReportKind::kFeature, 2, 2), mode);
    std::uint8_t text[255];  // and the Huions
    host.control({0x80, 6, 0x0300 | 200, 0x0409, 255}, text);
  }
  looks = device.looks;
  return lines;
}

TEST(InMemoryHost, LooksAtASilentDeviceLessAndSeesTheSame) {
  for (const SimulatedInfo& info : simulated_devices()) {
    SCOPED_TRACE(info.name);
    int rare = 0;
    int often = 0;
    const auto events = two_seconds(info.name, true, rare);
    EXPECT_EQ(events, two_seconds(info.name, false, often));
    EXPECT_GT(events.size(), 20U);
    EXPECT_LE(rare, info.name == "fast-pen" ? often : often * 8 / 10);
  }
}

}  // namespace
}  // namespace limn::firmware
