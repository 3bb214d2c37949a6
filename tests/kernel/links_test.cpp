// Simulated devices on a stock Linux kernel: what comes by hidraw, libusb and event nodes is what
// the same device gives to a host without a kernel.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <numbers>
#include <string_view>

#include "firmware_sim/devices/catalogue.hpp"
#include "tests/kernel/device_paths.hpp"
#include "tests/kernel/plugged_device.hpp"
#include "tests/kernel/started_device.hpp"

namespace limn::test {
namespace {

using testing::IsEmpty;

constexpr std::uint64_t kSeed = 7;
constexpr std::size_t kLong = 5000;
constexpr std::size_t kShort = 200;

/// A simulated device, its hand's start held back.
struct Held {
  Held(std::string_view device_name, std::string_view movement)
      : name(device_name),
        made(firmware::make_simulated_device(device_name, movement, kSeed)),
        device(made->bus()) {}

  std::string name;
  std::unique_ptr<firmware::SimulatedDevice> made;
  StartedDevice device;
};

Taken expected_from(std::string_view name, std::string_view movement, std::size_t enough,
                    bool initialize) {
  const auto made = firmware::make_simulated_device(name, movement, kSeed);
  return expected_of(made->bus(), enough, initialize);
}

std::future<Taken> taking(std::vector<ListedDevice> rows, std::size_t enough) {
  return std::async(std::launch::async,
                    [rows = std::move(rows), enough] { return take(rows, enough); });
}

void expect_reports(const Taken& taken, const Taken& expected, std::size_t enough) {
  EXPECT_EQ(taken.report_count, enough);
  for (const auto& [interface, reports] : taken.reports) {
    const auto found = expected.reports.find(interface);
    ASSERT_NE(found, expected.reports.end()) << "interface " << interface << " is silent";
    ASSERT_LE(reports.size(), found->second.size());
    const auto differ = std::mismatch(reports.begin(), reports.end(), found->second.begin()).first;
    EXPECT_EQ(differ, reports.end()) << "report " << differ - reports.begin() << " of "
                                     << reports.size() << " of interface " << interface;
  }
}

/// Whether Linux's side of a pen tells the same of both.
bool same_state(const PenSample& a, const PenSample& b, int counts) {
  const double degree = std::numbers::pi / 180 * (counts + 0.01);
  return a.state == b.state && a.buttons == b.buttons && std::abs(a.raw.x - b.raw.x) <= counts &&
         std::abs(a.raw.y - b.raw.y) <= counts &&
         std::abs(a.raw.pressure - b.raw.pressure) <= counts &&
         std::abs(a.tilt_x_rad - b.tilt_x_rad) <= degree &&
         std::abs(a.tilt_y_rad - b.tilt_y_rad) <= degree;
}

/// What is left where only changes are told, of a pen in range.
std::vector<PenSample> changes_of(const std::vector<PenSample>& samples) {
  std::vector<PenSample> changes;
  for (const PenSample& sample : samples) {
    if (sample.state == PenState::kOutOfRange) continue;
    if (changes.empty() || !same_state(changes.back(), sample, 0)) changes.push_back(sample);
  }
  return changes;
}

void expect_changes(const Taken& kernel, const Taken& expected, std::size_t at_least) {
  const auto got = changes_of(samples_of(kernel.trace));
  const auto all = changes_of(samples_of(expected.trace));
  EXPECT_GE(got.size(), at_least);
  ASSERT_LE(got.size(), all.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    ASSERT_TRUE(same_state(got[i], all[i], 1))
        << "change " << i << ": " << got[i].raw.x << ", " << got[i].raw.y << ", "
        << got[i].raw.pressure << " for " << all[i].raw.x << ", " << all[i].raw.y << ", "
        << all[i].raw.pressure;
  }
}

TEST(KernelLinks, NoReportOfAFastPenIsLostOnHidrawAndEvdev) {
  const Taken expected = expected_from("fast-pen", "signature", kLong + 1000, false);
  Held by_uhid("fast-pen", "signature");
  Held by_usbip("fast-pen", "signature");
  const PluggedDevice uhid(by_uhid.device, Cable::kUhid, false);
  const PluggedDevice usbip(by_usbip.device, Cable::kUsbip, false);
  std::vector<std::future<Taken>> raw;
  std::vector<std::future<Taken>> decoded;
  for (const Cable cable : {Cable::kUhid, Cable::kUsbip}) {
    const auto& spec = by_uhid.device.spec();
    raw.push_back(taking(wait_for_rows(Backend::kHidraw, spec, cable, 1), kLong));
    decoded.push_back(taking(wait_for_rows(Backend::kEvdev, spec, cable, 1), kLong));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // they open
  by_uhid.device.start();
  by_usbip.device.start();
  for (std::size_t i = 0; i < raw.size(); ++i) {
    SCOPED_TRACE(i == 0 ? "UHID" : "USB/IP");
    const Taken reports = raw[i].get();
    expect_reports(reports, expected, kLong);
    EXPECT_THAT(reports.notes, IsEmpty());
    const Taken frames = decoded[i].get();
    EXPECT_EQ(frames.frames, kLong);
    EXPECT_THAT(frames.notes, IsEmpty());
    expect_changes(frames, expected, kLong - 10);
  }
}

}  // namespace
}  // namespace limn::test
