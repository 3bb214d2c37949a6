// Simulated devices before Linux's own drivers of the real ones, and limn beside other readers:
// whoever wrote those never saw limn.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "drivers/transport/open_device.hpp"
#include "tests/kernel/device_paths.hpp"
#include "tests/kernel/expectations.hpp"
#include "tests/kernel/plugged_device.hpp"
#include "tests/kernel/qmp.hpp"

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
  const PluggedDevice plugged(held.device, cable);
  const ListedDevice node = wait_for_pen_node(held, cable, driver);
  switch_smoothing_off(node);
  // hid-uclogic takes two of the XP-Pen's three interfaces.
  const std::size_t nodes = std::min<std::size_t>(2, held.device.spec().interfaces.size());
  Taking raw(wait_for_rows(Backend::kHidraw, held.device.spec(), cable, nodes), kFrames);
  raw.wait_until_open();
  Taking kernel({node}, kFrames);
  kernel.wait_until_open();
  std::this_thread::sleep_for(1500ms);  // wacom sets the mode a second after it has the device
  held.device.start();
  const Taken expected = expected_from(name, "signature", 2 * kFrames, setup);
  // hid-uclogic turns the reports of some into what its own descriptor says.
  const Taken reports = raw.get();
  EXPECT_EQ(reports.report_count, kFrames);
  expect_changes(reports, expected, kFrames - 20);
  const Taken frames = kernel.get();
  EXPECT_GE(frames.frames, kFrames);
  expect_changes(frames, expected, kFrames - 20);
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

/// What a program of the guest prints, which has a minute for it.
class Program {
 public:
  explicit Program(const std::string& command)
      : output_(::popen(("exec timeout 60 " + command).c_str(), "r")) {}
  ~Program() {
    if (output_ != nullptr) ::pclose(output_);
  }
  Program(const Program&) = delete;

  std::string line() {
    std::array<char, 1024> text{};
    return std::fgets(text.data(), text.size(), output_) != nullptr ? text.data() : "";
  }

 private:
  std::FILE* output_;
};

/// A sample of libinput-debug-events: mm, degrees, 0 to 1, with two decimals.
struct LibinputSample {
  double x_mm = 0;
  double y_mm = 0;
  double tilt_x_deg = 0;
  double tilt_y_deg = 0;
  double pressure = 0;
};

std::optional<LibinputSample> read_libinput(std::string line) {
  const std::size_t event = line.find("TABLET_TOOL_");
  if (event == std::string::npos) return std::nullopt;
  std::erase(line, '*');  // behind what has changed
  const std::size_t axes = line.find("s\t", event);
  LibinputSample sample;
  const int read =
      std::sscanf(line.c_str() + axes + 1, " %lf/%lf tilt: %lf/%lf pressure: %lf", &sample.x_mm,
                  &sample.y_mm, &sample.tilt_x_deg, &sample.tilt_y_deg, &sample.pressure);
  return read == 5 ? std::optional(sample) : std::nullopt;
}

