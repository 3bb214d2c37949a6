// Simulated devices on a stock Linux kernel: what comes by hidraw, libusb and event nodes is what
// the same device gives to a host without a kernel.

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <string_view>
#include <thread>

#include "drivers/devices/trace_decoder.hpp"
#include "drivers/hid/descriptor_parser.hpp"
#include "firmware_sim/devices/catalogue.hpp"
#include "firmware_sim/link/usbip_server.hpp"
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

  static std::string movement(const Held& held) {
    return held.name.starts_with("space") ? "push" : "signature";
  }

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

/// The values of axis `axis` (0 to 5) in the reports of the SpaceMouse: number 1, all six as le16.
std::vector<int> axis_values(const Taken& expected, int axis) {
  std::vector<int> values;
  const auto at = static_cast<std::size_t>(1 + 2 * axis);
  for (const Bytes& report : expected.reports.at(0)) {
    if (report.at(0) != 1) continue;
    values.push_back(static_cast<std::int16_t>(report.at(at) | report.at(at + 1) << 8));
  }
  return values;
}

/// What an axis at rest tells in the course of these values.
std::vector<int> changes(const std::vector<int>& values) {
  std::vector<int> changes;
  int last = 0;
  for (const int value : values) {
    if (value != last) changes.push_back(value);
    last = value;
  }
  return changes;
}

/// What limn makes of a recording of a 3D mouse: the counts of each deflection, once while it
/// stays.
std::vector<std::array<std::int32_t, kMotionAxes>> deflections_of(const std::string& trace) {
  std::vector<std::array<std::int32_t, kMotionAxes>> all;
  auto reader = open_trace(memory_bytes(trace), {});
  EXPECT_TRUE(reader) << reader.error().what;
  if (!reader) return all;
  TraceDecoder decoder(*std::move(reader), {.salvage = true});
  for (;;) {
    const auto sample = decoder.next_any();
    EXPECT_TRUE(sample) << sample.error().what;
    const auto* const motion = sample ? std::get_if<const MotionSample*>(&*sample) : nullptr;
    if (motion == nullptr) return all;
    const bool pushed = !(*motion)->is_zero() && (all.empty() || all.back() != (*motion)->raw);
    if (pushed) all.push_back((*motion)->raw);
  }
}

/// A 3D mouse that calls its axes relative, of which the kernel tells no zero.
void expect_relative_event_node(Cable cable) {
  constexpr std::size_t kFrames = 120;  // of a push's: only half of its reports are translations
  Held mouse("spacenavigator", "push");
  const PluggedDevice plugged(mouse.device, cable);
  Taking taking(wait_for_rows(Backend::kEvdev, mouse.device.spec(), cable, 1), kFrames);
  taking.wait_until_open();
  mouse.device.start();
  const Taken taken = taking.get();
  EXPECT_EQ(taken.frames, kFrames);
  EXPECT_THAT(taken.notes, IsEmpty());
  const auto got = deflections_of(taken.trace);
  auto expected = deflections_of(
      expected_from("spacenavigator", "push", 2 * kFrames + 100, Setup::kNone).trace);
  EXPECT_GT(got.size(), kFrames / 2);
  ASSERT_GE(expected.size(), got.size());
  expected.resize(got.size());
  EXPECT_EQ(got, expected);
}

TEST_F(KernelLinks, RelativeEventNodesOfUhidTellTheSame) {
  expect_relative_event_node(Cable::kUhid);
}

TEST_F(KernelLinks, RelativeEventNodesOfUsbipTellTheSame) {
  expect_relative_event_node(Cable::kUsbip);
}

/// The event nodes of a pen and of a 3D mouse whose axes are absolute.
void expect_event_nodes(Cable cable) {
  constexpr std::size_t kChanges = 150;  // of a push's 206 reports
  Held pen("pen", "signature");
  Held mouse("spacemouse", "push");
  const PluggedDevice plugged_pen(pen.device, cable);
  const PluggedDevice plugged_mouse(mouse.device, cable);
  Taking of_pen(wait_for_rows(Backend::kEvdev, pen.device.spec(), cable, 1), kShort);
  Taking of_mouse(wait_for_rows(Backend::kEvdev, mouse.device.spec(), cable, 1), kChanges);
  of_pen.wait_until_open();
  of_mouse.wait_until_open();
  pen.device.start();
  mouse.device.start();
  const Taken drawn = of_pen.get();
  EXPECT_EQ(drawn.frames, kShort);
  EXPECT_THAT(drawn.notes, IsEmpty());
  expect_changes(drawn, expected_from("pen", "signature", kShort + 100, Setup::kNone), kShort - 10);
  const Taken moved = of_mouse.get();
  EXPECT_EQ(moved.frames, kChanges);
  EXPECT_EQ(moved.axes.size(), 6U);
  const Taken expected = expected_from("spacemouse", "push", kShort, Setup::kNone);
  for (const auto& [axis, values] : moved.axes) {
    SCOPED_TRACE("axis " + std::to_string(axis));
    auto all = changes(axis_values(expected, axis));
    const auto got = changes(values);
    ASSERT_GE(all.size(), got.size());
    all.resize(got.size());
    EXPECT_EQ(got, all);
  }
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
