// Simulated devices before Linux's own drivers of the real ones, and limn beside other readers:
// whoever wrote those never saw limn.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <signal.h>  // SIGTERM
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
#include <sstream>
#include <string>
#include <string_view>
#include <thread>

#include "drivers/transport/open_device.hpp"
#include "tests/kernel/device_paths.hpp"
#include "tests/kernel/expectations.hpp"
#include "tests/kernel/plugged_device.hpp"
#include "tests/kernel/qmp.hpp"
#include "tests/support/running_program.hpp"
#include "tests/support/spacenavd_rule.hpp"

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
  constexpr std::size_t kChanges = kFrames + 40;  // some are of a pen that leaves
  Taking kernel({node}, kChanges);
  kernel.wait_until_open();
  std::this_thread::sleep_for(1500ms);  // wacom sets the mode a second after it has the device
  held.device.start();
  const Taken expected = expected_from(name, "signature", 2 * kFrames, setup);
  // hid-uclogic turns the reports of some into what its own descriptor says.
  const Taken reports = raw.get();
  EXPECT_EQ(reports.report_count, kFrames);
  expect_changes(reports, expected, kFrames - 20);
  const Taken frames = kernel.get();
  EXPECT_GE(frames.frames, kChanges);
  expect_changes(frames, expected, kFrames);
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

/// What a program of libspnav's is told by the server at a socket.
class SpnavReader {
 public:
  explicit SpnavReader(const std::string& socket, int buttons)
      : program_({"/bin/env", "SPNAV_SOCKET=" + socket, "./spnav_reader", std::to_string(buttons)},
                 STDOUT_FILENO) {
    EXPECT_EQ(program_.line(), "open\n") << socket;
  }

  /// All of it, once the buttons have come.
  std::vector<SpnavTold> told() {
    std::vector<SpnavTold> all;
    for (std::string line = program_.line(); !line.empty(); line = program_.line()) {
      SpnavTold& one = all.emplace_back();
      one.kind = line[0];
      std::istringstream numbers(line.substr(line.find(' ')));
      for (int& axis : one.axes) numbers >> axis;
    }
    return all;
  }

 private:
  RunningProgram program_;
};

/// What limn's own transport has of it: its motions.
std::vector<SpnavTold> motions_of(const Taken& taken) {
  std::vector<SpnavTold> all;
  for (const auto& [axis, values] : taken.axes) {
    all.resize(std::max(all.size(), values.size()), {'m', {}, 0});
    for (std::size_t i = 0; i < values.size(); ++i) {
      all[i].axes.at(static_cast<std::size_t>(axis)) = values[i];
    }
  }
  return all;
}

bool within_one(const SpnavTold& a, const SpnavTold& b) {
  for (std::size_t i = 0; i < a.axes.size(); ++i) {
    if (std::abs(a.axes[i] - b.axes[i]) > 1) return false;
  }
  return a.kind == b.kind;
}

/// Fails unless both are the same but for one count, event by event.
void expect_told(const std::vector<SpnavTold>& got, const std::vector<SpnavTold>& expected) {
  const auto [differ, other] =
      std::mismatch(got.begin(), got.end(), expected.begin(), expected.end(), within_one);
  if (differ == got.end() && other == expected.end()) return;
  const auto text = [](const auto& at, const auto& all) {
    return at == all.end() ? std::string("nothing") : at->kind + testing::PrintToString(at->axes);
  };
  ADD_FAILURE() << "event " << differ - got.begin() << " of " << got.size() << " is "
                << text(differ, got) << " for " << text(other, expected);
}

/// spacenavd and `limn spnav-server` side by side at one device: its event node is spacenavd's, its
/// hidraw node limn's. Each has a program of libspnav's; limn reads spacenavd, too.
void expect_served_alike(const char* name, bool relative) {
  if (!std::filesystem::exists("spnav_reader")) GTEST_SKIP() << "this build has no spnav_reader";
  constexpr int kButtons = 4;  // two are clicked at the end of a push
  const std::string socket = "/tmp/limn.sock";
  Held held(name, "push");
  const PluggedDevice plugged(held.device, Cable::kUsbip);
  wait_for_rows(Backend::kHidraw, held.device.spec(), Cable::kUsbip, 1);
  wait_for_rows(Backend::kEvdev, held.device.spec(), Cable::kUsbip, 1);
  RunningProgram spacenavd({"/bin/sh", "-c", "cd / && exec spacenavd -d"});
  RunningProgram limn({"./limn", "spnav-server", "--socket", socket});
  ASSERT_NE(limn.line_with("listening on " + socket), "");
  std::optional<ListedDevice> row;  // spacenavd has its devices before it listens
  for (int tries = 0; tries < 100 && !row; ++tries) {
    std::this_thread::sleep_for(100ms);
    row = find_spacenavd();
  }
  ASSERT_TRUE(row);
  SpnavReader at_spacenavd(row->node, kButtons);
  SpnavReader at_limn(socket, kButtons);

  std::vector<MouseReport> reports;
  const Taken all = expected_from(name, "push", 1000, Setup::kNone);
  for (const Bytes& bytes : all.reports.at(0)) reports.push_back({0, bytes});
  const auto by_event_node = by_spacenavd(reports, {relative, true});
  Taking taking({*row}, by_event_node.size());
  taking.wait_until_open();
  held.device.start();
  const auto of_spacenavd = at_spacenavd.told();
  EXPECT_EQ(of_spacenavd, by_event_node);
  EXPECT_GT(of_spacenavd.size(), 100U);
  expect_told(at_limn.told(), by_spacenavd(reports, {relative, false}));
  auto motions = of_spacenavd;
  std::erase_if(motions, [](const SpnavTold& one) { return one.kind != 'm'; });
  EXPECT_EQ(motions_of(taking.get()), motions);
  EXPECT_EQ(limn.end(SIGTERM), 0);
  spacenavd.end(SIGTERM);
}

TEST_F(KernelOracles, SpacenavdAndLimnServeACombined3dMouseAlike) {
  expect_served_alike("spacemouse", false);
}

TEST_F(KernelOracles, SpacenavdAndLimnServeASpaceNavigatorAlike) {
  expect_served_alike("spacenavigator", true);
}

TEST_F(KernelOracles, ProgramsFindLimnsServerWhereSpacenavdWouldBe) {
  if (!std::filesystem::exists("spnav_reader")) GTEST_SKIP() << "this build has no spnav_reader";
  RunningProgram limn({"./limn", "spnav-server"});
  EXPECT_NE(limn.line_with("listening on /run/spnav.sock, where programs look"), "");
  const auto permissions = std::filesystem::status("/run/spnav.sock").permissions();
  EXPECT_EQ(static_cast<unsigned>(permissions), 0666U);
  RunningProgram reader({"./spnav_reader", "0"}, STDOUT_FILENO);
  EXPECT_EQ(reader.line(), "open\n");
  EXPECT_EQ(reader.end(0), 0);
  EXPECT_EQ(limn.end(SIGTERM), 0);
  EXPECT_FALSE(std::filesystem::exists("/run/spnav.sock"));
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
