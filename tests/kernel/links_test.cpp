// Simulated devices on a stock Linux kernel: what comes by hidraw, libusb and event nodes is what
// the same device gives to a host without a kernel.

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <numbers>
#include <string_view>
#include <thread>

#include "drivers/hid/descriptor_parser.hpp"
#include "firmware_sim/devices/catalogue.hpp"
#include "firmware_sim/devices/space_mouse.hpp"
#include "firmware_sim/devices/space_navigator.hpp"
#include "firmware_sim/link/usbip_server.hpp"
#include "firmware_sim/usb/usb_device.hpp"
#include "tests/kernel/device_paths.hpp"
#include "tests/kernel/expectations.hpp"
#include "tests/kernel/hidapi_reader.hpp"
#include "tests/kernel/plugged_device.hpp"

namespace limn::test {
namespace {

using testing::IsEmpty;

constexpr std::size_t kLong = 5000;
constexpr std::size_t kShort = 200;

class KernelLinks : public testing::Test {
 protected:
  void TearDown() override { wait_until_all_are_gone(); }
};

constexpr const char* kHidapiReader = "./libhidapi_reader.so";

/// What hidapi's libusb backend gives of an interface.
class HidapiReader {
 public:
  HidapiReader(const ListedDevice& row, std::size_t count) : interface_(row.interface_number) {
    const std::string bus_and_ports = row.usb_folder.substr(row.usb_folder.rfind('/') + 1);
    const std::string path = bus_and_ports + ":1." + std::to_string(row.interface_number);
    done_ = std::async(std::launch::async, [this, path, count] { read(path, count); });
    opened_.get_future().wait();
  }
  HidapiReader(const HidapiReader&) = delete;

  int interface() const { return interface_; }
  std::vector<Bytes> reports() {
    done_.get();
    return std::move(reports_);
  }

