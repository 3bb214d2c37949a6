#include "firmware_sim/usb/usb_device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "tests/support/alloc_guard.hpp"

namespace limn::firmware {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::IsEmpty;
using testing::SizeIs;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kNumbered[] = {0x85, 0x01};
// Unnumbered for all that: a long item holds what would be a Report ID item, so does a usage.
constexpr std::uint8_t kUnnumbered[] = {0xFE, 0x02, 0x00, 0x85, 0x01, 0x0A, 0x85, 0x01, 0x09, 0x84};
constexpr EndpointSpec kFirst[] = {{0x81, 8, 10}};
constexpr EndpointSpec kSecond[] = {{0x82, 64, 1}, {0x02, 16, 4}};
constexpr InterfaceSpec kInterfaces[] = {{kNumbered, 1, 2, kFirst}, {kUnnumbered, 0, 0, kSecond}};

constexpr DeviceSpec kSpec = [] {
  DeviceSpec spec;
  spec.vendor = 0x1209;
  spec.product = 0x0001;
  spec.version = 0x0123;
  spec.manufacturer = "limn";
  spec.product_name = "Pen";
  spec.interfaces = kInterfaces;
  spec.attributes = kRemoteWakeup;
  spec.power_ma = 480;
  spec.product_index = 6;
  return spec;
}();

/// Reports what it is given, and keeps what it is told.
class Echo final : public UsbFunction {
 public:
  const DeviceSpec& spec() const noexcept override { return kSpec; }
  void reset() noexcept override { ++resets; }
  std::size_t next_report(std::uint8_t interface, std::chrono::microseconds,
                          std::span<std::uint8_t> report) noexcept override {
    auto& waiting = reports[interface];
    if (waiting.empty()) return 0;
    const Bytes next = waiting.front();
    waiting.pop_front();
    std::copy_n(next.begin(), std::min(next.size(), report.size()), report.begin());
    return next.size();
  }
  int string_descriptor(std::uint8_t index, std::uint16_t language,
                        std::span<std::uint8_t> out) noexcept override {
    if (index != 200 || language != 0x0409) return kStall;
    const Bytes hidden = {0x04, 0x03, 0xAB, 0xCD};
    std::copy_n(hidden.begin(), std::min(hidden.size(), out.size()), out.begin());
    return 4;
  }
  int get_report(std::uint8_t, ReportKind kind, std::uint8_t id,
                 std::span<std::uint8_t> out) noexcept override {
    if (kind != ReportKind::kFeature || id != 2 || out.size() < 2) return kStall;
    out[0] = 2;
    out[1] = 7;
    return 2;
  }
  bool set_report(std::uint8_t interface, ReportKind kind, std::uint8_t id,
                  std::span<const std::uint8_t> bytes) noexcept override {
    told = {interface, static_cast<std::uint8_t>(kind), id};
    told.insert(told.end(), bytes.begin(), bytes.end());
    return id != 9;
  }
  int vendor_request(const SetupPacket& setup, std::span<const std::uint8_t> out,
                     std::span<std::uint8_t> in) noexcept override {
    if (setup.request != 0x55) return kStall;
    if (!in.empty()) in[0] = 0x66;
    told.assign(out.begin(), out.end());
    return in.empty() ? 0 : 1;
  }

