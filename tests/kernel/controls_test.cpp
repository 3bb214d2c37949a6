// What is asked of 3D mice while their motion is streamed by libusb and hidraw, on a stock Linux
// kernel.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/devices/motion_spec.hpp"
#include "drivers/transport/live_reader.hpp"
#include "drivers/transport/open_device.hpp"
#include "firmware_sim/devices/space_navigator.hpp"
#include "firmware_sim/link/in_memory.hpp"
#include "firmware_sim/usb/usb_device.hpp"
#include "modeler/app/bus_control.hpp"
#include "tests/kernel/device_paths.hpp"
#include "tests/kernel/plugged_device.hpp"
#include "tests/kernel/started_device.hpp"

namespace limn::test {
namespace {

using firmware::SpaceNavigator;
using firmware::TransferResult;
using std::chrono::microseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::array<std::uint8_t, 2> kKept = {5, 42};  // a feature report that is given back

/// A knob at rest at first, then pushed 100 counts along y and about it, and moved one count a
/// period along x and about it, over and over: no report is like its neighbours.
class Ramp final : public firmware::KnobSensor {
 public:
  firmware::KnobPose measure(microseconds time) noexcept override {
    constexpr int kSteps = 170;
    firmware::KnobPose pose;
    pose.time = time;
    const auto step = time / SpaceNavigator::kReportPeriod;
    if (step == 0) return pose;
    pose.deflection[0] = pose.deflection[3] =
        static_cast<double>(step % kSteps) / SpaceNavigator::kMostCounts;
    pose.deflection[1] = pose.deflection[4] = 100.0 / SpaceNavigator::kMostCounts;
    return pose;
  }
};

/// A SpaceNavigator so held, whose light can be looked at from any thread.
class LitMouse final : public firmware::BusDevice {
 public:
  bool light() const noexcept { return light_; }
  /// Whether no control transfer is answered.
  void be_silent(bool silent) noexcept { silent_ = silent; }

  const firmware::DeviceSpec& spec() const noexcept override { return device_.spec(); }
  bool plugged(microseconds now) noexcept override { return device_.plugged(now); }
  void reset() noexcept override { device_.reset(); }
  TransferResult control(const firmware::SetupPacket& setup, microseconds now,
                         std::span<std::uint8_t> data) noexcept override {
    if (silent_) return {firmware::TransferStatus::kNak, 0};
    const TransferResult result = device_.control(setup, now, data);
    light_ = mouse_.light();
    return result;
  }
  TransferResult interrupt_in(std::uint8_t endpoint, microseconds now,
                              std::span<std::uint8_t> data) noexcept override {
    return device_.interrupt_in(endpoint, now, data);
  }
  TransferResult interrupt_out(std::uint8_t endpoint, microseconds now,
                               std::span<const std::uint8_t> data) noexcept override {
    const TransferResult result = device_.interrupt_out(endpoint, now, data);
    light_ = mouse_.light();
    return result;
  }

 private:
  Ramp hand_;
  SpaceNavigator mouse_{hand_};
  firmware::UsbDevice device_{mouse_};
  std::atomic<bool> light_ = false;
  std::atomic<bool> silent_ = false;
};

/// A mouse that can be plugged into Linux by USB/IP, its hand held back.
struct PluggedMouse {
  LitMouse mouse;
  StartedDevice device{mouse};
  std::optional<PluggedDevice> plugged;

  /// Plugs it in and opens it. None of its kind may be on hidraw; one that libusb has is on hidraw
  /// no more, so the next is the only one there.
  std::unique_ptr<Transport> open(Backend backend) {
    plugged.emplace(device, Cable::kUsbip);
    auto rows = wait_for_rows(Backend::kHidraw, mouse.spec(), Cable::kUsbip, 1);
    if (backend != Backend::kHidraw) rows = wait_for_rows(backend, mouse.spec(), Cable::kUsbip, 1);
    if (rows.size() != 1) return nullptr;
    auto opened = open_device(rows[0]);
    EXPECT_TRUE(opened) << opened.error().at << ": " << opened.error().what;
    return opened ? std::move(opened->transport) : nullptr;
  }
};

/// Reports of devices 0 and 1, and notes.
struct Streamed {
  void take_reports(LiveReader& reader, std::size_t enough) {
    while (reports[0].size() < enough || reports[1].size() < enough) take(reader);
  }
  void take_notes(LiveReader& reader, std::size_t enough) {
    while (notes.size() < enough) take(reader);
  }
  void take(LiveReader& reader) {
    const auto event = *reader.next();
    if (const auto* report = std::get_if<Report>(&event)) {
      reports.at(report->device).emplace_back(report->bytes.begin(), report->bytes.end());
    } else if (const auto* note = std::get_if<TraceNote>(&event)) {
      notes.push_back(std::to_string(note->device) + " " + std::string(note->text));
    }
  }