 private:
  void read(const std::string& path, std::size_t count) {
    static void* const library = ::dlopen(kHidapiReader, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
    const auto read_reports =
        reinterpret_cast<decltype(&read_by_hidapi)>(::dlsym(library, "read_by_hidapi"));
    const auto opened = [](void* self) { static_cast<HidapiReader*>(self)->opened_.set_value(); };
    const auto report = [](void* self, const unsigned char* bytes, int size) {
      static_cast<HidapiReader*>(self)->reports_.emplace_back(bytes, bytes + size);
    };
    EXPECT_TRUE(read_reports(path.c_str(), static_cast<long>(count), opened, report, this));
  }

  int interface_;
  std::vector<Bytes> reports_;
  std::promise<void> opened_;
  std::future<void> done_;
};

/// As usbhid of Linux asks for a report: no more bytes than the longest of the descriptor has. (The
/// Huions send more than theirs says; what is cut off is their tilt.)
void cut_as_linux_does(Taken& expected, firmware::BusDevice& device) {
  for (auto& [interface, reports] : expected.reports) {
    const auto& spec = device.spec().interfaces[static_cast<std::size_t>(interface)];
    const auto descriptor = hid::parse_descriptor(spec.report_descriptor);
    ASSERT_TRUE(descriptor);
    std::size_t longest = 0;
    for (const hid::ReportShape& report : descriptor->reports) {
      if (report.kind == hid::ReportKind::kInput) {
        longest = std::max<std::size_t>(longest, report.byte_length);
      }
    }
    for (Bytes& bytes : reports) bytes.resize(std::min(bytes.size(), longest));
  }
}

/// Whether every report is what the device gives to a host without a kernel; of several interfaces
/// this one's.
void expect_reports(const std::vector<Bytes>& reports, const Taken& expected, int interface,
                    std::size_t enough) {
  Taken taken;
  taken.reports[interface] = reports;
  taken.report_count = reports.size();
  expect_reports(taken, expected, enough);
}

TEST_F(KernelLinks, NoReportOfAFastPenIsLostOnHidrawAndEvdev) {
  const Taken expected = expected_from("fast-pen", "signature", kLong + 1000, Setup::kNone);
  Held by_uhid("fast-pen", "signature");
  Held by_usbip("fast-pen", "signature");
  const PluggedDevice uhid(by_uhid.device, Cable::kUhid);
  const PluggedDevice usbip(by_usbip.device, Cable::kUsbip);
  std::vector<Taking> raw;
  std::vector<Taking> decoded;
  for (const Cable cable : {Cable::kUhid, Cable::kUsbip}) {
    const auto& spec = by_uhid.device.spec();
    raw.emplace_back(wait_for_rows(Backend::kHidraw, spec, cable, 1), kLong);
    decoded.emplace_back(wait_for_rows(Backend::kEvdev, spec, cable, 1), kLong);
  }
  for (Taking& one : raw) one.wait_until_open();
  for (Taking& one : decoded) one.wait_until_open();
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

TEST_F(KernelLinks, NoReportOfAFastPenIsLostByLibusb) {
  if (!std::filesystem::exists(kHidapiReader)) GTEST_SKIP() << "this build has no hidapi_reader";
  const Taken expected = expected_from("fast-pen", "signature", kLong, Setup::kNone);
  Held one("fast-pen", "signature");
  Held other("fast-pen", "signature");
  const PluggedDevice first(one.device, Cable::kUsbip);
  const PluggedDevice second(other.device, Cable::kUsbip);
  const auto rows = wait_for_rows(Backend::kUsb, one.device.spec(), Cable::kUsbip, 2);
  ASSERT_EQ(rows.size(), 2U);
  wait_for_rows(Backend::kHidraw, one.device.spec(), Cable::kUsbip, 2);  // Linux's drivers are done
  Taking by_limn({rows[0]}, kLong);
  HidapiReader hidapi(rows[1], kLong);
  by_limn.wait_until_open();
  one.device.start();
  other.device.start();
  expect_reports(hidapi.reports(), expected, 0, kLong);
  const Taken taken = by_limn.get();
  expect_reports(taken, expected, kLong);
  EXPECT_THAT(taken.notes, IsEmpty());
}

/// All devices but the fast pen, plugged in at once, each moved so that it has enough to say.
class AllOthers {
 public:
  explicit AllOthers(Cable cable) : cable_(cable) {
    for (const firmware::SimulatedInfo& info : firmware::simulated_devices()) {
      if (info.name == "fast-pen") continue;
      const bool pen = info.kind == firmware::SimulatedKind::kPen;
      held_.push_back(std::make_unique<Held>(info.name, pen ? "signature" : "push"));
    }
    // Whoever has a report in seven measurements takes 7 s, and is waited for when all others have
    // gone.
    std::stable_partition(held_.begin(), held_.end(),
                          [](const auto& one) { return one->name != "bluetooth-pen"; });
    for (const auto& one : held_) {
      plugged_.push_back(std::make_unique<PluggedDevice>(one->device, cable));
    }
  }

  template <class Function>
  void each(const Function& function) {
    for (const auto& held : held_) function(*held);
  }
  /// The same, and unplugs each afterwards.
  template <class Function>
  void each_for_the_last_time(const Function& function) {
    for (std::size_t i = 0; i < held_.size(); ++i) {
      function(*held_[i]);
      plugged_[i].reset();
    }
  }
  /// Of each device, in order.
  std::vector<std::vector<ListedDevice>> rows(Backend backend) const {
    std::vector<WantedRows> wanted;
    for (const auto& held : held_) {
      const auto& spec = held->device.spec();
      wanted.push_back({spec, spec.interfaces.size()});
    }
    return wait_for_rows(backend, cable_, wanted);
  }

  static bool is_mouse(const Held& held) { return held.name.starts_with("space"); }
  static std::string movement(const Held& held) { return is_mouse(held) ? "push" : "signature"; }

 private:
  Cable cable_;
  std::vector<std::unique_ptr<Held>> held_;
  std::vector<std::unique_ptr<PluggedDevice>> plugged_;
};

/// Reads all others at once by one of limn's backends.
void expect_all_others(Cable cable, Backend backend) {
  AllOthers others(cable);
  std::vector<Taking> taken;
  for (auto& rows : others.rows(backend)) taken.emplace_back(std::move(rows), kShort);
  for (Taking& one : taken) one.wait_until_open();
  others.each([](Held& held) { held.device.start(); });
  std::size_t next = 0;
  others.each_for_the_last_time([&](const Held& held) {
    SCOPED_TRACE(held.name);
    // UHID is no USB, of which strings and endpoints could be asked.
    const Setup setup = cable == Cable::kUsbip ? Setup::kLimn : Setup::kNone;
    Taken expected = expected_from(held.name, AllOthers::movement(held), kShort + 100, setup);
    if (setup == Setup::kLimn && backend == Backend::kHidraw)
      cut_as_linux_does(expected, held.made->bus());
    const Taken got = taken[next++].get();
    expect_reports(got, expected, kShort);
    if (AllOthers::is_mouse(held)) expect_motions(got, expected);
  });
}

TEST_F(KernelLinks, EveryDeviceIsReadOnHidrawOfUhid) {
  expect_all_others(Cable::kUhid, Backend::kHidraw);
}

TEST_F(KernelLinks, EveryDeviceIsReadOnHidrawOfUsbip) {
  expect_all_others(Cable::kUsbip, Backend::kHidraw);
}

TEST_F(KernelLinks, EveryDeviceIsReadByLibusb) { expect_all_others(Cable::kUsbip, Backend::kUsb); }

TEST_F(KernelLinks, EveryDeviceIsReadByHidapisLibusb) {
  if (!std::filesystem::exists(kHidapiReader)) GTEST_SKIP() << "this build has no hidapi_reader";
  AllOthers others(Cable::kUsbip);
  const auto rows = others.rows(Backend::kUsb);
  others.rows(Backend::kHidraw);  // Linux's drivers are done
  // hidapi tells tablets nothing: they report as plugged in, some by one interface of several.
  std::vector<Taken> expected;
  std::vector<std::unique_ptr<HidapiReader>> readers;
  others.each([&](const Held& held) {
    const auto& its = rows.at(expected.size());
    expected.push_back(
        expected_from(held.name, AllOthers::movement(held), kShort + 100, Setup::kNone));
    auto& reports = expected.back().reports;
    const auto most = std::max_element(
        reports.begin(), reports.end(),
        [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
    ASSERT_NE(most, reports.end()) << held.name << " is silent";
    // It asks for no more than a packet; of a longer report the rest is cut off.
    const auto& spec = held.device.spec().interfaces[static_cast<std::size_t>(most->first)];
    const std::size_t packet = spec.endpoints.front().most_bytes;
    for (Bytes& bytes : most->second) bytes.resize(std::min(bytes.size(), packet));
    const auto row = std::find_if(its.begin(), its.end(), [most](const ListedDevice& one) {
      return one.interface_number == most->first;
    });
    ASSERT_NE(row, its.end()) << held.name;
    readers.push_back(std::make_unique<HidapiReader>(*row, kShort));
  });
  others.each([](Held& held) { held.device.start(); });
  std::size_t next = 0;
  others.each_for_the_last_time([&](const Held& held) {
    SCOPED_TRACE(held.name);
    HidapiReader& reader = *readers.at(next);
    expect_reports(reader.reports(), expected.at(next), reader.interface(), kShort);
    readers.at(next++).reset();
  });
}

/// A knob that is led along and about all axes at once, in circles of different lengths, for ever.
class Circles final : public firmware::KnobSensor {
 public:
  firmware::KnobPose measure(std::chrono::microseconds time) noexcept override {
    firmware::KnobPose pose;
    pose.time = time;
    for (std::size_t axis = 0; axis < firmware::kKnobAxes; ++axis) {
      const double turns =
          static_cast<double>(time.count()) * 1e-6 / (2 + static_cast<double>(axis));
      pose.deflection[axis] = 0.8 * std::sin(2 * std::numbers::pi * turns);
    }
    return pose;
  }
};

/// A 3D mouse so led, its hand held back.
template <class Function>
struct CircledMouse {
  /// What it gives to a host without a kernel.
  static Taken expected(std::size_t enough) {
    CircledMouse mouse;
    return expected_of(mouse.usb, enough, Setup::kNone);
  }

  Circles hand;
  Function function{hand};
  firmware::UsbDevice usb{function};
  StartedDevice device{usb};
};

/// The axes' counts of a 3D mouse, once while they stay.
std::vector<std::array<std::int32_t, kMotionAxes>> changes_of_motion(const Taken& taken) {
  std::vector<std::array<std::int32_t, kMotionAxes>> all;
  for (const MotionSample& motion : motions_of(taken.trace)) {
    if (!motion.is_zero() && (all.empty() || all.back() != motion.raw)) all.push_back(motion.raw);
  }
  return all;
}

void expect_motion_changes(const Taken& frames, const Taken& expected) {
  EXPECT_THAT(frames.notes, IsEmpty());
  const auto got = changes_of_motion(frames);
  auto all = changes_of_motion(expected);
  EXPECT_GE(got.size(), kShort);
  ASSERT_GE(all.size(), got.size());
  all.resize(got.size());
  EXPECT_EQ(got, all);
}

/// Of what hid-generic takes for pens (as they are plugged in) and of 3D mice, of which the
/// SpaceNavigator calls its axes relative, so that the kernel tells no zero of them.
void expect_event_nodes(Cable cable) {
  constexpr std::size_t kFrames =
      kShort + 40;  // some are of a pen that leaves, or tell nothing new
  std::vector<std::unique_ptr<Held>> pens;
  std::vector<std::unique_ptr<PluggedDevice>> plugged;
  for (const char* name : {"pen", "huion", "huion-1060", "xppen"}) {
    pens.push_back(std::make_unique<Held>(name, "signature"));
    plugged.push_back(std::make_unique<PluggedDevice>(pens.back()->device, cable));
  }
  CircledMouse<firmware::SpaceMouse> mouse;
  CircledMouse<firmware::SpaceNavigator> navigator;
  std::vector<WantedRows> wanted;
  for (const auto& pen : pens) wanted.push_back({pen->device.spec(), 1});
  wanted[3].count = 2;  // which of its interfaces has the pen is its own affair
  for (StartedDevice* device : {&mouse.device, &navigator.device}) {
    plugged.push_back(std::make_unique<PluggedDevice>(*device, cable));
    wanted.push_back({device->spec(), 1});
  }
  std::vector<Taking> taken;
  for (auto& rows : wait_for_rows(Backend::kEvdev, cable, wanted)) {
    taken.emplace_back(std::move(rows), kFrames);
  }
  for (Taking& one : taken) one.wait_until_open();
  for (const auto& pen : pens) pen->device.start();
  mouse.device.start();
  navigator.device.start();
  for (std::size_t i = 0; i < pens.size(); ++i) {
    SCOPED_TRACE(pens[i]->name);
    const Taken drawn = taken[i].get();
    EXPECT_THAT(drawn.notes, IsEmpty());
    expect_changes(drawn, expected_from(pens[i]->name, "signature", 2 * kFrames, Setup::kNone),
                   kShort);
  }
  SCOPED_TRACE("3D mice");
  const std::size_t reports = 2 * kFrames;
  expect_motion_changes(taken[4].get(), CircledMouse<firmware::SpaceMouse>::expected(reports));
  expect_motion_changes(taken[5].get(), CircledMouse<firmware::SpaceNavigator>::expected(reports));
}

TEST_F(KernelLinks, EventNodesOfUhidTellTheSame) { expect_event_nodes(Cable::kUhid); }

TEST_F(KernelLinks, EventNodesOfUsbipTellTheSame) { expect_event_nodes(Cable::kUsbip); }

TEST_F(KernelLinks, LinuxsOwnUsbipPlugsADeviceInOverTcp) {
  Held pen("pen", "signature");
  firmware::UsbipServer server(pen.device, {.wait_for_reader = false});
  const auto port = server.listen(firmware::usbip::kDefaultPort);
  ASSERT_TRUE(port) << port.error().what;
  auto waiter = firmware::Waiter::make();
  ASSERT_TRUE(waiter);
  std::thread serving([&] { EXPECT_TRUE(server.run(std::chrono::hours(1), *waiter)); });
  EXPECT_EQ(std::system("usbip attach -r 127.0.0.1 -b 1-1"), 0);
  Taking taking(wait_for_rows(Backend::kHidraw, pen.device.spec(), Cable::kUsbip, 1), kShort);
  taking.wait_until_open();
  pen.device.start();
  expect_reports(taking.get(), expected_from("pen", "signature", kShort, Setup::kNone), kShort);
  waiter->stop();
  serving.join();
}

}  // namespace
}  // namespace limn::test