  std::array<std::deque<Bytes>, 2> reports;
  Bytes told;
  int resets = 0;
};

class UsbDeviceTest : public testing::Test {
 protected:
  /// A control transfer to the host; the stall is kNothing.
  Bytes in(std::uint8_t type, std::uint8_t number, std::uint16_t value, std::uint16_t index,
           std::uint16_t length) {
    Bytes data(length, 0xEE);
    const auto result = device.control({type, number, value, index, length}, now, data);
    if (result.status != TransferStatus::kDone) return kStalled;
    data.resize(result.bytes);
    return data;
  }
  bool out(std::uint8_t type, std::uint8_t number, std::uint16_t value, std::uint16_t index,
           Bytes data = {}) {
    const auto length = static_cast<std::uint16_t>(data.size());
    const auto result = device.control({type, number, value, index, length}, now, data);
    EXPECT_EQ(result.bytes, result.status == TransferStatus::kDone ? data.size() : 0U);
    return result.status == TransferStatus::kDone;
  }
  bool configure() { return out(0x00, 9, 1, 0); }
  std::pair<TransferStatus, Bytes> poll(std::uint8_t endpoint, std::size_t room = 64) {
    Bytes data(room, 0xEE);
    const auto result = device.interrupt_in(endpoint, now, data);
    data.resize(result.bytes);
    return {result.status, data};
  }