TEST_F(KernelOracles, LibinputReadsThePenAsLimnDoes) {
  std::filesystem::create_directories("/etc/libinput");
  std::ofstream("/etc/libinput/local-overrides.quirks")
      << "[as the device says]\nMatchUdevType=tablet\nAttrTabletSmoothing=0\n";
  Held held("pen", "signature");
  const PluggedDevice plugged(held.device, Cable::kUsbip);
  const ListedDevice node = wait_for_pen_node(held, Cable::kUsbip, "hid-generic");
  Program libinput("/usr/libexec/libinput/libinput-debug-events --device " + node.node);
  ASSERT_NE(libinput.line().find("DEVICE_ADDED"), std::string::npos);
  held.device.start();
  std::vector<PenSample> expected =
      samples_of(expected_from("pen", "signature", 2 * kFrames, Setup::kNone).trace);
  std::erase_if(expected, [](const PenSample& s) { return s.state == PenState::kOutOfRange; });
  std::size_t next = 0;
  std::size_t compared = 0;
  while (compared < kFrames) {
    const std::string line = libinput.line();
    const auto got = read_libinput(line);
    ASSERT_TRUE(got) << line;
    // Reports that change nothing are not told; what is told is one of the next few.
    constexpr double kPosition = 0.0101;  // a count, and the last decimal
    constexpr double kTilt = 0.02;
    constexpr double kPressure = 0.0055;
    constexpr double kFloor = 0.01;  // libinput's pressure begins at 1 % of the range
    const auto alike = [&](const PenSample& s) {
      constexpr double kDegree = std::numbers::pi / 180;
      return std::abs(s.x_mm - got->x_mm) < kPosition && std::abs(s.y_mm - got->y_mm) < kPosition &&
             std::abs(s.tilt_x_rad / kDegree - got->tilt_x_deg) < kTilt &&
             std::abs(s.tilt_y_rad / kDegree - got->tilt_y_deg) < kTilt &&
             std::abs(std::max(0.0, (s.pressure - kFloor) / (1 - kFloor)) - got->pressure) <
                 kPressure;
    };
    ASSERT_LT(next, expected.size());
    const std::size_t last = std::min(next + 3, expected.size());
    const auto found = std::find_if(expected.begin() + static_cast<std::ptrdiff_t>(next),
                                    expected.begin() + static_cast<std::ptrdiff_t>(last), alike);
    ASSERT_NE(found, expected.begin() + static_cast<std::ptrdiff_t>(last))
        << line << "for " << expected[next].x_mm << "/" << expected[next].y_mm << " "
        << expected[next].tilt_x_rad * 180 / std::numbers::pi << "/"
        << expected[next].tilt_y_rad * 180 / std::numbers::pi << " " << expected[next].pressure;
    next = static_cast<std::size_t>(found - expected.begin()) + 1;
    ++compared;
  }
}

/// Six axes of a 3D mouse at one time.
using Deflections = std::array<int, 6>;

/// What spacenavd makes of the SpaceMouse's reports: -350 to 350 is scaled to -500 to 500, what is
/// hardly anything is nothing, and its frame is x, -z, -y of the device's.
std::vector<Deflections> by_spacenavd(const Taken& reports) {
  const auto scaled = [](int value) {
    constexpr int kDeadZone = 2;
    const int of_500 = (value + 350) * 1000 / 700 - 500;
    return std::abs(of_500) < kDeadZone ? 0 : of_500;
  };
  std::vector<Deflections> all;
  for (const Bytes& report : reports.reports.at(0)) {
    if (report.at(0) != 1) continue;
    Deflections raw{};
    for (std::size_t i = 0; i < raw.size(); ++i) {
      raw[i] = scaled(static_cast<std::int16_t>(report.at(1 + 2 * i) | report.at(2 + 2 * i) << 8));
    }
    all.push_back({raw[0], -raw[2], -raw[1], raw[3], -raw[5], -raw[4]});
  }
  return all;
}

/// What came by libspnav, whose every event has all six.
std::vector<Deflections> by_libspnav(const Taken& taken) {
  std::vector<Deflections> all(taken.frames);
  for (const auto& [axis, values] : taken.axes) {
    for (std::size_t i = 0; i < std::min(all.size(), values.size()); ++i) {
      all[i].at(static_cast<std::size_t>(axis)) = values[i];
    }
  }
  return all;
}

