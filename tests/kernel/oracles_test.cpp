// Simulated devices before Linux's own drivers of the real ones, and limn beside other readers:
// whoever wrote those never saw limn.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>
#include <thread>

#include "tests/kernel/device_paths.hpp"
#include "tests/kernel/expectations.hpp"
#include "tests/kernel/plugged_device.hpp"

namespace limn::test {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kFrames = 200;

class KernelOracles : public testing::Test {
 protected:
  void TearDown() override { wait_until_all_are_gone(); }
};

/// The event node of the pen itself, when its driver and udev are done with it.
ListedDevice wait_for_pen_node(const Held& held, Cable cable, std::string_view driver) {
  for (int tries = 0; tries < 100; ++tries) {
    for (const ListedDevice& row : wait_for_rows(Backend::kEvdev, held.device.spec(), cable, 1)) {
      const auto& axes = row.device.axes;  // a tablet's buttons have a node of their own
      const bool pen = std::any_of(axes.begin(), axes.end(),
                                   [](const EvdevAxis& axis) { return axis.code == ABS_PRESSURE; });
      if (pen && row.driver == driver) return row;
    }
    std::this_thread::sleep_for(100ms);
  }
  ADD_FAILURE() << held.name << " has no event node of " << driver;
  return {};
}

/// Linux smooths the axes for which a driver asks it to (wacom: by 4 counts); here it must not.
void switch_smoothing_off(const ListedDevice& row) {
  const int node = ::open(row.node.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(node, 0) << row.node;
  for (const EvdevAxis& axis : row.device.axes) {
    input_absinfo info{};
    EXPECT_EQ(::ioctl(node, EVIOCGABS(axis.code), &info), 0);
    info.fuzz = 0;
    EXPECT_EQ(::ioctl(node, EVIOCSABS(axis.code), &info), 0);
  }
  ::close(node);
}

/// Whether Linux's driver decodes the device to what limn makes of its reports.
void expect_decoded_alike(const char* name, Cable cable, const char* driver, Setup setup) {
  SCOPED_TRACE(std::string(name) + " by " + test::name(cable));
  Held held(name, "signature");
  const PluggedDevice plugged(held.device, cable, false);
  const ListedDevice node = wait_for_pen_node(held, cable, driver);
  switch_smoothing_off(node);
  Taking kernel({node}, kFrames);
  kernel.wait_until_open();
  std::this_thread::sleep_for(1500ms);  // wacom sets the mode a second after it has the device
  held.device.start();
  const Taken frames = kernel.get();
  EXPECT_GE(frames.frames, kFrames);
  expect_changes(frames, expected_from(name, "signature", 2 * kFrames, setup), kFrames - 20);
}

TEST_F(KernelOracles, HidUclogicDecodesTheHuionsAsLimnDoes) {
  expect_decoded_alike("huion", Cable::kUsbip, "uclogic", Setup::kLimn);
}

TEST_F(KernelOracles, HidUclogicDecodesTheHuion1060AsLimnDoes) {
  expect_decoded_alike("huion-1060", Cable::kUsbip, "uclogic", Setup::kLimn);
}

TEST_F(KernelOracles, HidUclogicDecodesTheXpPenAsLimnDoes) {
  expect_decoded_alike("xppen", Cable::kUsbip, "uclogic", Setup::kLimn);
}

TEST_F(KernelOracles, WacomDecodesTheIntuosAsLimnDoes) {
  expect_decoded_alike("intuos", Cable::kUhid, "wacom", Setup::kWacom);
  wait_until_all_are_gone();
  expect_decoded_alike("intuos", Cable::kUsbip, "wacom", Setup::kWacom);
}

TEST_F(KernelOracles, WacomDecodesTheBluetoothPenAsLimnDoes) {
  expect_decoded_alike("bluetooth-pen", Cable::kUhid, "wacom", Setup::kNone);
}

}  // namespace
}  // namespace limn::test