  const Bytes kStalled = {0x57, 0xA1, 0x1E, 0xD0};
  Echo echo;
  UsbDevice device{echo};
  std::chrono::microseconds now{};
};

TEST_F(UsbDeviceTest, DescribesTheDevice) {
  EXPECT_THAT(in(0x80, 6, 0x0100, 0, 18), ElementsAre(18, 1, 0x00, 0x02, 0, 0, 0, 64, 0x09, 0x12,
                                                      0x01, 0x00, 0x23, 0x01, 1, 6, 0, 1));
  EXPECT_THAT(in(0x80, 6, 0x0100, 0, 8), ElementsAre(18, 1, 0x00, 0x02, 0, 0, 0, 64));
  EXPECT_THAT(in(0x80, 6, 0x0100, 0, 255), SizeIs(18));
}

TEST_F(UsbDeviceTest, DescribesTheConfigurationWithAllBelowIt) {
  const Bytes expected = {9, 2,    66,   0, 2,  1, 0,    0xA0, 240,  // configuration
                          9, 4,    0,    0, 1,  3, 1,    2,    0,    // interface 0: boot mouse
                          9, 0x21, 0x11, 1, 0,  1, 0x22, 2,    0,    // HID
                          7, 5,    0x81, 3, 8,  0, 10,               // endpoint 1 in
                          9, 4,    1,    0, 2,  3, 0,    0,    0,    // interface 1
                          9, 0x21, 0x11, 1, 0,  1, 0x22, 10,   0,    // HID
                          7, 5,    0x82, 3, 64, 0, 1,                // endpoint 2 in
                          7, 5,    0x02, 3, 16, 0, 4};               // endpoint 2 out
  EXPECT_THAT(in(0x80, 6, 0x0200, 0, 255), ElementsAreArray(expected));
  EXPECT_THAT(in(0x80, 6, 0x0200, 0, 9),
              ElementsAreArray(Bytes(expected.begin(), expected.begin() + 9)));
}

TEST_F(UsbDeviceTest, GivesStringsInUsEnglishAndTheVendorsOwn) {
  EXPECT_THAT(in(0x80, 6, 0x0300, 0, 255), ElementsAre(4, 3, 0x09, 0x04));
  EXPECT_THAT(in(0x80, 6, 0x0301, 0x0409, 255), ElementsAre(10, 3, 'l', 0, 'i', 0, 'm', 0, 'n', 0));
  EXPECT_THAT(in(0x80, 6, 0x0306, 0x0409, 255), ElementsAre(8, 3, 'P', 0, 'e', 0, 'n', 0));
  EXPECT_EQ(in(0x80, 6, 0x0303, 0x0409, 255), kStalled) << "no serial number";
  EXPECT_THAT(in(0x80, 6, 0x03C8, 0x0409, 255), ElementsAre(4, 3, 0xAB, 0xCD));
  EXPECT_EQ(in(0x80, 6, 0x03C8, 0x0407, 255), kStalled);
}

TEST_F(UsbDeviceTest, GivesHidAndReportDescriptorsByInterface) {
  EXPECT_THAT(in(0x81, 6, 0x2100, 0, 255), ElementsAre(9, 0x21, 0x11, 1, 0, 1, 0x22, 2, 0));
  EXPECT_THAT(in(0x81, 6, 0x2200, 0, 255), ElementsAreArray(kNumbered));
  EXPECT_THAT(in(0x81, 6, 0x2200, 1, 255), ElementsAreArray(kUnnumbered));
  EXPECT_THAT(in(0x81, 6, 0x2200, 1, 3), SizeIs(3));
  EXPECT_EQ(in(0x81, 6, 0x2200, 2, 255), kStalled);
  EXPECT_EQ(in(0x81, 6, 0x2300, 0, 255), kStalled);
}

TEST_F(UsbDeviceTest, StallsAtDescriptorsThatAFullSpeedDeviceHasNot) {
  for (const std::uint16_t value : {0x0101, 0x0201, 0x0400, 0x0500, 0x0600, 0x0700, 0x0F00}) {
    EXPECT_EQ(in(0x80, 6, value, 0, 255), kStalled) << value;
  }
}

TEST_F(UsbDeviceTest, TakesAddressAndConfiguration) {
  EXPECT_TRUE(out(0x00, 5, 12, 0));
  EXPECT_EQ(device.address(), 12);
  EXPECT_FALSE(out(0x00, 5, 128, 0));
  EXPECT_THAT(in(0x80, 8, 0, 0, 1), ElementsAre(0));
  EXPECT_FALSE(out(0x00, 9, 2, 0));
  EXPECT_TRUE(configure());
  EXPECT_THAT(in(0x80, 8, 0, 0, 1), ElementsAre(1));
  EXPECT_FALSE(out(0x00, 5, 13, 0)) << "configured";
  device.reset();
  EXPECT_EQ(device.address(), 0);
  EXPECT_EQ(device.configuration(), 0);
  EXPECT_EQ(echo.resets, 1);
}

TEST_F(UsbDeviceTest, TellsItsStatusAndTakesFeatures) {
  EXPECT_THAT(in(0x80, 0, 0, 0, 2), ElementsAre(0, 0));
  EXPECT_TRUE(out(0x00, 3, 1, 0)) << "remote wakeup";
  EXPECT_THAT(in(0x80, 0, 0, 0, 2), ElementsAre(2, 0));
  EXPECT_TRUE(out(0x00, 1, 1, 0));
  EXPECT_THAT(in(0x80, 0, 0, 0, 2), ElementsAre(0, 0));
  EXPECT_FALSE(out(0x00, 3, 2, 0)) << "test mode is for high speed";
  EXPECT_EQ(in(0x81, 0, 0, 0, 2), kStalled) << "not configured";
  EXPECT_EQ(in(0x82, 0, 0, 0x81, 2), kStalled);
  EXPECT_THAT(in(0x82, 0, 0, 0x80, 2), ElementsAre(0, 0));
  ASSERT_TRUE(configure());
  EXPECT_THAT(in(0x81, 0, 0, 1, 2), ElementsAre(0, 0));
  EXPECT_EQ(in(0x81, 0, 0, 2, 2), kStalled);
  EXPECT_THAT(in(0x81, 10, 0, 1, 1), ElementsAre(0));
  EXPECT_TRUE(out(0x01, 11, 0, 1));
  EXPECT_FALSE(out(0x01, 11, 1, 1)) << "no alternate settings";
}

TEST_F(UsbDeviceTest, AHaltedEndpointStallsUntilItIsCleared) {
  echo.reports[0] = {{1, 2}, {1, 3}};
  ASSERT_TRUE(configure());
  EXPECT_TRUE(out(0x02, 3, 0, 0x81));
  EXPECT_THAT(in(0x82, 0, 0, 0x81, 2), ElementsAre(1, 0));
  EXPECT_EQ(poll(0x81).first, TransferStatus::kStall);
  EXPECT_TRUE(out(0x02, 1, 0, 0x81));
  EXPECT_THAT(in(0x82, 0, 0, 0x81, 2), ElementsAre(0, 0));
  EXPECT_THAT(poll(0x81).second, ElementsAre(1, 2));
  EXPECT_TRUE(out(0x02, 3, 0, 0x81));
  EXPECT_TRUE(out(0x01, 11, 0, 0));
  EXPECT_THAT(poll(0x81).second, ElementsAre(1, 3)) << "SET_INTERFACE clears it as well";
  EXPECT_FALSE(out(0x02, 3, 0, 0x83)) << "no such endpoint";
  EXPECT_FALSE(out(0x02, 3, 0, 0x00)) << "endpoint 0 does not halt";
}

TEST_F(UsbDeviceTest, ReportsOnlyWhenConfiguredAndOnlyWhatThereIs) {
  echo.reports[1] = {{5, 6, 7}};
  EXPECT_EQ(poll(0x82).first, TransferStatus::kStall);
  ASSERT_TRUE(configure());
  EXPECT_EQ(poll(0x81).first, TransferStatus::kNak);
  EXPECT_EQ(poll(0x83).first, TransferStatus::kStall);
  EXPECT_EQ(poll(0x02).first, TransferStatus::kStall) << "an endpoint of the other direction";
  EXPECT_EQ(poll(0x82, 2), std::pair(TransferStatus::kDone, Bytes({5, 6})));
  EXPECT_EQ(poll(0x82).first, TransferStatus::kNak);
}

TEST_F(UsbDeviceTest, GivesAndTakesReports) {
  EXPECT_EQ(in(0xA1, 1, 0x0302, 0, 8), kStalled) << "not configured";
  ASSERT_TRUE(configure());
  EXPECT_THAT(in(0xA1, 1, 0x0302, 0, 8), ElementsAre(2, 7));
  EXPECT_EQ(in(0xA1, 1, 0x0303, 0, 8), kStalled);
  EXPECT_EQ(in(0xA1, 1, 0x0402, 0, 8), kStalled);
  EXPECT_EQ(in(0xA1, 1, 0x0101, 0, 8), kStalled) << "no input report yet";
  echo.reports[0] = {{1, 2, 3}, {4, 5}};
  poll(0x81);
  poll(0x81);
  EXPECT_THAT(in(0xA1, 1, 0x0101, 0, 8), ElementsAre(1, 2, 3)) << "the last one with that ID";
  EXPECT_THAT(in(0xA1, 1, 0x0104, 0, 8), ElementsAre(4, 5));
  EXPECT_THAT(in(0xA1, 1, 0x0101, 0, 2), ElementsAre(1, 2));
  EXPECT_TRUE(out(0x21, 9, 0x0204, 1, {4, 1}));
  EXPECT_THAT(echo.told, ElementsAre(1, 2, 4, 4, 1));
  EXPECT_FALSE(out(0x21, 9, 0x0309, 0, {9}));
  EXPECT_FALSE(out(0x21, 9, 0x0004, 0, {4}));
}

TEST_F(UsbDeviceTest, InterruptOutIsAnOutputReport) {
  const Bytes bytes = {2, 0xB0, 4};
  EXPECT_EQ(device.interrupt_out(0x02, now, bytes).status, TransferStatus::kStall);
  ASSERT_TRUE(configure());
  const auto result = device.interrupt_out(0x02, now, bytes);
  EXPECT_EQ(result.status, TransferStatus::kDone);
  EXPECT_EQ(result.bytes, 3U);
  EXPECT_THAT(echo.told, ElementsAre(1, 2, 0, 2, 0xB0, 4)) << "not numbered: no ID";
  EXPECT_EQ(device.interrupt_out(0x82, now, bytes).status, TransferStatus::kStall);
}

TEST_F(UsbDeviceTest, RepeatsAReportAtTheIdleRateOfItsId) {
  ASSERT_TRUE(configure());
  EXPECT_THAT(in(0xA1, 2, 0, 0, 1), ElementsAre(0));
  EXPECT_TRUE(out(0x21, 10, 0x0301, 0)) << "ID 1: 12 ms";
  EXPECT_THAT(in(0xA1, 2, 0x0001, 0, 1), ElementsAre(3));
  EXPECT_THAT(in(0xA1, 2, 0x0002, 0, 1), ElementsAre(0));
  echo.reports[0] = {{1, 9}, {2, 8}};
  poll(0x81);
  poll(0x81);
  now = 11999us;
  EXPECT_EQ(poll(0x81).first, TransferStatus::kNak);
  now = 12ms;
  EXPECT_EQ(poll(0x81), std::pair(TransferStatus::kDone, Bytes({1, 9})));
  EXPECT_EQ(poll(0x81).first, TransferStatus::kNak) << "ID 2 is never repeated";
  EXPECT_TRUE(out(0x21, 10, 0x0100, 0)) << "all: 4 ms";
  now = 16ms;
  EXPECT_EQ(poll(0x81).second, Bytes({1, 9}));
  EXPECT_EQ(poll(0x81).second, Bytes({2, 8}));
  EXPECT_TRUE(out(0x21, 10, 0, 0)) << "never";
  now = 10s;
  EXPECT_EQ(poll(0x81).first, TransferStatus::kNak);
}

TEST_F(UsbDeviceTest, OnlyBootInterfacesHaveProtocols) {
  ASSERT_TRUE(configure());
  EXPECT_THAT(in(0xA1, 3, 0, 0, 1), ElementsAre(1));
  EXPECT_TRUE(out(0x21, 11, 0, 0));
  EXPECT_THAT(in(0xA1, 3, 0, 0, 1), ElementsAre(0));
  EXPECT_EQ(in(0xA1, 3, 0, 1, 1), kStalled);
  EXPECT_FALSE(out(0x21, 11, 0, 1));
  EXPECT_FALSE(out(0x21, 11, 2, 0));
}

TEST_F(UsbDeviceTest, OtherRequestsAreTheFunctionsOwn) {
  EXPECT_THAT(in(0xC0, 0x55, 0, 0, 8), ElementsAre(0x66));
  EXPECT_TRUE(out(0x40, 0x55, 0, 0, {1, 2}));
  EXPECT_THAT(echo.told, ElementsAre(1, 2));
  EXPECT_EQ(in(0xC0, 0x56, 0, 0, 8), kStalled);
  EXPECT_EQ(in(0x80, 12, 0, 0, 8), kStalled) << "SYNCH_FRAME";
}

TEST_F(UsbDeviceTest, MoreReportIdsThanItKeepsDoNoHarm) {
  ASSERT_TRUE(configure());
  for (int id = 1; id <= 255; ++id) echo.reports[0].push_back({static_cast<std::uint8_t>(id), 5});
  for (int id = 1; id <= 255; ++id) EXPECT_EQ(poll(0x81).second[0], id);
  EXPECT_THAT(in(0xA1, 1, 0x010C, 0, 8), ElementsAre(12, 5));
  EXPECT_EQ(in(0xA1, 1, 0x010D, 0, 8), kStalled);
  EXPECT_FALSE(out(0x21, 10, 0x040D, 0));
}

TEST_F(UsbDeviceTest, ARequestWithLessDataThanItSaysIsCut) {
  ASSERT_TRUE(configure());
  const auto result = device.control({0x21, 9, 0x0204, 0, 500}, now, {});
  EXPECT_EQ(result.status, TransferStatus::kDone);
  EXPECT_THAT(echo.told, SizeIs(3));
}

TEST_F(UsbDeviceTest, AnsweringAllocatesNothing) {
  std::array<std::uint8_t, 64> data{};
  const test::AllocGuard guard;
  for (std::uint16_t value = 0x0100; value <= 0x0302; value += 0x0100) {
    device.control({0x80, 6, value, 0, 64}, now, data);
  }
  device.control({0x00, 9, 1, 0, 0}, now, data);
  device.interrupt_in(0x81, now, data);
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace limn::firmware