  std::array<std::vector<Bytes>, 2> reports;
  std::vector<std::string> notes;
};

/// Whether a report tells of a knob that is pushed along y, or about it.
bool is_pushed(const Bytes& report) { return report.at(3) != 0 || report.at(4) != 0; }

/// What a mouse gives to a host without a kernel, which takes the knob as it is for its zero after
/// `before` reports.
std::vector<Bytes> expected_reports(std::size_t before, std::size_t count) {
  LitMouse mouse;
  firmware::InMemoryHost host(mouse, firmware::InMemoryHost::Polling::kWhenDue);
  app::BusControl control(host, 0);
  std::vector<Bytes> reports;
  while (reports.size() < count) {
    const auto event = host.next(host.time() + std::chrono::seconds(1));
    if (!event) break;
    if (event->kind != firmware::HostEvent::Kind::kReport) continue;
    reports.emplace_back(event->bytes.begin(), event->bytes.end());
    if (reports.size() == before) {
      EXPECT_TRUE(control.set_feature(zero_report()));
    }
  }
  return reports;
}

class KernelControls : public testing::Test {
 protected:
  void TearDown() override { wait_until_all_are_gone(); }
};

TEST_F(KernelControls, AreAnsweredWhileMotionIsStreamedAndLoseNoReport) {
  constexpr std::size_t kBefore = 100;
  constexpr std::size_t kAfter = 300;
  std::array<PluggedMouse, 2> mice;
  std::vector<std::unique_ptr<Transport>> transports;
  transports.push_back(mice[0].open(Backend::kUsb));
  transports.push_back(mice[1].open(Backend::kHidraw));
  ASSERT_TRUE(transports[0] && transports[1]);
  const auto reader = *LiveReader::start(std::move(transports));
  for (PluggedMouse& one : mice) one.device.start();
  Streamed streamed;
  streamed.take_reports(*reader, kBefore);

  std::array<std::unique_ptr<DeviceControl>, 2> controls;
  for (DeviceIndex i = 0; i < mice.size(); ++i) {
    SCOPED_TRACE(i == 0 ? "libusb" : "hidraw");
    auto control = reader->open_control(i);
    ASSERT_TRUE(control) << control.error().what;
    controls.at(i) = *std::move(control);
    EXPECT_TRUE(controls.at(i)->set_output(light_report(true)));
    EXPECT_TRUE(mice.at(i).mouse.light());
    EXPECT_TRUE(controls.at(i)->set_feature(kKept));
    const auto kept = controls.at(i)->get_feature(kKept[0], kKept.size());
    ASSERT_TRUE(kept) << kept.error().what;
    EXPECT_THAT(*kept, ElementsAre(kKept[0], kKept[1]));
    EXPECT_TRUE(controls.at(i)->set_output(light_report(false)));
    EXPECT_FALSE(mice.at(i).mouse.light());
    EXPECT_TRUE(controls.at(i)->set_feature(zero_report()));
  }
  streamed.take_reports(*reader, kAfter);
  EXPECT_THAT(streamed.notes, IsEmpty());
  for (const auto& reports : streamed.reports) {
    const auto zeroed = std::find_if_not(reports.begin(), reports.end(), is_pushed);
    const auto before = static_cast<std::size_t>(zeroed - reports.begin());
    EXPECT_GE(before, kBefore);
    EXPECT_LT(before, kAfter) << "the zero was not taken anew";
    EXPECT_EQ(reports, expected_reports(before, reports.size()));
  }

  for (PluggedMouse& one : mice) one.plugged.reset();
  streamed.take_notes(*reader, 2);
  EXPECT_THAT(streamed.notes, testing::UnorderedElementsAre("0 gone", "1 gone"));
  for (DeviceIndex i = 0; i < mice.size(); ++i) {
    SCOPED_TRACE(i == 0 ? "libusb" : "hidraw");
    const auto told = controls.at(i)->set_output(light_report(true));
    ASSERT_FALSE(told);
    EXPECT_THAT(told.error().what, HasSubstr("No such device"));
    EXPECT_EQ(reader->open_control(i).error().code, ErrorCode::kMissing);
  }
}

TEST_F(KernelControls, ASilentDeviceRunsOutOfTimeAndIsStreamedOn) {
  PluggedMouse one;
  std::vector<std::unique_ptr<Transport>> transports;
  transports.push_back(one.open(Backend::kUsb));
  ASSERT_TRUE(transports[0]);
  const auto reader = *LiveReader::start(std::move(transports));
  one.mouse.be_silent(true);
  one.device.start();
  const auto control = *reader->open_control(0);
  const auto told = control->set_output(light_report(true));
  ASSERT_FALSE(told);
  EXPECT_EQ(told.error().what, "cannot be told: Connection timed out");
  one.mouse.be_silent(false);              // to Linux, which asks when it has it back
  constexpr std::size_t kMeanwhile = 125;  // a request's longest time of 1 s, a report each 8 ms
  Streamed streamed;
  while (streamed.reports[0].size() < kMeanwhile) streamed.take(*reader);
  EXPECT_THAT(streamed.notes, IsEmpty());
  EXPECT_EQ(streamed.reports[0], expected_reports(0, kMeanwhile));
}

TEST_F(KernelControls, EndWhereNobodyReadsAndWhenTheStreamGoes) {
  PluggedMouse one;
  auto transport = one.open(Backend::kUsb);
  ASSERT_TRUE(transport);
  const auto control = *transport->open_control();
  const auto unread = control->set_output(light_report(true));
  ASSERT_FALSE(unread);
  EXPECT_EQ(unread.error().what, "gives no answer while nobody reads its stream");
  EXPECT_TRUE(one.mouse.light()) << "it was told, all the same";

  auto waiting =
      std::async(std::launch::async, [&] { return control->set_output(light_report(false)); });
  while (one.mouse.light()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  transport.reset();
  const auto ended = waiting.get();  // answered in the last moment, or not
  EXPECT_TRUE(ended || ended.error().what == "cannot be told: No such device");
  const auto gone = control->set_output(light_report(true));
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().what, "cannot be told: No such device");
  EXPECT_FALSE(one.mouse.light());
}

}  // namespace
}  // namespace limn::test