TEST_F(KernelOracles, SpacenavdReadsA3dMouseAsLimnDoes) {
  ASSERT_EQ(std::system("cd / && timeout 20 spacenavd -d >/dev/null 2>&1 &"), 0);
  Held held("spacemouse", "push");
  const PluggedDevice plugged(held.device, Cable::kUsbip);
  wait_for_rows(Backend::kHidraw, held.device.spec(), Cable::kUsbip, 1);
  std::this_thread::sleep_for(2s);  // spacenavd is told by udev, too, and says nothing of it
  const auto row = find_spacenavd();
  ASSERT_TRUE(row);
  constexpr std::size_t kMotions = 150;
  Taking taking({*row}, kMotions);
  taking.wait_until_open();
  held.device.start();
  auto got = by_libspnav(taking.get());
  auto expected = by_spacenavd(expected_from("spacemouse", "push", 206, Setup::kNone));
  for (auto* list : {&got, &expected}) {
    list->insert(list->begin(), Deflections{});  // both begin at rest, and rests are told once
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  EXPECT_GT(got.size(), 100U);
  ASSERT_LE(got.size(), expected.size());
  expected.resize(got.size());
  const auto [differ, other] = std::mismatch(got.begin(), got.end(), expected.begin());
  if (differ != got.end()) {
    ADD_FAILURE() << "motion " << differ - got.begin() << " is " << testing::PrintToString(*differ)
                  << " for " << testing::PrintToString(*other);
  }
}

/// The node of one of QEMU's own devices.
ListedDevice wait_for_qemus(Backend backend, int vendor, int product) {
  for (int tries = 0; tries < 100; ++tries) {
    for (const ListedDevice& row : list_devices_of(backend).value_or(std::vector<ListedDevice>())) {
      if (row.device.vendor == vendor && row.device.product == product && row.readable) return row;
    }
    std::this_thread::sleep_for(100ms);
  }
  ADD_FAILURE() << "QEMU has no such device";
  return {};
}

constexpr int kPoints = 12;
constexpr int x_of(int point) { return 1000 + 2000 * point; }
constexpr int y_of(int point) { return 500 + 1000 * point; }
constexpr bool down_at(int point) { return point > 3; }

/// The device that QEMU calls `driver` and `pointer`, plugged in and moved along a line.
Taken point_with(const char* driver, const char* pointer, Backend backend, int vendor,
                 int product) {
  static Qmp qemu;  // it negotiates once
  qemu.ask("device_add", std::string(R"({"driver": ")") + driver + R"(", "id": "pointer"})");
  const ListedDevice row = wait_for_qemus(backend, vendor, product);
  if (backend == Backend::kEvdev) switch_smoothing_off(row);
  Taking taking({row}, kPoints);
  taking.wait_until_open();
  std::this_thread::sleep_for(1500ms);  // wacom sets the mode a second after it has the device
  qemu.choose_pointer(pointer);
  for (int i = 0; i < kPoints; ++i) {
    qemu.point(x_of(i), y_of(i), down_at(i));
    std::this_thread::sleep_for(50ms);
  }
  Taken taken = taking.get();
  qemu.ask("device_del", R"({"id": "pointer"})");
  return taken;
}

TEST_F(KernelOracles, QemusTabletIsReadRight) {
  const Taken taken = point_with("usb-tablet", "QEMU HID Tablet", Backend::kHidraw, 0x0627, 0x0001);
  ASSERT_EQ(taken.report_count, static_cast<std::size_t>(kPoints));
  for (int i = 0; i < kPoints; ++i) {
    const Bytes& report = taken.reports.at(0).at(static_cast<std::size_t>(i));
    ASSERT_EQ(report.size(), 6U);
    EXPECT_EQ(report[0], down_at(i) ? 1 : 0);
    EXPECT_EQ(report[1] | report[2] << 8, x_of(i));
    EXPECT_EQ(report[3] | report[4] << 8, y_of(i));
  }
}

TEST_F(KernelOracles, QemusWacomTabletIsReadRight) {
  const Taken taken =
      point_with("usb-wacom-tablet", "QEMU PenPartner tablet", Backend::kEvdev, 0x056A, 0x0000);
  const auto samples = samples_of(taken.trace);
  ASSERT_GE(samples.size(), static_cast<std::size_t>(kPoints));
  for (int i = 0; i < kPoints; ++i) {
    SCOPED_TRACE(i);
    const PenSample& sample = samples[static_cast<std::size_t>(i)];
    EXPECT_EQ(sample.raw.x, x_of(i) * 5040 / 0x7FFF);
    EXPECT_EQ(sample.raw.y, y_of(i) * 3780 / 0x7FFF);
    EXPECT_NEAR(sample.x_mm, x_of(i) / 32767.0 * 5040 / 40, 0.025) << "40 counts a mm";
    EXPECT_EQ(sample.state, down_at(i) ? PenState::kInContact : PenState::kInRange);
  }
}

}  // namespace
}  // namespace limn::test
